"""Organs: leaves as cubic patches, ramets of three leaflets, needles."""

import re

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery

ALONG, ACROSS = 6, 3
"""Rows and columns of vertices of a leaf."""


def leaf() -> np.ndarray:
    """Return the vertices (6, 3, 3) of the leaf that `~l` stands for."""
    drawn = bio.Turtle().interpret(bio.LSystem("axiom: ~l(1)\nA --> A\n").derive(0))
    return np.asarray(drawn.mesh().positions).reshape(ALONG, ACROSS, 3)


@pytest.mark.capability("PL-212")
def test_a_leaf_is_a_cubic_patch():
    points = leaf()
    # A cubic at even steps: its fourth differences vanish, its third are constant and are not 0.
    assert np.abs(np.diff(points, 4, axis=0)).max() < 1e-5
    assert np.abs(np.diff(points, 3, axis=0)).max() > 0.01
    middle, edges = points[2, 1], points[2, [0, 2]].mean(axis=0)
    assert edges[2] > middle[2] + 0.02, "it is hollow along its middle"
    widths = np.ptp(points[..., 0], axis=1)
    assert widths[2] > widths[4] > widths[5] == 0, "and it narrows to the tip"


@pytest.mark.capability("PL-212")
def test_a_climber_bears_a_patch_at_each_internode():
    string = bio.environments.derive(gallery.read("climber"), 1200)
    drawn = bio.Turtle().interpret(string)
    stem = int((drawn.segments.color == 1).sum())
    assert stem > 10
    assert len(drawn.surfaces) == stem
    assert {name for name, *_ in drawn.surfaces} == {"l"}
    on_stem = np.linalg.norm(
        np.array([place for _, place, _, _ in drawn.surfaces])[:, None]
        - drawn.segments.end[drawn.segments.color == 1],
        axis=-1,
    )
    assert on_stem.min(axis=1).max() < 1e-3


@pytest.mark.capability("PL-212")
def test_a_ramet_is_three_leaflets_around_its_stalk():
    string = bio.environments.derive(gallery.read("clonal_plant"), 26)
    ramets = re.findall(r"@o\(([\d.]+),[\d.]+\)", string.string())
    assert len(ramets) > 5
    leaflets = bio.Turtle().interpret(string).surfaces
    assert {name for name, *_ in leaflets} == {"l"}
    assert len(leaflets) == 3 * len(ramets)
    for number, radius in enumerate(ramets):
        three = leaflets[3 * number : 3 * number + 3]
        places = np.array([place for _, place, _, _ in three])
        assert np.ptp(places, axis=0).max() < 1e-5, "they stand on one stalk"
        for _, _, (width, length, _), _ in three:
            assert (width, length) == pytest.approx((1.3 * float(radius), 1.5 * float(radius)))
    # Each looks another way: the tips of a ramet are a triangle with equal sides.
    text = re.sub(r"axiom: .*", "axiom: @o(1,0)", gallery.text("clonal_plant"))
    mesh = bio.Turtle().interpret(bio.LSystem(text).derive(0)).mesh()
    tips = np.asarray(mesh.positions).reshape(3, ALONG, ACROSS, 3)[:, -1, 1]
    sides = np.linalg.norm(tips - np.roll(tips, 1, axis=0), axis=1)
    assert sides == pytest.approx(np.full(3, sides[0]), rel=1e-4)


@pytest.mark.capability("PL-212")
def test_needles_are_drawn_or_not():
    drawn = {}
    for needles in (0, 1):
        system = gallery.read("conifer", NEEDLES=needles)
        string = bio.environments.derive(system, 6 * 13)
        drawn[needles] = bio.Turtle().interpret(string).segments
    bare, green = drawn[0], drawn[1]
    assert set(np.unique(bare.color)) <= {1, 2}
    wood = np.isin(green.color, (1, 2))
    np.testing.assert_array_equal(green.end[wood], bare.end)
    assert (~wood).sum() > 2 * wood.sum()
