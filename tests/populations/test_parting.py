"""Plants give way to what swims past."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.populations.place import Habitat, Rectangle


class Passer(bio.Population):
    """A living ball that goes straight on along +Z."""

    transient = ("mesh", "material")

    def __init__(self, place, speed):
        self.place = np.array(place, np.float32)
        self.velocity = np.array((0, 0, speed), np.float32)
        x, y = np.array(((1, 0, 0), (0, 1, 0)), np.float32) * 0.25
        z = np.array((0, 0, 0.25), np.float32)
        points = np.stack([x, -x, y, -y, z, -z])
        faces = np.array([[a, b, c] for a in (0, 1) for b in (2, 3) for c in (4, 5)], np.uint32)
        self.mesh, self.material = bio.Mesh(points, faces), bio.Material(color=(1, 1, 1))
        self.ids = np.empty(0, np.uint32)

    def settle(self):
        return 1

    def born(self, ids):
        self.ids = ids

    def move(self, dt):
        self.place = self.place + self.velocity * np.float32(dt)

    def publish(self, scene):
        scene.instances(
            "passer",
            self.mesh,
            self.material,
            ids=self.ids,
            positions=self.place[None],
            rotations=np.array([[0, 0, 0, 1]], np.float32),
            scales=np.ones(1, np.float32),
            velocities=self.velocity[None],
        )


def leaves(side: float | None, **parameters: float) -> np.ndarray:
    """Places (ticks, joints, 3) of a kelp's joints while something passes at its side, if so."""
    world = bio.World(seed=5, dt=1 / 30)
    world.environment.water(surface=6.0)
    habitat = Habitat(area=Rectangle((-0.01, -0.01), (0.01, 0.01)))
    kelp = world.add(bio.Plants("kelp", 1, habitat=habitat, **parameters))
    height = world.inspect(int(batch(world).ids[0]))["values"]["height_m"]
    if side is not None:
        world.add(Passer((0.12 * side, 0.6 * height, -1.5), 0.5))
    places = []
    for _ in range(450):
        world.step()
        plant = batch(world)
        x, y, z, w = np.asarray(plant.rotations[0], float)
        axis = np.array((x, y, z))
        local = np.asarray(plant.poses, float).reshape(-1, np.shape(plant.poses)[-1])[:, :3]
        turned = local + 2 * np.cross(axis, np.cross(axis, local) + w * local)
        places.append(np.asarray(plant.positions[0], float) + plant.scales[0] * turned)
    assert kelp.statistics["count"] == 1
    return np.array(places)


def batch(world: bio.World):
    return next(one for one in world.scene.batches if one.species == "kelp" and len(one.ids))


@pytest.mark.capability("TF-164")
def test_leaves_deflect_away_from_a_fish_that_passes_and_come_back():
    still = leaves(None)
    moved = {side: leaves(side) - still for side in (1.0, -1.0)}
    for side, change in moved.items():
        passing = int(1.5 / 0.5 * 30)
        aside = change[: passing + 30, :, 0] * side
        assert aside.min() < -0.03, "the leaves beside it give way by centimetres"
        assert aside.max() < -0.2 * aside.min(), "and none comes to meet it"
        assert np.abs(change[-1]).max() < 0.02, "when it is gone they come back"
    assert np.abs(leaves(1.0, parting=0.0) - still).max() < 1e-6
