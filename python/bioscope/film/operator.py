"""The camera operator: which camera at which moment of the film."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope import _engine
from bioscope.errors import UnknownNameError
from bioscope.film.steady import Steady

if TYPE_CHECKING:
    from bioscope._engine import Camera
    from bioscope.world import World

_SECONDS_PER_SHOT = 5.0


class Operator:
    """Gives the camera of each picture: one throughout, or the world's shot list over and over."""

    def __init__(self, world: World, camera: str | None) -> None:
        self._world = world
        names = list(world.cameras)
        if camera is not None:
            if camera not in names:
                known = ", ".join(names) or "none"
                raise UnknownNameError(f"unknown camera '{camera}'; this world has: {known}")
            self._shots = [(camera, math.inf)]
        else:
            self._shots = world.shots or [(name, _SECONDS_PER_SHOT) for name in names]
        self._previous: Camera | None = None
        self._steady: Steady | None = None
        self._shot = -1

    def camera(self, seconds: float, dt: float) -> tuple[Camera, bool]:
        """Return the camera at `seconds` of the film, `dt` after the last, and whether it cuts."""
        shot, name = self._at(seconds)
        cut = shot != self._shot
        if cut or self._steady is None:
            found = (
                self._world.cameras.now(name, None if cut else self._previous, dt) if name else None
            )
            self._steady = None if found is None else self._taken_in_hand(name, found)
        else:
            found = self._steady.camera(self._world.scene, dt)
        camera = found or self._previous or overview(self._world)
        self._shot, self._previous = shot, camera
        return camera, cut

    def _taken_in_hand(self, name: str, camera: Camera) -> Steady | None:
        """Return the hands that hold a camera which goes with an animal from here on."""
        rig = next(one for one in self._world.cameras.describe() if one["name"] == name)
        return Steady.begin(self._world.scene, rig, camera)

    def _at(self, seconds: float) -> tuple[int, str]:
        """Return the number of the shot and the name of its camera; empty without cameras."""
        if not self._shots:
            return 0, ""
        if len(self._shots) == 1:
            return 0, self._shots[0][0]
        whole = sum(length for _, length in self._shots)
        turn, left = divmod(seconds, whole)
        for number, (name, length) in enumerate(self._shots):
            if left < length:
                return int(turn) * len(self._shots) + number, name
            left -= length
        return int(turn) * len(self._shots) + len(self._shots) - 1, self._shots[-1][0]

    def state(self) -> dict[str, Any]:
        """Return what is needed to go on later."""
        camera = self._previous
        pose = None
        if camera is not None:
            pose = (camera.position, camera.rotation, camera.field_of_view)
        steady = None if self._steady is None else self._steady.state()
        return {"shot": self._shot, "pose": pose, "steady": steady}

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from where `state` was taken."""
        self._shot = state["shot"]
        pose = state["pose"]
        self._previous = None if pose is None else _engine.Camera(*pose)
        steady = state["steady"]
        self._steady = None if steady is None else Steady.restored(steady)


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
