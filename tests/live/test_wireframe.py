"""Preview and final picture of one simulation: wires on the page, then traced paths."""

import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageFilter
from test_page import until
from test_server import Server, free_port

import bioscope as bio

pytest.importorskip("mitsuba")
pytestmark = pytest.mark.browser

WORLD = """
import bioscope as bio

def world(seed):
    world = bio.World(seed=seed, dt=1 / 60, title="tank")
    world.environment.water(surface=0.0)
    world.environment.set(shafts=0.0)
    shark = bio.RoamingFish(
        center=(0, -3, 0), radius=0.2, body="muscle_swimmer", mind="intentions"
    )
    world.add(shark, "shark")
    world.cameras.fixed(
        "above", position=(-0.7, -1.4, 2.2), target=(-1.4, -3.1, 0.9), field_of_view=24
    )
    return world
"""
SIZE = (360, 240)
TICK = 132
"""The shark turns: its body is bent."""
LATER = 12
"""Ticks after which its pose is another one."""


@pytest.fixture
def page(browser, tmp_path):
    """Return the page with the world standing still at the tick, seen by its camera."""
    script = tmp_path / "tank.py"
    script.write_text(WORLD)
    server = Server(script, "--port", free_port())
    width, height = SIZE
    page = browser.new_page(viewport={"width": width, "height": height}, accept_downloads=True)
    page.errors = []
    page.on("pageerror", lambda error: page.errors.append(str(error)))
    page.set_default_timeout(120_000)
    page.goto(f"{server.address}#world=tank&seed=5&tick={TICK}&camera=above")
    until(page, f"window.bioscope && window.bioscope.tick === {TICK} && !window.bioscope.running")
    yield page
    page.close()
    server.close()


def saved(page, action, path):
    """Press a button of the bar that saves something."""
    with page.expect_download() as download:
        page.evaluate(f"document.querySelector('.bio-bar [data-action={action}]').click()")
    download.value.save_as(path)
    return path


def previewed(page, path):
    """Return the page's own picture, without what lies over it."""
    return np.asarray(Image.open(saved(page, "screenshot", path)).convert("RGB")).astype(int)


def traced_outlines(snapshot):
    """Return the outlines of the fish, path-traced at the tick of a snapshot and later."""
    from bioscope.film.path import PathRenderer
    from bioscope.film.variant import SURE

    world = bio.World.restore(snapshot)
    renderer = PathRenderer(SIZE, 4, mitsuba_variant=SURE, depth_of_field=False)

    def traced():
        return renderer.render(world.scene, world.cameras.now("above")).astype(int)

    assert world.tick == TICK
    now = traced()
    world.step(LATER)
    later = traced()
    world.order("shark", {"number": 0})
    water = traced()  # without beams of light open water looks the same at both ticks
    return filled(differing(now, water)), filled(differing(later, water))


def differing(picture, empty):
    """Return where a picture is not that of the empty water."""
    return np.abs(picture - empty).max(axis=-1) > 6


def filled(marks):
    """Return what the outline of marks encloses, gaps of two pixels closed."""
    image = Image.fromarray(np.pad(marks, 2).astype(np.uint8) * 255)
    image = image.filter(ImageFilter.MaxFilter(3))
    ImageDraw.floodfill(image, (0, 0), 128)
    inside = Image.fromarray((np.asarray(image) != 128).astype(np.uint8) * 255)
    return np.asarray(inside.filter(ImageFilter.MinFilter(3)))[2:-2, 2:-2] > 0


def overlap(one, other):
    """Return intersection over union."""
    return (one & other).sum() / (one | other).sum()


def centered(shape):
    """Return a shape with its centroid in the middle, so that only its form counts."""
    middle = np.argwhere(shape).mean(axis=0).round().astype(int)
    return np.roll(shape, np.array(shape.shape) // 2 - middle, axis=(0, 1))


@pytest.mark.capability("TF-007")
def test_the_wires_of_the_preview_lie_where_the_traced_fish_is(page, tmp_path):
    page.keyboard.press("6")
    page.get_by_role("button", name="wireframe").click()
    wired = previewed(page, tmp_path / "wired.png")
    snapshot = saved(page, "snapshot", tmp_path / "tank.world")
    page.keyboard.press("1")
    number = page.get_by_label("how many shark")
    number.fill("0")
    number.press("Enter")
    until(page, "window.bioscope.instances().length === 0")
    water = previewed(page, tmp_path / "water.png")
    assert page.evaluate("window.bioscope.tick") == TICK
    assert page.errors == []
    page.close()

    wires = differing(wired, water)
    preview = filled(wires)
    now, later = traced_outlines(snapshot)
    assert preview.sum() > 8000
    assert wires.sum() < 0.96 * preview.sum(), "one sees between the wires"
    assert overlap(preview, now) > 0.9
    assert overlap(preview, later) < 0.5
    assert overlap(centered(preview), centered(later)) < 0.6, "the pose, not the place alone"
