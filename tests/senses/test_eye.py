"""The synthetic eye through its Python surface."""

import math

import numpy as np
import pytest

import bioscope as bio


class Balls(bio.Population):
    """Balls at given places."""

    transient = ("mesh", "material")

    def __init__(self, places, radius=0.5):
        self.places = np.asarray(places, np.float32)
        self.radius = radius
        self.mesh, self.material = ball(), bio.Material(color=(0.9, 0.1, 0.1))

    def settle(self):
        return len(self.places)

    def born(self, ids):
        self.ids = ids

    def publish(self, scene):
        scales = np.full(len(self.ids), self.radius, np.float32)
        scene.instances(
            "balls", self.mesh, self.material, ids=self.ids, positions=self.places, scales=scales
        )


def ball(rings=40):
    """Return a unit ball."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 2 * rings), np.linspace(0, np.pi, rings))
    points = np.stack([np.cos(u) * np.sin(v), np.cos(v), np.sin(u) * np.sin(v)], axis=-1)
    columns = 2 * rings
    triangles = []
    for row in range(rings - 1):
        for column in range(columns - 1):
            a = row * columns + column
            triangles += [[a, a + 1, a + columns], [a + 1, a + columns + 1, a + columns]]
    return bio.Mesh(points.reshape(-1, 3).astype(np.float32), np.array(triangles, np.uint32))


def world_of(places, radius=0.5):
    world = bio.World(seed=1)
    balls = world.add(Balls(places, radius))
    return world, balls


def test_depth_is_metres_and_identity_is_the_scenes():
    world, balls = world_of([(0, 0, -4), (2, 0, -8)])
    camera = bio.Camera.looking_at((0, 0, 0), (0, 0, -1), math.radians(60))
    view = bio.look(world.scene, camera, (101, 75))
    assert view.color.shape == (75, 101, 3)
    assert view.identity[37, 50] == balls.ids[0]
    assert view.depth[37, 50] == pytest.approx(3.5, abs=0.01)
    assert view.identity[0, 0] == 0
    assert np.isinf(view.depth[0, 0])
    assert set(np.unique(view.identity)) == {0, *balls.ids}
    red = view.color[37, 50]
    assert red[0] > 3 * red[1]


def test_depth_agrees_with_rays_all_over_the_picture():
    world, balls = world_of([(0.4, -0.3, -5)], radius=1.2)
    camera = bio.Camera.looking_at((0, 0, 0), (0, 0, -1), math.radians(50))
    view = bio.look(world.scene, camera, (80, 80))
    reach = math.tan(math.radians(25))
    rows, columns = np.mgrid[0:80, 0:80]
    rays = np.stack(
        [((columns + 0.5) / 40 - 1) * reach, (1 - (rows + 0.5) / 40) * reach, -np.ones((80, 80))],
        -1,
    )
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    along = rays @ balls.places[0]
    apart = np.sum(balls.places[0] ** 2) - along**2
    inside = apart < 1.2**2 * 0.7
    exact = along - np.sqrt(np.maximum(1.2**2 - apart, 0))
    assert inside.sum() > 500
    assert (view.identity[inside] == balls.ids[0]).all()
    wrong = np.abs(view.depth - exact)[inside]
    assert np.median(wrong) < 0.003
    assert wrong.max() < 0.02


@pytest.mark.parametrize("degrees", [0, 60, 120, 145])
def test_a_fisheye_sees_to_the_side_and_behind(degrees):
    angle = math.radians(degrees)
    place = (5 * math.sin(angle), 0.0, -5 * math.cos(angle))
    world, balls = world_of([place], radius=0.6)
    camera = bio.Camera((0, 0, 0), (0, 0, 0, 1), math.radians(300), fisheye=True)
    view = bio.look(world.scene, camera, (201, 201))
    rows, columns = np.nonzero(view.identity == balls.ids[0])
    assert len(rows) > 10
    assert rows.mean() == pytest.approx(100, abs=1.5)
    assert columns.mean() == pytest.approx(100.5 + degrees / 150 * 100.5, abs=2.5)
    assert view.depth[rows, columns].min() == pytest.approx(4.4, abs=0.05)


def test_many_eyes_see_what_one_sees():
    world, _ = world_of([(0, 0, -3), (1, 1, -5)])
    cameras = [
        bio.Camera.looking_at((x, 0.0, 0.0), (0, 0, -4), math.radians(70)) for x in (-1.0, 0.0, 2.0)
    ]
    together = bio.look_many(world.scene, cameras, (64, 64))
    for camera, view in zip(cameras, together, strict=True):
        alone = bio.look(world.scene, camera, (64, 64))
        assert (alone.identity == view.identity).all()
        assert (alone.color == view.color).all()


def test_water_takes_the_red_first():
    world = bio.World(seed=1)
    world.environment.water(surface=30.0)
    world.add(Balls([(0, 0, -2), (0, 0, -12)], radius=0.9))
    near = bio.look(world.scene, bio.Camera.looking_at((0, 0, 0), (0, 0, -1), 0.5), (33, 33))
    world = bio.World(seed=1)
    world.environment.water(surface=30.0)
    world.add(Balls([(0, 0, -12)], radius=0.9))
    far = bio.look(world.scene, bio.Camera.looking_at((0, 0, 0), (0, 0, -1), 0.5), (33, 33))
    assert far.identity[16, 16] > 0
    assert (
        far.color[16, 16, 0] / far.color[16, 16, 2] < near.color[16, 16, 0] / near.color[16, 16, 2]
    )


@pytest.mark.parametrize("size", [(0, 5), (100000, 100000)])
def test_impossible_sizes_are_refused(size):
    world, _ = world_of([(0, 0, -3)])
    with pytest.raises(ValueError, match="size"):
        bio.look(world.scene, bio.Camera.looking_at((0, 0, 0), (0, 0, -1), 1.0), size)
