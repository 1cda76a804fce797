"""Primitives of flow to compose a current from: what is added to a world superposes.

After X. Tu, "Artificial animals for computer animation", 1996, section 7.1, and Wejchert and
Haumann, "Animation aerodynamics", SIGGRAPH 1991.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from bioscope.errors import InvalidValueError
from bioscope.world.field import Field

if TYPE_CHECKING:
    from numpy.typing import NDArray

Vector = tuple[float, float, float]
Flow = dict[str, "NDArray[np.float32]"]

_CORE = 0.25
"""Share of a source's radius within which its flow grows no further: choice, for it diverges."""


def _finite(name: str, *values: float) -> None:
    for value in values:
        if not math.isfinite(value):
            raise InvalidValueError(f"{name} = {value}: expected a finite number")


class Uniform(Field):
    """Water that moves the same everywhere, to and fro if it has a period.

    Parameters
    ----------
    direction
        Towards where it flows; any length but zero.
    strength
        Greatest speed, m/s.
    period
        Time of one swing, seconds; none for a steady flow.
    """

    kind = "uniform_flow"

    def __init__(self, direction: Vector, strength: float, *, period: float | None = None) -> None:
        _finite("direction", *direction)
        _finite("strength", strength)
        length = math.hypot(*direction)
        if length == 0:
            raise InvalidValueError("direction = (0, 0, 0): expected any other vector")
        if period is not None and not 0 < period < math.inf:
            raise InvalidValueError(f"period = {period}: expected more than 0 s")
        self.velocity = [one / length * strength for one in direction]
        self.period = period

    def at(self, points: NDArray[np.float32], time: float) -> Flow:
        """Return `a sin(2π t / period)` times the direction, or `a` times it."""
        swing = 1.0 if self.period is None else math.sin(2 * math.pi * time / self.period)
        flow = np.broadcast_to(np.array(self.velocity) * swing, points.shape)
        return {"flow": flow.astype(np.float32)}


class Source(Field):
    """Water that parts before an upright cylinder, or gathers at it if the strength is negative.

    Outward by `strength / (d - r)²` at the distance d from its axis, nothing within and above it.

    Parameters
    ----------
    place
        x and z of the axis, metres.
    radius, top
        Of the cylinder, and the height up to which it reaches, metres.
    strength
        m³/s: speed at one metre from its side, m/s.
    """

    kind = "source_flow"

    def __init__(
        self, place: tuple[float, float], radius: float, top: float, strength: float
    ) -> None:
        _finite("place", *place)
        _finite("top", top)
        _finite("strength", strength)
        if not 0 < radius < math.inf:
            raise InvalidValueError(f"radius = {radius}: expected more than 0 m")
        self.place, self.radius, self.top, self.strength = list(place), radius, top, strength

    def at(self, points: NDArray[np.float32], time: float) -> Flow:
        """Return the flow; `time` does not matter."""
        del time
        away = points[:, [0, 2]] - np.array(self.place)
        distance = np.linalg.norm(away, axis=1)
        gap = np.maximum(distance - self.radius, _CORE * self.radius)
        speed = self.strength / gap**2 / np.maximum(distance, 1e-9)
        speed[(distance <= self.radius) | (points[:, 1] > self.top)] = 0.0
        flow = np.zeros_like(points)
        flow[:, [0, 2]] = away * speed[:, None]
        return {"flow": flow}


class Vortex(Field):
    """Water that turns about an upright axis, fastest at the edge of its core.

    By `circulation / 2π · d / (d² + core²)` at the distance d: without curl far from the core.

    Parameters
    ----------
    place
        x and z of the axis, metres.
    circulation
        m²/s, positive from +Z towards +X.
    core
        Radius of the core, metres.
    """

    kind = "vortex_flow"

    def __init__(self, place: tuple[float, float], circulation: float, core: float = 0.3) -> None:
        _finite("place", *place)
        _finite("circulation", circulation)
        if not 0 < core < math.inf:
            raise InvalidValueError(f"core = {core}: expected more than 0 m")
        self.place, self.circulation, self.core = list(place), circulation, core

    def at(self, points: NDArray[np.float32], time: float) -> Flow:
        """Return the flow; `time` does not matter."""
        del time
        away = points[:, [0, 2]] - np.array(self.place)
        square = (away**2).sum(axis=1) + self.core**2
        rate = self.circulation / (2 * math.pi * square)
        flow = np.zeros_like(points)
        flow[:, 0], flow[:, 2] = away[:, 1] * rate, -away[:, 0] * rate
        return {"flow": flow}
