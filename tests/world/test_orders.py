"""What populations can be told between two ticks, and that a replay repeats it."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.world.changes import Addition, Order, Script, Setting, Step, brief, perform


def lagoon(seed=3, fishes=4, speed=0.0):
    """Return a small sea with fishes that have minds and muscles."""
    world = bio.World(seed=seed, dt=1 / 30, title="lagoon")
    world.environment.water(0.0, bio.Current((1, 0, 0), speed=speed, surge=0.0, turbulence=0.0))
    mind = bio.minds.Intentions("pacifist", food=["plankton"])
    school = bio.RoamingFish("fusilier", fishes, center=(0, -3, 0), radius=1.0, mind=mind)
    world.add(school, "fish")
    world.add(bio.Plankton(40, low=(-3, -5, -3), high=(3, -1, 3)))
    return world, school


def ids(population):
    return [int(one) for one in population.values("id")]


@pytest.mark.capability("TF-180")
def test_numbers_of_everything_can_be_set_and_species_added():
    world, fish = lagoon()
    world.step(5)
    fish.resize(7)
    assert len(set(ids(fish))) == 7
    fish.resize(0)
    fish.resize(3)
    world.order("plankton", {"number": 12})
    species = ["clownfish", "blue_tang", "anthias", "chromis", "yellow_tang", "moorish_idol"]
    for one in [*species, "parrotfish", "butterflyfish"]:
        perform(world, Addition("fish", 2, (0, -3, 1), one, "pacifist"))
    perform(world, Addition("plants", 6, (0, -5, 0), "seagrass"))
    perform(world, Addition("pillars", 3, (2, -5, 0)))
    world.step(3)
    counts = world.populations
    assert (counts["fish"], counts["plankton"]) == (3, 12)
    assert (counts["seagrass"], counts["pillar"]) == (6, 3)
    assert all(counts[one] == 2 for one in species)


def test_the_youngest_go_first_and_newcomers_take_after_the_others():
    world, fish = lagoon()
    fish.set(intentions_appetite=9.0)
    first = ids(fish)
    fish.resize(6)
    assert ids(fish)[:4] == first
    newest = world.inspect(ids(fish)[-1])
    assert newest["traits"]["intentions_appetite"] == 9.0
    fish.resize(2)
    assert ids(fish) == first[:2]
    fish.remove(first[0])
    assert ids(fish) == first[1:2]


@pytest.mark.capability("TF-189", "TF-188")
def test_temper_and_habits_of_one_fish_or_all():
    world, fish = lagoon()
    one, other = ids(fish)[:2]
    fish.set_one(one, intentions_appetite=2.0, intentions_female=1.0, intentions_likes_dark=1.0)
    traits = {who: world.inspect(who)["traits"] for who in (one, other)}
    assert [traits[one][f"intentions_{name}"] for name in ("appetite", "female")] == [2.0, 1.0]
    assert [traits[other][f"intentions_{name}"] for name in ("appetite", "female")] == [5.0, 0.0]
    fish.set(intentions_likes_company=1.0)
    assert all(world.inspect(who)["traits"]["intentions_likes_company"] == 1.0 for who in ids(fish))


@pytest.mark.capability("TF-189")
@pytest.mark.parametrize("kind", ["Intentions", "BehaviorNetwork", "FreeFlow"])
def test_a_lover_of_darkness_leaves_the_light_unless_it_likes_both(kind):
    def chosen(**habits):
        mind = getattr(bio.minds, kind)("pacifist", drive_threshold=1.0)
        mind.set(**habits)
        assert {name: mind.parameters[name] for name in habits} == habits
        choices = [mind.decide({"body_length": 0.1, "light": 1.0}) for _ in range(30)]
        return choices[-1]["behavior"]

    assert chosen(likes_dark=1.0, likes_bright=0.0) == "leave"
    assert chosen(likes_dark=1.0, likes_bright=1.0) != "leave"
    assert chosen(likes_dark=0.0, likes_bright=0.0) != "leave"


@pytest.mark.capability("TF-184", "TF-185")
def test_without_the_push_of_water_a_beating_tail_gives_no_way():
    def way(**physics):
        world, fish = lagoon(fishes=1)
        fish.set(**{f"muscle_swimmer_{name}": value for name, value in physics.items()})
        fish.steer(ids(fish)[0], speed=2.0)
        places = []
        for _ in range(3):
            places.append(world.scene.batches[0].positions[0].copy())
            world.step(30)
        return np.linalg.norm(places[2] - places[1])

    swims, beats = way(), way(water=0.0)
    assert swims > 0.15
    assert beats < 0.1 * swims


@pytest.mark.capability("TF-184")
@pytest.mark.parametrize("name", ["water", "mass", "stiffness", "viscosity"])
def test_a_change_of_physics_takes_effect_in_the_next_step(name):
    world, fish = lagoon()
    same, other = lagoon()
    world.step(20)
    same.step(20)
    other.set(**{f"muscle_swimmer_{name}": 0.5})
    world.step()
    same.step()
    moved, otherwise = (one.scene.batches[0].poses for one in (world, same))
    assert not np.array_equal(moved, otherwise)
    fish.set(**{f"muscle_swimmer_{name}": 1.0})
    assert fish.parameters[f"muscle_swimmer_{name}"] == 1.0


@pytest.mark.capability("TF-186")
def test_tracers_turn_with_the_current_and_stop_when_it_is_off():
    def drift(world):
        before = world.scene.points[0]
        world.step(10)
        after = world.scene.points[0]
        rows = {int(one): row for row, one in enumerate(before.ids)}
        kept = [(rows[int(one)], row) for row, one in enumerate(after.ids) if int(one) in rows]
        old, new = np.array(kept).T
        return np.median(after.positions[new] - before.positions[old], axis=0) / (10 * world.dt)

    world, _ = lagoon(speed=0.3)
    world.set("plankton", "swimming", 0.0)
    world.step(30)
    assert np.allclose(drift(world), [0.3, 0, 0], atol=0.03)
    world.set("current", "bearing", 180.0)
    assert np.allclose(drift(world), [0, 0, -0.3], atol=0.03)
    world.set("current", "strength", 0.0)
    assert np.allclose(drift(world), 0, atol=0.03)


@pytest.mark.capability("TF-187")
def test_the_time_step_can_be_changed_and_time_goes_on():
    world, _ = lagoon()
    world.step(30)
    assert world.time == pytest.approx(1.0)
    world.set("world", "time_step", 0.01)
    assert world.time == pytest.approx(1.0)
    world.step(50)
    assert world.time == pytest.approx(1.5)
    assert world.scene.time == world.time


@pytest.mark.capability("TF-196")
def test_a_steered_fish_does_what_it_is_told_and_goes_on_by_itself_when_released():
    world, fish = lagoon()
    one = ids(fish)[0]

    def heading():
        batch = world.scene.batches[0]
        x, y, z, w = batch.rotations[list(batch.ids).index(one)]
        return np.arctan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y))

    def turned(angle):
        before = heading()
        fish.steer(one, turn=angle, speed=1.5)
        world.step(8)
        return (heading() - before + np.pi) % (2 * np.pi) - np.pi

    hungry = world.inspect(one)["values"]["hunger"]
    left, right = turned(0.9), turned(-0.9)
    assert left > 0.3
    assert right < -0.3
    inspection = world.inspect(one)
    assert (inspection["behavior"], inspection["values"]["steered"]) == ("steered", True)
    assert inspection["values"]["hunger"] > hungry
    fish.release(one)
    world.step()
    assert world.inspect(one)["behavior"] != "steered"


@pytest.mark.capability("TF-196")
def test_a_steered_fish_eats_with_an_open_mouth():
    world, fish = lagoon(fishes=1)
    world.add(bio.Plankton(4000, low=(-0.6, -3.6, -0.6), high=(0.6, -2.4, 0.6)))
    one = ids(fish)[0]
    fish.place(one, (0.0, -3.0, 0.0))
    fish.steer(one, speed=1.5, mouth=1.0)
    world.step(90)
    assert any(event.kind == "eaten" and event.object == one for event in world.events)


@pytest.mark.capability("TF-183")
def test_things_are_moved_and_sized():
    world, fish = lagoon()
    perform(world, Addition("plants", 3, (0, -5, 0), "seagrass"))
    pillars = world.add(bio.Pillars([(0.0, -5.0, 0.0)], radius=0.5, height=3.0))

    def of(species):
        return next(one for one in world.scene.batches if one.species == species)

    fish.place(ids(fish)[0], (1.0, -2.0, 0.5))
    assert np.allclose(of("fusilier").positions[0], (1.0, -2.0, 0.5), atol=0.05)
    plant = int(of("seagrass").ids[0])
    size = of("seagrass").scales[0]
    world.order("seagrass", {"place": {"id": plant, "position": [2, -5, 1], "scale": 1.5}})
    assert np.allclose(of("seagrass").positions[0], (2, -5, 1))
    assert of("seagrass").scales[0] == pytest.approx(1.5 * size)
    pillars.place(int(of("pillar").ids[0]), (1.0, -5.0, 0.5), scale=2.0)
    world.step(2)
    place = next(one.positions[0] for one in world.scene.batches if one.species == "fusilier")
    # The fish was where the pillar now stands: it is put beside it.
    assert np.hypot(place[0] - 1.0, place[2] - 0.5) > 0.9


CHANGES = [
    (5, Setting("environment", "temperature", 20.0)),
    (5, Order("fish", {"number": 6})),
    (9, Addition("fish", 2, (0.0, -3.0, 1.0), "clownfish", "prey")),
    (12, Order("plankton", {"number": 60})),
    (12, Setting("world", "time_step", 0.02)),
    (15, Addition("pillars", 2, (1.0, -5.0, 0.0))),
    (20, Setting("current", "bearing", 33.0)),
    (22, Setting("fish", "muscle_swimmer_stiffness", 1.7)),
]


def changed(world, changes):
    fish = [int(one) for one in world._engine.values("fish", "id")]
    steering = {"turn": 0.4, "pitch": 0.1, "speed": 1.0, "brake": 0.0, "mouth": 0.0}
    own = [
        (3, Order("fish", {"steer": {"id": fish[0], "steering": steering}})),
        (7, Order("fish", {"place": {"id": fish[1], "position": [0.5, -2.5, 0], "scale": 1.0}})),
        (8, Order("fish", {"trait": {"id": fish[2], "name": "intentions_female", "value": 1.0}})),
        (18, Order("fish", {"remove": fish[3]})),
        (25, Order("fish", {"steer": {"id": fish[0], "steering": None}})),
    ]
    steps = sorted([*changes, *own], key=lambda one: one[0])
    for tick, change in steps:
        world.step(tick - world.tick)
        perform(world, change)
    world.step(40 - world.tick)
    return [Step(*one) for one in steps]


@pytest.mark.capability("TF-182", "TF-183")
def test_scripts_and_recordings_repeat_all_changes_to_the_bit(tmp_path):
    world, _ = lagoon()
    world.record()
    steps = changed(world, CHANGES)
    end = world.state_hash()
    world.save_recording(tmp_path / "run.recording")
    assert bio.World.replay(tmp_path / "run.recording").state_hash() == end
    text = Script("lagoon", 3, 40, brief(steps)).text()
    (tmp_path / "lagoon.py").write_text(
        f"import sys\nsys.path.insert(0, {str(tmp_path.parent)!r})\n"
        "def world(seed):\n    import test_orders\n    return test_orders.lagoon(seed)[0]\n"
    )
    script = tmp_path / "lagoon.json"
    script.write_text(text.replace('"lagoon"', f'"{tmp_path / "lagoon.py"}"', 1))
    assert bio.load(str(script)).state_hash() == end


REFUSED = [
    ("fish", {"number": -1}),
    ("fish", {"number": 10**9}),
    ("fish", {"number": 10**30}),
    ("fish", {"remove": 999_999}),
    ("fish", {"dance": 1}),
    ("fish", {"steer": {"id": 1, "steering": {"turn": 9.0}}}),
    ("fish", {"place": {"id": 1, "position": [1e9, 0, 0], "scale": 1.0}}),
    ("fish", {"place": {"id": 1, "position": [0, 0], "scale": 1.0}}),
    ("fish", {"trait": {"id": 1, "name": "courage", "value": 1.0}}),
    ("fish", {"trait": {"id": 1, "name": "intentions_appetite", "value": -3.0}}),
    ("plankton", {"steer": {"id": 1, "steering": None}}),
    ("nobody", {"number": 1}),
]


@pytest.mark.parametrize(("population", "order"), REFUSED)
def test_refused_orders_change_nothing(population, order):
    world, _ = lagoon()
    before = world.state_hash()
    with pytest.raises(bio.BioscopeError):
        world.order(population, order)
    assert world.state_hash() == before


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        '{"world": "reef"}',
        '{"world": "reef", "seed": -1, "tick": 3}',
        "null",
        "{" * 100_000,
    ],
)
def test_broken_scripts_are_refused_by_name(tmp_path, text):
    path = tmp_path / "broken.json"
    path.write_text(text)
    with pytest.raises(bio.BioscopeError, match=r"broken\.json"):
        bio.load(str(path))
