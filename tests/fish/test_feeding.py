"""Suction: what an open mouth does to what floats before it."""

import numpy as np
import pytest

import bioscope as bio

MOUTH = 0.48
"""How far the mouth lies ahead of the middle, body lengths."""


class Idle(bio.Mind):
    """Wants nothing."""

    def decide(self, percepts):
        return {"speed": 0.0}


def mouth(world: bio.World, species: str, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Place of the mouth of the first of a species, and the direction in which it opens."""
    batch = next(one for one in world.scene.batches if one.species == species)
    x, y, z, w = np.asarray(batch.rotations[0], float)
    ahead = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    return np.asarray(batch.positions[0], float) + MOUTH * length * ahead, ahead


def drifters(world: bio.World) -> dict[int, np.ndarray]:
    """Place of each piece of plankton."""
    points = world.scene.points[0]
    return dict(zip(points.ids.tolist(), np.asarray(points.positions, float), strict=True))


def pool(opening: float) -> tuple[bio.World, int, float]:
    """Return still water full of plankton, and a fish in it that holds its mouth this far open."""
    world = bio.World(seed=4, dt=1 / 60)
    world.environment.water(surface=5.0)
    mind = bio.minds.Intentions("pacifist", food=["plankton"], cruise_speed=0.0, full_speed=0.0)
    place = {"center": (0, 0, 0), "radius": 0.0}
    fish = world.add(bio.RoamingFish("parrotfish", 1, **place, mind=mind, body="swimmer"))
    # In so thick a soup it must smell more than the eight morsels nearest to its middle.
    fish.set(smell_attention=1000)
    box = {"low": (-0.4, -0.4, -0.4), "high": (0.4, 0.4, 0.4)}
    world.add(bio.Plankton(12_000, **box, swimming=0.0))
    (one,) = (int(name) for name in fish.values("id"))
    fish.steer(one, speed=0.0, mouth=opening)
    world.step(2)
    return world, one, world.inspect(one)["values"]["body_length_m"]


@pytest.mark.capability("TF-132", "AA-052")
def test_food_before_an_open_mouth_is_drawn_in_and_swallowed():
    world, eater, length = pool(1.0)
    start = drifters(world)
    place, ahead = mouth(world, "parrotfish", length)
    offset = {name: at - place for name, at in start.items()}
    far = {name: float(np.linalg.norm(way)) / length for name, way in offset.items()}
    cosine = {name: float(way @ ahead) / length / far[name] for name, way in offset.items()}
    before = {n for n in start if 0.15 < far[n] < 0.35 and cosine[n] > 0.5}
    behind = {n for n in start if far[n] > (0.15 if cosine[n] < 0 else 0.5)}
    assert len(before) > 20
    world.drain_events()
    ways = []
    for _ in range(3):
        last = drifters(world)
        world.step()
        now = drifters(world)
        ways.append({n: float((last[n] - now[n]) @ offset[n]) / far[n] for n in before & set(now)})
        assert all(np.linalg.norm(now[n] - start[n]) < 1e-4 for n in behind & set(now))
    for name in before & set(ways[-1]):
        assert ways[0][name] > 0, "towards the mouth"
        assert ways[1][name] > ways[0][name], "faster and faster"
    world.run(seconds=1.5)
    eaten = [event for event in world.drain_events() if event.kind == "eaten"]
    assert {event.object for event in eaten} == {eater}
    gone = {event.subject for event in eaten}
    assert len(gone) > 15
    assert len(gone & before) > 4
    assert not gone & set(drifters(world)), "what is eaten is gone"
    assert not gone & behind


@pytest.mark.capability("TF-132")
def test_a_closed_mouth_draws_nothing_in():
    world, *_ = pool(0.0)
    start = drifters(world)
    world.run(seconds=1)
    now = drifters(world)
    assert start.keys() == now.keys()
    assert max(np.linalg.norm(now[name] - start[name]) for name in start) < 1e-4


@pytest.mark.capability("TF-132", "AA-052")
@pytest.mark.parametrize("body", ["swimmer", "muscle_swimmer"])
def test_prey_is_drawn_into_the_mouth_of_its_hunter(body):
    world = bio.World(seed=4, dt=1 / 60)
    world.environment.water(surface=5.0)
    hunts = bio.minds.Intentions("predator", food=["chromis"], cruise_speed=0.0, full_speed=0.0)
    place = {"center": (0, 0, 0), "radius": 0.0}
    shark = world.add(bio.RoamingFish("grey_reef_shark", 1, **place, mind=hunts, body="swimmer"))
    (one,) = (int(name) for name in shark.values("id"))
    length = world.inspect(one)["values"]["body_length_m"]
    jaws, ahead = mouth(world, "grey_reef_shark", length)
    center = tuple(float(axis) for axis in jaws + 0.28 * length * ahead)
    prey = world.add(bio.RoamingFish("chromis", 1, center=center, radius=0.0, mind=Idle, body=body))
    shark.steer(one, speed=0.0, mouth=1.0)

    def gap() -> float:
        chromis = next(one for one in world.scene.batches if one.species == "chromis")
        jaws, _ = mouth(world, "grey_reef_shark", length)
        return float(np.linalg.norm(np.asarray(chromis.positions[0], float) - jaws))

    world.step()
    gaps = [gap()]
    while world.populations["chromis"] and world.time < 3:
        world.step()
        gaps += [gap()] if world.populations["chromis"] else []
    assert len(gaps) > 4
    assert (np.diff(gaps[1:]) < 0).all(), "nearer and nearer"
    (caught,) = (event for event in world.events if event.kind == "caught")
    assert caught.object == one
    assert prey.statistics["count"] == 0
