"""`bioscope stills`: color plates by one command."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.film.operator import Operator

PLATES = {
    "mixed_reef",
    "courting_pair",
    "stalked_school",
    "fishing_line",
    "hooked_fish",
    "peaceful_world",
    "predator_chase",
    "fleeing_school",
}


@pytest.mark.capability("TF-205")
def test_each_plate_shows_the_living_at_its_moment():
    plates = bio.worlds.plates()
    assert set(plates) == PLATES
    for name in plates:
        plate = bio.worlds.plate(name)
        world = bio.load(plate.world, seed=plate.seed)
        world.run(plate.time)
        camera, _ = Operator(world, None, [plate.shot]).camera(0.0, 0.0)
        view = bio.look(world.scene, camera, (96, 54))
        alive = [one for batch in world.scene.batches if batch.alive for one in batch.ids]
        shown = np.isin(view.identity, alive).mean()
        assert shown > 0.004, (name, shown)
        assert view.color.max() > 4 * view.color.min() + 0.05, name


def test_a_plate_is_a_picture_and_is_not_taken_twice(bioscope, tmp_path):
    for _ in range(2):
        done = bioscope("stills", "-o", tmp_path, "--size", "96x54", "mixed_reef")
        assert done.returncode == 0, done.stderr
    assert "is there" in done.stderr
    picture = (tmp_path / "mixed_reef.png").read_bytes()
    assert picture[1:4] == b"PNG"
    wrong = bioscope("stills", "-o", tmp_path, "moon")
    assert wrong.returncode == 1
    assert "unknown still 'moon'; known: " in wrong.stderr
