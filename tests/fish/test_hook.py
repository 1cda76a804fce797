"""A hook comes down after a minute among nine fishes of three species that feed on plankton."""

import itertools

import numpy as np
import pytest

import bioscope as bio

START, SECONDS = 60.0, 150.0
CAST = {
    "emperor_angelfish": ["bait", "plankton"],
    "butterflyfish": ["plankton"],
    "yellow_tang": ["plankton"],
}


@pytest.mark.capability("AA-009")
def test_the_first_mouth_at_the_hook_is_hauled_up_while_the_others_feed_on():
    sea = bio.World(seed=2, dt=1 / 30)
    sea.environment.water()
    for species, food in CAST.items():
        mind = bio.minds.Intentions(
            "pacifist", food=food, appetite=60.0, home_range=2.0, libido_growth=0.0
        )
        sea.add(bio.RoamingFish(species, 3, center=(0, -4.3, 0.2), radius=1.4, mind=mind))
    sea.add(bio.Plankton(900, low=(-3.0, -5.4, -2.4), high=(3.0, -2.4, 2.4)))
    line = bio.FishingLine(
        (0.2, 0.4), bait="bait", start=START, depth=4.1, sinking=1.2, hauling=0.6
    )
    sea.add(line)
    events, heights = [], {}
    while sea.time < SECONDS:
        sea.step(3)
        events += sea.drain_events()
        for batch in sea.scene.batches:
            if batch.species == "emperor_angelfish":
                for one, place in zip(batch.ids, batch.positions, strict=True):
                    heights.setdefault(int(one), []).append((sea.time, float(place[1])))
    (hooked,) = (event for event in events if event.kind == "hooked")
    assert hooked.time > START
    bites = [one for one in events if one.kind == "bitten" and one.subject == hooked.object + 1]
    assert bites[0].object == hooked.subject, "the first mouth that reached the bait"
    rising = [height for time, height in heights[hooked.subject] if time > hooked.time + 1.5]
    assert all(above > below for below, above in itertools.pairwise(rising))
    assert rising[-1] > -0.4, "metres below the surface"
    meals = [e.time for e in events if e.kind == "eaten" and e.object != hooked.subject]
    assert np.histogram(meals, np.arange(0.0, 91.0, 10.0))[0].min() >= 1, "in each ten seconds"
