"""`bioscope films`: the five films by one command."""

import pytest

import bioscope as bio

FILMS = ["go_fish", "jack_cousto", "mating", "preying", "schooling"]


def test_there_are_five_and_each_has_a_shot_list_of_its_own_cameras():
    assert sorted(bio.worlds.films()) == FILMS
    for name, seed in bio.worlds.films().items():
        world = bio.load(name, seed=seed)
        assert {camera for camera, _ in world.shots} <= set(world.cameras)
        assert 20 <= sum(seconds for _, seconds in world.shots) <= 80


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
