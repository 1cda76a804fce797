"""A worm on a hook comes down after a minute among eight fishes that feed, and three that wait."""

import itertools

import numpy as np
import pytest

import bioscope as bio

START, SECONDS = 60.0, 110.0
CAST = {
    "emperor_angelfish": (3, "bait"),
    "parrotfish": (2, "plankton"),
    "butterflyfish": (3, "plankton"),
    "yellow_tang": (3, "plankton"),
}


@pytest.mark.capability("AA-009")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_first_mouth_at_the_hook_is_hauled_up_while_the_others_feed_on(seed):
    sea = bio.World(seed=seed, dt=1 / 30)
    sea.environment.water()
    for species, (count, food) in CAST.items():
        mind = bio.minds.Intentions(
            "pacifist", food=[food], appetite=60.0, home_range=2.0, libido_growth=0.0
        )
        sea.add(bio.RoamingFish(species, count, center=(0, -4.3, 0.2), radius=1.4, mind=mind))
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
    bitten = [(one.subject, one.object) for one in events if one.kind == "bitten"]
    assert len(set(bitten)) == len(bitten), "a mouth closes once on a morsel"
    eaten = {one.data["species"] for one in events if one.kind == "eaten"}
    assert eaten == {"bait", "plankton"}, "it is told of what nobody can look up any more"
    rising = [height for time, height in heights[hooked.subject] if time > hooked.time + 1.5]
    assert all(above > below for below, above in itertools.pairwise(rising))
    assert rising[-1] > -0.4, "metres below the surface"
    meals = [e.time for e in events if e.kind == "eaten" and e.object != hooked.subject]
    in_ten_seconds, _ = np.histogram(meals, np.arange(0.0, SECONDS + 1.0, 10.0))
    assert in_ten_seconds.min() >= 1
