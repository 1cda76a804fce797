"""Shapes as corners and faces, in the frame of the turtle (thesis, appendix C)."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from bioscope._engine import cosine, sine
from bioscope.lsystem.animation.vectors import (
    Pose,
    Vector,
    add,
    cross,
    dot,
    subtract,
    times,
    unit,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

Face = tuple[int, ...]
Shape = tuple[list[Vector], list[Face]]
"""Corners, and faces as numbers of corners, counterclockwise seen from outside."""

LEAST_SIDES = 3
SIDES = 10
"""Sides of round shapes if `n` says nothing."""
MOST_SIDES = 64
ALONGSIDE = 3
"""What a closing polygon asks for in its third parameter to be rimmed with cylinders."""
_BOX_FACES: list[Face] = [
    (0, 1, 3, 2),
    (4, 6, 7, 5),
    (0, 4, 5, 1),
    (2, 3, 7, 6),
    (0, 2, 6, 4),
    (1, 5, 7, 3),
]
_PYRAMID_FACES: list[Face] = [(3, 2, 1, 0), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]


def box(pose: Pose, size: Vector) -> Shape:
    """Return a box that begins here and is centred about the heading."""
    a, b, c = size
    corners = [
        pose.point(x * a, (y - 0.5) * b, (z - 0.5) * c)
        for x in (0, 1)
        for y in (0, 1)
        for z in (0, 1)
    ]
    return corners, _outward(_BOX_FACES, a * b * c)


def pyramid(pose: Pose, size: Vector) -> Shape:
    """Return a pyramid with its base here and its peak ahead."""
    a, b, c = size
    square = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
    corners = [pose.point(0, y * b, z * c) for y, z in square]
    return [*corners, pose.point(a)], _outward(_PYRAMID_FACES, a * b * c)


def _outward(faces: list[Face], volume: float) -> list[Face]:
    return faces if volume >= 0 else [face[::-1] for face in faces]


def revolved(
    pose: Pose, profile: Sequence[tuple[float, float, float]], sides: int, *, closed: bool = True
) -> Shape:
    """Return what a profile describes that is turned about the heading.

    Parameters
    ----------
    pose
        Where it stands.
    profile
        How far ahead, and its radii along left and up; radii of 0 are poles.
    sides
        Corners of each ring.
    closed
        Whether open ends are covered.
    """
    corners: list[Vector] = []
    rings: list[list[int]] = []
    for ahead, left, up in profile:
        if left == 0 and up == 0:
            rings.append([len(corners)])
            corners.append(pose.point(ahead))
            continue
        rings.append(list(range(len(corners), len(corners) + sides)))
        for side in range(sides):
            turn = math.tau * side / sides
            corners.append(pose.point(ahead, left * cosine(turn), up * sine(turn)))
    faces: list[Face] = []
    for low, high in pairwise(rings):
        for side in range(sides):
            after = (side + 1) % sides
            if len(low) == 1 and len(high) == 1:
                break
            if len(low) == 1:
                faces.append((low[0], high[after], high[side]))
            elif len(high) == 1:
                faces.append((low[side], low[after], high[0]))
            else:
                faces.append((low[side], low[after], high[after], high[side]))
    if closed and len(rings[0]) > 1:
        faces.append(tuple(reversed(rings[0])))
    if closed and len(rings[-1]) > 1:
        faces.append(tuple(rings[-1]))
    return corners, faces


def ellipsoid(pose: Pose, size: Vector, sides: int) -> Shape:
    """Return an ellipsoid about here, as thick as `size` along heading, left and up."""
    a, b, c = (one / 2 for one in size)
    rings = max(2, sides // 2)
    profile = []
    for ring in range(rings + 1):
        angle = math.pi * ring / rings
        width = sine(angle) if 0 < ring < rings else 0.0
        profile.append((-a * cosine(angle), b * width, c * width))
    return revolved(pose, profile, sides)


def trunk(
    pose: Pose, ahead: float, base: tuple[float, float], end: tuple[float, float], sides: int
) -> Shape:
    """Return a tapered cylinder with hemispherical ends; thicknesses along left and up."""
    quarter = max(1, sides // 4)
    profile = []
    for ring in range(quarter):
        angle = math.pi / 2 * ring / quarter
        out, width = cosine(angle), sine(angle) if ring else 0.0
        deep = (base[0] + base[1]) / 4 * out
        profile.append((-deep, base[0] / 2 * width, base[1] / 2 * width))
    profile += [(0.0, base[0] / 2, base[1] / 2), (ahead, end[0] / 2, end[1] / 2)]
    for ring in reversed(range(quarter)):
        angle = math.pi / 2 * ring / quarter
        out, width = cosine(angle), sine(angle) if ring else 0.0
        deep = (end[0] + end[1]) / 4 * out
        profile.append((ahead + deep, end[0] / 2 * width, end[1] / 2 * width))
    return revolved(pose, profile, sides)


def tube(pose: Pose, ahead: float, thick: tuple[float, float], sides: int) -> Shape:
    """Return an open cylinder; thicknesses along left and up."""
    radii = thick[0] / 2, thick[1] / 2
    return revolved(pose, [(0.0, *radii), (ahead, *radii)], sides, closed=False)


def placed(shape: Shape, pose: Pose, size: Vector) -> Shape:
    """Return a shape in the frame of a pose, scaled along its axes."""
    corners, faces = shape
    a, b, c = size
    return [pose.point(x * a, y * b, z * c) for x, y, z in corners], faces


def normal_of(corners: Sequence[Vector]) -> Vector | None:
    """Return the normal of a polygon that need not be flat (Newell); None if it has no area."""
    total = (0.0, 0.0, 0.0)
    first = corners[0] if corners else (0.0, 0.0, 0.0)
    edges = [subtract(one, first) for one in corners]
    for a, b in pairwise(edges):
        total = add(total, cross(a, b))
    return unit(total)


def extruded(
    corners: list[Vector], *, flipped: bool, parallel: bool, closing: int, distance: float
) -> list[Shape]:
    """Return a polygon as `}` asks for it.

    Parameters
    ----------
    corners
        At least three.
    flipped
        Whether its normal is inverted.
    parallel
        Whether there is a second one, at `distance` along the normal of the first, that looks the
        other way.
    closing
        1: side faces between the two; 3: cylinders along the sides, as thick as the distance.
    distance
        Metres.
    """
    if flipped:
        corners = corners[::-1]
    normal = normal_of(corners)
    count = len(corners)
    front = tuple(range(count))
    if not parallel or normal is None:
        return [(corners, [front])]
    second = [add(one, times(normal, distance)) for one in corners]
    faces: list[Face] = [front, tuple(reversed(range(count, 2 * count)))]
    shapes: list[Shape] = []
    for at in range(count if closing else 0):
        after = (at + 1) % count
        if closing != ALONGSIDE:
            faces.append((after, at, at + count, after + count))
            continue
        middle = add(corners[at], times(normal, distance / 2))
        side = subtract(corners[after], corners[at])
        ahead = unit(side)
        if ahead is not None:
            pose = Pose(middle, ahead, cross(normal, ahead), normal)
            thick = abs(distance), abs(distance)
            shapes.append(trunk(pose, math.sqrt(dot(side, side)), thick, thick, SIDES))
    return [(corners + second, faces), *shapes]


def fan(face: Face) -> list[tuple[int, int, int]]:
    """Return a convex face as triangles, the same as `triangles` does."""
    last = face[-1]
    return [(last, face[at], face[at + 1]) for at in range(len(face) - 2)]


def triangles(corners: Sequence[Vector], face: Face) -> list[tuple[int, int, int]]:
    """Return a face as triangles; ears are cut off, so that it may be concave."""
    if len(face) == LEAST_SIDES:
        return [(face[0], face[1], face[2])]
    rest = list(face)
    normal = normal_of([corners[one] for one in face])
    if len(rest) < LEAST_SIDES:
        return []
    found = []
    while len(rest) > LEAST_SIDES:
        ear = next((at for at in range(len(rest)) if _is_ear(corners, rest, at, normal)), 0)
        found.append((rest[ear - 1], rest[ear], rest[(ear + 1) % len(rest)]))
        del rest[ear]
    return [*found, (rest[0], rest[1], rest[2])]


def _is_ear(corners: Sequence[Vector], rest: list[int], at: int, normal: Vector | None) -> bool:
    if normal is None:
        return True
    before, here, after = rest[at - 1], rest[at], rest[(at + 1) % len(rest)]
    a, b, c = corners[before], corners[here], corners[after]

    def beside(p: Vector, q: Vector, r: Vector) -> float:
        return dot(cross(subtract(q, p), subtract(r, p)), normal)

    if beside(a, b, c) <= 0:
        return False
    for other in rest:
        point = corners[other]
        if other in (before, here, after) or point in (a, b, c):
            continue
        if beside(a, b, point) >= 0 and beside(b, c, point) >= 0 and beside(c, a, point) >= 0:
            return False
    return True


def square(edge: float, center: Vector) -> Shape:
    """Return a horizontal square with its normal up."""
    half = edge / 2
    corners = [(-half, -half), (-half, half), (half, half), (half, -half)]
    return [add(center, (x, 0.0, z)) for x, z in corners], [(0, 1, 2, 3)]


NET_HEIGHT = 0.91
COURT_LENGTH, COURT_WIDTH, DOUBLES_WIDTH, SERVICE = 23.77, 8.23, 10.97, 6.40
"""Metres (thesis, table C: proportional to real values)."""
LINE_WIDTH = 0.05


def tennis_court() -> dict[str, Shape]:
    """Return the parts of a tennis court in the x,z plane: areas, lines, net, by material."""
    half, singles, doubles = COURT_LENGTH / 2, COURT_WIDTH / 2, DOUBLES_WIDTH / 2
    strips = [
        *((-half, z, half, z) for z in (-doubles, -singles, singles, doubles)),
        *((x, -doubles, x, doubles) for x in (-half, half)),
        *((x, -singles, x, singles) for x in (-SERVICE, SERVICE)),
        (-SERVICE, 0.0, SERVICE, 0.0),
    ]
    net = [(0.0, y, z) for y, z in ((0, -doubles), (0, doubles), (NET_HEIGHT, doubles))]
    net.append((0.0, NET_HEIGHT, -doubles))
    return {
        "green": _rectangles([(-half, -doubles, half, doubles)], 0.0),
        "white": _rectangles([_widened(strip) for strip in strips], 0.002),
        "grey1": (net, [(0, 1, 2, 3)]),
    }


def _widened(strip: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    x0, z0, x1, z1 = strip
    w = LINE_WIDTH / 2
    return (x0, z0 - w, x1, z1 + w) if z0 == z1 else (x0 - w, z0, x1 + w, z1)


def _rectangles(areas: Sequence[tuple[float, float, float, float]], height: float) -> Shape:
    corners: list[Vector] = []
    faces: list[Face] = []
    for x0, z0, x1, z1 in areas:
        at = len(corners)
        corners += [(x0, height, z0), (x0, height, z1), (x1, height, z1), (x1, height, z0)]
        faces.append((at, at + 1, at + 2, at + 3))
    return corners, faces
