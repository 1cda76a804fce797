"""The world `preying`: what a hungry shark, its prey and those it spares do."""

import numpy as np
import pytest

import bioscope as bio

SECONDS = 24


def places(world, species):
    found = [np.array(one.positions) for one in world.scene.batches if one.species == species]
    return np.concatenate(found) if found else np.zeros((0, 3))


def nearest(points):
    gaps = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    return gaps.min(axis=1)


@pytest.fixture(scope="module")
def story():
    """Run the film's length; returns the world at its end and what happened on the way."""
    world = bio.load("preying", seed=bio.worlds.films()["preying"])
    shark = next(int(b.ids[0]) for b in world.scene.batches if b.species == "blacktip_shark")
    prey = {int(i) for b in world.scene.batches if b.species == "fusilier" for i in b.ids}
    events, hunger, spread, near, schooling = [], [], [], [], []
    while world.time < SECONDS:
        world.run(0.25)
        events += world.drain_events()
        hunger.append(world.inspect(shark)["values"]["hunger"])
        points = places(world, "fusilier")
        spread.append(nearest(points).mean())
        near.append(np.linalg.norm(points - places(world, "blacktip_shark")[0], axis=1).min())
        schooling.append(
            sum(
                world.inspect(int(one))["behavior"] == "school"
                for batch in world.scene.batches
                if batch.species == "fusilier"
                for one in batch.ids
            )
        )
    return world, prey, events, np.array(hunger), np.array(spread), np.array(near), schooling


@pytest.mark.capability("TF-202", "TF-130")
def test_the_shark_eats_its_fill_of_fusiliers_and_spares_the_angelfishes(story):
    world, prey, events, hunger, *_ = story
    caught = [event for event in events if event.kind == "caught"]
    assert caught
    assert {event.subject for event in caught} <= prey
    assert hunger[0] > 0.9
    assert hunger[-1] < 0.3, "who has eaten its fill does not care for food"
    populations = world.populations
    assert populations["fusilier"] + populations["fusilier-2"] == len(prey) - len(caught)
    assert len(caught) < len(prey), "some get away"
    assert populations["emperor_angelfish"] == 3


@pytest.mark.capability("TF-133", "TF-202")
def test_the_prey_schools_and_scatters(story):
    *_, events, _, spread, near, schooling = story
    kinds = {event.kind for event in events}
    assert {"schooled", "escaped"} <= kinds
    assert max(np.convolve(np.array(schooling) >= 4, np.ones(20), "valid")) >= 16, "for 5 s"
    # Within 2 s of the shark at their backs they are twice as far apart.
    bursts = [
        spread[index : index + 8].max() / spread[max(index - 4, 0) : index + 1].min()
        for index in np.flatnonzero(near < 1.5)
    ]
    assert max(bursts) > 2
