"""The turtle: strings become segments, polygons, surfaces and meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bioscope import _engine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from bioscope._engine import Mesh
    from bioscope.lsystem.lsystem import ModuleString


@dataclass(frozen=True, slots=True)
class Segments:
    """All strokes of the turtle, in order."""

    start: NDArray[np.float32]
    """(n, 3), metres."""
    end: NDArray[np.float32]
    """(n, 3), metres."""
    radii: NDArray[np.float32]
    """At start and end (n, 2), metres."""
    color: NDArray[np.int32]
    """Colour numbers (n,)."""
    axis: NDArray[np.uint32]
    """Number of the axis that each belongs to (n,)."""


class Interpretation:
    """What the turtle drew."""

    def __init__(self, engine: _engine.Interpretation) -> None:
        self._engine = engine

    @property
    def segments(self) -> Segments:
        """The strokes."""
        return Segments(*self._engine.segments())

    @property
    def polygons(self) -> list[tuple[NDArray[np.float32], int]]:
        """Filled polygons as (corners (n, 3) in metres, colour number)."""
        return self._engine.polygons

    @property
    def surfaces(self) -> list[tuple[str, tuple[float, ...], tuple[float, ...], int]]:
        """Predefined surfaces as (name, position, scale, colour number)."""
        return [
            (name, tuple(at), tuple(scale), color)
            for name, at, scale, color in self._engine.surfaces
        ]

    def mesh(
        self, *, sides: int = 8, palette: list[tuple[float, float, float]] | None = None
    ) -> Mesh:
        """Return one mesh with vertex colours: smooth generalized cylinders, polygons, surfaces.

        Parameters
        ----------
        sides
            Sides of the thickest axis, 3 to 64.
        palette
            Linear colours by number.
        """
        return self._engine.mesh(sides, palette)


class Turtle:
    """Draws strings; starts at the origin, heading up (+Y).

    Parameters
    ----------
    **options
        `step` (m), `angle` (degrees; the file's if it says one), `width` (m), `width_step` (m),
        `color`, `slash_rolls_right`, `tropism` (direction), `susceptibility` (radians).
    """

    def __init__(self, **options: Any) -> None:
        self._options = options

    def interpret(self, string: ModuleString) -> Interpretation:
        """Return what the string draws.

        Raises
        ------
        UnknownNameError
            For an unknown option.
        LimitError
            If it draws more than fits.
        """
        return Interpretation(_engine.interpret(string._engine, self._options))
