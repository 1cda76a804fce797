"""The world `go_fish`: a hook among hungry fishes."""

import itertools

import numpy as np
import pytest

import bioscope as bio
from bioscope.geometry.skinning import bent

PILLARS = [((-1.7, -1.2), 0.28, -2.9), ((1.9, -0.6), 0.22, -3.6)]
FEEDERS = ("parrotfish", "butterflyfish", "yellow_tang")


def batch(world, species):
    return next((one for one in world.scene.batches if one.species == species), None)


@pytest.fixture(scope="module")
def story():
    """Run the film's length; returns events, heights of the caught fish and all places."""
    world = bio.load("go_fish", seed=bio.worlds.films()["go_fish"])
    events, heights, places, hooks = [], {}, [], []
    while world.time < 34:
        world.step(3)
        events += world.drain_events()
        angelfishes = batch(world, "emperor_angelfish")
        for one, place in zip(angelfishes.ids, angelfishes.positions, strict=True):
            heights.setdefault(int(one), []).append((world.time, float(place[1])))
        hooks.append((world.time, float(batch(world, "fishing_line").positions[0][1])))
        places += [np.array(one.positions) for one in world.scene.batches if one.species in FEEDERS]
    return events, heights, np.concatenate(places), hooks, world


@pytest.mark.capability("TF-169", "TF-200")
def test_the_first_who_bites_is_hooked_and_hauled_to_the_surface(story):
    events, heights, _, hooks, world = story
    hooked = [event for event in events if event.kind == "hooked"]
    assert len(hooked) == 1
    (event,) = hooked
    hook = int(batch(world, "fishing_line").ids[0])
    assert event.object == hook
    bitten = [one for one in events if one.kind == "bitten" and one.subject == hook + 1]
    assert bitten[0].object == event.subject, "the first mouth on the bait"
    assert event.time - bitten[0].time < 3 * world.dt
    rising = [height for time, height in heights[event.subject] if time > event.time + 1.5]
    assert rising[0] < -1.0
    assert all(b > a - 0.05 for a, b in itertools.pairwise(rising))
    assert rising[-1] > -0.4
    landed = [one for one in events if one.kind == "caught" and one.subject == event.subject]
    assert [one.object for one in landed] == [hook]
    assert world.populations["emperor_angelfish"] == 2
    wound = [height for time, height in hooks if event.time + 0.5 < time < landed[0].time]
    assert all(b > a for a, b in itertools.pairwise(wound))
    assert batch(world, "bait") is None


def test_who_is_hooked_hangs_by_the_mouth():
    world = bio.World(seed=3, dt=1 / 30)
    world.environment.water()
    hungry = bio.minds.Intentions("pacifist", food=["bait"], stagger=0.0)
    world.add(bio.RoamingFish("parrotfish", 1, center=(0, -2, 2.5), radius=0.1, mind=hungry))
    world.add(bio.FishingLine(depth=2.0, sinking=2.0))
    while not any(event.kind == "hooked" for event in world.drain_events()):
        world.step()
        assert world.time < 30
    for _ in range(20):
        world.step(3)
        fish, hook = batch(world, "parrotfish"), batch(world, "fishing_line").positions[0]
        mesh, turn = fish.mesh, fish.rotations[0]
        snout = np.argmax(mesh.positions[:, 2])
        skin = bent(mesh, fish.poses[0])[0][snout] * fish.scales[0]
        x, y, z, w = turn
        axis = np.array([x, y, z])
        place = skin + 2 * np.cross(axis, np.cross(axis, skin) + w * skin) + fish.positions[0]
        assert np.linalg.norm(place - hook) < 0.06 * np.ptp(mesh.positions[:, 2]) * fish.scales[0]


@pytest.mark.capability("TF-165")
def test_the_others_feed_on(story):
    events, *_, world = story
    (hooked,) = (event for event in events if event.kind == "hooked")
    species = {int(one): b.species for b in world.scene.batches for one in b.ids}
    meals = [event for event in events if event.kind == "eaten"]
    late = [one for one in meals if one.time > hooked.time and species.get(one.object) in FEEDERS]
    assert len(late) >= 3
    assert world.populations["plankton"] == 900, "eaten ones are replaced from without"


@pytest.mark.capability("TF-117", "TF-167")
def test_nobody_enters_a_pillar(story):
    places = story[2]
    for middle, radius, top in PILLARS:
        away = np.linalg.norm(places[:, [0, 2]] - middle, axis=1)
        assert (away[places[:, 1] < top] > radius).all()


def test_a_line_can_be_saved_while_it_hauls(tmp_path):
    world = bio.World(seed=3, dt=1 / 30)
    world.environment.water()
    hungry = bio.minds.Intentions("pacifist", food=["bait"], stagger=0.0)
    world.add(
        bio.RoamingFish(
            "parrotfish", 1, center=(0, -2, 2.5), radius=0.1, mind=hungry, body="swimmer"
        )
    )
    world.add(bio.FishingLine(depth=2.0, sinking=2.0))
    while not any(event.kind == "hooked" for event in world.drain_events()):
        world.step()
        assert world.time < 20
    world.run(1.0)
    world.save(tmp_path / "line.world")
    again = bio.World.restore(tmp_path / "line.world")
    for one in (world, again):
        one.run(2.0)
    assert world.state_hash() == again.state_hash()
    (fish,) = (int(one) for one in batch(world, "parrotfish").ids)
    assert world.inspect(fish)["behavior"] == "struggle"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"place": (1e39, 0.0)}, "place"),
        ({"depth": -1.0}, "depth"),
        ({"color": 3.0}, "color"),
    ],
)
def test_nonsense_is_refused_by_name(options, message):
    with pytest.raises(bio.BioscopeError, match=message):
        bio.FishingLine(**options)
