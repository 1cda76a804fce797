"""Fishes of muscles keep their backs up, whatever their minds make them do."""

import numpy as np
import pytest

import bioscope as bio


class Wheeling(bio.Mind):
    """Turns and dives or climbs all the time."""

    kind = "wheeling"

    def __init__(self, turn=0.0, rise=0.0, speed=1.0):
        self.turn, self.rise, self.speed = turn, rise, speed

    def decide(self, percepts):
        level = np.cos(self.rise)
        way = (level * np.sin(self.turn), np.sin(self.rise), level * np.cos(self.turn))
        return {"behavior": "wheel", "heading": tuple(map(float, way)), "speed": self.speed}


def leans(batch):
    """Return by how much each of a batch leans over, radians."""
    x, y, z, w = np.array(batch.rotations).T
    up = 1 - 2 * (x * x + z * z)
    left = 2 * (x * y + w * z)
    return np.abs(np.arctan2(left, up))


@pytest.mark.capability("TF-041", "TF-044")
@pytest.mark.parametrize("turn", [0.3, 0.6, 1.2])
@pytest.mark.parametrize("rise", [-0.3, 0.0, 0.3])
@pytest.mark.parametrize("speed", [1.0, 2.5])
def test_a_fish_that_turns_and_dives_stays_upright(turn, rise, speed):
    world = bio.World(seed=1, dt=1 / 30)
    world.environment.water(surface=30.0)
    mind = Wheeling(turn, rise, speed)
    world.add(bio.RoamingFish("yellow_tang", 1, center=(0, 0, 0), mind=mind, body="muscle_swimmer"))
    turned, last = 0.0, 0.0
    for _ in range(90):
        world.step()
        batch = world.scene.batches[0]
        assert leans(batch).max() < np.radians(30)
        x, y, z, w = np.array(batch.rotations)[0]
        yaw = np.arctan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y))
        turned += (yaw - last + np.pi) % (2 * np.pi) - np.pi
        last = yaw
    assert turned > turn / 2, "it turns nevertheless"


@pytest.mark.capability("TF-041")
@pytest.mark.parametrize("film", ["go_fish", "preying"])
def test_nobody_lies_on_its_side_in_the_films(film):
    world = bio.load(film, seed=bio.worlds.films()[film])
    fishes = {"butterflyfish", "yellow_tang", "emperor_angelfish", "fusilier", "blacktip_shark"}
    seen, angles = set(), []
    while world.time < 15:
        world.step(6)
        for batch in world.scene.batches:
            if batch.species in fishes and len(batch.ids):
                seen.add(batch.species)
                angles += leans(batch).tolist()
    assert len(seen) >= 3
    assert np.mean(np.array(angles) > np.radians(30)) < 0.01
    assert max(angles) < np.radians(60), "not even who is sucked in"
