"""The panels of the page in a real browser: each changes the world, or shows what is in it."""

import json
import time

import numpy as np
import pytest
from PIL import Image
from test_page import picture, until
from test_server import Server, free_port

import bioscope as bio

pytestmark = pytest.mark.browser

WORLD = """
import bioscope as bio

def world(seed):
    world = bio.World(seed=seed, dt=1 / 30, title="pond")
    world.environment.add(bio.Current(speed=0.05))
    mind = bio.minds.Intentions("pacifist", food=["plankton"])
    world.add(bio.RoamingFish("fusilier", 4, center=(0, -2, 0), mind=mind), "fish")
    world.environment.water(surface=0.0)
    world.cameras.fixed("pond", position=(3, -2, 3), target=(0, -2, 0))
    return world
"""


@pytest.fixture(scope="module")
def pond(tmp_path_factory):
    path = tmp_path_factory.mktemp("panels") / "pond.py"
    path.write_text(WORLD)
    return path


@pytest.fixture(scope="module")
def server(pond):
    server = Server(pond, "--port", free_port())
    yield server
    server.close()


@pytest.fixture(scope="module")
def one_page(browser, server):
    page = browser.new_page(viewport={"width": 600, "height": 460}, accept_downloads=True)
    page.errors = []
    page.on("pageerror", lambda error: page.errors.append(str(error)))
    page.set_default_timeout(120_000)
    page.goto(server.address)
    until(page, "window.bioscope && window.bioscope.frames > 2 && window.bioscope.tick > 0")
    yield page
    page.close()


@pytest.fixture
def page(one_page):
    """Return the page with a running world and a selected fish, and no panel open."""
    for _ in range(3):
        one_page.keyboard.press("Escape")
    if not one_page.evaluate("window.bioscope.running"):
        one_page.keyboard.press("Space")
    until(one_page, "window.bioscope.running")
    one_page.keyboard.press("s")
    until(one_page, "window.bioscope.selected > 0")
    yield one_page
    assert one_page.errors == []


def within(condition, seconds=30):
    """Wait until a condition holds; fail if it does not in time."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.2)


def open_panel(page, name):
    page.mouse.move(300, 230)
    page.evaluate(f"document.querySelector('.bio-dock [data-panel={name}]').click()")
    panel = page.locator(f".bio-panel[data-panel={name}]")
    panel.wait_for(state="visible")
    return panel


def slide(panel, label, value):
    """Move a slider as a hand does."""
    panel.get_by_label(label, exact=True).evaluate(
        f"input => {{ input.value = {value}; input.dispatchEvent(new Event('input')); "
        "input.dispatchEvent(new Event('change')) }"
    )


@pytest.mark.capability("TF-190")
def test_the_dock_opens_each_panel(page):
    signs = page.locator(".bio-dock button")
    names = signs.evaluate_all("all => all.map(one => one.dataset.panel)")
    assert len(names) == 9
    for name in names:
        open_panel(page, name)
        shown = page.locator(".bio-panel:visible")
        assert shown.count() == 1
        assert shown.get_attribute("data-panel") == name
        assert len(shown.inner_text()) > 10


@pytest.mark.capability("TF-180")
def test_a_typed_number_is_the_number_there(page):
    panel = open_panel(page, "numbers")
    until(page, "window.bioscope.counts.fish > 0")
    field = panel.get_by_label("how many fish")
    field.fill("6")
    field.press("Enter")
    until(page, "window.bioscope.counts.fish === 6")
    panel.get_by_label("how many come").fill("3")
    panel.get_by_label("what comes").select_option("fish:clownfish")
    panel.get_by_role("button", name="add").click()
    until(page, "window.bioscope.counts.clownfish === 3")
    until(
        page, "window.bioscope.instances().filter(one => one.species === 'clownfish').length === 3"
    )


@pytest.mark.capability("TF-181")
def test_seaweed_comes_with_as_many_leaves_as_are_typed(page, tmp_path):
    panel = open_panel(page, "numbers")
    assert not panel.get_by_label("leaves of each").is_visible()
    panel.get_by_label("what comes").select_option("plants:seagrass")
    leaves = panel.get_by_label("leaves of each")
    assert leaves.input_value() == "28"
    leaves.fill("9")
    panel.get_by_label("how many come").fill("2")
    panel.get_by_role("button", name="add").click()
    until(page, "window.bioscope.counts.seagrass === 2")
    open_panel(page, "layout")
    with page.expect_download() as download:
        page.get_by_role("button", name="save script").click()
    download.value.save_as(tmp_path / "pond.json")
    grown = bio.load(str(tmp_path / "pond.json"), 5)
    for batch in grown.scene.batches:
        if batch.species == "seagrass":
            assert blades(batch.mesh) == 9


def blades(mesh):
    """Count the separate pieces of a mesh: each leaf of a tuft is one."""
    piece = np.unique(mesh.positions, axis=0, return_inverse=True)[1].reshape(-1)
    while True:
        least = piece.copy()
        corners = mesh.triangles
        np.minimum.at(least, corners.ravel(), np.repeat(piece[corners].min(axis=1), 3))
        if (least == piece).all():
            return len(np.unique(piece))
        piece = least


@pytest.mark.capability("TF-183")
def test_a_fish_is_dragged_on_the_map(page):
    page.keyboard.press("Space")
    until(page, "!window.bioscope.running")
    panel = open_panel(page, "layout")
    canvas = panel.locator("canvas")
    box = canvas.bounding_box()
    chosen = page.evaluate("window.bioscope.selected")
    until(page, f"window.bioscope.onMap({chosen}) !== null")

    def places():
        found = page.evaluate("window.bioscope.instances()")
        return {one["id"]: np.array(one["position"]) for one in found}

    settled = places()
    column, row = page.evaluate(f"window.bioscope.onMap({chosen})")
    column, row = column * box["width"], row * box["height"]
    page.mouse.move(box["x"] + column, box["y"] + row)
    page.mouse.down()
    # Another one may lie still nearer to that point of the map.
    chosen = page.evaluate("window.bioscope.selected")
    before = settled[chosen]
    aim = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    for share in (0.3, 0.6, 1.0):
        page.mouse.move(
            aim[0] * share + (box["x"] + column) * (1 - share),
            aim[1] * share + (box["y"] + row) * (1 - share),
        )
        time.sleep(0.2)
    page.mouse.up()
    within(lambda: np.hypot(*(places()[chosen] - before)[[0, 2]]) > 0.05)
    with page.expect_download() as download:
        panel.get_by_role("button", name="save script").click()
    script = json.loads(download.value.path().read_text())
    assert any("place" in step["change"].get("order", {}) for step in script["steps"])
    page.keyboard.press("Space")


@pytest.mark.capability("TF-184", "TF-185", "TF-186", "TF-187")
def test_physics_and_current_are_set(page):
    panel = open_panel(page, "physics")

    def value(owner, name):
        return page.evaluate(
            "([owner, name]) => window.bioscope.parameter(owner, name)", [owner, name]
        )

    slide(panel, "stiffness", 1.5)
    slide(panel, "time step", 0.02)
    until(page, "window.bioscope.parameter('fish', 'muscle_swimmer_stiffness') === 1.5")
    until(page, "window.bioscope.parameter('world', 'time_step') === 0.02")
    panel.get_by_role("button", name="water pushes").click()
    until(page, "window.bioscope.parameter('fish', 'muscle_swimmer_water') === 0")
    panel.get_by_role("button", name="water pushes").click()
    until(page, "window.bioscope.parameter('fish', 'muscle_swimmer_water') === 1")
    dial = panel.locator(".bio-dial").bounding_box()
    page.mouse.click(dial["x"] + dial["width"] / 2, dial["y"] + 8)
    until(page, "Math.abs(window.bioscope.parameter('current', 'bearing')) > 175")
    panel.get_by_role("button", name="flows").click()
    until(page, "window.bioscope.parameter('current', 'strength') === 0")
    assert value("fish", "muscle_swimmer_mass") == 1.0


@pytest.mark.capability("TF-188")
def test_the_chart_of_drives_is_that_of_the_world(page, pond):
    before = page.evaluate("window.bioscope.tick")
    page.keyboard.press("r")
    page.get_by_role("button", name="with this seed").click()
    until(page, f"window.bioscope.tick >= 0 && window.bioscope.tick < {before}")
    page.keyboard.press("s")
    panel = open_panel(page, "behavior")
    until(page, "window.bioscope.drives !== null && window.bioscope.drives[0] > 0.5")
    page.keyboard.press("Space")
    until(page, "!window.bioscope.running")
    chosen = page.evaluate("window.bioscope.selected")
    alone = bio.load(str(pond), 5)
    alone.step(page.evaluate("window.bioscope.tick"))
    now = pytest.approx(alone.time)
    within(lambda: page.evaluate("window.bioscope.drives")[0] == now)
    _, *drives = page.evaluate("window.bioscope.drives")
    index = [int(one) for one in alone._engine.values("fish", "id")].index(chosen)
    logged = [alone._engine.values("fish", name)[index] for name in ("hunger", "libido", "fear")]
    assert drives == pytest.approx(logged)
    lit = panel.locator(".bio-lit").inner_text()
    assert lit == alone._engine.values("fish", "intention")[index]
    slide(panel, "appetite", 8)
    until(page, "window.bioscope.trait('intentions_appetite') === 8")
    page.keyboard.press("Space")


@pytest.mark.capability("TF-189")
def test_habits_are_switched(page):
    panel = open_panel(page, "habits")
    panel.get_by_role("button", name="darkness").click()
    until(page, "window.bioscope.trait('intentions_likes_dark') === 1")
    panel.get_by_role("button", name="brightness").click()
    until(page, "document.querySelector('.bio-habits').innerText.includes('Indifferent')")
    panel.get_by_role("button", name="female").click()
    until(page, "window.bioscope.trait('intentions_female') === 1")


@pytest.mark.capability("TF-194", "TF-195", "TF-191", "TF-192")
def test_the_fish_view_turns_shows_identities_and_keeps_views(page):
    page.keyboard.press("Space")
    until(page, "!window.bioscope.running")
    panel = open_panel(page, "view")
    until(page, "window.bioscope.retinaPixels() !== null")
    ahead = page.evaluate("window.bioscope.retinaPixels()")
    slide(panel, "pan, to the left", 70)
    until(page, "document.querySelector('.bio-eye output').textContent.startsWith('70')")
    within(lambda: page.evaluate("window.bioscope.retinaPixels()") != ahead)
    panel.get_by_role("button", name="identity").click()

    def is_a_map():
        colors = np.array(page.evaluate("window.bioscope.retinaPixels()")).reshape(-1, 4)
        return 1 <= len({tuple(one) for one in colors if tuple(one[:3]) != (8, 14, 20)}) < 20

    within(is_a_map)
    panel.get_by_role("button", name="both eyes").click()
    until(page, "document.querySelector('.bio-eye small').textContent.includes('left and right')")
    plain = picture(page)
    panel.get_by_role("button", name="labels").click()
    within(lambda: np.abs(picture(page) - plain).max() > 60)
    with page.expect_download() as download:
        panel.get_by_role("button", name="save view").click()
    saved = json.loads(download.value.path().read_text())
    page.mouse.wheel(0, 400)
    with page.expect_file_chooser() as chooser:
        panel.get_by_role("button", name="load view").click()
    chooser.value.set_files(download.value.path())
    there = pytest.approx(saved["eye"], abs=0.05)
    within(lambda: page.evaluate("window.bioscope.camera.position") == there)
    page.keyboard.press("Space")


@pytest.mark.capability("TF-193")
def test_the_picture_is_dumped_to_a_file(page):
    with page.expect_download() as download:
        page.keyboard.press("p")
    image = Image.open(download.value.path())
    assert image.format == "PNG"
    assert min(image.size) > 100
    assert np.asarray(image.convert("RGB")).std() > 2


@pytest.mark.capability("TF-196")
def test_one_becomes_a_fish_and_lets_go(page):
    page.keyboard.press("b")
    until(page, "window.bioscope.steered > 0 && window.bioscope.behavior === 'steered'")
    page.keyboard.down("d")
    until(page, "window.bioscope.value('wanted_heading')[0] < -0.5")
    page.keyboard.up("d")
    until(page, "Math.abs(window.bioscope.value('wanted_heading')[0]) < 0.01")
    page.mouse.move(400, 200)
    page.mouse.down()
    page.mouse.move(140, 260)
    until(page, "window.bioscope.value('wanted_heading')[0] > 0.3")
    page.mouse.up()
    page.keyboard.press("Escape")
    until(page, "window.bioscope.steered === 0 && window.bioscope.behavior !== 'steered'")
    assert page.evaluate("window.bioscope.selected") > 0
