"""Conifers that compete for light: alone, in pairs and in a stand."""

import re

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery

YEARS_15 = 194
WOOD = 1


def trees(string: bio.ModuleString, spacing: float) -> dict[tuple[int, int], np.ndarray]:
    """Return the upper ends of all segments by column and row, about the stem of each tree."""
    symbols = np.array(string.symbols)[string.kinds]
    depth = np.cumsum((symbols == "[").astype(int) - (symbols == "]"))
    number = np.cumsum((symbols == "[") & (depth == 1)) - 1
    owners = number[symbols == "F"]
    drawn = bio.Turtle().interpret(string).segments
    ends = drawn.end[drawn.color == WOOD]
    assert len(owners) == len(ends)
    grown = {}
    for one in range(owners.max() + 1):
        stem = ends[owners == one][0] * (1, 0, 1)
        place = tuple(np.round((stem[[0, 2]] - ends[0, [0, 2]]) / spacing).astype(int).tolist())
        grown[place] = ends[owners == one] - stem
    return grown


def stand(rows: int, spacing: float) -> bio.ModuleString:
    """Grow a stand."""
    system = gallery.read("conifer", ROWS=rows, SPACING=spacing)
    return bio.environments.derive(system, YEARS_15)


def crown_base(tree: np.ndarray) -> float:
    """Return the height below which the tree has hardly any twigs."""
    twigs = np.hypot(tree[:, 0], tree[:, 2]) > 0.5
    return float(np.quantile(tree[twigs, 1], 0.05))


@pytest.mark.capability("PL-446")
def test_two_conifers_keep_apart():
    spacing = 4.0
    text = gallery.text("conifer", ROWS=2, SPACING=spacing, SHED=0)
    pair = bio.LSystem(text.replace("i < many*many", "i < 2"))
    grown = trees(bio.environments.derive(pair, YEARS_15), spacing)
    left, right = grown[0, 0], grown[1, 0]
    # Published: 13,502 segments.
    assert 9_000 < len(left) + len(right) < 15_000
    for tree, facing in ((left, 1), (right, -1)):
        along = np.abs(tree[:, 2]) < 1.5
        heights = [(low, low + 3) for low in (2, 5, 8, 11)]
        toward, away, radius = [], [], []
        for low, high in heights:
            tier = tree[along & (tree[:, 1] >= low) & (tree[:, 1] < high)]
            reach = facing * tier[:, 0]
            toward.append(reach.max())
            radius.append(np.quantile(reach[reach > 0], 0.85))
            away.append((-facing * tier[:, 0]).max())
        assert away == sorted(away, reverse=True), "lower tiers are older and wider"
        assert away[0] > spacing
        # Most twigs end before the middle; a tip learns of the shade there one shoot too late.
        assert max(radius) <= spacing / 2
        assert max(toward) < spacing / 2 + 1


@pytest.mark.capability("PL-447")
def test_in_a_stand_the_middle_sheds_most():
    grown = trees(stand(3, 5.0), 5.0)
    bases = {place: crown_base(tree) for place, tree in grown.items()}
    corner = np.mean([bases[x, z] for x in (0, 2) for z in (0, 2)])
    edge = np.mean([bases[place] for place in ((1, 0), (0, 1), (2, 1), (1, 2))])
    assert bases[1, 1] > edge > corner


@pytest.mark.capability("PL-448")
def test_planting_distance_trades_clear_stems_for_girth():
    clear, girth = [], []
    for spacing in (4.0, 6.0, 9.0):
        string = stand(3, spacing)
        clear.append(crown_base(trees(string, spacing)[1, 1]))
        stems = re.findall(r"\^\(-90\)/\([^)]*\)!\(([^,]+),", string.string())
        assert len(stems) == 9
        girth.append(float(stems[4]))
    assert clear == sorted(clear, reverse=True)
    assert girth == sorted(girth)
    assert clear[0] > clear[-1] + 2
    assert girth[-1] > 1.2 * girth[0]
