"""The world `clover`: clones that look for light on a forest floor."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.worlds.clover.world import BRIGHT, GLADE, UNIT, clone


def leaves(world: bio.World) -> np.ndarray:
    """Return the places of all leaves, x and z."""
    found = [one.positions for one in world.scene.batches if one.name.startswith("clover/l")]
    return np.concatenate(found)[:, [0, 2]] if found else np.zeros((0, 2))


def inside(places: np.ndarray, patch: tuple[tuple[float, float], float]) -> int:
    center, radius = patch
    return int((np.linalg.norm(places - center, axis=1) < radius).sum())


@pytest.mark.capability("PL-420", "PL-423")
def test_a_clone_crosses_the_poor_light_to_the_bright_patch():
    """One plant with the published light: at the half-lit patch, heading for the bright one."""
    reached, reinvaded = [], []
    for seed in range(1, 7):
        world = bio.World(seed=seed, dt=1 / 6)
        one = bio.Plants(
            "clover",
            1,
            habitat=bio.Habitat(area=[GLADE[0]]),
            size=UNIT,
            rate=6.0,
            environment=bio.environments.PatchLight(),
            origin=(0.0, 0.0, 0.0),
            lying=True,
            turned=False,
            flexibility=0.0,
        )
        world.add(one, "clover")
        counts = []
        for _ in range(182):
            world.step()
            places = leaves(world)
            counts.append((inside(places, BRIGHT), inside(places, GLADE)))
        bright, glade = np.array(counts).T
        reached.append(bool((bright[:60] > 0).any()))
        taken = np.flatnonzero(glade > 0)
        reinvaded.append(bool((np.diff(taken) > 10).any()))
    assert sum(reached) >= 3
    assert sum(reinvaded) >= 1


def test_light_decides_where_the_leaves_are():
    world = bio.World(seed=3, dt=1 / 6)
    world.add(clone(), "clover")
    bright, dark = 0, 0
    for _ in range(60):
        world.step()
        places = leaves(world)
        bright += inside(places, BRIGHT)
        dark += inside(places, ((1.6, 1.6), BRIGHT[1]))
    assert bright > 2 * dark


def test_the_floor_is_settled_by_several_plants_and_by_seeds():
    world = bio.load("clover", seed=2)
    assert world.populations["clover"] == 4
    world.run(seconds=8)
    assert len(leaves(world)) > 60
    assert any(event.kind == "germinated" for event in world.events)
    heights = np.concatenate(
        [one.positions[:, 1] for one in world.scene.batches if one.name.startswith("clover/l")]
    )
    assert heights.min() > -0.01
    assert heights.max() < 0.4
