"""Reynolds' flocks through the Python surface, by the criteria of the 1987 paper."""

import subprocess
import sys

import numpy as np
import pytest

from bioscope.crowds import Flock

DT = 1 / 30


def flock(seed=1, half=8.0, **parameters):
    return Flock(80, half=(half,) * 3, seed=seed, boxed=True, **parameters)


@pytest.mark.capability("RE-12")
@pytest.mark.parametrize("seed", range(4))
def test_a_scattered_flock_polarizes_and_keeps_its_distance(seed):
    birds = flock(seed)
    birds.step(DT, 150)
    assert birds.polarization() > 0.93
    birds.step(DT, 150)
    assert birds.polarization() > 0.995
    assert birds.flockettes(link=10.0) == 1
    near = birds.nearest(reach=20.0)
    assert 1.8 < near.mean() < 3.2
    assert near.min() > 1.0


@pytest.mark.capability("RE-13")
def test_a_flock_migrates_round_obstacles_and_arrives():
    birds = flock(2)
    birds.step(DT, 150)
    birds.add_sphere((0.0, 0.0, 60.0), 6.0)
    birds.migrate_to((0.0, 0.0, 150.0))
    before = np.linalg.norm(birds.positions.mean(axis=0) - [0, 0, 150])
    closest = np.inf
    for _ in range(60):
        birds.step(DT, 10)
        closest = min(closest, np.linalg.norm(birds.positions - [0, 0, 60], axis=1).min())
    after = np.linalg.norm(birds.positions.mean(axis=0) - [0, 0, 150])
    assert closest > 6.0
    assert after < before - 30


@pytest.mark.capability("RE-21")
def test_flight_is_along_the_heading_and_within_the_speed_limit():
    birds = flock(3, maximum_speed=8.0)
    for _ in range(40):
        birds.step(DT, 5)
        speed = np.linalg.norm(birds.velocities, axis=1)
        assert speed.max() <= 8.0 * 1.0001
        along = np.sum(birds.velocities * birds.headings, axis=1) / speed
        assert along.min() > 0.9999
    before = birds.positions
    birds.step(DT, 1)
    moved = (birds.positions - before) / DT
    assert np.abs(moved - birds.velocities).max() < 1e-2


@pytest.mark.capability("RE-22")
def test_level_flight_is_level_and_a_turn_is_banked_inward():
    lone = Flock(1, half=(0.1, 0.1, 0.1), seed=3, body_length=1.0)
    far = 4000.0
    heading = lone.headings[0]
    level = np.array([heading[0], 0, heading[2]]) / np.hypot(heading[0], heading[2])
    lone.migrate_to(tuple(float(one) for one in level * far))
    lone.step(DT, 600)
    assert lone.ups[0, 1] > 0.99
    side = np.cross([0, 1, 0], lone.headings[0])
    lone.migrate_to(tuple(float(one) for one in lone.positions[0] + side * 30))
    lone.step(DT, 20)
    assert np.dot(lone.ups[0], side) > 0.02


@pytest.mark.capability("RE-27")
def test_nobody_beyond_the_radius_counts():
    near = Flock(2, half=(1.0, 1.0, 1.0), seed=4, radius=10.0)
    far = Flock(2, half=(400.0, 400.0, 400.0), seed=4, radius=10.0)
    assert np.linalg.norm(np.diff(far.positions, axis=0)) > 10
    for pair in (near, far):
        pair.step(DT, 60)
    turned = [np.dot(*pair.headings) for pair in (near, far)]
    start = [np.dot(*Flock(2, half=(h,) * 3, seed=4).headings) for h in (1.0, 400.0)]
    assert turned[0] > start[0] + 0.3
    assert abs(turned[1] - start[1]) < 0.1


@pytest.mark.capability("RE-29")
def test_avoiding_comes_before_everything_else():
    birds = flock(5, matching=8.0, centering=8.0)
    birds.step(DT, 150)
    ahead = birds.headings.mean(axis=0)
    ahead /= np.linalg.norm(ahead)
    wall = birds.positions.mean(axis=0) + ahead * 40
    birds.add_plane(tuple(map(float, wall)), tuple(map(float, -ahead)))
    birds.migrate_to(tuple(map(float, wall + ahead * 500)))
    deepest = -np.inf
    for _ in range(120):
        birds.step(DT, 5)
        deepest = max(deepest, float(((birds.positions - wall) @ ahead).max()))
    assert deepest < 0.0


HASH = """
import hashlib
from bioscope.crowds import Flock
f = Flock(3000, half=(30, 30, 30), seed=9)
f.step(1 / 60, 40)
print(hashlib.sha256(f.positions.tobytes() + f.velocities.tobytes()).hexdigest())
"""


@pytest.mark.capability("RE-32")
def test_the_same_seed_gives_the_same_bits_on_one_and_two_threads():
    import os

    found = {
        subprocess.run(
            [sys.executable, "-c", HASH],
            env=os.environ | {"RAYON_NUM_THREADS": str(threads)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for threads in (1, 1, 2)
    }
    assert len(found) == 1


SHAPES = {
    "sphere": (
        lambda f: f.add_sphere((0, 0, 40), 5),
        lambda p: np.linalg.norm(p - [0, 0, 40], axis=1) - 5,
    ),
    "cylinder": (
        lambda f: f.add_cylinder((0, -90, 40), (0, 90, 40), 5),
        lambda p: np.linalg.norm((p - [0, 0, 40])[:, [0, 2]], axis=1) - 5,
    ),
    "box": (
        lambda f: f.add_box((-5, -5, 35), (5, 5, 45)),
        lambda p: np.linalg.norm(np.maximum(np.abs(p - [0, 0, 40]) - 5, 0), axis=1),
    ),
    "plane": (lambda f: f.add_plane((0, 0, 60), (0, 0, -1)), lambda p: 60 - p[:, 2]),
}


@pytest.mark.capability("RE-37")
@pytest.mark.parametrize("shape", SHAPES)
def test_nobody_runs_into_anything(shape):
    birds = flock(6, half=6.0)
    birds.step(DT, 100)
    add, clearance = SHAPES[shape]
    add(birds)
    birds.migrate_to((0.0, 0.0, 200.0))
    least = np.inf
    for _ in range(100):
        birds.step(DT, 4)
        least = min(least, clearance(birds.positions).min())
    assert least > 0.0


@pytest.mark.capability("RE-41")
def test_neighbors_are_those_of_brute_force():
    birds = Flock(4000, half=(60, 60, 60), seed=8, boxed=True)
    near = birds.nearest(reach=200.0)
    points = birds.positions
    sample = np.arange(0, 4000, 131)
    apart = np.linalg.norm(points[sample, None] - points[None], axis=2)
    apart[np.arange(len(sample)), sample] = np.inf
    assert near[sample] == pytest.approx(apart.min(axis=1), rel=1e-4)


def test_unknown_and_impossible_parameters_are_refused():
    with pytest.raises(LookupError, match=r"unknown parameter 'cohesion'.*centering"):
        flock(1, cohesion=1.0)
    with pytest.raises(ValueError, match="body_length"):
        flock(1, body_length=-1.0)
