"""The world `honda_tiers`: two tiers of branches that compete for space."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.worlds.honda_tiers.world import DISTANCE

STEMS = 2
"""Segments of the stem of each tree, which the model of the tier does not count."""


def tier(world: bio.World, plant: int) -> np.ndarray:
    """Return the places of the leaves of one tree."""
    batches = [one for one in world.scene.batches if one.name.startswith("tier_tree/l")]
    return np.concatenate([one.positions[np.asarray(one.ids) == plant] for one in batches])


@pytest.mark.capability("PL-410", "PL-411", "PL-412")
def test_the_tiers_have_the_published_segments_and_grow_apart():
    world = bio.load("honda_tiers", seed=1)
    world.run(seconds=15)
    stand = world.statistics()
    assert stand["tier_tree.step"] >= 5
    assert stand["tier_tree.segments"] - 2 * STEMS == 138
    trees = [(one.ids[0], one.positions[0]) for one in stems(world)]
    (left, at_left), (right, at_right) = sorted(trees, key=lambda one: one[1][0])
    assert at_right[0] - at_left[0] == pytest.approx(DISTANCE)
    assert tier(world, left)[:, 0].mean() < at_left[0] - 0.1
    assert tier(world, right)[:, 0].mean() > at_right[0] + 0.1


def stems(world: bio.World) -> list[bio.Batch]:
    """Return what is seen of the wood of each tree."""
    return [one for one in world.scene.batches if one.name.removeprefix("tier_tree/").isdigit()]
