"""The world `jack_cousto`: courtship, school and stalker before one lens."""

import numpy as np
import pytest

import bioscope as bio


def batch(world, species):
    return next(one for one in world.scene.batches if one.species == species)


@pytest.mark.capability("TF-201")
def test_courtship_school_and_stalking_overlap_within_a_minute():
    world = bio.load("jack_cousto", seed=bio.worlds.films()["jack_cousto"])
    eye = np.array(world.cameras.now("bay").position)
    shark = int(batch(world, "blacktip_shark").ids[0])
    together, behind, fed = 0, [], 0
    while world.time < 40:
        world.run(0.5)
        fed += sum(event.kind == "eaten" for event in world.drain_events())
        pair = [world.inspect(int(one)) for one in batch(world, "clownfish").ids]
        courts = all(
            one["values"]["courtship"] in ("loop", "circle", "ascend", "nuzzle") for one in pair
        )
        school = batch(world, "fusilier")
        stalks = world.inspect(shark)
        hunts = stalks["behavior"] == "eat" and stalks["values"].get("target") in school.ids
        schools = np.mean([world.inspect(int(one))["behavior"] == "school" for one in school.ids])
        if courts and hunts and schools > 0.4:
            together += 1
            away = eye[2] - np.array(school.positions)[:, 2]
            pair_away = eye[2] - np.array(batch(world, "clownfish").positions)[:, 2]
            behind.append((away > pair_away.max()).mean())
    assert together >= 4, "half seconds in which all of it happens at once"
    assert np.mean(behind) > 0.9, "the school passes behind the pair"
    assert fed >= 5, "others feed"
