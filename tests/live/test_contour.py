"""The contour page in a browser: a mesh locks to a pictured fish, texture coordinates come out."""

import json
import re
import signal
import subprocess
import sys
import urllib.request
from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from test_server import free_port

import bioscope as bio
from bioscope.lsystem.specimen import Specimen

pytestmark = pytest.mark.browser

WIDTH, HEIGHT = 480, 320
CENTER = np.array([240.0, 160.0])


@pytest.fixture(scope="module")
def address():
    command = [sys.executable, "-m", "bioscope.cli", "contour", "--no-open"]
    process = subprocess.Popen(
        [*command, "--port", str(free_port())], stderr=subprocess.PIPE, text=True
    )
    found = re.search(r"contours at (http://\S+)", process.stderr.readline())
    yield found[1]
    process.send_signal(signal.SIGINT)
    assert process.wait(15) == 130
    process.kill()


def half_height(along, depth=95.0):
    """Half the height of the drawn body at places along it, -1 (snout) to 1 (root of the tail)."""
    inside = np.abs(along) < 1
    return np.where(inside, depth * np.sqrt(np.maximum(1 - along**2, 0)) * (1 - 0.3 * along), 0)


def outline():
    along = -np.cos(np.linspace(0, np.pi, 6000))
    x = CENTER[0] + 180 * along
    return np.concatenate(
        [np.stack([x, CENTER[1] + side * half_height(along)], axis=1) for side in (-1, 1)]
    )


def drawn(depth=95.0):
    """Colors of a striped body on a plain ground, and where the body is."""
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    inside = np.abs(y - CENTER[1]) < half_height((x - CENTER[0]) / 180, depth)
    shade = np.where(inside, 0.55 + 0.1 * np.sin(x / 9), 0.9)
    return np.stack([shade, 0.8 * shade, np.where(inside, 0.2, shade)], axis=2), inside


def picture(marks=0, depth=95.0):
    """The drawn body as a file; with marks in the corners, so many pixels from it."""
    rgb, _ = drawn(depth)
    if marks:
        left, right = int(CENTER[0] - 180 - marks), int(CENTER[0] + 180 + marks)
        top, bottom = int(CENTER[1] - 97 - marks), int(CENTER[1] + 97 + marks)
        for row in (top, bottom):
            for column in (left, right):
                rgb[row - 2 : row + 3, column - 2 : column + 3] = 0
    file = BytesIO()
    Image.fromarray((255 * rgb).astype(np.uint8)).save(file, "PNG")
    return {"name": "drawn.png", "mimeType": "image/png", "buffer": file.getvalue()}


@pytest.fixture
def page(address, flat_browser):
    page = flat_browser.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(120_000)
    faults = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.goto(address)
    status(page, "paused")
    page.set_input_files("input[type=file]", picture())
    page.wait_for_timeout(300)
    yield page
    page.close()
    assert not faults


def status(page, text):
    page.locator(".status", has_text=text).wait_for(timeout=120_000)


def press(page, title):
    page.get_by_role("button", name=title, exact=True).click()


def table(page):
    with page.expect_download() as download:
        press(page, "Save coordinates (.json)")
    return json.loads(download.value.path().read_text())


def nodes(page):
    """Places of the nodes in pixels of the picture: rows × columns × 2."""
    return np.array(table(page)["coordinates"]) * [WIDTH, HEIGHT]


def on_screen(point):
    scale = 0.86 * min(1280 / WIDTH, 800 / HEIGHT)
    return (
        0.5 * (1280 - scale * WIDTH) + scale * point[0],
        0.5 * (800 - scale * HEIGHT) + scale * point[1],
    )


def border(points):
    return np.concatenate([points[0], points[-1], points[:, 0], points[:, -1]])


def distances(points):
    return np.linalg.norm(points[:, None] - outline()[None], axis=2).min(axis=1)


@pytest.mark.capability("TF-054", "TF-059", "AA-006")
def test_the_mesh_locks_to_the_outline(page):
    press(page, "Settle")
    status(page, "settled")
    found = table(page)
    assert (found["rows"], found["columns"]) == (9, 21)
    coordinates = np.array(found["coordinates"])
    assert coordinates.shape == (9, 21, 2)
    assert np.isfinite(coordinates).all()
    assert coordinates.min() >= 0
    assert coordinates.max() <= 1
    points = coordinates * [WIDTH, HEIGHT]
    assert distances(border(points)).max() < 2
    across, down = np.diff(points, axis=1)[:-1], np.diff(points, axis=0)[:, :-1]
    assert (across[..., 0] * down[..., 1] > across[..., 1] * down[..., 0]).all(), (
        "all cells have areas of one sign"
    )
    assert "0 folds" in page.locator(".status").text_content()
    inner = points[1:-1, 1:-1]
    around = points[:-2, 1:-1] + points[2:, 1:-1] + points[1:-1, :-2] + points[1:-1, 2:]
    assert np.linalg.norm(inner - around / 4, axis=2).max() < 2


@pytest.mark.capability("AA-005")
@pytest.mark.parametrize("depth", [55.0, 95.0, 105.0], ids=["slender", "plump", "deep"])
def test_the_modelled_fish_looks_like_its_picture(page, depth):
    page.set_input_files("input[type=file]", picture(depth=depth))
    page.wait_for_timeout(300)
    press(page, "Settle")
    status(page, "settled")
    form = bio.fish.Form.of_picture(
        table(page)["coordinates"], (WIDTH, HEIGHT), length=0.36, fins=(1e-4, 1e-4)
    )
    rgb, inside = drawn(depth)
    pixels = np.dstack([(255 * rgb).astype(np.uint8), np.full((HEIGHT, WIDTH), 255, np.uint8)])
    world = bio.World(seed=1)
    world.add(Specimen(form.mesh(), "pictured", material=bio.Material(texture=pixels)))
    world.step()
    # From so far away, the body's side is seen as in the picture: 360 pixels are 0.36 m.
    camera = bio.Camera.looking_at((48, 0, -0.18), (0, 0, -0.18), 2 * np.arctan(0.16 / 48))
    seen = bio.look(world.scene, camera, (WIDTH, HEIGHT))
    shown = seen.identity > 0
    assert (shown & inside).sum() / (shown | inside).sum() >= 0.9
    both = shown & inside
    drawn_shade, seen_shade = rgb[..., 0][both], seen.color[..., 0][both]
    assert np.corrcoef(drawn_shade, seen_shade)[0, 1] > 0.45, "stripes are where they were drawn"


@pytest.mark.capability("TF-055")
def test_a_dragged_node_follows_the_cursor_and_goes_back(page):
    press(page, "Settle")
    status(page, "settled")
    before = nodes(page)[0, 10]
    to = before - [0, 14]
    page.mouse.move(*on_screen(before))
    page.mouse.down()
    page.mouse.move(*on_screen(before - [0, 6]))
    page.mouse.move(*on_screen(to))
    status(page, "settled")
    # The spring gives a little to the outline.
    assert np.linalg.norm(nodes_while_held(page)[0, 10] - to) < 4
    page.mouse.up()
    page.wait_for_timeout(100)
    status(page, "settled")
    assert distances(nodes(page)[0, 10][None])[0] < 2


def nodes_while_held(page):
    """Places of the nodes, saved without the mouse, which is holding one."""
    with page.expect_download() as download:
        page.get_by_role("button", name="Save coordinates (.json)", exact=True).dispatch_event(
            "click"
        )
    points = json.loads(download.value.path().read_text())["coordinates"]
    return np.array(points) * [WIDTH, HEIGHT]


@pytest.mark.capability("TF-056")
def test_an_anchored_node_stays_near_its_anchor(page):
    start = nodes(page)[8, 2]
    assert distances(start[None])[0] > 8
    page.mouse.dblclick(*on_screen(start))
    status(page, "1 anchors")
    press(page, "Settle")
    status(page, "settled")
    points = nodes(page)
    assert np.linalg.norm(points[8, 2] - start) < 3
    far = np.delete(border(points), [21 + column for column in range(6)], axis=0)
    assert np.median(distances(far)) < 2


@pytest.mark.capability("TF-057")
def test_a_wider_potential_catches_from_further_away(page):
    """The mesh begins at marks well outside the fish."""
    page.set_input_files("input[type=file]", picture(marks=26))
    page.wait_for_timeout(300)
    away = distances(border(nodes(page)))
    assert np.median(away) > 12
    caught = {}
    for width in (1.5, 14):
        press(page, "Start over")
        field = page.locator(".tp-lblv", has_text="range, px").locator("input")
        field.fill(str(width))
        field.press("Enter")
        press(page, "Settle")
        status(page, "settled")
        caught[width] = np.mean(distances(border(nodes(page))) < 2)
    assert caught[1.5] < 0.5
    assert caught[14] > 0.9


@pytest.mark.capability("TF-058")
def test_fins_have_a_mesh_of_their_own(page):
    page.locator("select").first.select_option(label="fin, 2 × 12")
    status(page, "2 × 12")
    press(page, "Settle")
    status(page, "settled")
    points = nodes(page)
    assert points.shape == (2, 12, 2)
    assert distances(border(points)).max() < 2


def test_the_whole_mesh_is_moved_and_sized(page):
    before = nodes(page)
    middle = on_screen(CENTER)
    page.keyboard.down("Shift")
    page.mouse.move(*middle)
    page.mouse.wheel(0, 300)
    page.mouse.down()
    page.mouse.move(middle[0] + 40, middle[1] + 10)
    page.mouse.up()
    page.keyboard.up("Shift")
    page.wait_for_timeout(300)
    after = nodes(page)
    scale = 0.86 * min(1280 / WIDTH, 800 / HEIGHT)
    wanted = CENTER + np.exp(-0.45) * (before - CENTER) + np.array([40, 10]) / scale
    assert np.abs(after - wanted).max() < 0.5


def test_what_is_no_picture_is_told(page):
    page.set_input_files(
        "input[type=file]", {"name": "letter.txt", "mimeType": "text/plain", "buffer": b"Dear"}
    )
    status(page, "letter.txt: no picture that this browser reads")


def test_only_this_machine_is_answered(address):
    request = urllib.request.Request(address, headers={"Host": "elsewhere.example"})
    with pytest.raises(urllib.error.HTTPError, match="421"):
        urllib.request.urlopen(request)
