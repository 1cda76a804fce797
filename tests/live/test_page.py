"""The page in a real browser: it draws, moves, inspects, pauses, reconnects."""

import random
import time
from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from test_server import Server, free_port

pytestmark = pytest.mark.browser

WORLD = """
import bioscope as bio

def world(seed):
    world = bio.World(seed=seed, title="tank")
    world.environment.water(surface=0.0, current=bio.Current(speed=0.05))
    world.add(bio.FishSchool("fusilier", 24, center=(0, -2, 0)), "school")
    world.cameras.follow("school", species="fusilier", index=7, offset=(2.5, 0.5, 1.0))
    return world
"""


@pytest.fixture(scope="module")
def tank(tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "tank.py"
    path.write_text(WORLD)
    return path


@pytest.fixture
def server(tank):
    server = Server(tank, "--port", free_port())
    yield server
    server.close()


@pytest.fixture
def page(browser, server):
    page = browser.new_page(viewport={"width": 480, "height": 300})
    page.errors = []
    page.on("pageerror", lambda error: page.errors.append(str(error)))
    page.set_default_timeout(120_000)
    page.goto(server.address)
    until(page, "window.bioscope && window.bioscope.frames > 3 && window.bioscope.tick > 5")
    yield page
    assert page.errors == []
    page.close()


def until(page, condition, seconds=120):
    page.wait_for_function(condition, timeout=seconds * 1000)


def picture(page):
    return np.asarray(Image.open(BytesIO(page.screenshot())).convert("RGB")).astype(int)


def a_fish_on_screen(page):
    """Return a fish near the middle of the picture."""
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        seen = [
            one
            for one in page.evaluate("window.bioscope.instances()")
            if one["screen"] and 120 < one["screen"][0] < 360 and 60 < one["screen"][1] < 200
        ]
        if seen:
            return seen
        time.sleep(0.5)
    raise AssertionError("no fish came into the picture")


def test_it_draws_and_the_fish_move(page):
    first = picture(page)
    assert first.reshape(-1, 3).std(axis=0).max() > 4
    places = {one["id"]: one["position"] for one in page.evaluate("window.bioscope.instances()")}
    tick = page.evaluate("window.bioscope.tick")
    until(page, f"window.bioscope.tick > {tick + 60}")
    later = {one["id"]: one["position"] for one in page.evaluate("window.bioscope.instances()")}
    moved = [np.linalg.norm(np.subtract(later[one], places[one])) for one in places]
    assert len(moved) == 24
    assert np.median(moved) > 0.05
    assert np.abs(picture(page) - first).max() > 20


def test_pause_pauses_and_step_steps(page):
    page.keyboard.press("Space")
    until(page, "!window.bioscope.running")
    tick = page.evaluate("window.bioscope.tick")
    time.sleep(1.5)
    assert page.evaluate("window.bioscope.tick") == tick
    page.keyboard.press("ArrowRight")
    until(page, f"window.bioscope.tick == {tick + 1}")
    page.keyboard.press("ArrowLeft")
    until(page, f"window.bioscope.tick == {tick}")
    page.keyboard.press("Space")
    until(page, f"window.bioscope.running && window.bioscope.tick > {tick + 5}")


def test_a_click_opens_the_inspector_with_a_retina(page):
    page.keyboard.press("Space")
    until(page, "!window.bioscope.running")
    deadline = time.monotonic() + 60
    while not page.evaluate("window.bioscope.selected") and time.monotonic() < deadline:
        page.mouse.click(*random.choice(a_fish_on_screen(page))["screen"])
        time.sleep(1)
    assert page.evaluate("window.bioscope.selected") > 0
    until(page, "window.bioscope.retinaPixels() !== null")
    pixels = np.array(page.evaluate("window.bioscope.retinaPixels()")).reshape(-1, 4)
    assert pixels[:, :3].std() > 1
    assert "fusilier" in page.inner_text("body").lower()


def test_next_animal_and_its_eye(page):
    page.keyboard.press("s")
    until(page, "window.bioscope.selected > 0")
    chosen = page.evaluate("window.bioscope.selected")
    page.keyboard.press("s")
    until(page, f"window.bioscope.selected > 0 && window.bioscope.selected != {chosen}")
    before = page.evaluate("window.bioscope.camera.name")
    page.keyboard.press("c")
    until(page, f"window.bioscope.camera.name != {before!r}")
    page.keyboard.press("?")
    assert "Space" in page.inner_text("body")


def test_it_reconnects_by_itself(page, server, tank):
    server.process.kill()
    server.process.wait()
    until(page, "!window.bioscope.connected")
    assert page.evaluate("window.bioscope.notices").__len__() > 0
    again = Server(tank, "--port", server.port)
    try:
        until(page, "window.bioscope.connected && window.bioscope.tick >= 0")
        tick = page.evaluate("window.bioscope.tick")
        until(page, f"window.bioscope.tick != {tick}")
    finally:
        again.close()
