"""Films of growing plants, and growth without jumps, through the command line and worlds."""

import shutil
import subprocess

import numpy as np
import pytest

import bioscope as bio

MODELS = {
    "internodes that stretch": "angle: 40\naxiom: FA\nF --> FF\nA --> F[+A][-A]A\n",
    "shoots that age": "axiom: A\nA --> I(0)[&(40)A]A\nI(a) --> I(a+1)\nhomomorphism\n"
    "I(a) : a < 1 --> !(0.05)F(0.3)[+(50)~l(0.2)]F(0.7)\n"
    "I(a) --> !(0.1*a+0.1)F(0.6)[+(70)~l(0.3)]F(0.6)\n",
}


def heights(text: str, *, unfold: bool) -> np.ndarray:
    """Return the height of a plant in every tick of six steps, and while the last one lasts."""
    world = bio.World(seed=1, dt=1 / 20)
    plant = world.add(
        bio.Plants(
            f"lsystem: m\n{text}endlsystem\n",
            1,
            rate=2.0,
            steps=6,
            turned=False,
            unfold=unfold,
            flexibility=0.0,
        )
    )
    rows = []
    for _ in range(75):
        world.step()
        rows.append(plant.values("height_m")[0])
    return np.array(rows)


@pytest.mark.parametrize("model", MODELS)
def test_plants_grow_without_jumps_between_their_steps(model):
    smooth, stepped = (heights(MODELS[model], unfold=unfold) for unfold in (True, False))
    jumps = np.abs(np.diff(smooth)).max(), np.abs(np.diff(stepped)).max()
    span = np.ptp(stepped)
    assert span > 0.1
    # Ten ticks a step: the steepest tick of a smooth step takes 15 % of it.
    assert jumps[0] < 0.3 * jumps[1], jumps
    assert smooth[-1] == pytest.approx(stepped[-1], rel=1e-3)


def test_the_growth_of_a_plant_is_filmed(bioscope, tmp_path):
    film = tmp_path / "tulip.mp4"
    done = bioscope("grow", "tulip", "-o", film, "--seconds", "1", "--size", "96x96")
    assert done.returncode == 0, done.stderr
    assert film.stat().st_size > 1000
    if shutil.which("ffmpeg"):
        command = ["ffmpeg", "-v", "error", "-i", film, "-f", "rawvideo", "-pix_fmt", "gray", "-"]
        raw = subprocess.run(command, capture_output=True, check=True).stdout
        pictures = np.frombuffer(raw, np.uint8).reshape(-1, 96, 96).astype(float)
        assert len(pictures) == 30
        grown = np.abs(pictures - pictures[0]).mean(axis=(1, 2))
        # The plant that is there at the end is half there before.
        assert grown[-1] > 1.0
        assert 0.1 < grown[len(grown) // 2] / grown[-1] < 1.2


def test_what_cannot_be_filmed_growing_is_refused(bioscope, tmp_path):
    done = bioscope("grow", "tulip", "-o", tmp_path / "t.mp4", "--steps", "0")
    assert done.returncode != 0
    assert "one step or more" in done.stderr
    assert not list(tmp_path.iterdir())
