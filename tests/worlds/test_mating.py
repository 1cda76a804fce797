"""The world `mating`: courtship, rivalry and spawning."""

import itertools

import pytest

import bioscope as bio

STAGES = ["courted", "circled", "mated", "spawned"]


@pytest.fixture(scope="module")
def story():
    """Run the film's length; returns events, who is who, and the stages that each showed."""
    world = bio.load("mating", seed=bio.worlds.films()["mating"])
    cast, events, stages, speeds = {}, [], {}, {}
    for batch in world.scene.batches:
        for one in batch.ids:
            values = (world.inspect(int(one)) or {}).get("values", {})
            if "courtship" in values:
                cast[int(one)] = (batch.species, values["body_length_m"])
    while world.time < 80:
        world.step(2)
        events += world.drain_events()
        for one in cast:
            values = world.inspect(one)["values"]
            now = (values["courtship"], values.get("target"))
            speeds.setdefault(one, []).append(
                (values["courtship"], values["wanted_speed_body_lengths_per_s"])
            )
            if not stages.setdefault(one, []) or stages[one][-1] != now:
                stages[one].append(now)
    return events, cast, stages, speeds


def pairs(events):
    """Return those who spawned, as (male, female), in order."""
    spawned = [event for event in events if event.kind == "spawned"]
    courted = {one.subject: one.object for one in events if one.kind == "circled"}
    return [(one.subject, courted[one.subject]) for one in spawned]


@pytest.mark.capability("TF-204", "TF-137", "TF-138", "TF-139", "TF-140", "TF-143")
def test_two_pairs_go_through_all_stages_in_order(story):
    events, cast, stages, _ = story
    couples = {frozenset(pair) for pair in pairs(events)}
    assert len(couples) >= 2
    for one in set().union(*couples):
        names = [name for name, _ in stages[one]]
        order = [name for name, _ in itertools.groupby(names)]
        text = " ".join(order)
        assert "loop circle ascend nuzzle" in text, (one, text)
    species = {cast[one][0] for pair in couples for one in pair}
    assert "moorish_idol" in species


@pytest.mark.capability("TF-142", "TF-135")
def test_the_larger_male_wins_her_and_the_other_courts_somebody_else(story):
    events, cast, stages, _ = story
    idols = sorted(one for one, (species, _) in cast.items() if species == "moorish_idol")
    males, female = idols[:2], idols[2]
    small, large = sorted(males, key=lambda one: cast[one][1])
    circled = [
        (event.subject, event.object)
        for event in events
        if event.kind == "circled" and event.object == female
    ]
    assert circled[0][0] == large
    rejected = [target for name, target in stages[small] if name in ("follow", "display", "loop")]
    butterfly = next(one for one, (species, _) in cast.items() if species == "butterflyfish")
    assert female in rejected, "he courted her too"
    assert butterfly in rejected, "and then another"


@pytest.mark.capability("TF-140")
def test_he_touches_her_three_times_and_backs_off_in_between(story):
    events, _, _, speeds = story
    male, _ = pairs(events)[0]
    nuzzling = [speed for name, speed in speeds[male] if name == "nuzzle"]
    backs = sum(b < 0 <= a for a, b in itertools.pairwise(nuzzling))
    # The third touch ends it.
    assert backs >= 2
