"""Cameras stay out of the ground and of what is in the way."""

import numpy as np
import pytest

import bioscope as bio
from bioscope import _engine
from bioscope.film.ground import Ground


class Hill(bio.Population):
    """A slope from 0 m at x = -4 to 4 m at x = 4, built where it is."""

    def __init__(self, size=4.0, faces=1, rise=0.5):
        self.size, self.faces, self.rise = size, faces, rise

    def settle(self):
        return 1

    def born(self, ids):
        self.ids = ids

    def publish(self, scene):
        x, z = np.meshgrid(*2 * [np.linspace(-1, 1, 33) * self.size], indexing="ij")
        corners = np.stack([x, self.rise * x + 2.0, z], axis=-1).reshape(-1, 3)
        first = np.arange(32 * 33).reshape(32, 33)[:, :-1].ravel()
        pairs = np.stack([first, first + 1, first + 33, first + 33, first + 1, first + 34], axis=-1)
        mesh = bio.Mesh(
            positions=corners.astype(np.float32),
            triangles=pairs.reshape(-1, 3)[:, :: self.faces].astype(np.uint32),
        )
        here = np.zeros((1, 3), np.float32)
        scene.instances("hill", mesh, bio.Material(), ids=self.ids, positions=here, alive=False)


@pytest.fixture
def hill():
    world = bio.World(seed=1)
    world.add(Hill())
    world.step()
    return world


def test_the_ground_is_as_high_as_what_is_near_and_nowhere_beyond(hill):
    ground = Ground(hill.scene)
    x = np.linspace(-3.5, 3.5, 40)
    heights = ground.height(np.stack([x, 0 * x, np.sin(x)], axis=-1))
    assert (heights >= 0.5 * x + 2.0 - 1e-4).all()
    assert (heights < 0.5 * x + 2.0 + 0.45).all()
    assert ground.height(np.array([[9.0, 0.0, 0.0], [0.0, 0.0, -9.0]])).tolist() == [-np.inf] * 2


@pytest.mark.parametrize("build", [{"size": 4e4}, {"faces": -1}, {"rise": 40.0}])
def test_what_is_endless_or_faces_down_or_is_a_wall_is_no_ground(build):
    world = bio.World(seed=1)
    world.add(Hill(**build))
    world.step()
    assert Ground(world.scene).height(np.zeros((1, 3))).tolist() == [-np.inf]


def test_a_world_without_ground_has_none():
    ground = Ground(bio.World(seed=1).scene)
    assert ground.height(np.zeros((1, 3))).tolist() == [-np.inf]


def test_a_camera_in_the_ground_is_lifted_and_looks_the_same_way(hill):
    ground = Ground(hill.scene)
    inside = _engine.Camera.looking_at((1.0, 1.0, 0.0), (1.0, 4.0, 3.0), 0.8)
    lifted = ground.above(inside)
    assert 2.6 < lifted.position[1] < 3.2
    assert lifted.position[::2] == inside.position[::2]
    assert (lifted.rotation, lifted.field_of_view) == (inside.rotation, inside.field_of_view)
    free = _engine.Camera.looking_at((1.0, 5.0, 0.0), (1.0, 4.0, 3.0), 0.8)
    assert ground.above(free) is free
