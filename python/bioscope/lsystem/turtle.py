"""The turtle: strings become segments, polygons, surfaces and meshes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bioscope import _engine

if TYPE_CHECKING:
    from os import PathLike

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


@dataclass(frozen=True, slots=True)
class Balls:
    """All balls of the turtle."""

    center: NDArray[np.float32]
    """(n, 3), metres."""
    radius: NDArray[np.float32]
    """(n,), metres."""
    color: NDArray[np.int32]
    """Colour numbers (n,)."""


@dataclass(frozen=True, slots=True)
class Discs:
    """All discs of the turtle."""

    center: NDArray[np.float32]
    """(n, 3), metres."""
    normal: NDArray[np.float32]
    """(n, 3), unit vectors."""
    radius: NDArray[np.float32]
    """(n,), metres."""
    rim: NDArray[np.float32]
    """Width of the rim (n,), metres; 0 is a filled disc."""
    color: NDArray[np.int32]
    """Colour numbers (n,)."""


@dataclass(frozen=True, slots=True)
class Patches:
    """All bicubic patches whose points the turtle set."""

    points: NDArray[np.float32]
    """Control points (n, 16, 3), row by row, metres."""
    color: NDArray[np.int32]
    """Colour numbers (n,)."""


class ViewFile:
    """A view file of cpfg (.v) with the surfaces, contours and functions beside it.

    Raises
    ------
    FormatError
        If the file cannot be read. What is not understood in it is in `warnings`.
    """

    def __init__(self, path: str | PathLike[str]) -> None:
        self._engine = _engine.ViewFile(path)

    @property
    def warnings(self) -> list[str]:
        """What was not understood, or is missing, with file and line."""
        return self._engine.warnings

    @property
    def sides(self) -> int:
        """Sides of cylinders."""
        return self._engine.sides

    @property
    def textures(self) -> list[str]:
        """Names of the textures, number 1 first."""
        return self._engine.textures

    @property
    def surfaces(self) -> list[str]:
        """Letters of the surfaces."""
        return self._engine.shapes[0]

    @property
    def contours(self) -> list[int]:
        """Numbers of the contours."""
        return self._engine.shapes[1]

    def function(self, number: int, x: float) -> float | None:
        """Return the value of a function (1 is the first) at `x`; None if there is none."""
        return self._engine.function(number, x)


class AnimateFile:
    """An animate file of cpfg (.a): which steps of a model are shown.

    Raises
    ------
    FormatError
        If the file cannot be read. What is not understood in it is in `warnings`.
    """

    def __init__(self, path: str | PathLike[str]) -> None:
        self._engine = _engine.AnimateFile(path)

    @property
    def warnings(self) -> list[str]:
        """What was not understood, with file and line."""
        return self._engine.warnings

    @property
    def switches(self) -> list[str]:
        """Names of what is switched on, such as `clear between frames`."""
        return self._engine.switches

    @property
    def swap_interval(self) -> int:
        """How long each frame stays, in refreshes of a screen."""
        return self._engine.swap_interval

    def frames(self, length: int) -> list[int]:
        """Return the steps that are shown; `length` is the last if the file does not say."""
        return self._engine.frames(length)


def read_colors(path: str | PathLike[str]) -> list[tuple[float, float, float]]:
    """Return the linear colours of a color map (.map) or material file (.mat).

    Raises
    ------
    FormatError
        If it is none.
    """
    return [(red, green, blue) for red, green, blue in _engine.read_colors(path)]


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

    @property
    def balls(self) -> Balls:
        """The balls."""
        return Balls(*self._engine.balls())

    @property
    def discs(self) -> Discs:
        """The discs."""
        return Discs(*self._engine.discs())

    @property
    def patches(self) -> Patches:
        """The bicubic patches."""
        return Patches(*self._engine.patches())

    @property
    def labels(self) -> list[tuple[tuple[float, ...], list[float]]]:
        """Labels as (position, the numbers of `@L`)."""
        return [(tuple(place), numbers) for place, numbers in self._engine.labels]

    def mesh(
        self,
        *,
        sides: int = 8,
        palette: list[tuple[float, float, float]] | None = None,
        texture: int | None = None,
    ) -> Mesh:
        """Return one mesh with vertex colours: smooth generalized cylinders, polygons, surfaces.

        Parameters
        ----------
        sides
            Sides of the thickest axis, 3 to 64; thinner ones have fewer, and so have all in plants
            of more than 200,000 strokes.
        palette
            Linear colours by number.
        texture
            Only the parts with this texture number (0 is none).
        """
        return self._engine.mesh(sides, palette, texture)


@dataclass(frozen=True, slots=True)
class SharedPart:
    """A branch that occurs more than once, and all its places."""

    drawn: Interpretation
    """What it looks like, its base at the origin, heading +Y."""
    positions: NDArray[np.float32]
    """Where it stands (n, 3), metres."""
    rotations: NDArray[np.float32]
    """How it is turned there: unit quaternions x, y, z, w (n, 4)."""


@dataclass(frozen=True, slots=True)
class SharedPlant:
    """A plant whose equal branches are drawn once."""

    rest: Interpretation
    """What occurs once."""
    parts: list[SharedPart]
    """The branches that occur more often."""


class Turtle:
    """Draws strings; starts at the origin, heading up (+Y).

    Parameters
    ----------
    view
        A view file, or its path: how cpfg would draw.
    **options
        `position`, `heading`, `up` (where it starts), `step` (m), `angle` (degrees; the file's if
        it says one), `width` (m), `width_step` (m), `color`, `color_step`, `scale`, `scale_step`,
        `slash_rolls_right`, `tropism` (direction), `susceptibility` (radians), `tapered`, `cpfg`
        (whether symbols mean what they mean to cpfg).
    """

    def __init__(self, view: ViewFile | str | PathLike[str] | None = None, **options: Any) -> None:
        self._view = view if isinstance(view, ViewFile) or view is None else ViewFile(view)
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
        view = self._view._engine if self._view is not None else None
        return Interpretation(_engine.interpret(string._engine, self._options, view))

    def share(self, string: ModuleString) -> SharedPlant:
        """Return what the string draws, equal branches drawn once and placed many times.

        Raises
        ------
        UnknownNameError
            For an unknown option.
        LimitError
            If it draws more than fits.
        """
        view = self._view._engine if self._view is not None else None
        rest, parts = _engine.share(string._engine, self._options, view)
        shared = [SharedPart(Interpretation(drawn), at, turned) for drawn, at, turned in parts]
        return SharedPlant(Interpretation(rest), shared)
