"""What the tests share: small worlds of Python populations, and the check of capability markers."""

import contextlib
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import bioscope as bio

ROOT = Path(__file__).parent.parent
CHROMIUM = next(
    filter(None, map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])), None
)
GRAPHICS = [
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-background-networking",
    "--disable-component-update",
]
"""Flags with which Chromium draws in three dimensions on a machine without graphics hardware."""
CAPABILITY = re.compile(r"[A-Z]{2}-[A-Z]?\d+[a-z]?")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Refuse capability ids of a wrong form."""
    for item in items:
        for mark in item.iter_markers("capability"):
            wrong = [one for one in mark.args if not CAPABILITY.fullmatch(str(one))]
            if wrong or not mark.args:
                raise pytest.UsageError(f"{item.nodeid}: capability ids {wrong or '(none)'}")


class Drifters(bio.Population):
    """Grains that drift with the flow and wander at random; some are born, some die."""

    tunable = {"wander": ("m/s", 0.0, 2.0, 0.3, "Speed of wandering.")}

    def __init__(self, number: int = 8) -> None:
        self.number = number
        self.ids = np.empty(0, np.uint32)
        self.places = np.empty((0, 3), np.float32)
        self.flow = np.empty((0, 3), np.float32)
        self.steps = np.empty((0, 3), np.float32)
        self.ticks = 0

    @property
    def count(self) -> int:
        return len(self.ids)

    def settle(self) -> int:
        return self.number

    def born(self, ids):
        start = np.stack([np.cos(ids), -1 - 0.1 * (ids % 5), np.sin(ids)], axis=1)
        self.ids = np.concatenate([self.ids, ids])
        self.places = np.concatenate([self.places, start.astype(np.float32)])

    def sense(self, view):
        self.flow = view.flow(self.places)
        self.steps = view.random(self.ids, "wander", 3) - 0.5

    def move(self, dt):
        self.places = self.places + (self.flow + self.wander * self.steps) * np.float32(dt)

    def grow(self) -> int:
        self.ticks += 1
        if self.ticks % 20 == 0:
            self.ids, self.places = self.ids[1:], self.places[1:]
            return 1
        return 0

    def publish(self, scene):
        radii = np.full(len(self.ids), 0.05, np.float32)
        scene.points("drifters", ids=self.ids, positions=self.places, radii=radii)
        if self.ticks % 20 == 0 and self.count:
            scene.event("born", int(self.ids[-1]), height_m=float(self.places[-1, 1]))

    def inspect(self, individual):
        found = np.flatnonzero(self.ids == individual)
        return {"height_m": float(self.places[found[0], 1])} if len(found) else None


def small_world(seed: int = 5) -> bio.World:
    """Return a small world with water, a current and drifters."""
    world = bio.World(seed=seed, dt=1 / 60, title="small")
    current = bio.Current(direction=(1, 0, 0), speed=0.2)
    world.environment.water(surface=0.0, current=current)
    world.add(Drifters(), "drifters")
    world.cameras.fixed("main", position=(0, -1, 5), target=(0, -1, 0))
    return world


@pytest.fixture
def world() -> bio.World:
    return small_world()


@contextlib.contextmanager
def chromium(*flags):
    """A browser for the tests of a page."""
    from playwright.sync_api import sync_playwright

    if CHROMIUM is None:
        pytest.fail("Chromium is missing: install it (Debian: apt install chromium)")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=CHROMIUM, args=["--no-sandbox", *flags]
        )
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def browser():
    """Chromium, for pages with pictures in three dimensions."""
    with chromium(*GRAPHICS) as browser:
        yield browser


@pytest.fixture(scope="module")
def flat_browser():
    """Chromium for pages in two dimensions, which the processor draws faster by itself."""
    with chromium("--disable-gpu") as browser:
        yield browser


@pytest.fixture
def bioscope(tmp_path):
    """Run the command line in a folder of its own; returns the finished process."""

    def run(*arguments: object, timeout: float = 300) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "bioscope.cli", *map(str, arguments)]
        return subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, timeout=timeout, check=False
        )

    return run


SCRIPT = """
import sys
sys.path.insert(0, {tests!r})
from conftest import small_world

def world(seed):
    return small_world(seed)
"""


@pytest.fixture
def script(tmp_path) -> Path:
    """A world script for the command line."""
    path = tmp_path / "small.py"
    path.write_text(SCRIPT.format(tests=str(Path(__file__).parent)))
    return path
