"""What one actor sees: a small square picture of colors, depths and identities.

H. Noser, EPFL thesis 1609 (1997), section 3.1: the world as it is drawn from the eye of the actor,
whose pixels have a depth and can be projected back to where they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bioscope._engine import cosine, sine
from bioscope.errors import InvalidValueError
from bioscope.lsystem.animation.viewing import Camera

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope.lsystem.animation.vectors import Vector

    Numbers = NDArray[np.float64]

ALIKE = 0.05
"""Chromatic distance below which colors are the same (thesis, section 3.1: that of the ball)."""
TIE = 1e-3
"""Share by which an obstacle on the left must be nearer than one on the right to be the nearest."""


class Code(NamedTuple):
    """By what an actor recognizes things: color-coded identity."""

    name: str
    """Of the material, or in a world the species."""
    color: tuple[int, int, int]
    """Red, green and blue as definitions give them, 0 to 255, whatever the light."""


@dataclass(slots=True)
class Window:
    """The vision window of an actor, as of the last frame. Pixels are rows from the top."""

    edge: int
    """Rows, and pixels in each."""
    most: int
    """How many colors it tells apart."""
    camera: Camera = field(default_factory=Camera)
    """The eye."""
    color: NDArray[np.float32] = field(init=False)
    """Linear red, green and blue (edge, edge, 3): lit, but for materials without lighting."""
    depth: NDArray[np.float32] = field(init=False)
    """Distance along each pixel's ray (edge, edge), units of the model; infinite for nothing."""
    identity: NDArray[np.uint32] = field(init=False)
    """What is seen (edge, edge): 1 is the first of `codes`; 0 is nothing, or not told apart."""
    codes: list[Code] = field(default_factory=list)
    """What the identities stand for: first what interests the actor, then as it is drawn."""

    def __post_init__(self) -> None:
        """See nothing."""
        shape = self.edge, self.edge
        self.color = np.zeros((*shape, 3), np.float32)
        self.depth = np.full(shape, np.inf, np.float32)
        self.identity = np.zeros(shape, np.uint32)

    @property
    def distance(self) -> float:
        """Distance of what is in the middle; that of the far plane if nothing is there."""
        return min(float(self.depth[self.edge // 2, self.edge // 2]), self.camera.far)

    def local(self) -> Numbers:
        """Return how far pixels are to the right, up and ahead (edge, edge, 3).

        Units of the model; infinite or not a number where nothing is.
        """
        with np.errstate(invalid="ignore"):
            return rays(self.edge, self.camera.angle) * self.depth[:, :, None].astype(np.float64)

    def points(self, seen: NDArray[np.bool_] | None = None) -> Numbers:
        """Return where pixels are in the model, projected back by their depths.

        Parameters
        ----------
        seen
            Which pixels (edge, edge); all that show something if not given.

        Returns
        -------
        ndarray
            Points (n, 3), in the order of the pixels.
        """
        chosen = np.isfinite(self.depth) if seen is None else seen & np.isfinite(self.depth)
        local = self.local()[chosen]
        axes = [np.array(axis) for axis in self.camera.axes()]
        ways = sum(local[:, [column]] * axis for column, axis in enumerate(axes))
        return np.asarray(np.array(self.camera.eye) + ways, np.float64).reshape(-1, 3)

    def center(self, seen: NDArray[np.bool_]) -> Vector | None:
        """Return the mean place of some pixels (thesis, eq. 3.1.9); none if there are none."""
        points = self.points(seen)
        if not len(points):
            return None
        # Exact sums: the same on all machines, in whatever order they are made.
        x, y, z = (math.fsum(column) / len(points) for column in points.T.tolist())
        return x, y, z

    def area(self, seen: NDArray[np.bool_], distance: float | None = None) -> float:
        """Return how large some pixels are together, across the line of sight.

        Parameters
        ----------
        seen
            Which pixels (edge, edge).
        distance
            How far away all of them are, which is good enough for small things in the middle
            (thesis, eq. 3.1.5 to 3.1.7); if not given, every pixel is as far ahead as its depth
            says (eq. 3.1.8).

        Returns
        -------
        float
            Square units of the model.
        """
        chosen = seen & np.isfinite(self.depth)
        ahead = self.local()[chosen][:, 2] if distance is None else np.full(chosen.sum(), distance)
        half = math.radians(self.camera.angle) / 2
        widths = 2 * ahead * (sine(half) / cosine(half)) / self.edge
        return math.fsum((widths * widths).tolist())

    def showing(self, *, names: tuple[str, ...] = (), color: object = None) -> NDArray[np.bool_]:
        """Return which pixels show things of these names, or of this color."""
        wanted = [
            number
            for number, code in enumerate(self.codes, 1)
            if code.name in names or code.color == color
        ]
        return np.isin(self.identity, wanted)

    def resembling(
        self, color: tuple[float, float, float], threshold: float = ALIKE
    ) -> NDArray[np.bool_]:
        """Return which pixels have the hue of a color, in light and shade (thesis, section 3.1).

        Colors are compared by their shares of red, green and blue, so light must be white, and
        things must be matt.

        Parameters
        ----------
        color
            Red, green and blue as definitions give them, in whatever unit.
        threshold
            Euclidean distance between the shares; those of different things should be 0.2 apart.

        Raises
        ------
        InvalidValueError
            For black, which has no hue.
        """
        if not sum(color) > 0:
            raise InvalidValueError(f"color = {color}: expected one that is not black")
        wanted = np.array(color) / sum(color)
        with np.errstate(invalid="ignore", divide="ignore"):
            shares = self.color / self.color.sum(axis=2, keepdims=True)
        away: Numbers = np.sqrt(((shares - wanted) ** 2).sum(axis=2))
        return np.isfinite(self.depth) & (away < threshold)

    def obstacle(self, size: float, reach: float) -> float:
        """Return on which side the way is obstructed.

        An obstacle is what is seen in the space that the actor needs to go ahead: a square of its
        size about its line of sight, as long as its reach.

        Parameters
        ----------
        size, reach
            Edge of the actor, and how far ahead it looks, units of the model.

        Returns
        -------
        float
            0 if the way is free; −1 if the nearest obstacle is to the left of the middle, 1 if it
            is to the right, or as near on both sides.
        """
        local = self.local()
        right, up, ahead = (local[:, :, axis] for axis in range(3))
        half = size / 2
        inside = (abs(right) <= half) & (abs(up) <= half) & (ahead <= reach)
        if not inside.any():
            return 0.0
        left_side = np.broadcast_to(np.arange(self.edge) < self.edge // 2, inside.shape)
        nearest = [
            float(ahead[inside & side].min(initial=np.inf)) for side in (left_side, ~left_side)
        ]
        return -1.0 if nearest[0] < nearest[1] * (1 - TIE) else 1.0


@cache
def rays(edge: int, angle: float) -> Numbers:
    """Return the directions of pixels as unit vectors to the right, up and ahead (edge, edge, 3).

    Parameters
    ----------
    edge
        Pixels of a row.
    angle
        The whole angle of view from edge to edge, degrees.
    """
    half = math.radians(angle) / 2
    places = (2 * (np.arange(edge) + 0.5) / edge - 1) * (sine(half) / cosine(half))
    made = np.ones((edge, edge, 3))
    made[:, :, 0], made[:, :, 1] = places[None, :], -places[:, None]
    squares = made * made
    found: Numbers = (
        made / np.sqrt(squares[:, :, 0] + squares[:, :, 1] + squares[:, :, 2])[:, :, None]
    )
    found.flags.writeable = False
    return found
