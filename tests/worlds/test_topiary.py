"""The world `topiary`: bushes that are clipped while they grow."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.worlds.topiary.world import SHAPES, bush


def radius(x, z):
    return np.hypot(x, z)


INSIDE = {
    "ball": lambda x, y, z, e: np.sqrt(x**2 + (y - 6) ** 2 + z**2) <= 6 + e,
    "box": lambda x, y, z, e: (abs(x) <= 5 + e) & (abs(z) <= 5 + e) & (y <= 11 + e),
    "cone": lambda x, y, z, e: (y <= 15 + e) & (radius(x, z) <= 6.2 * (1 - y / 15) + e),
    "double": lambda x, y, z, e: (
        (np.sqrt(x**2 + (y - 5) ** 2 + z**2) <= 5 + e)
        | (np.sqrt(x**2 + (y - 12.5) ** 2 + z**2) <= np.sqrt(12.5) + e)
    ),
    "column": lambda x, y, z, e: (radius(x, z) <= np.sqrt(12) + e) & (y <= 14 + e),
    "hourglass": lambda x, y, z, e: (y <= 13 + e) & (radius(x, z) <= 2.2 + 0.62 * abs(y - 6.5) + e),
    "mushroom": lambda x, y, z, e: (
        ((y < 7) & (radius(x, z) <= np.sqrt(5) + e))
        | ((y >= 7 - e) & (np.sqrt(x**2 + z**2 + 2.2 * (y - 7) ** 2) <= np.sqrt(40) + 1.5 * e))
    ),
}
"""Which points (internodes from the foot) are inside each shape, widened by e internodes."""


def bush_points(world: bio.World) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices of the wood, and of the places of leaves, in internodes."""
    wood = next(one for one in world.scene.batches if one.name.split("/")[1].isdigit())
    leaves = [one.positions for one in world.scene.batches if one is not wood and len(one.ids) > 1]
    return wood.mesh.positions.astype(float), np.concatenate(leaves) / 0.1


@pytest.mark.capability("PL-322")
@pytest.mark.parametrize("shape", SHAPES)
def test_each_bush_fills_its_shape_and_stays_in_it(shape: str):
    world = bio.World(seed=1, dt=0.5)
    world.add(bush(shape, (0.0, 0.0), rate=70.0), "bush")
    world.set("bush", "flexibility", 0.0)
    world.run(seconds=1)
    wood, leaves = bush_points(world)
    inside = INSIDE[shape]
    x, y, z = wood.T
    # Shoots are cut after they have left: by one internode (and their own thickness) at most.
    assert inside(x, y, z, 1.2).all()
    assert y.max() >= 8
    grid = np.arange(-8, 8, 2.0) + 1.0
    points = np.concatenate([wood, leaves])[:, [0, 2]]
    occupied = {tuple(column) for column in np.floor(points / 2).astype(int).tolist()}
    heights = np.linspace(0.5, 14, 60)
    columns = [
        (int(np.floor(a / 2)), int(np.floor(b / 2)))
        for a in grid
        for b in grid
        if inside(np.full(60, a), heights, np.full(60, b), -0.3).sum() >= 8
    ]
    share = np.mean([column in occupied for column in columns])
    assert inside(x, y, z, 0.0).mean() >= 0.85
    assert share >= 0.95


def test_the_garden_has_six_shapes_or_more():
    world = bio.load("topiary", seed=1)
    bushes = [name for name in world.populations if name in SHAPES]
    assert len(bushes) == len(SHAPES) >= 6
    world.run(seconds=3)
    statistics = world.statistics()
    assert all(statistics[f"{name}.segments"] > 10 for name in bushes)
