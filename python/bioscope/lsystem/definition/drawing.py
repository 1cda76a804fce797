"""What the turtle draws for the symbols of definition files (thesis, appendix C).

`x y z` are the parameters of a symbol (par1 to par3), `a b c` its growth values (par4 to par6).
Symbols that are not here mean nothing to the turtle: actors, particles, sounds, lights, cameras,
imported surfaces. Cylinders are round, as thick as their par5.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

Point = tuple[float, float, float]

RINGS, SIDES = 6, 8
"""Parts of an ellipsoid from pole to pole, and around."""
_CORNERS = [(0, 0), (1, 0), (1, 1), (0, 1)]


def _moved(ahead: str, left: str, up: str, move: str) -> str:
    """Return a move without turning, by lengths along H, L and U."""
    return f"{move}({ahead}) +(90) {move}({left}) -(90) ^(90) {move}({up}) &(90)"


def _polygon(corners: Sequence[Point]) -> str:
    """Return a polygon with corners in units of a, b and c along H, L and U; it moves nothing."""
    words, now = [], (0.0, 0.0, 0.0)
    for corner in corners:
        steps = [there - here for there, here in zip(corner, now, strict=True)]
        a, b, c = (f"{name}*({step:.9g})" for name, step in zip("abc", steps, strict=True))
        words.append(_moved(a, b, c, "g") + " .")
        now = corner
    return "[ { " + " ".join(words) + " } ]"


def _box() -> str:
    """Return a box that begins here, centred about H."""
    sides = []
    for axis in range(3):
        for end in (0, 1):
            corners = []
            for first, second in _CORNERS if end else _CORNERS[::-1]:
                place = [first, second]
                place.insert(axis, end)
                corners.append((float(place[0]), place[1] - 0.5, place[2] - 0.5))
            sides.append(_polygon(corners))
    return " ".join(sides)


def _pyramid() -> str:
    """Return a pyramid with its base here, centred about H, and its peak ahead."""
    base = [(0.0, first - 0.5, second - 0.5) for first, second in _CORNERS]
    peak = (1.0, 0.0, 0.0)
    sides = [(base[at], base[(at + 1) % 4], peak) for at in range(4)]
    return " ".join([_polygon(base[::-1]), *map(_polygon, sides)])


def _ellipsoid() -> str:
    """Return an ellipsoid about here, of thickness a along H, b along L and c along U."""

    def at(ring: int, side: int) -> Point:
        polar, around = math.pi * ring / RINGS, 2 * math.pi * side / SIDES
        across = math.sin(polar) / 2
        return (math.cos(polar) / 2, across * math.cos(around), across * math.sin(around))

    faces = []
    for ring in range(RINGS):
        for side in range(SIDES):
            corners = [
                at(ring, side),
                at(ring + 1, side),
                at(ring + 1, side + 1),
                at(ring, side + 1),
            ]
            # At the poles two corners are one.
            faces.append(
                corners[:3] if ring + 1 == RINGS else corners[1:] if ring == 0 else corners
            )
    return " ".join(map(_polygon, faces))


_CAPSULE = (("", "!(b) @O(b / 2) F(a) @O(b / 2)"),)
_TRUNK = (("", "!(b) @O(b / 2) @Gs !(c) F(a) @Ge @O(c / 2)"),)
_LINE = (("", "F(a)"),)

DRAWINGS: dict[str, tuple[tuple[str, str], ...]] = {
    "+": (("", "+(a)"),),
    "-": (("", "-(a)"),),
    "&": (("", "&(a)"),),
    "^": (("", "^(a)"),),
    "/": (("", "/(a)"),),
    "$": (
        ("y == 0", "\\(a)"),
        ("y == 1", "@v"),
        ("y == 3", "@R(1,0,0,0,0,1)"),
    ),
    "f": (
        ("z == 0", "f(a)"),
        ("z == 2", "@M(a,b,c)"),
        ("z == 3", _moved("a", "b", "c", "f")),
    ),
    "c": (("", f"{_box()} f(a)"),),
    "d": (("", f"{_box()} f(a)"),),
    "p": (("", f"{_pyramid()} f(a)"),),
    "q": (("", f"{_pyramid()} f(a)"),),
    "a": (("", "@O(a / 2)"),),
    "s": (("", _ellipsoid()),),
    "O": _CAPSULE,
    "N": _CAPSULE,
    "o": (("", "!(b) F(a)"),),
    "P": _TRUNK,
    "Q": _TRUNK,
    "R": _LINE,
    "S": _LINE,
    "m": (("", ";(x)"),),
    "n": (("", "@!(x)"),),
    "{": (("", "{"),),
    ".": (("", "."),),
    "}": (("", "}"),),
}
"""By symbol: conditions and what is drawn; the first that holds counts."""
