"""Points of view that a world offers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from bioscope._engine import Camera

if TYPE_CHECKING:
    from collections.abc import Iterator

    from bioscope.world.world import World

Vector = tuple[float, float, float]


class Cameras:
    """The named cameras of one world, `world.cameras`. Angles of view are vertical, degrees."""

    def __init__(self, world: World) -> None:
        self._world = world

    def fixed(
        self, name: str, *, position: Vector, target: Vector, field_of_view: float = 45.0
    ) -> None:
        """Add a camera that stands at `position` (metres) and looks at `target`."""
        self._world._engine.add_fixed_rig(name, math.radians(field_of_view), position, target)

    def orbit(
        self,
        name: str,
        *,
        target: Vector,
        radius: float,
        height: float = 1.0,
        period: float = 60.0,
        field_of_view: float = 45.0,
    ) -> None:
        """Add a camera that circles `target` once in `period` seconds."""
        angle = math.radians(field_of_view)
        self._world._engine.add_orbit_rig(name, angle, target, radius, height, period)

    def follow(
        self,
        name: str,
        *,
        species: str,
        index: int = 0,
        offset: Vector = (1.2, 0.4, 0.6),
        field_of_view: float = 45.0,
    ) -> None:
        """Add a camera that goes with the `index`-th animal of a species, late and loosely.

        `offset` is where it wants to be, in the animal's frame (left, up, ahead) and in its body
        lengths.
        """
        angle = math.radians(field_of_view)
        self._world._engine.add_follow_rig(name, angle, species, index, offset)

    def now(self, name: str, previous: Camera | None = None, dt: float = 0.0) -> Camera | None:
        """Return the camera at this moment; none if there is nothing to follow.

        `previous` is its camera `dt` seconds ago; without it the camera is where it wants to be.
        """
        return self._world._engine.camera(name, previous, dt)

    def describe(self) -> list[dict[str, Any]]:
        """Return all rigs as dicts, the main one first."""
        return self._world._engine.rigs

    def __iter__(self) -> Iterator[str]:
        return iter([rig["name"] for rig in self.describe()])
