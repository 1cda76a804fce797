"""Prey: one hunter and five that school while it is far, scatter when it comes, and are eaten."""

import numpy as np
import pytest

import bioscope as bio

PREY, HUNTER = "fusilier", "blacktip_shark"
NEAR, SOON = 1.5, 5.0
"""Metres to the hunter within which they scatter, and seconds for that."""


def world(seed):
    sea = bio.World(seed=seed, dt=1 / 30)
    sea.environment.water()
    prey = bio.minds.Intentions("prey", enemies=[HUNTER], habits=["school"], home_range=4.0)
    sea.add(bio.RoamingFish(PREY, 5, center=(0, -8, 0), radius=0.6, mind=prey))
    hunter = bio.minds.Intentions(
        "predator", food=[PREY], stagger=0.0, appetite=2.0, home_range=5.0
    )
    at, home = (0, -8, -7.0), (0, -8, 0)
    sea.add(bio.RoamingFish(HUNTER, 1, center=at, radius=0.1, home=home, mind=hunter))
    return sea


def places(sea, species):
    found = [np.array(b.positions) for b in sea.scene.batches if b.species == species]
    return np.concatenate(found)


class Hunt:
    """What happens until somebody is caught and for some seconds after."""

    def __init__(self, seed):
        sea = world(seed)
        ids = [int(one) for b in sea.scene.batches if b.species == PREY for one in b.ids]
        self.caught, self.said, rows = None, {one: [] for one in ids}, []
        while sea.time < 120 and (self.caught is None or sea.time < self.caught + SOON):
            sea.step(3)
            times = [event.time for event in sea.drain_events() if event.kind == "caught"]
            self.caught = self.caught or next(iter(times), None)
            known = {one: sea.inspect(one) for one in ids}
            fears = [one["values"]["fear"] for one in known.values() if one]
            for one, told in known.items():
                if told:
                    self.said[one].append((told["behavior"], told["values"]["fear"]))
            points = places(sea, PREY)
            gaps = np.linalg.norm(points[:, None] - points[None], axis=2)
            np.fill_diagonal(gaps, np.inf)
            off = np.linalg.norm(points - places(sea, HUNTER)[0], axis=1).min()
            rows.append((sea.time, off, gaps.min(axis=1).mean(), np.mean(fears)))
        self.times, self.off, self.spread, self.fear = np.array(rows).T


@pytest.mark.capability("AA-053")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_five_school_then_scatter_before_a_hunter_that_eats(seed):
    hunt = Hunt(seed)
    assert hunt.caught is not None
    coming = hunt.times < hunt.caught
    assert np.corrcoef(hunt.off[coming], hunt.fear[coming])[0, 1] < -0.5, "fear grows as it comes"
    first = [
        next(name for name, _ in said if name in ("school", "escape"))
        for said in hunt.said.values()
    ]
    assert first.count("school") >= 2, "some school before they flee"
    fled = [fear for said in hunt.said.values() for name, fear in said if name == "escape"]
    schooled = [fear for said in hunt.said.values() for name, fear in said if name == "school"]
    assert np.mean(fled) > np.mean(schooled)
    begun = np.flatnonzero(hunt.off < NEAR)[0]
    soon = (hunt.times >= hunt.times[begun]) & (hunt.times <= hunt.times[begun] + SOON)
    assert hunt.spread[soon].max() >= 2 * hunt.spread[begun]


@pytest.mark.capability("AA-053")
def test_a_hunter_takes_the_lonely_one_of_two_at_one_distance():
    chosen = []
    for side in (1.0, -1.0):
        for distance in (1.0, 2.0, 4.0):
            hunter = bio.minds.Intentions("predator", food=[PREY], stagger=0.0)
            both = [
                {"id": 7, "position": (0.4 * distance * side, 0.0, distance)},
                {"id": 8, "position": (-0.4 * distance * side, 0.0, distance)},
            ]
            seen = [{**one, "species": PREY, "size": 0.26, "velocity": (0, 0, 0)} for one in both]
            seen[0]["display"] = {"act": "schooling"}
            decided = hunter.decide({"dt": 1 / 30, "body_length": 1.4, "seen": seen})
            chosen.append(decided["target"])
    assert chosen == [8] * 6
