"""Films: pictures, sound, cameras, and going on after an interruption."""

import hashlib
import signal
import subprocess
import sys
import time

import av
import numpy as np
import pytest
from conftest import small_world

import bioscope as bio
from bioscope.errors import UnknownNameError
from bioscope.film import FilmOptions, film_world

SMALL = {"seconds": 1.0, "size": (96, 64), "frames_per_second": 12.0}


def pictures(path):
    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


def sound(path):
    with av.open(str(path)) as container:
        return np.concatenate([frame.to_ndarray() for frame in container.decode(audio=0)], axis=1)


def quiet(*_):
    """Say nothing."""


def test_a_film_has_its_pictures_its_sound_and_its_length(tmp_path):
    path = tmp_path / "small.mp4"
    film_world(small_world(), path, FilmOptions(**SMALL), say=quiet)
    with av.open(str(path)) as container:
        video, audio = container.streams.video[0], container.streams.audio[0]
        assert (video.codec_context.name, audio.codec_context.name) == ("h264", "aac")
        assert (video.width, video.height, audio.channels) == (96, 64, 2)
        assert float(video.duration * video.time_base) == pytest.approx(1.0, abs=0.02)
        assert float(audio.duration * audio.time_base) == pytest.approx(1.0, abs=0.06)
    frames = pictures(path)
    assert len(frames) == 12
    assert frames[0].std() > 1
    heard = sound(path)
    assert 1e-4 < np.abs(heard).max() < 10 ** (-1 / 20)
    assert [one.name for one in tmp_path.iterdir()] == ["small.mp4"]


@pytest.mark.capability("AA-002")
def test_a_minute_of_the_same_seed_has_the_same_pictures(tmp_path):
    options = FilmOptions(seconds=60.0, size=(64, 36), frames_per_second=1.0)
    prints = []
    for number in range(2):
        world, folder = bio.load("mating", seed=3), tmp_path / str(number)
        film_world(world, tmp_path / f"{number}.mp4", options, frames=folder, say=quiet)
        frames = sorted(folder.iterdir())
        assert len(frames) == 60
        prints.append([hashlib.sha256(one.read_bytes()).hexdigest() for one in frames])
    assert prints[0] == prints[1]
    assert len(set(prints[0])) == 60, "something moves in every second"


def test_an_interrupted_film_goes_on_and_ends_the_same(tmp_path):
    options = FilmOptions(**SMALL | {"seconds": 7.0})
    whole, frames = tmp_path / "whole.mp4", tmp_path / "frames"
    film_world(small_world(), whole, options, frames=frames, say=quiet)
    broken, again = tmp_path / "broken.mp4", tmp_path / "again"

    def interrupt(text):
        if "picture 60" in text:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        film_world(small_world(), broken, options, frames=again, say=interrupt)
    assert not broken.exists()
    said = []
    film_world(small_world(), broken, options, frames=again, say=said.append)
    assert "going on after 60 of 84 pictures" in said[0]
    names = sorted(one.name for one in frames.iterdir())
    assert len(names) == 84
    for name in names:
        assert (frames / name).read_bytes() == (again / name).read_bytes()
    assert (sound(whole) == sound(broken)).all()
    assert len(pictures(broken)) == 84


def test_a_killed_film_goes_on_by_the_same_command(script, tmp_path):
    output = tmp_path / "film.mp4"
    command = [sys.executable, "-m", "bioscope.cli", "film", str(script), "-o", str(output)]
    command += ["--seconds", "8", "--fps", "15", "--size", "96x64"]
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    progress = tmp_path / ".film.mp4.partial" / "progress"
    deadline = time.monotonic() + 120
    while not progress.exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert not output.exists()
    again = subprocess.run(command, capture_output=True, text=True, check=False)
    assert again.returncode == 0, again.stderr
    assert "going on after" in again.stderr
    assert len(pictures(output)) == 120
    assert not progress.parent.exists()


def test_pictures_go_to_a_folder(tmp_path):
    folder = tmp_path / "pictures"
    film_world(small_world(), None, FilmOptions(**SMALL), frames=folder, say=quiet)
    files = sorted(folder.iterdir())
    assert [one.name for one in files] == [f"frame-{number:05}.png" for number in range(1, 13)]
    assert all(one.read_bytes().startswith(b"\x89PNG") for one in files)


def test_filming_does_not_change_the_world(tmp_path):
    filmed, run = small_world(), small_world()
    options = FilmOptions(**SMALL)
    film_world(filmed, None, options, frames=tmp_path / "pictures", say=quiet)
    run.step(filmed.tick)
    assert filmed.state_hash() == run.state_hash()


def test_a_camera_is_chosen_and_an_unknown_one_refused(tmp_path):
    world = small_world()
    world.cameras.orbit("round", target=(0, -1, 0), radius=3)
    world.cameras.follow("after", species="drifters")
    with pytest.raises(
        UnknownNameError, match="unknown camera 'side'; this world has: main, round"
    ):
        film_world(world, tmp_path / "x.mp4", FilmOptions(**SMALL, camera="side"), say=quiet)
    one, two = tmp_path / "main.mp4", tmp_path / "round.mp4"
    film_world(small_world(), one, FilmOptions(**SMALL, camera="main"), say=quiet)
    film_world(world, two, FilmOptions(**SMALL, camera="round"), say=quiet)
    assert np.abs(pictures(one)[0].astype(int) - pictures(two)[0]).mean() > 0.5
