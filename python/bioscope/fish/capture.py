"""Synthetic motion capture: what a muscle-driven fish does, kept as frames and deformations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bioscope.errors import InvalidValueError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from bioscope.fish.tank import Tank

AHEAD = (slice(1, 5), slice(9, 13))
"""Nodes of the first and of the third ring, from which a fish's heading is taken."""


@dataclass(frozen=True)
class Segment:
    """A captured motion: the motion of a local frame, and the body's deformation within it.

    D. Terzopoulos, "Artificial life for computer graphics", Communications of the ACM 42(8), 1999:
    kinematic replicas of the biomechanical fish replay such segments.

    Attributes
    ----------
    interval
        Seconds from one moment to the next.
    centers
        Origin of the frame at each moment, the mean of the nodes: (n, 3), metres.
    yaws
        Heading of the frame at each moment, radians from +Z towards +X, not wrapped: (n,).
    deformations
        Nodes in the frame, the heading along +Z: (n, 23, 3), metres.
    """

    interval: float
    centers: NDArray[np.float64]
    yaws: NDArray[np.float64]
    deformations: NDArray[np.float64]

    @classmethod
    def split(cls, nodes: ArrayLike, interval: float) -> Segment:
        """Split places of nodes (n, 23, 3), metres, into a rigid motion and a deformation.

        Raises
        ------
        InvalidValueError
            For arrays of another shape, and numbers that are not finite.
        """
        places = np.asarray(nodes, dtype=np.float64)
        if places.ndim != 3 or places.shape[1:] != (23, 3) or not len(places):
            msg = f"nodes of shape {places.shape}: expected (n, 23, 3)"
            raise InvalidValueError(msg)
        if not (np.isfinite(places).all() and np.isfinite(interval) and interval > 0):
            msg = f"nodes and interval = {interval}: expected finite numbers, interval above 0"
            raise InvalidValueError(msg)
        centers = places.mean(axis=1)
        fore, hind = (places[:, ring].mean(axis=1) for ring in AHEAD)
        ahead = fore - hind
        yaws = np.unwrap(np.arctan2(ahead[:, 0], ahead[:, 2]))
        local = _turned(places - centers[:, None], -yaws)
        return cls(float(interval), centers, yaws, local)

    def nodes(self) -> NDArray[np.float64]:
        """Put frames and deformations together again: places of the nodes (n, 23, 3), metres."""
        return _turned(self.deformations, self.yaws) + self.centers[:, None]

    @property
    def duration(self) -> float:
        """Seconds it lasts."""
        return self.interval * (len(self.yaws) - 1)


def capture(tank: Tank, seconds: float, control: Callable[[Tank], None] | None = None) -> Segment:
    """Run a tank for some seconds and capture its fish at every step.

    `control` is called with the tank before each step, if given.
    """
    moments = [tank.nodes]
    for _ in range(round(seconds / tank.dt)):
        if control is not None:
            control(tank)
        tank.step()
        moments.append(tank.nodes)
    return Segment.split(np.array(moments), tank.dt)


def _turned(points: NDArray[np.float64], yaws: NDArray[np.float64]) -> NDArray[np.float64]:
    """Turn points (n, m, 3) about the vertical by angles (n,), from +Z towards +X."""
    sine, cosine = np.sin(yaws)[:, None], np.cos(yaws)[:, None]
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([x * cosine + z * sine, y, z * cosine - x * sine], axis=-1)
