"""Escaping: one prey and one hunter of equal speed, alone, by their muscles."""

import math
import random

import numpy as np
import pytest

import bioscope as bio

PREY, HUNTER = "yellow_tang", "butterflyfish"
LENGTHS = {PREY: 0.16, HUNTER: 0.15}
SPEED = 0.32
"""Metres per second, both."""
SECONDS, PAIRS = 6.0, 30


def mind(species):
    pace = {"full_speed": SPEED / LENGTHS[species], "home_range": 1000.0}
    if species == PREY:
        return bio.minds.Intentions("prey", enemies=[HUNTER], **pace)
    return bio.minds.Intentions("predator", food=[PREY], stagger=0.0, appetite=50.0, **pace)


def places(world, species):
    return np.array([b.positions[0] for b in world.scene.batches if b.species == species])


def pairs(seed, apart):
    """Return a world of pairs too far from each other to be seen, prey and hunter at random."""
    draw = random.Random(seed)
    world = bio.World(seed=seed, dt=1 / 30)
    world.environment.water()
    for number in range(PAIRS):
        x, bearing = 100.0 * number, draw.uniform(0, math.tau)
        aside = apart * LENGTHS[PREY]
        at = {
            PREY: (x, -20.0, 0.0),
            HUNTER: (x + aside * math.cos(bearing), -20.0, aside * math.sin(bearing)),
        }
        for species, center in at.items():
            fish = bio.RoamingFish(
                species, 1, center=center, radius=0.005, variation=0.0, mind=mind(species)
            )
            world.add(fish)
    return world


@pytest.mark.capability("AA-048")
def test_who_is_hunted_at_equal_speed_gets_farther_away():
    farther = []
    for seed, apart in enumerate((1.0, 2.0, 4.0)):
        world = pairs(seed, apart)
        world.step()
        first = np.linalg.norm(places(world, PREY) - places(world, HUNTER), axis=1)
        world.run(SECONDS)
        prey, hunters = places(world, PREY), places(world, HUNTER)
        assert len(prey) == PAIRS, "nobody is caught"
        farther.append(np.mean(np.linalg.norm(prey - hunters, axis=1) > first))
    assert min(farther) >= 0.8, farther
