"""Schools and single fishes through the Python surface."""

import math

import numpy as np
import pytest

import bioscope as bio


def tank(seed=1):
    world = bio.World(seed=seed, title="tank")
    world.environment.water(surface=0.0)
    return world


@pytest.mark.capability("RE-12", "RE-13")
def test_a_school_polarizes():
    world = tank()
    school = world.add(bio.FishSchool("fusilier", 120, center=(0, -8, 0), home_radius=30.0))
    world.run(seconds=10)
    assert school.statistics["polarization"] > 0.9
    assert school.statistics["count"] == 120


@pytest.mark.capability("RE-21")
def test_fishes_swim_where_they_look():
    world = tank()
    world.add(bio.FishSchool("anthias", 60, center=(0, -5, 0)))
    world.run(seconds=5)
    batch = world.scene.batches[0]
    x, y, z, w = batch.rotations.T
    ahead = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)
    speed = np.linalg.norm(batch.velocities, axis=1)
    assert (np.sum(ahead * batch.velocities, axis=1) / speed > 0.95).mean() > 0.95


def test_parameters_are_keywords_and_sliders():
    world = tank()
    school = world.add(bio.FishSchool("fusilier", 10, center=(0, -5, 0), matching=2.5))
    assert school.parameters["matching"] == 2.5
    school.set(matching=1.0)
    assert school.parameters["matching"] == 1.0
    with pytest.raises(LookupError, match="cohesiveness"):
        bio.FishSchool("fusilier", 10, cohesiveness=1.0)
    with pytest.raises(ValueError, match="matching"):
        bio.FishSchool("fusilier", 10, matching=-1.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"species": "unicorn"}, "unicorn.*anchovy"),
        ({"count": 10**9}, "count"),
        ({"center": (math.nan, 0, 0)}, "center|null"),
        ({"center": np.array([math.nan, 0, 0])}, "center"),
        ({"center": (np.float32(math.inf), 0, 0)}, "center"),
        ({"center": np.array([1j, 0, 0])}, "expected numbers"),
    ],
)
def test_impossible_schools_are_refused(arguments, message):
    with pytest.raises(bio.BioscopeError, match=message):
        bio.FishSchool(**{"species": "anchovy", "count": 3} | arguments)


def test_numbers_of_numpy_are_numbers():
    at = np.array([0.5, -5.0, 0.25])
    hashes = set()
    for center, count, threshold in [
        (tuple(at.tolist()), 4, 0.5),
        (at, np.int64(4), np.float32(0.5)),
    ]:
        world = tank()
        mind = bio.minds.Intentions("pacifist", drive_threshold=threshold)
        world.add(bio.RoamingFish("anthias", count, center=center, mind=mind))
        world.add(bio.FishSchool("fusilier", count, center=tuple(center), half=at**2))
        world.add(bio.Plankton(10, low=at - 1, high=at + 1))
        world.step(3)
        world.order("fusilier", {"number": count - 1})
        hashes.add(world.state_hash())
    assert len(hashes) == 1


def test_a_species_of_ones_own_and_a_wrong_one(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("name = 5\n")
    with pytest.raises(bio.BioscopeError, match=r"mine\.toml"):
        bio.FishSchool(str(path), 3)


class Circler(bio.Mind):
    """Swims in circles, and remembers how often it was asked."""

    def __init__(self):
        self.asked = 0

    def decide(self, percepts):
        self.asked += 1
        if self.asked == 200:
            raise ArithmeticError("dizzy")
        return {"behavior": "circle", "heading": (1.0, 0.0, 1.0), "speed": 1.0, "urgency": 0.6}


def test_a_mind_of_ones_own_drives_a_body(tmp_path):
    world = tank()
    world.add(bio.RoamingFish("grey_reef_shark", 2, center=(0, -5, 0), mind=Circler), "sharks")
    start = world.scene.batches[0].rotations.copy()
    world.step(120)
    found = world.inspect(int(world.scene.batches[0].ids[0]))
    assert found["behavior"] == "circle"
    assert np.abs(world.scene.batches[0].rotations - start).max() > 0.2
    world.save(tmp_path / "sharks.world")
    again = bio.World.restore(tmp_path / "sharks.world")
    world.step(30)
    again.step(30)
    assert world.state_hash() == again.state_hash()
    with pytest.raises(ArithmeticError, match="dizzy"):
        world.step(100)
    assert world.tick == 199


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        ({"heading": (math.nan, 0, 1)}, "heading"),
        ({"speed": math.inf}, "speed"),
        ({"wings": 2}, "wings"),
    ],
)
def test_a_mind_that_answers_nonsense_is_told(answer, message):
    class Nonsense(bio.Mind):
        def decide(self, percepts):
            return answer

    world = tank()
    world.add(bio.RoamingFish("barracuda", 1, center=(0, -5, 0), mind=Nonsense))
    with pytest.raises(bio.BioscopeError, match=message):
        world.step()
    assert world.tick == 0


def test_a_school_flees_from_what_is_large():
    world = tank(3)
    world.add(bio.FishSchool("anchovy", 80, center=(0, -5, 0), home_radius=3.0))
    world.run(seconds=3)
    world.add(
        bio.RoamingFish("grey_reef_shark", 1, center=(0, -5, -2.5), radius=0.1, home=(0, -5, 0))
    )
    world.run(seconds=12)
    assert "startled" in {event.kind for event in world.events}
