"""Stands of plants as circles: self-thinning, and eight species on wet and dry ground."""

import math
import re

import numpy as np
import pytest

import bioscope as bio
from bioscope import gallery

PLACED = 17
"""Steps that only place the plants of `self_thinning`."""


@pytest.mark.capability("PL-519")
def test_a_stand_thins_itself_along_the_line():
    # What plants look like does not matter here, and costs time.
    text = gallery.text("self_thinning").split("homomorphism")[0] + "endlsystem\n"
    count, area = {}, {}
    for step in (99, 164):
        string = bio.environments.derive(bio.LSystem(text), step + PLACED).string()
        alive = re.findall(r"\?E\(([^,]+),0\)", string)
        count[step] = len(alive)
        area[step] = np.mean([math.pi * float(radius) ** 2 for radius in alive])
    # Published: 16,354 and 441.
    assert count[99] == pytest.approx(16_354, rel=0.05)
    assert count[164] == pytest.approx(441, rel=0.10)
    slope = math.log(area[164] / area[99]) / math.log(count[164] / count[99])
    assert slope == pytest.approx(-1, abs=0.05)


@pytest.mark.capability("PL-520")
def test_wet_and_dry_species_sort_themselves_out():
    system = gallery.read("eight_species")
    plants = bio.Turtle().interpret(bio.environments.derive(system)).balls
    assert len(plants.radius) > 500
    assert set(plants.color.tolist()) == set(range(1, 9))
    # A stripe of wet ground; the first four species like it.
    is_wet = np.abs(plants.center[:, 0] - 30) < 6.7
    likes_wet = plants.color <= 4
    area = plants.radius**2
    assert area[is_wet & likes_wet].sum() > 0.7 * area[is_wet].sum()
    assert area[~is_wet & ~likes_wet].sum() > 0.7 * area[~is_wet].sum()
