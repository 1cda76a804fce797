"""The world `jack_cousto`: courtship, school and stalker before one lens."""

import numpy as np
import pytest

import bioscope as bio

FILM = bio.worlds.films()["jack_cousto"]


def batch(world, species):
    return next(one for one in world.scene.batches if one.species == species)


@pytest.mark.capability("TF-201")
def test_courtship_school_and_stalking_overlap_within_a_minute():
    world = bio.load("jack_cousto", seed=FILM)
    eye = np.array(world.cameras.now("bay").position)
    shark = int(batch(world, "blacktip_shark").ids[0])
    together, behind, fed = 0, [], 0
    while world.time < 40:
        world.run(0.5)
        fed += sum(event.kind == "eaten" for event in world.drain_events())
        pair = [world.inspect(int(one)) for one in batch(world, "clownfish").ids]
        courts = all(
            one["values"]["courtship"] in ("loop", "circle", "ascend", "nuzzle") for one in pair
        )
        school = batch(world, "fusilier")
        stalks = world.inspect(shark)
        hunts = stalks["behavior"] == "eat" and stalks["values"].get("target") in school.ids
        schools = np.mean([world.inspect(int(one))["behavior"] == "school" for one in school.ids])
        if courts and hunts and schools > 0.4:
            together += 1
            away = eye[2] - np.array(school.positions)[:, 2]
            pair_away = eye[2] - np.array(batch(world, "clownfish").positions)[:, 2]
            behind.append((away > pair_away.max()).mean())
    assert together >= 4, "half seconds in which all of it happens at once"
    assert np.mean(behind) > 0.9, "the school passes behind the pair"
    assert fed >= 5, "others feed"


def largest_school(world):
    """Return the headings of the most who school and are linked by two body lengths and less."""
    school = batch(world, "fusilier")
    minds = [world.inspect(int(one)) for one in school.ids]
    schooling = np.array([one["behavior"] == "school" for one in minds])
    if not schooling.any():
        return np.zeros((0, 3))
    places, velocities = (np.array(one)[schooling] for one in (school.positions, school.velocities))
    length = np.mean([one["values"]["body_length_m"] for one in minds])
    linked = np.linalg.norm(places[:, None] - places[None], axis=2) < 2 * length
    for _ in range(4):  # The chains of all fourteen have at most 2^4 links.
        linked = linked @ linked
    headings = velocities[linked[linked.sum(axis=1).argmax()]]
    return headings / np.linalg.norm(headings, axis=1, keepdims=True)


@pytest.mark.capability("AA-010")
@pytest.mark.parametrize("seed", [FILM, FILM + 1])
def test_within_150_s_some_nuzzle_some_are_eaten_and_a_school_heads_one_way(seed):
    world = bio.load("jack_cousto", seed=seed)
    (shark,) = (int(one) for one in batch(world, "blacktip_shark").ids)
    prey = {int(one) for one in batch(world, "fusilier").ids}
    weed = np.array(batch(world, "seagrass").poses)
    plankton = {int(one) for points in world.scene.points for one in points.ids}
    events, polarized, nuzzles, done = [], [], False, False
    while not done and world.time < 150:
        world.run(0.5)
        events += world.drain_events()
        eaten = sum(one.kind == "eaten" and one.subject in plankton for one in events)
        hunted, fled = (
            sum(one.kind == kind and one.subject in prey and one.object == shark for one in events)
            for kind in ("caught", "escaped")
        )
        headings = largest_school(world)
        polarized.append(len(headings) >= 5 and np.linalg.norm(headings.mean(axis=0)) >= 0.8)
        lasting = np.convolve(polarized, np.ones(6))[: len(polarized)].max() > 5.5
        pair = [world.inspect(int(one))["values"] for one in batch(world, "clownfish").ids]
        nuzzles |= all(one["courtship"] == "nuzzle" for one in pair)
        done = nuzzles and eaten >= 10 and hunted and fled and lasting
    assert nuzzles, "a courtship gets that far"
    assert hunted >= 1, "the shark eats of the school"
    assert fled >= 1, "which evades it"
    assert lasting, "for 3 s at a stretch five and more head one way"
    assert eaten >= 10, "plankton"
    assert np.abs(batch(world, "seagrass").poses - weed).max() > 0.01, "seaweed sways"
