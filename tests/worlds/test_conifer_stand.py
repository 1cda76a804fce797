"""The world `conifer_stand`: conifers that shade each other in rank and file."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.worlds.conifer_stand.world import stand

YEAR = 13


def grown(rows: int, spacing: float, years: int, seed: int = 1) -> tuple[bio.World, bio.Plants]:
    world = bio.World(seed=seed, dt=1 / 30)
    return world, world.add(stand(rows, spacing, start=years * YEAR))


def wood(world: bio.World, plant: int) -> np.ndarray:
    """Return the vertices of a tree, metres from its foot."""
    batch = next(one for one in world.scene.batches if plant in one.ids and len(one.ids) == 1)
    return batch.mesh.positions * batch.scales[0]


def crown_base(points: np.ndarray) -> float:
    """Return the height of the lowest branches that reach out, metres."""
    out = np.hypot(points[:, 0], points[:, 2]) > 0.35
    return float(np.percentile(points[out][:, 1], 4))


@pytest.mark.capability("PL-447")
def test_the_middle_sheds_its_branches_before_edge_and_corner():
    bases = {"middle": [], "edge": [], "corner": []}
    for seed in (1, 2, 3):
        world, trees = grown(3, 1.6, years=12, seed=seed)
        ids = [int(one) for one in trees.values("id")]
        for number, plant in enumerate(ids):
            kind = "middle" if number == 4 else "edge" if number % 2 else "corner"
            bases[kind].append(crown_base(wood(world, plant)))
    mean = {kind: float(np.mean(one)) for kind, one in bases.items()}
    assert mean["middle"] > mean["edge"] > mean["corner"], mean


def test_the_world_grows_a_year_in_two_seconds():
    world = bio.load("conifer_stand", seed=2)
    before = world.statistics()
    world.run(seconds=4)
    after = world.statistics()
    assert after["conifer.step"] - before["conifer.step"] == 2 * YEAR
    assert after["conifer.segments"] > 2 * before["conifer.segments"]
    assert world.populations["conifer"] == 9
