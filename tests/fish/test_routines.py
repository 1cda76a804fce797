"""Each routine by itself, with typed-in percepts: Tu 1996, section 6.4 (nine and five within)."""

import math

import pytest

import bioscope as bio

LENGTH = 0.1


def fish(role="pacifist", *, habits=(), fed=0, **temper):
    """A clownfish; sated if it was fed."""
    one = bio.minds.Intentions(
        role,
        species="clownfish",
        enemies=["shark"],
        food=["plankton"],
        habits=habits,
        **{"stagger": 0.0, "digestion": 0.0, "libido_growth": 0.0, "mate_weight": 0.0} | temper,
    )
    if fed:
        one.decide({"fed": fed})
    return one


def thing(number, species, place, **more):
    return {"id": number, "species": species, "position": place, "heading": (0, 0, 1)} | more


def noticed(**more):
    always = {"id": 1, "dt": 1 / 30, "body_length": LENGTH, "depth": 3.0, "light": 0.5}
    return always | {"velocity": (0, 0, 0.1), "temperature": 24.0} | more


def steers(wanted):
    """Behavior, and whether it steers left, right or straight on."""
    side = "straight" if abs(wanted["turn"]) < 0.05 else "left" if wanted["turn"] > 0 else "right"
    return wanted["behavior"], side


ROUTINES = {
    # What it is, and with what in view it does what.
    "avoiding-static-obstacle": (
        fish(fed=11),
        noticed(ahead={"distance": 0.1, "aim": (0.1, 0, 0.1)}),
        ("avoid", "left"),
    ),
    "avoiding-fish": (
        fish(fed=11),
        noticed(seen=[thing(2, "parrotfish", (0.02, 0, 0.08), size=0.2, heading=(0, 0, -1))]),
        ("avoid", "right"),
    ),
    "chasing-target": (
        fish(),
        noticed(smelled=[thing(2, "plankton", (-0.4, 0, 0.4), size=0.01)]),
        ("eat", "right"),
    ),
    "eating-food": (
        fish(),
        noticed(smelled=[thing(2, "plankton", (0.0, 0, 0.3), size=0.01)]),
        ("eat", "straight"),
    ),
    "leaving": (
        fish(fed=11, habits=["dark"]),
        noticed(light=0.9),
        ("leave", None),
    ),
    "wandering": (fish(fed=11), noticed(), ("wander", None)),
    "escaping": (
        fish("prey", fed=11, fear_distance=4.0),
        noticed(seen=[thing(2, "shark", (0.45, 0, 0.0), size=0.4)]),
        ("escape", "right"),
    ),
    "schooling": (
        fish("prey", fed=11, habits=["school"]),
        noticed(seen=[thing(2, "clownfish", (0.25, 0, 0.05), size=0.1, velocity=(0, 0, 0.1))]),
        ("school", "left"),
    ),
    "mating": (
        fish(fed=11, libido_growth=1.0),
        noticed(seen=[thing(2, "clownfish", (0.4, 0, 0.4), size=0.1, display={"sex": "female"})]),
        ("mate", "left"),
    ),
}


@pytest.mark.capability("TF-116")
@pytest.mark.parametrize("name", ROUTINES)
def test_each_routine_can_be_tried_alone(name):
    one, percepts, (behavior, side) = ROUTINES[name]
    for tick in range(3):
        wanted = one.decide(percepts | {"time": tick / 30})
    assert steers(wanted)[0] == behavior
    assert side in (None, steers(wanted)[1])
    assert wanted["speed"] > 0


@pytest.mark.capability("TF-116")
def test_sucking_in_is_what_the_mouth_does_near_food():
    def mouth(far):
        morsel = thing(2, "plankton", (0.0, 0.0, 0.048 + far), size=0.01)
        return fish().decide(noticed(smelled=[morsel]))["mouth"]

    assert mouth(0.2) == 0
    assert mouth(0.01) == 1


@pytest.mark.capability("TF-116", "TF-141")
def test_courtship_goes_through_its_four_parts():
    """A female, who is shown in turn what a male does."""
    one = fish(habits=["female"], fed=11, libido_growth=1.0, turns=3.0, spawning_depth=1.0)

    def live(seconds, act, *, depth=3.0, turning=0.0, place=(0.05, 0.0, 0.15)):
        nonlocal now, bearing
        for _ in range(round(seconds * 30)):
            now, bearing = now + 1 / 30, bearing + turning / 30
            attitude = (0.0, math.sin(bearing / 2), 0.0, math.cos(bearing / 2))
            shown = {"sex": "male", "act": act, "partner": 1}
            him = thing(2, "clownfish", place, size=0.1, display=shown)
            wanted = one.decide(noticed(seen=[him], time=now, depth=depth, attitude=attitude))
            pitches.append(wanted["pitch"])
        return one.values["courtship"], wanted

    now, bearing, pitches = 0.0, 0.0, []
    stage, wanted = live(2.0, "courting")
    assert stage == "loop"
    assert wanted["speed"] == 0, "she hovers"
    assert max(pitches) > 0.1 > -0.1 > min(pitches), "and bobs her head"
    stage, wanted = live(0.5, "circling")
    assert (stage, wanted["speed"] > 0) == ("circle", True)
    assert live(5.0, "circling", turning=2.0)[0] == "circle", "not yet three turns"
    stage, wanted = live(5.0, "circling", turning=2.0)
    assert stage == "ascend"
    assert wanted["pitch"] > 0.5
    assert live(0.5, "nuzzling", depth=0.9)[0] == "nuzzle"
