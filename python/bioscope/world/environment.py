"""What is not alive: terrain, water, light and fields."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np

from bioscope.world.field import Current, Field

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from bioscope.world.world import World

AnyField = TypeVar("AnyField", bound=Field | Current)


Vector = tuple[float, float, float]


class Environment:
    """The environment of one world; reached as `world.environment`."""

    def __init__(self, world: World) -> None:
        self._world = world

    def water(self, surface: float = 0.0, current: Current | None = None) -> None:
        """Fill everything below `surface` (metres) with sea water, with a current if given."""
        self._world._engine.fill_with_water(surface)
        if current is not None:
            self.add(current)

    def terrain(
        self,
        heights: ArrayLike,
        *,
        spacing: float = 1.0,
        origin: tuple[float, float] | None = None,
    ) -> None:
        """Lay a heightfield.

        Parameters
        ----------
        heights
            Metres, shape (rows along z, columns along x), at least 2 × 2, finite.
        spacing
            Distance of neighboring samples in metres.
        origin
            x and z of the first sample; centred about (0, 0) if not given.

        Raises
        ------
        InvalidValueError
            For anything else.
        """
        array = np.ascontiguousarray(heights, dtype=np.float32)
        if array.ndim != 2:
            array = array.reshape(1, -1)
        rows, columns = array.shape
        if origin is None:
            origin = (-spacing * (columns - 1) / 2, -spacing * (rows - 1) / 2)
        self._world._engine.lay_terrain(array, origin, spacing)

    def cylinder(self, base: Vector, top: Vector, radius: float) -> None:
        """Put up a solid cylinder: animals steer round it and see nothing behind it.

        It stands for the shape of something that a population shows; it is not drawn by itself.

        Parameters
        ----------
        base, top
            Middles of its ends, metres.
        radius
            Metres.

        Raises
        ------
        InvalidValueError
            For points that are not finite or the same, and radii of zero or less.
        """
        self._world._engine.add_cylinder(base, top, radius)

    def add(self, field: AnyField, name: str | None = None) -> AnyField:
        """Add something that acts at a distance; return it."""
        if isinstance(field, Current):
            self._world._engine.add_field(field._field, name)
        else:
            self._world._engine.add_python_field(field, type(field).kind, name)
        return field

    def set(self, **values: float) -> None:
        """Set light and water by name: `sun_elevation`, `turbidity`, `caustics` and more."""
        for name, value in values.items():
            self._world.set("environment", name, value)
