"""Fishes with a mind by its name alone live as their species do."""

from collections import Counter

import numpy as np
import pytest
from designs import SPECIES, changed

import bioscope as bio


def sea(seed=5):
    """Return a world of water under a surface."""
    world = bio.World(seed=seed, dt=1 / 30)
    world.environment.water(surface=0.0)
    return world


def told(world, kind):
    """Return who did it, and to whom."""
    return [(event.subject, event.object) for event in world.events if event.kind == kind]


@pytest.mark.capability("TF-005", "TF-130", "TF-133")
@pytest.mark.parametrize("kind", ["intentions", "behavior_network", "free_flow"])
def test_a_shark_hunts_and_prey_flees(kind):
    world = sea(seed=1)
    prey = world.add(
        bio.FishSchool("anthias", 12, mind=kind, center=(0, -4, 1), half=(0.8, 0.5, 0.8))
    )
    shark = world.add(
        bio.FishSchool("shark", 1, mind=kind, center=(0, -4, -2), half=(0.1, 0.1, 0.1))
    )
    hunter = int(shark.values("id")[0])
    world.run(seconds=60)
    assert hunter in {whom for _, whom in told(world, "escaped")}
    assert told(world, "caught"), Counter(event.kind for event in world.events)
    assert len(prey.hunger) < 12


@pytest.mark.capability("TF-133", "TF-125")
def test_prey_schools_and_eats_plankton():
    world = sea()
    world.add(bio.FishSchool("anchovy", 10, mind="intentions", half=(0.6, 0.4, 0.6)))
    world.add(bio.Plankton(200, low=(-1.5, -4.0, -1.5), high=(1.5, -2.0, 1.5)))
    world.run(seconds=30)
    assert told(world, "eaten")
    assert told(world, "schooled")


@pytest.mark.capability("TF-134", "TF-100")
def test_pacifists_of_both_sexes_court_and_spawn():
    world = sea(seed=3)
    fish = world.add(
        bio.FishSchool(
            "butterfly fish", 4, mind="intentions", center=(0, -3, 0), half=(0.5, 0.3, 0.5)
        )
    )
    world.add(bio.Plankton(300, low=(-2.0, -5.0, -2.0), high=(2.0, -1.0, 2.0)))
    world.run(seconds=120)
    ids = [int(one) for one in fish.values("id")]
    females = {one for one in ids if world.inspect(one)["traits"]["intentions_female"] == 1.0}
    assert len(females) == 2
    for kind in ("courted", "mated", "spawned"):
        assert told(world, kind), Counter(event.kind for event in world.events)
        for one, other in told(world, kind):
            assert {one, other} <= set(ids)
            assert (one in females) != (other in females), "partners are of both sexes"


@pytest.mark.capability("TF-005")
def test_a_species_file_says_how_a_fish_lives(tmp_path):
    def behaviors(role):
        path = changed(SPECIES, tmp_path / "mine.toml", r"^role = .*$", f"{role}  # mine")
        world = sea()
        mine = world.add(bio.FishSchool(path, 1, mind="intentions", half=(0.01, 0.01, 0.01)))
        world.add(bio.RoamingFish("barracuda", 1, center=(0, -3, 2), radius=0.1))
        world.run(seconds=2)
        assert np.isfinite(mine.hunger).all()
        return {event.kind for event in world.events if event.object is not None}

    assert "escaped" in behaviors('role = "prey"')
    assert "escaped" not in behaviors('role = "pacifist"')
    for wrong, field in (
        ('role = "plant"', "plant"),
        ('role = "prey"\nwings = 2', "wings"),
        ('role = "prey"\nleaders = ["No Name"]', r"nature\.leaders\[0\]"),
        ('role = "prey"\nspecies = "other"', r"nature\.species"),
    ):
        path = changed(SPECIES, tmp_path / "mine.toml", r"^role = .*$", wrong)
        with pytest.raises(bio.BioscopeError, match=field):
            bio.FishSchool(path, 1)


def test_the_name_of_a_family_means_all_its_species():
    world = sea()
    wary = bio.minds.Intentions("prey", enemies="shark", stagger=0.0)
    fish = world.add(bio.RoamingFish("chromis", 1, center=(0, -4, 0), radius=0.1, mind=wary))
    world.step(10)
    assert fish.fear[0] == 0.0
    assert not np.signbit(fish.fear[0])
    world.add(bio.RoamingFish("grey_reef_shark", 1, center=(0, -4, 4), radius=0.1))
    world.step(30)
    assert fish.fear[0] > 0.2


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: bio.minds.Intentions("shark"), "role"),
        (lambda: bio.minds.Intentions("prey", enemies=None), "enemies"),
        (lambda: bio.minds.Intentions("prey", food=[3]), "food"),
        (lambda: bio.minds.Intentions(habits="night"), "night"),
        (lambda: bio.minds.Intentions(appetite=float("nan")), "appetite"),
        (lambda: bio.minds.Intentions().decide(None), "percepts"),
        (lambda: bio.fish.Shoal("anthias", -1), "count"),
        (lambda: bio.fish.Shoal("anthias", 2.5), "count"),
        (lambda: bio.fish.Shoal(None), "species"),
        (lambda: bio.fish.Shoal("anthias").turn(0, float("nan")), "angle"),
    ],
)
def test_wrong_minds_and_shoals_are_refused_by_the_name_of_the_field(make, field):
    with pytest.raises(bio.BioscopeError, match=field):
        make()
