"""Trees of the gallery that live on the light that they catch."""

import math
import re

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery

YEAR = 31


def turn(tree: bio.ModuleString) -> float:
    """Return the angle between the trunk and the segment that follows it, degrees."""
    segments = bio.Turtle().interpret(tree).segments
    trunk, shoot = (segments.end - segments.start)[:2]
    cosine = trunk @ shoot / np.linalg.norm(trunk) / np.linalg.norm(shoot)
    return math.degrees(math.acos(min(1.0, cosine)))


class ShadeOnLaterals(bio.environments.Environment):
    """Keeps the first lateral shoot in the dark, in its first year; the rest has full light."""

    def exchange(self, step, messages):
        """Tell how much light there is."""
        light = np.ones((len(messages["positions"]), 1))
        if step == 2 * YEAR - 1:
            # In the order of the string: trunk, lateral, main shoot.
            assert len(light) == 3
            light[1] = 0
        return light


@pytest.mark.capability("PL-440", "PL-442", "PL-443")
def test_the_tree_of_24_years_has_the_published_size():
    tree = gallery.read("light_tree")
    grown = bio.environments.derive(tree, 24 * YEAR)
    segments = len(bio.Turtle().interpret(grown).segments.end)
    # Published: 22,462 segments of the tree with leading shoots.
    assert 20_000 <= segments <= 25_000
    means, terminals = {}, {}
    for year in (6, 9, 15):
        string = bio.environments.derive(tree, year * YEAR - 1).string()
        light = [float(one) for one in re.findall(r"\?E\(([^)]*)\)", string)]
        means[year] = np.mean(light)
        terminals[year] = string.count("A(")
    assert terminals[6] == 2**5
    assert terminals[9] < 2**8
    assert all(0.4 < means[year] < 0.6 for year in (9, 15))


@pytest.mark.capability("PL-443")
def test_a_shoot_leads_after_its_sister_was_shed():
    free = gallery.read("light_tree")
    stiff = gallery.read("light_tree", AR=1)
    turns = {
        name: [
            turn(bio.environments.derive(tree, year * YEAR - 1, environment=ShadeOnLaterals()))
            for year in (3, 4, 5, 6)
        ]
        for name, tree in (("free", free), ("stiff", stiff))
    }
    assert turns["stiff"] == pytest.approx([20] * 4, abs=0.01)
    assert turns["free"] == sorted(turns["free"], reverse=True)
    assert 1 < turns["free"][0] < 19
    assert turns["free"][-1] < 1
