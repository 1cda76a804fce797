"""Vectors of three numbers, and the pose of a turtle."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from bioscope._engine import arc_tangent, cosine, sine

Vector = tuple[float, float, float]

ZERO: Vector = (0.0, 0.0, 0.0)
UP: Vector = (0.0, 1.0, 0.0)
DOWN: Vector = (0.0, -1.0, 0.0)
PARALLEL = 1e-12
"""Below this length a cross product says nothing about a direction."""


def add(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def subtract(a: Vector, b: Vector) -> Vector:
    """Return a − b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(a: Vector, factor: float) -> Vector:
    """Return a, so many times as long."""
    return a[0] * factor, a[1] * factor, a[2] * factor


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def length(a: Vector) -> float:
    """Return the Euclidean length."""
    return math.sqrt(dot(a, a))


def unit(a: Vector) -> Vector | None:
    """Return the direction of a; None if it has none."""
    size = length(a)
    return times(a, 1 / size) if PARALLEL < size < math.inf else None


def mixed(a: Vector, b: Vector, angle: float) -> tuple[Vector, Vector]:
    """Return a and b turned in their plane, a toward b, by an angle in degrees."""
    c, s = cosine(math.radians(angle)), sine(math.radians(angle))
    return add(times(a, c), times(b, s)), add(times(b, c), times(a, -s))


def around(vector: Vector, axis: Vector, angle: float) -> Vector:
    """Return a vector turned about a unit axis by an angle in radians (Rodrigues)."""
    c, s = cosine(angle), sine(angle)
    along = times(axis, dot(vector, axis) * (1 - c))
    return add(add(along, times(vector, c)), times(cross(axis, vector), s))


@dataclass(frozen=True, slots=True)
class Pose:
    """Where the turtle is and how it is turned: heading, left and up are orthonormal."""

    position: Vector = ZERO
    heading: Vector = (1.0, 0.0, 0.0)
    left: Vector = (0.0, 1.0, 0.0)
    up: Vector = (0.0, 0.0, 1.0)

    def at(self, position: Vector) -> Pose:
        """Return it elsewhere, turned as it is."""
        return replace(self, position=position)

    def turned(self, angle: float) -> Pose:
        """Return it turned left by degrees."""
        heading, left = mixed(self.heading, self.left, angle)
        return replace(self, heading=heading, left=left)

    def pitched(self, angle: float) -> Pose:
        """Return it pitched down by degrees."""
        up, heading = mixed(self.up, self.heading, angle)
        return replace(self, heading=heading, up=up)

    def rolled(self, angle: float) -> Pose:
        """Return it rolled left by degrees."""
        left, up = mixed(self.left, self.up, angle)
        return replace(self, left=left, up=up)

    def point(self, ahead: float, left: float = 0.0, up: float = 0.0) -> Vector:
        """Return a point given along its axes."""
        along = add(self.position, times(self.heading, ahead))
        return add(add(along, times(self.left, left)), times(self.up, up))

    def level(self) -> Pose:
        """Return it with a horizontal left and the same heading; unchanged if that is vertical."""
        left = unit(cross(UP, self.heading))
        if left is None:
            return self
        return replace(self, left=left, up=cross(self.heading, left))

    def toward(self, direction: Vector) -> Pose:
        """Return it heading there with its left horizontal; unchanged for no direction.

        Its left stays as it is for a vertical direction, as far as it can.
        """
        heading = unit(direction)
        if heading is None:
            return self
        left = unit(cross(UP, heading))
        if left is None:
            left = unit(subtract(self.left, times(heading, dot(self.left, heading))))
        if left is None:
            return self
        return replace(self, heading=heading, left=left, up=cross(heading, left))

    def bent(self, force: Vector, rigidity: float) -> Pose:
        """Return it bent toward a force (thesis, section 2.3.2): never beyond its direction."""
        torque = cross(self.heading, force)
        axis = unit(torque)
        if axis is None or rigidity <= 0:
            return self
        angle = arc_tangent(length(torque), dot(self.heading, force))
        angle *= 1 - 1 / (1 + length(torque) / rigidity)
        heading, left = around(self.heading, axis, angle), around(self.left, axis, angle)
        return replace(self, heading=heading, left=left, up=cross(heading, left))
