"""Fishes asked for in ways that make no sense: the field is named, the world lives on."""

import math

import numpy as np
import pytest
from designs import DESIGN, SPECIES, changed

import bioscope as bio

NAN, INF = math.nan, math.inf


def water() -> bio.World:
    """Return a world with water and one fish in it."""
    world = bio.World(seed=2, dt=1 / 30)
    world.environment.water()
    world.add(bio.RoamingFish("chromis", 1, center=(0, -3, 0)), "resident")
    return world


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (r"^name = .*$", "", "name"),
        (r"^length = .*$", "", "length"),
        (r"^length = .*$", "length = 0.0", "length"),
        (r"^length = .*$", "length = -0.1", "length"),
        (r"^length = .*$", "length = nan", "length"),
        (r"^length = .*$", "length = inf", "length"),
        (r"^length = .*$", "length = 1e30", "length"),
        (r"^length = .*$", 'length = "long"', "length"),
        (r"^length = .*$", "length = 0.11\nwings = 2", "wings"),
        (r"^cruise = .*$", "", "cruise"),
        (r"^cruise = .*$", "cruise = nan", "cruise"),
        (r"^cruise = .*$", "cruise = -1.0", "cruise"),
        (r"^burst = .*$", "burst = inf", "burst"),
        (r"^waves = .*$", "waves = nan", "waves"),
        (r"^style = .*$", 'style = "crawl"', "crawl"),
        (r"^at = \[0\.0, 0\.007", "at = [0.0, 0.9", "at"),
        (r"^at = \[0\.0, 0\.007", "at = [0.0, nan", "at"),
        (r"^back = \[0\.006", "back = [nan", "back"),
        (r"^back = \[0\.006, ", "back = [", "back"),
        (r"^belly = \[0\.016", "belly = [-5.0", "belly"),
        (r"^width = \[0\.007", "width = [-0.1", "width"),
        (r"^fullness = \[2\.0", "fullness = [0.0", "fullness"),
        (r"^radius = 0\.0265", "radius = nan", "radius"),
        (r"^rays = 18", "rays = -1", "rays"),
        (r"^rays = 18", "rays = 4000000000", "rays"),
        (r'^color = "#8a3a1c"', 'color = "reddish"', "color"),
        (r"^base = \[0\.19, 0\.62\]", "base = [0.62, 0.19]", "base"),
        (r"^base = \[0\.19, 0\.62\]", "base = [0.19, 40.0]", "base"),
        (r"^swing = .*$", "swing = nan", "swing"),
    ],
)
def test_wrong_species_files_are_refused_by_the_name_of_the_field(tmp_path, old, new, message):
    world = water()
    path = changed(SPECIES, tmp_path / "mine.toml", old, new)
    with pytest.raises(bio.BioscopeError, match=message) as refused:
        world.add(bio.RoamingFish(path, 1, center=(0, -3, 0)))
    assert "mine.toml" in str(refused.value), "the file is named"
    world.step(3)
    assert len(world.populations) == 1


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (r"^step = .*$", "step = nan", "step"),
        (r"^damping = .*$", "damping = -1.0", "damping"),
        (r"^damping = .*$", "", "damping"),
        (r"^damping = ", "dumping = 1.0\ndamping = ", "dumping"),
        (r"^shortening = .*$", "shortening = 2.0", "shorten"),
        (r"^stations = .*$", "stations = [0.5, 0.4, 0.3, 0.2, 0.1]", "stations"),
        (r"^masses = .*$", "masses = [1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0]", "mass"),
        (r"^friction = .*$", "friction = inf", "friction"),
    ],
)
def test_wrong_designs_are_refused_by_the_name_of_the_field(tmp_path, old, new, message):
    preset = changed(DESIGN, tmp_path / "mine.toml", old, new)
    with pytest.raises(bio.BioscopeError, match=message):
        bio.fish.Tank("anthias", preset=preset)


@pytest.mark.parametrize("text", ["", "name = ", "\0\0", "[[[[", "name = 5", "é" * 9999])
def test_what_is_no_species_file_is_refused_by_its_name(tmp_path, text):
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    for kind in (bio.FishSchool, bio.RoamingFish):
        with pytest.raises(bio.BioscopeError, match=r"mine\.toml"):
            kind(str(path), 3)


@pytest.mark.parametrize(
    "make",
    [
        lambda: bio.FishSchool("anthias", 0),
        lambda: bio.FishSchool("anthias", 0, replayed=1.0, driven=5),
        lambda: bio.FishSchool("anthias", 0, mind="intentions"),
        lambda: bio.RoamingFish("anthias", 0),
        lambda: bio.RoamingFish("anthias", 0, mind="free_flow", body="swimmer"),
    ],
)
def test_no_fish_at_all_are_no_trouble(make, tmp_path):
    world = water()
    none = world.add(make(), "none")
    world.step(3)
    assert len(world.populations) == 2
    assert none.statistics["count"] == 0
    world.save(tmp_path / "none.world")
    again = bio.World.restore(tmp_path / "none.world")
    again.step(2)
    world.step(2)
    assert world.state_hash() == again.state_hash()


@pytest.mark.parametrize("kind", [bio.FishSchool, bio.RoamingFish])
@pytest.mark.parametrize("count", [10_000_000, 2**62, -1, 2.5, "many"])
def test_impossible_numbers_of_fish_are_refused(kind, count):
    world = water()
    with pytest.raises(bio.BioscopeError, match="count"):
        world.add(kind("anthias", count))
    world.step(2)
    assert world.populations["resident"] == 1


@pytest.mark.parametrize("count", [10_000_000, 2**62, -1])
def test_no_population_grows_without_end(count):
    world = bio.World(seed=2, dt=1 / 30)
    for fishes in (bio.FishSchool("anthias", 2), bio.RoamingFish("anthias", 2)):
        population = world.add(fishes)
        with pytest.raises(bio.BioscopeError, match="count"):
            population.resize(count)
        world.step()
        assert world.populations[population.name] == 2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"center": (NAN, 0, 0)}, "center"),
        ({"center": (0, 0)}, "center"),
        ({"radius": NAN}, "radius"),
        ({"radius": -1.0}, "radius"),
        ({"radius": INF}, "radius"),
        ({"home": (0, INF, 0)}, "home"),
        ({"variation": 2.0}, "variation"),
        ({"variation": NAN}, "variation"),
        ({"females": 1.5, "mind": "intentions"}, "females"),
        ({"females": NAN, "mind": "intentions"}, "females"),
        ({"body": "wheels"}, "wheels"),
        ({"mind": "clever"}, "clever"),
        ({"wings": 2.0}, "wings"),
    ],
)
def test_options_of_fishes_that_make_no_sense_are_refused(options, message):
    world = water()
    with pytest.raises((bio.BioscopeError, LookupError, ValueError), match=message):
        world.add(bio.RoamingFish("anthias", 2, **options))
    world.step(2)
    assert len(world.populations) == 1


ANSWERS = [
    ({"heading": (NAN, 0, 1)}, "heading"),
    ({"speed": INF}, "speed"),
    ({"speed": "fast"}, "speed"),
    ({"brake": NAN}, "brake"),
    ({"mouth": NAN}, "mouth"),
    ({"urgency": -INF}, "urgency"),
    ({"wings": 2}, "wings"),
    (None, "decide|intention|None"),
    (5, "decide|intention|int"),
]


@pytest.mark.parametrize(("answer", "message"), ANSWERS)
@pytest.mark.parametrize("body", ["swimmer", "muscle_swimmer"])
def test_a_mind_that_answers_nonsense_leaves_the_world_as_it_was(answer, message, body):
    class Odd(bio.Mind):
        def __init__(self):
            self.asked = 0

        def decide(self, percepts):
            self.asked += 1
            return {"speed": 1.0} if self.asked < 3 else answer

    world = water()
    world.add(bio.RoamingFish("anthias", 2, center=(0, -3, 0), mind=Odd, body=body))
    world.step(2)
    before = world.state_hash()
    for _ in range(2):
        with pytest.raises((bio.BioscopeError, TypeError), match=message):
            world.step()
        assert world.tick == 2
        assert world.state_hash() == before


def test_a_world_goes_on_when_a_mind_that_failed_has_recovered():
    class Moody(bio.Mind):
        calm = False

        def decide(self, percepts):
            if not Moody.calm and percepts["time"] > 0.1:
                raise ArithmeticError("dizzy")
            return {"speed": 1.0}

    world = water()
    world.add(bio.RoamingFish("anthias", 2, center=(0, -3, 0), mind=Moody))
    with pytest.raises(ArithmeticError, match="dizzy"):
        world.step(30)
    failed = world.tick
    Moody.calm = True
    world.step(30)
    assert world.tick == failed + 30
    assert all(np.isfinite(batch.positions).all() for batch in world.scene.batches)


def test_what_a_tank_cannot_do_is_refused_by_name():
    with pytest.raises(bio.BioscopeError, match="known"):
        bio.fish.Tank("unicorn")
    with pytest.raises(bio.BioscopeError, match="preset"):
        bio.fish.Tank("anthias", preset="wrong")
    for wrong in ({"dt": NAN}, {"dt": -1}, {"length": 0}, {"water": -1}):
        with pytest.raises(bio.BioscopeError):
            bio.fish.Tank("anthias", **wrong)
    tank = bio.fish.Tank("anthias")
    with pytest.raises(bio.BioscopeError, match="activations"):
        tank.step(np.zeros(11))
    with pytest.raises(bio.BioscopeError, match="activations"):
        tank.step(np.full(12, NAN))
    with pytest.raises(bio.BioscopeError, match="speed"):
        tank.swim(INF)
    with pytest.raises(bio.BioscopeError, match="radians"):
        tank.turn(90)
    tank.step()
    assert np.isfinite(tank.nodes).all()
