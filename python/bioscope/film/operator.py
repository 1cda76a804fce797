"""The camera operator: which camera at which moment of the film."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope import _engine
from bioscope.errors import UnknownNameError
from bioscope.film.direction import Shot
from bioscope.film.ground import Ground
from bioscope.film.steady import Beside, Steady, Through

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bioscope._engine import Camera
    from bioscope.world import World

_SECONDS_PER_SHOT = 5.0


class Operator:
    """Gives the camera of each picture: one throughout, or a shot list over and over.

    Parameters
    ----------
    world
        The world that is filmed.
    camera
        The one camera; none for the shot list.
    shots
        The shot list; the world's own if none.
    """

    def __init__(
        self, world: World, camera: str | None, shots: Sequence[Shot] | None = None
    ) -> None:
        self._world = world
        names = list(world.cameras)
        if camera is not None:
            if camera not in names:
                known = ", ".join(names) or "none"
                raise UnknownNameError(f"unknown camera '{camera}'; this world has: {known}")
            self._shots = [Shot(math.inf, camera)]
        elif shots:
            self._shots = list(shots)
        else:
            listed = world.shots or [(name, _SECONDS_PER_SHOT) for name in names]
            self._shots = [Shot(seconds, name) for name, seconds in listed]
        self._ground = Ground(world.scene)
        self._previous: Camera | None = None
        self._hands: Beside | Steady | Through | None = None
        self._shot = -1

    def camera(self, seconds: float, dt: float) -> tuple[Camera, bool]:
        """Return the camera at `seconds` of the film, `dt` after the last, and whether it cuts."""
        number, shot = self._at(seconds)
        cut = number != self._shot
        found = None
        if cut and shot is not None and not shot.camera:
            self._hands = Through(shot) if shot.eyes else Beside(shot)
        elif cut or self._hands is None:
            found = self._rig(shot, cut, dt)
        if found is None and self._hands is not None:
            found = self._hands.camera(self._world.scene, dt)
        camera = found or self._previous or overview(self._world)
        if self._hands is not None:
            camera = self._ground.above(camera)
        self._shot, self._previous = number, camera
        return camera, cut

    def _rig(self, shot: Shot | None, cut: bool, dt: float) -> Camera | None:
        """Return the world's camera of a shot; those that go with an animal are taken in hand."""
        if shot is None:
            return None
        name = shot.camera
        found = self._world.cameras.now(name, None if cut else self._previous, dt)
        self._hands = None if found is None else self._taken_in_hand(name, found)
        return found

    def _taken_in_hand(self, name: str, camera: Camera) -> Steady | None:
        """Return the hands that hold a camera which goes with an animal from here on."""
        rig = next(one for one in self._world.cameras.describe() if one["name"] == name)
        return Steady.begin(self._world.scene, rig, camera)

    def _at(self, seconds: float) -> tuple[int, Shot | None]:
        """Return the number of the shot and the shot; none without cameras."""
        if not self._shots:
            return 0, None
        if len(self._shots) == 1:
            return 0, self._shots[0]
        whole = sum(shot.seconds for shot in self._shots)
        turn, left = divmod(seconds, whole)
        for number, shot in enumerate(self._shots):
            if left < shot.seconds:
                return int(turn) * len(self._shots) + number, shot
            left -= shot.seconds
        return int(turn) * len(self._shots) + len(self._shots) - 1, self._shots[-1]

    def state(self) -> dict[str, Any]:
        """Return what is needed to go on later."""
        camera = self._previous
        pose = None
        if camera is not None:
            pose = (camera.position, camera.rotation, camera.field_of_view)
        hands = None if self._hands is None else self._hands.state()
        return {"shot": self._shot, "pose": pose, "hands": hands}

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from where `state` was taken."""
        self._shot = state["shot"]
        pose, hands = state["pose"], state["hands"]
        self._previous = None if pose is None else _engine.Camera(*pose)
        self._hands = None
        if hands is not None:
            shot = self._shots[self._shot % len(self._shots)]
            if shot.camera:
                self._hands = Steady.restored(hands)
            else:
                self._hands = (Through if shot.eyes else Beside).restored(shot, hands)


def overview(world: World) -> Camera:
    """Return a camera that sees all that is alive, for worlds without cameras."""
    scene = world.scene
    places = [batch.positions for batch in scene.batches if len(batch.ids)]
    places += [points.positions for points in scene.points if len(points.ids)]
    if not places:
        return _engine.Camera.looking_at((0.0, 1.5, 6.0), (0.0, 0.5, 0.0), math.radians(45))
    every = np.concatenate(places)
    low, high = every.min(axis=0), every.max(axis=0)
    middle = (low + high) / 2
    reach = max(1.0, float(np.linalg.norm(high - low)) * 0.8)
    place = middle + np.array([0.5, 0.35, 0.8]) * reach
    x, y, z = (float(one) for one in place)
    tx, ty, tz = (float(one) for one in middle)
    return _engine.Camera.looking_at((x, y, z), (tx, ty, tz), math.radians(45))
