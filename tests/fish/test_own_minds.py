"""Minds of one's own: functions, classes and copies; namesakes; states as arrays."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.errors import InvalidValueError, UnknownNameError


def tank():
    """Return an empty box of water."""
    world = bio.World(seed=4, dt=1 / 30)
    world.environment.water()
    return world


def left(percepts):
    """Turn to the left for ever."""
    return {"behavior": "left", "heading": (1.0, 0.0, 1.0), "speed": 1.0}


class Counting(bio.Mind):
    """Says how often it was asked."""

    def __init__(self, first=0):
        self.asked = first

    def decide(self, percepts):
        self.asked += 1
        return {"behavior": f"asked {self.asked}"}


@pytest.mark.parametrize("kind", ["intentions", "behavior_network", "free_flow"])
def test_the_inner_life_of_fishes_is_arrays(kind):
    world = tank()
    school = world.add(bio.FishSchool(species="clownfish", count=5, mind=kind))
    world.step(30)
    for drive in (school.hunger, school.libido, school.fear):
        assert drive.shape == (5,)
        assert drive.dtype == np.float64
        assert ((drive >= 0) & (drive <= 1)).all()
    assert school.intention.shape == (5,)
    assert set(school.intention) <= {"avoid", "eat", "mate", "school", "leave", "wander", "escape"}
    assert school.target.shape == (5,)
    assert school.target.dtype == np.int64
    one = world.inspect(int(school.values("id")[2]))["values"]
    assert school.hunger[2] == pytest.approx(one["hunger"])
    none = world.add(bio.FishSchool(species="clownfish", count=0, mind=kind))
    assert none.hunger.shape == none.intention.shape == none.target.shape == (0,)


def test_schools_without_minds_have_no_drives():
    world = tank()
    school = world.add(bio.FishSchool("anchovy", 3))
    with pytest.raises(UnknownNameError, match="hunger"):
        _ = school.hunger


@pytest.mark.parametrize(
    ("mind", "behavior"),
    [
        (left, "left"),
        (lambda percepts: {"behavior": "lambda"}, "lambda"),
        (lambda *percepts: {"behavior": "whatever"}, "whatever"),
        (Counting, "asked 9"),
        (lambda: Counting(20), "asked 29"),
        (Counting(40), "asked 49"),
    ],
)
def test_a_mind_is_a_function_a_class_a_maker_or_an_example(mind, behavior):
    world = tank()
    school = world.add(bio.FishSchool(species="anthias", count=3, mind=mind))
    world.step(9)
    assert set(school.intention) == {behavior}


def test_a_function_is_found_again_in_a_saved_world(tmp_path):
    world = tank()
    world.add(bio.FishSchool(species="anthias", count=2, mind=left))
    world.step(10)
    world.save(tmp_path / "left.world")
    again = bio.World.restore(tmp_path / "left.world")
    world.step(10)
    again.step(10)
    assert world.state_hash() == again.state_hash()


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (None, "decide = None"),
        (float("nan"), "decide = nan"),
        ([1, 2], "decide"),
        ({"behavior": 3}, "behavior"),
        ({"target": -1}, "target"),
        ({"target": 10**20}, "target"),
        ({"display": 3}, "display"),
        ({"display": {"sex": 3}}, "sex"),
        ({"display": {"partner": "she"}}, "partner"),
    ],
)
def test_nonsense_is_told_by_the_name_of_the_field_and_the_world_lives_on(answer, message):
    world = tank()
    calm = world.add(bio.FishSchool(species="anthias", count=2, mind="intentions"))
    mad = world.add(
        bio.FishSchool(
            species="anthias",
            count=1,
            mind=lambda percepts: answer if percepts["time"] > 0.1 else {},
        )
    )
    with pytest.raises(InvalidValueError, match=message):
        world.step(30)
    tick = world.tick
    assert 0 < tick < 30
    mad.resize(0)
    world.step(30)
    assert world.tick == tick + 30
    assert len(calm.hunger) == 2


@pytest.mark.parametrize("mind", [3, (lambda: 3), (lambda: None), object()])
def test_what_makes_no_mind_is_refused(mind):
    with pytest.raises(InvalidValueError, match="mind"):
        bio.FishSchool(species="anthias", count=1, mind=mind)


def test_parameters_of_fishes_with_minds_of_ones_own_are_heeded():
    world = tank()
    fish = world.add(bio.RoamingFish("anthias", 1, mind=left, sight_range=3.0))
    assert fish.parameters["sight_range"] == 3.0
    with pytest.raises(UnknownNameError, match="wings"):
        bio.RoamingFish("anthias", 1, mind=left, wings=2)


def namesake(behavior):
    """Return a class called as others are."""

    class Namesake(bio.Mind):
        def decide(self, percepts):
            if percepts["time"] > 1.0:
                raise ArithmeticError("late")
            return {"behavior": behavior}

    return Namesake


def test_newcomers_have_the_mind_of_their_population_whatever_is_called_alike():
    world = tank()
    ones = world.add(bio.RoamingFish("anthias", 2, mind=namesake("one")))
    others = world.add(bio.RoamingFish("anthias", 2, mind=namesake("other")))
    namesake("third")
    ones.resize(4)
    others.resize(3)
    world.step(3)
    assert set(ones.intention) == {"one"}
    assert set(others.intention) == {"other"}
    # A tick that fails is undone: so are minds.
    with pytest.raises(ArithmeticError):
        world.step(60)
    assert set(ones.intention) == {"one"}


def test_namesakes_are_not_saved_together(tmp_path):
    world = tank()
    world.add(bio.RoamingFish("anthias", 1, mind=namesake("one")))
    world.save(tmp_path / "one.world")
    world.add(bio.RoamingFish("anthias", 1, mind=namesake("other")))
    with pytest.raises(InvalidValueError, match=r"'Namesake'.*`kind`"):
        world.save(tmp_path / "both.world")
    assert not (tmp_path / "both.world").exists()


def test_a_population_has_one_class_of_each_kind():
    makers = iter([namesake("one"), namesake("other")])
    with pytest.raises(InvalidValueError, match="Namesake"):
        bio.RoamingFish("anthias", 2, mind=lambda: next(makers)())


def test_a_saved_mind_with_two_namesakes_in_modules_is_ambiguous(tmp_path):
    first = type("Twin", (Counting,), {"__module__": "north"})
    world = tank()
    world.add(bio.RoamingFish("anthias", 1, mind=first))
    world.save(tmp_path / "twin.world")
    bio.World.restore(tmp_path / "twin.world").step(3)
    type("Twin", (Counting,), {"__module__": "south"})
    with pytest.raises(UnknownNameError, match=r"north\.Twin, south\.Twin"):
        bio.World.restore(tmp_path / "twin.world")
    world.step(3)
