"""The world `light_trees`: trees that compete for light on a meadow."""

import os
import subprocess
import sys

import numpy as np

import bioscope as bio


def test_trees_grow_and_the_crowded_middle_stays_behind():
    world = bio.load("light_trees", seed=3)
    trees = world.populations["tree"]
    before = world.statistics()
    world.run(seconds=4)
    after = world.statistics()
    assert after["tree.step"] - before["tree.step"] == 31, "a year lasts four seconds"
    assert after["tree.segments"] > 1.5 * before["tree.segments"]
    assert after["tree.tallest_m"] > before["tree.tallest_m"] + 0.3
    assert world.populations["tree"] >= trees - 1
    # All leaves move with the wind, a little.
    world.set("tree", "rate", 0.0)
    world.step()
    places = next(one for one in world.scene.batches if one.name.startswith("tree/l")).positions
    then = places.copy()
    world.step(5)
    now = next(one for one in world.scene.batches if one.name.startswith("tree/l")).positions
    moved = np.linalg.norm(now - then, axis=1)
    assert 0 < np.median(moved) < 0.3


def test_the_result_does_not_depend_on_the_number_of_threads():
    script = (
        "import bioscope as bio; world = bio.load('light_trees', seed=5); world.run(seconds=0.6); "
        "print(world.state_hash())"
    )
    hashes = set()
    for threads in ("1", "3"):
        done = subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, "RAYON_NUM_THREADS": threads},
            capture_output=True,
            text=True,
            check=True,
        )
        hashes.add(done.stdout.strip())
    assert len(hashes) == 1
