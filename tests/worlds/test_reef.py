"""The ready-made reef."""

import os
import subprocess
import sys

import numpy as np
import pytest

import bioscope as bio


@pytest.fixture(scope="module")
def reef():
    world = bio.load("reef", seed=7)
    world.run(seconds=8)
    return world


def living(world, species):
    return [batch for batch in world.scene.batches if batch.species == species]


def test_it_holds_what_a_reef_holds(reef):
    counts = reef.populations
    assert counts["fusilier"] + counts["anthias"] >= 300
    assert counts["grey_reef_shark"] >= 1
    assert sum(counts[name] for name in ("seagrass", "kelp", "sea_fan", "staghorn")) >= 100
    assert counts["corals"] > 40
    assert counts["plankton"] >= 1800
    assert counts["bubbles"] > 0
    assert {event.kind for event in reef.events}


def test_fishes_school_above_the_ground_below_the_surface(reef):
    figures = reef.statistics()
    assert figures["fusilier.polarization"] > 0.6
    heights, origin, spacing = reef._engine.terrain
    for batch in living(reef, "fusilier") + living(reef, "anthias"):
        places = batch.positions
        assert (places[:, 1] < 0).all()
        columns = np.clip(
            ((places[:, 0] - origin[0]) / spacing).astype(int), 0, heights.shape[1] - 1
        )
        rows = np.clip(((places[:, 2] - origin[1]) / spacing).astype(int), 0, heights.shape[0] - 1)
        assert (places[:, 1] > heights[rows, columns] - 0.3).all()


def test_bodies_undulate_and_plants_sway(reef):
    poses = {
        batch.name: batch.poses.copy()
        for batch in reef.scene.batches
        if batch.species in ("fusilier", "kelp")
    }
    reef.run(seconds=0.4)
    for batch in reef.scene.batches:
        if batch.name in poses:
            assert np.abs(batch.poses - poses[batch.name]).max() > 1e-3


def test_ids_are_unique_and_seen_by_the_eye(reef):
    ids = np.concatenate([batch.ids for batch in reef.scene.batches])
    ids = np.concatenate([ids, *[points.ids for points in reef.scene.points]])
    assert len(np.unique(ids)) == len(ids)
    fish = living(reef, "fusilier")[0]
    eye = reef.inspect(int(fish.ids[0]))["eye"]
    assert eye.fisheye
    view = bio.look(reef.scene, eye, (96, 96))
    assert set(np.unique(view.identity)) <= {0, *ids.tolist()}
    assert len(set(np.unique(view.identity)) & set(fish.ids.tolist())) > 3


def test_the_shark_has_a_mind_and_percepts(reef):
    shark = living(reef, "grey_reef_shark")[0]
    found = reef.inspect(int(shark.ids[0]))
    assert found["behavior"] in {"cruise", "turn home", "avoid", "inspect", "dash"}
    assert found["percepts"]
    assert reef.scene.annotations


def test_something_is_heard(reef):
    kinds = set()
    for _ in range(300):
        reef.step()
        kinds |= {sound["kind"] for sound in reef.sounds}
    assert kinds & {"bubble", "crackle"}


SCRIPT = """
import bioscope as bio
world = bio.load("reef", seed=3)
world.step(120)
print(world.state_hash())
"""


@pytest.mark.capability("RE-32")
def test_one_and_two_threads_and_a_restore_give_the_same_reef(tmp_path):
    hashes = []
    for threads in ("1", "2"):
        environment = os.environ | {"RAYON_NUM_THREADS": threads}
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        hashes.append(done.stdout.strip())
    world = bio.load("reef", seed=3)
    world.step(53)
    world.save(tmp_path / "reef.world")
    restored = bio.World.restore(tmp_path / "reef.world")
    assert restored.state_hash() == world.state_hash()
    restored.step(67)
    assert {restored.state_hash(), *hashes} == {hashes[0]}


def test_changing_the_current_bends_the_plants():
    world = bio.load("reef", seed=5)
    world.run(seconds=2)
    kelp = next(batch for batch in world.scene.batches if batch.species == "kelp")
    calm = kelp.poses[:, :, 4:].copy()
    world.set("current", "speed", 0.8)
    world.run(seconds=4)
    kelp = next(batch for batch in world.scene.batches if batch.name == kelp.name)
    assert np.abs(kelp.poses[:, :, 4:] - calm).max() > 0.1
