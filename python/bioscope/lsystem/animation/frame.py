"""What was drawn in one frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from bioscope.lsystem.animation.materials import Material, stroke_material
from bioscope.lsystem.animation.meshes import Meshes
from bioscope.lsystem.animation.shapes import LEAST_SIDES, fan, triangles, tube
from bioscope.lsystem.animation.vectors import Pose, Vector, length, subtract

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from bioscope.lsystem.animation.meshes import Part
    from bioscope.lsystem.animation.shapes import Face


@dataclass(frozen=True, slots=True)
class Piece:
    """A shape."""

    symbol: str
    corners: list[Vector]
    """Metres."""
    faces: list[Face]
    """Numbers of corners, counterclockwise seen from outside."""
    material: Material
    smooth: bool = False
    body: int | None = None
    """The actor whose body it is of."""
    convex: bool = False
    """Whether all its faces are known to be convex."""

    def triangles(self) -> list[tuple[int, int, int]]:
        """Return its faces as triangles."""
        if self.convex:
            return [one for face in self.faces for one in fan(face)]
        return [one for face in self.faces for one in triangles(self.corners, face)]


@dataclass(frozen=True, slots=True)
class Line:
    """A stroke without thickness."""

    start: Vector
    end: Vector
    color: tuple[float, float, float]
    """Red, green and blue, 0 to 255."""
    body: int | None = None

    def piece(self, thickness: float) -> Piece:
        """Return it as a thin tube."""
        pose = Pose(self.start).toward(subtract(self.end, self.start))
        ahead = length(subtract(self.end, self.start))
        corners, faces = tube(pose, ahead, (thickness, thickness), LEAST_SIDES)
        red, green, blue = (one / 255 for one in self.color)
        material = stroke_material((red, green, blue))
        return Piece("R", corners, faces, material, body=self.body, convex=True)


@dataclass(frozen=True, slots=True)
class Directive:
    """Words for the offline renderer, at this place of its scene."""

    text: str


@dataclass(slots=True)
class Frame:
    """All that one frame shows, in the order in which it was drawn."""

    number: int
    time: float
    """Seconds."""
    items: list[Piece | Line | Directive] = field(default_factory=list)
    printed: list[Vector] = field(default_factory=list)
    """Positions of the turtle where a symbol asked to print them."""
    proxies: list[str] = field(default_factory=list)
    """Definition files of one cube each, around what was drawn between two marks."""

    @property
    def pieces(self) -> list[Piece]:
        """The shapes."""
        return [one for one in self.items if isinstance(one, Piece)]

    @property
    def lines(self) -> list[Line]:
        """The strokes."""
        return [one for one in self.items if isinstance(one, Line)]

    def points(self, begin: int = 0) -> Iterator[Vector]:
        """Return all corners, of what was drawn from the item `begin` on."""
        for one in self.items[begin:]:
            if isinstance(one, Piece):
                yield from one.corners
            elif isinstance(one, Line):
                yield one.start
                yield one.end

    def bounds(self, begin: int = 0) -> tuple[Vector, Vector] | None:
        """Return the lowest and the highest corner; None if nothing was drawn."""
        points = np.array(list(self.points(begin)))
        if not len(points):
            return None
        low, high = points.min(axis=0), points.max(axis=0)
        return (low[0], low[1], low[2]), (high[0], high[1], high[2])

    def meshes(self, stroke: float = 0.0) -> list[Part]:
        """Return one mesh per material and body, for a scene; strokes as thick as `stroke`."""
        return Meshes().of(self, stroke)

    def surface(self) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
        """Return everything as one triangulated surface: corners (n, 3) and triangles (m, 3)."""
        corners: list[Vector] = []
        found: list[tuple[int, int, int]] = []
        for piece in self.pieces:
            base = len(corners)
            found += [(base + a, base + b, base + c) for a, b, c in piece.triangles()]
            corners += piece.corners
        return (
            np.array(corners, float).reshape(-1, 3),
            np.array(found, np.uint32).reshape(-1, 3),
        )
