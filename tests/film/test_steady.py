"""Cameras that go with animals: beside them, and behind their eyes."""

import numpy as np
import pytest

import bioscope as bio
from bioscope.film.direction import Shot
from bioscope.film.operator import Operator


class Train(bio.Population):
    """One box that goes along x at 2 m/s until it stops dead at x = 4."""

    def settle(self):
        return 1

    def born(self, ids):
        self.ids, self.x = ids, 0.0

    def move(self, dt):
        self.x = min(4.0, self.x + 2.0 * dt)

    def publish(self, scene):
        corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-3, 3)], float)
        sides = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7]]
        mesh = bio.Mesh(
            positions=(corners * 0.05).astype(np.float32),
            triangles=np.array([*sides, [2, 7, 6], [1, 5, 7], [1, 7, 3]], np.uint32),
        )
        half = np.sqrt(0.5)
        scene.instances(
            "train",
            mesh,
            bio.Material(),
            ids=self.ids,
            positions=np.array([[self.x, 0.0, 0.0]], np.float32),
            rotations=np.array([[0.0, half, 0.0, half]], np.float32),
            velocities=np.array([[2.0 if self.x < 4.0 else 0.0, 0.0, 0.0]], np.float32),
        )


def film(shot, seconds=3.0):
    """Return the world, and the operator and camera at each tick."""
    world = bio.World(seed=1, dt=1 / 30)
    train = world.add(Train())
    world.step()
    operator = Operator(world, None, [shot(int(train.ids[0]))])
    while world.time < seconds:
        world.step()
        camera, _ = operator.camera(world.time, world.dt)
        yield world, operator, camera


def test_who_stops_dead_stays_in_the_picture():
    for world, _, camera in film(lambda one: Shot(9.0, "", (one,), (0.0, 0.2, 1.0))):
        seen = bio.look(world.scene, camera, (80, 45)).identity > 0
        assert seen.any()
        # Not at the edge.
        assert not seen[:, [0, -1]].any()


def test_through_its_eyes_one_sees_what_lies_ahead_and_not_oneself():
    for world, _, camera in film(lambda one: Shot(9.0, "", (one,), eyes=True), 2.0):
        x = min(4.0, 2.0 * world.time)
        assert camera.position == pytest.approx((x + 0.165, 0.0, 0.0), abs=1e-4)
        assert not (bio.look(world.scene, camera, (80, 45)).identity > 0).any()


def test_a_film_through_eyes_goes_on_where_it_was_left():
    shot = []

    def through(one):
        shot.append(Shot(9.0, "", (one,), eyes=True))
        return shot[0]

    *_, (world, operator, camera) = film(through, 1.0)
    again = Operator(world, None, shot)
    again.restore(operator.state())
    assert again.camera(world.time, 0.0)[0].rotation == pytest.approx(camera.rotation)
