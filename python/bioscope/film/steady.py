"""A camera in the hands of somebody who swims beside one animal or several, or behind one's eyes.

It goes with the animal and looks where it is going, late and loosely. It stays on the side on which
it is: while the animal turns it does not swing round with it, but comes about slowly. Several are
kept in the picture together: the nearer they come to each other, the nearer comes the camera.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from bioscope import _engine
from bioscope.film.direction import before_eyes, drift, frame, lens

if TYPE_CHECKING:
    from bioscope._engine import Camera, Scene
    from bioscope.film.direction import Shot

_PLACE_LAG, _AIM_LAG, _SIDE_LAG = 0.5, 0.35, 7.0
"""Time constants of going with the animal, of looking at it, of coming about, seconds."""
_LEAD = 0.1
"""How far ahead of the animal it looks, as a share of its distance."""
_BESIDE_LAG, _REACH_LAG = 0.3, 0.9
"""Time constants of going with several and of coming nearer to them, seconds."""
_OFF = 0.4
"""Farthest from the middle of the picture that the middle of several may be, in their reaches."""
_GAZE_LAG = 0.25
"""Time constant of looking where an animal heads, through its eyes, seconds."""

_Point = NDArray[np.float64]


class Steady:
    """The camera of one shot that goes with one animal.

    Parameters
    ----------
    animal
        Identity of the animal.
    place, yaw
        Where it is, metres, and where it heads, radians from +Z towards +X.
    camera
        Where the shot begins.
    """

    def __init__(self, animal: int, place: _Point, yaw: float, camera: Camera) -> None:
        self.animal = animal
        arm = np.array(camera.position, float) - place
        self.reach, self.height = math.hypot(arm[0], arm[2]), float(arm[1])
        self.bearing = math.atan2(arm[0], arm[2])
        self.side = self.bearing - yaw
        self.field_of_view = camera.field_of_view
        self.place, self.aim = place, self._ahead(place, yaw)

    @classmethod
    def begin(cls, scene: Scene, rig: dict[str, Any], camera: Camera) -> Steady | None:
        """Begin a shot of the animal of a following rig; none if it goes with nobody."""
        if rig["kind"] != "follow":
            return None
        left = rig["index"]
        for batch in scene.batches:
            if batch.species == rig["species"]:
                if left < len(batch.ids):
                    place, yaw = _pose(batch, left)
                    return cls(int(batch.ids[left]), place, yaw, camera)
                left -= len(batch.ids)
        return None

    def camera(self, scene: Scene, dt: float) -> Camera:
        """Return the camera `dt` seconds later; it stays where it is if the animal is gone."""
        found = _find(scene, self.animal)
        if found is not None:
            place, yaw = found
            self.place = self.place + (place - self.place) * _share(dt, _PLACE_LAG)
            self.aim = self.aim + (self._ahead(place, yaw) - self.aim) * _share(dt, _AIM_LAG)
            about = math.remainder(yaw + self.side - self.bearing, math.tau)
            self.bearing += about * _share(dt, _SIDE_LAG)
        arm = (
            math.sin(self.bearing) * self.reach,
            self.height,
            math.cos(self.bearing) * self.reach,
        )
        position = (self.place + arm).tolist()
        return _engine.Camera.looking_at(position, self.aim.tolist(), self.field_of_view)

    def _ahead(self, place: _Point, yaw: float) -> _Point:
        return place + np.array([math.sin(yaw), 0.0, math.cos(yaw)]) * (_LEAD * self.reach)

    def state(self) -> dict[str, Any]:
        """Return what is needed to go on later."""
        arrays = {"place": self.place.tolist(), "aim": self.aim.tolist()}
        return vars(self) | arrays

    @classmethod
    def restored(cls, state: dict[str, Any]) -> Steady:
        """Go on from where `state` was taken."""
        steady = cls.__new__(cls)
        vars(steady).update(state)
        steady.place, steady.aim = np.array(state["place"]), np.array(state["aim"])
        return steady


class Beside:
    """The camera of one shot that goes with several animals.

    It guesses their way, so that it is not behind those who swim straight on.
    """

    def __init__(self, shot: Shot) -> None:
        self._shot = shot
        self._middle: _Point | None = None
        self._velocity = np.zeros(3)
        self._reach = 0.0

    def camera(self, scene: Scene, dt: float) -> Camera | None:
        """Return the camera `dt` seconds later; none as long as nobody was there."""
        found = frame(scene, self._shot.subjects)
        if found is not None:
            self._go(*found, dt, scene)
        if self._middle is None:
            return None
        angle = self._shot.field_of_view
        position = lens(self._middle, self._reach, self._shot.arm, angle)
        return _engine.Camera.looking_at(position.tolist(), self._middle.tolist(), angle)

    def _go(self, middle: _Point, reach: float, dt: float, scene: Scene) -> None:
        if self._middle is None:
            self._middle, self._reach = middle, reach
            self._velocity = drift(scene, self._shot.subjects)
        elif dt > 0.0:
            # An alpha-beta filter: critically damped, and without a lag at constant velocity.
            share = _share(dt, _BESIDE_LAG)
            guess = self._middle + self._velocity * dt
            wrong = middle - guess
            self._middle = guess + wrong * share
            self._velocity = self._velocity + wrong * (share**2 / (2.0 - share) / dt)
            self._reach += (reach - self._reach) * _share(dt, _REACH_LAG)
            # Who stops short is not swum past.
            off = self._middle - middle
            far = float(np.linalg.norm(off)) / (_OFF * self._reach)
            self._middle = middle + off / max(far, 1.0)

    def state(self) -> dict[str, Any]:
        """Return what is needed to go on later."""
        middle = None if self._middle is None else self._middle.tolist()
        return {"middle": middle, "velocity": self._velocity.tolist(), "reach": self._reach}

    @classmethod
    def restored(cls, shot: Shot, state: dict[str, Any]) -> Beside:
        """Go on from where `state` was taken."""
        beside = cls(shot)
        if state["middle"] is not None:
            beside._middle = np.array(state["middle"])
        beside._velocity, beside._reach = np.array(state["velocity"]), state["reach"]
        return beside


class Through:
    """The camera of one shot through the eyes of an animal, which keeps its gaze while it beats."""

    def __init__(self, shot: Shot) -> None:
        self._shot = shot
        self._place = self._gaze = np.zeros(3)

    def camera(self, scene: Scene, dt: float) -> Camera | None:
        """Return the camera `dt` seconds later; none as long as it was not there."""
        found = before_eyes(scene, self._shot.subjects[0])
        if found is not None:
            self._place, ahead = found
            share = _share(dt, _GAZE_LAG) if self._gaze.any() else 1.0
            self._gaze = self._gaze + (ahead - self._gaze) * share
        if not self._gaze.any():
            return None
        aim = (self._place + self._gaze).tolist()
        return _engine.Camera.looking_at(self._place.tolist(), aim, self._shot.field_of_view)

    def state(self) -> dict[str, Any]:
        """Return what is needed to go on later."""
        return {"place": self._place.tolist(), "gaze": self._gaze.tolist()}

    @classmethod
    def restored(cls, shot: Shot, state: dict[str, Any]) -> Through:
        """Go on from where `state` was taken."""
        through = cls(shot)
        through._place, through._gaze = np.array(state["place"]), np.array(state["gaze"])
        return through


def _share(dt: float, lag: float) -> float:
    return 1.0 - math.exp(-dt / lag)


def _find(scene: Scene, animal: int) -> tuple[_Point, float] | None:
    for batch in scene.batches:
        if batch.alive and len(index := np.flatnonzero(batch.ids == animal)):
            return _pose(batch, int(index[0]))
    return None


def _pose(batch: Any, index: int) -> tuple[_Point, float]:
    """Return place and heading of one of a batch."""
    x, y, z, w = (float(one) for one in batch.rotations[index])
    ahead = (2 * (x * z + w * y), 1 - 2 * (x * x + y * y))
    return np.array(batch.positions[index], float), math.atan2(*ahead)
