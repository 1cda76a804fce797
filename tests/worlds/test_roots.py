"""The world `roots`: two herbs whose roots share the water of the soil."""

import re

import numpy as np
import pytest

import bioscope as bio
from bioscope.worlds.roots.world import CELL, CELLS, SPRINGS, herbs


def roots(world: bio.World) -> list[np.ndarray]:
    """Return what is below the ground of each plant: places of vertices, metres."""
    batches = [one for one in world.scene.batches if re.fullmatch(r"herb/\d+", one.name)]
    places = [one.positions[0] + one.mesh.positions * one.scales[0] for one in batches]
    return [one[one[:, 1] < 0] for one in places]


def has_reached(places: np.ndarray, spring: tuple[float, ...]) -> bool:
    """Return whether a root is at a spring, to four cells."""
    low_x, low_y, _, high_x, high_y, _, _ = spring
    x, y = places[:, 0] / CELL, places[:, 1] / CELL + CELLS[1] / 2 - 0.5
    near = (x > low_x - 4) & (x < high_x + 4) & (y > low_y - 4) & (y < high_y + 4)
    return bool(near.any())


def stopped_side_roots(string: str) -> list[float]:
    """Return the lengths of the side roots of the first order that have no tip any more."""
    lengths, stack = [], [{"length": 0.0, "order": -1, "tip": False}]
    for module in re.finditer(r"([\[\]A]|F)(?:\(([^)]*)\))?", string):
        letter, numbers = module[1], (module[2] or "").split(",")
        if letter == "[":
            stack.append({"length": 0.0, "order": -1, "tip": False})
        elif letter == "]":
            root = stack.pop()
            if root["order"] == 1 and not root["tip"]:
                lengths.append(root["length"])
        elif letter == "A":
            stack[-1]["tip"] = True
        else:
            stack[-1]["length"] += float(numbers[0])
            stack[-1]["order"] = int(float(numbers[1]))
    return lengths


@pytest.mark.capability("PL-430")
def test_roots_follow_the_water_and_stop_where_it_is_dry():
    reached, lengths = [], []
    for seed in (1, 2, 3):
        world = bio.World(seed=seed, dt=1 / 30)
        stand = world.add(herbs(start=180), "herbs")
        both = roots(world)
        assert all(one[:, 1].min() > -CELLS[1] * CELL for one in both), "none leaves the soil"
        places = np.concatenate(both)
        reached += [has_reached(places, spring) for spring in SPRINGS]
        for string in stand.values("string"):
            lengths += stopped_side_roots(string)
    assert np.mean(reached) >= 0.5, "most springs have been found"
    assert len(lengths) > 20
    assert np.mean(np.array(lengths) < 5.0) > 0.2, "they stop short where it is dry"


def test_each_root_system_keeps_to_its_own_ground():
    gaps = []
    for seed in (1, 2, 3):
        world = bio.World(seed=seed, dt=1 / 30)
        world.add(herbs(start=150), "herbs")
        left, right = roots(world)
        gaps.append(right[:, 0].mean() - left[:, 0].mean())
    assert np.mean(gaps) > 0.25


def test_the_world_grows_evenly():
    world = bio.load("roots", seed=1)
    world.run(seconds=0.5)
    depths = []
    for _ in range(30):
        world.step(2)
        depths.append(min(one[:, 1].min() for one in roots(world)))
    falls = -np.diff(depths)
    assert falls.max() < 0.6 * CELL
    assert depths[-1] < -0.1
