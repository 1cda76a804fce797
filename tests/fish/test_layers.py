"""The layers of an artificial fish: each can be exchanged or taken away, and watched at work."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.fish import trace

HUNGRY = {"food": ["plankton"], "stagger": 0.0, "home_range": 5.0}


class Straight(bio.Mind):
    """A mind of one's own: straight on."""

    kind = "straight"

    def decide(self, percepts):
        return {"behavior": "go on", "heading": (0.0, 0.0, 1.0), "speed": 1.0}


def water(mind, *, body="muscle_swimmer", plankton=60):
    """Return a world with one fish among plankton, the population, and the fish's identity."""
    world = bio.World(seed=5, dt=1 / 30)
    world.environment.water()
    fish = bio.RoamingFish("butterflyfish", 1, center=(0, -3, 0), radius=0.1, mind=mind, body=body)
    world.add(fish)
    world.add(bio.Plankton(plankton, low=(-1.0, -4.0, -1.0), high=(1.0, -2.0, 1.0)))
    one = next(int(b.ids[0]) for b in world.scene.batches if b.species == "butterflyfish")
    return world, fish, one


@pytest.mark.capability("AA-001", "TF-002")
def test_a_tick_goes_from_what_is_perceived_to_how_the_body_moves():
    world, _, one = water(bio.minds.Intentions("pacifist", **HUNGRY))
    before = next(np.array(b.positions[0]) for b in world.scene.batches if one in b.ids)
    ticks = trace(world, one, 60)
    assert [tick.tick for tick in ticks] == list(range(1, 61))
    attentive = 0
    for tick in ticks:
        # What it perceived is how things lay before it moved.
        home = np.linalg.norm(before - (0, -3, 0))
        assert tick.perceived["home_distance_m"] == pytest.approx(home, abs=2e-3)
        assert tick.intention in ("avoid", "eat", "wander")
        attentive += tick.intention == "eat" and tick.focus is not None
        heading, speed = tick.wanted
        assert np.linalg.norm(heading) == pytest.approx(1.0, abs=1e-3)
        assert speed != 0.0
        assert tick.actuated["tail_beat_hz"] >= 0.0
        # The body moves as fast as it says, no faster.
        moved = np.linalg.norm(np.array(tick.place) - before) * 30
        assert moved <= np.linalg.norm(tick.velocity) + 0.2
        before = np.array(tick.place)
    assert attentive > 30, "while it eats one morsel has its attention"
    assert max(tick.actuated["tail_beat_hz"] for tick in ticks) > 1.0


@pytest.mark.capability("AA-001", "TF-002")
@pytest.mark.parametrize("body", ["muscle_swimmer", "swimmer"])
@pytest.mark.parametrize("kind", ["Intentions", "BehaviorNetwork", "FreeFlow"])
def test_each_mind_lives_in_each_body(kind, body):
    world, _, one = water(getattr(bio.minds, kind)("pacifist", **HUNGRY), body=body)
    ticks = trace(world, one, 90)
    assert len(ticks) == 90
    gone = np.linalg.norm(np.subtract(ticks[-1].place, ticks[0].place))
    assert gone > 0.1
    assert ("bend" in ticks[0].actuated) == (body == "muscle_swimmer")


@pytest.mark.capability("AA-001", "TF-002")
def test_each_center_can_be_taken_away():
    mind = bio.minds.Intentions("pacifist", **HUNGRY)
    # Perception: who smells and sees nothing has nothing to attend to, and swims all the same.
    world, fish, one = water(mind)
    fish.set_one(one, smell_attention=1.0, smell_range=0.1, sight_attention=1.0, sight_range=0.1)
    blind = trace(world, one, 60)
    assert all(tick.focus is None for tick in blind[5:])
    assert np.linalg.norm(np.subtract(blind[-1].place, blind[0].place)) > 0.1
    # Behavior: told what to do, it senses as before and does that.
    world, fish, one = water(mind)
    fish.steer(one, turn=0.0, speed=2.0)
    told = trace(world, one, 30)
    assert all(tick.wanted[1] == pytest.approx(2.0) for tick in told[2:])
    assert told[-1].perceived["smelled"] > 0
    # Motor control: in air no beat of the tail gives a push; mind and senses go on.
    world, fish, one = water(mind)
    fish.set_one(one, muscle_swimmer_water=0.0)
    helpless = trace(world, one, 60)
    assert np.linalg.norm(np.subtract(helpless[-1].place, helpless[0].place)) < 0.05
    assert "eat" in {tick.intention for tick in helpless}
    # The mind: one of one's own in its place.
    world, _, one = water(Straight)
    assert {tick.intention for tick in trace(world, one, 30)[1:]} == {"go on"}


def test_nobody_is_refused():
    world, _, _ = water(Straight)
    with pytest.raises(bio.BioscopeError, match="animal = 99999"):
        trace(world, 99999, 1)
