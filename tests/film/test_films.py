"""`bioscope films`: the five films by one command."""

import importlib

import numpy as np
import pytest

import bioscope as bio
from bioscope.film.direction import Story
from bioscope.film.ground import Ground
from bioscope.film.operator import Operator

FILMS = ["go_fish", "jack_cousto", "mating", "preying", "schooling"]


def test_there_are_five_and_each_has_a_shot_list_of_its_own_cameras():
    assert sorted(bio.worlds.films()) == FILMS
    for name, seed in bio.worlds.films().items():
        world = bio.load(name, seed=seed)
        assert {camera for camera, _ in world.shots} <= set(world.cameras)
        assert 20 <= sum(seconds for _, seconds in world.shots) <= 80


EVENTS = {
    "go_fish": ["hooked"],
    "preying": ["caught"],
    "mating": ["circled", "spawned"],
    "jack_cousto": ["circled", "spawned"],
}
"""What each film is about."""


@pytest.mark.parametrize("name", EVENTS)
def test_after_a_trial_run_the_film_shows_what_it_is_about(name):
    module = importlib.import_module(f"bioscope.worlds.{name}.world")
    story = Story(module.world(module.FILM_SEED), module.TRIAL)
    shots = module.direct(story)
    assert 25 <= sum(shot.seconds for shot in shots) <= 80
    assert all(1.5 <= shot.seconds <= 12 for shot in shots)
    world = module.world(module.FILM_SEED)
    operator = Operator(world, None, shots)
    for event in [story.all(kind)[0] for kind in EVENTS[name]]:
        who = [one for one in (event.subject, event.object) if one in story.species]
        # Who is eaten is gone afterwards.
        before = filmed(world, operator, event.time - 0.2)
        assert all((before == one).mean() > 2e-4 for one in who), event
        after = filmed(world, operator, event.time + 1.0)
        assert sum((after == one).mean() for one in who) > 0.003, event


def test_a_story_in_which_nothing_happens_is_said_to_be_one(monkeypatch):
    module = importlib.import_module("bioscope.worlds.preying.world")
    monkeypatch.setattr(module, "TRIAL", 0.5)
    with pytest.raises(
        bio.BioscopeError, match=r"preying: what the film shows did not happen in 0\.5 s"
    ):
        bio.worlds.shots("preying")


def filmed(world, operator, until):
    """Return whom the film's picture shows at a time: identities by pixel."""
    ground = Ground(world.scene)
    while world.time < until:
        world.step()
        camera, _ = operator.camera(world.time, world.dt)
        place = np.array([camera.position], float)
        assert place[0, 1] > ground.height(place)[0] + 0.1
    return bio.look(world.scene, camera, (160, 90)).identity


def test_what_is_there_is_not_made_again(bioscope, tmp_path):
    for name in FILMS:
        (tmp_path / f"{name}.mp4").write_bytes(b"a film")
    done = bioscope("films", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("is there") == 5


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["reef"], "unknown film 'reef'; known: go_fish, "),
        (["--size", "9x9"], "size = 9x9"),
        (["--renderer", "oil"], "renderer = oil"),
    ],
)
def test_wrong_wishes_are_named(bioscope, tmp_path, arguments, message):
    done = bioscope("films", "-o", tmp_path / "new", *arguments)
    assert done.returncode == 1
    assert message in done.stderr
    assert not list(tmp_path.glob("**/*.mp4"))
