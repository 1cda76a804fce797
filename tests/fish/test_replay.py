"""Captured motion, replayed."""

import numpy as np
import pytest

import bioscope as bio


@pytest.mark.capability("TF-224", "AA-402", "AA-404")
def test_a_replayed_fish_swims_as_the_muscle_driven_one_does():
    kinds = [bio.fish.Shoal("anthias", 1, replayed=replayed) for replayed in (False, True)]
    length = bio.fish.Tank("anthias").length
    ways, swings = [], []
    for shoal in kinds:
        shoal.step(1 / 60, ticks=240)
        start = shoal.nodes[0, 5:9].mean(axis=0)
        tails = []
        for _ in range(120):
            shoal.step(1 / 60)
            nodes = shoal.nodes[0]
            tails.append((nodes[-2:].mean(axis=0) - nodes[5:9].mean(axis=0))[0])
        ways.append(np.linalg.norm(shoal.nodes[0, 5:9].mean(axis=0) - start))
        swings.append(np.ptp(tails))
    assert ways[1] == pytest.approx(ways[0], rel=0.1)
    assert abs(swings[1] - swings[0]) < 0.05 * length
