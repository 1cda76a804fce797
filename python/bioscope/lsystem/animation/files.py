"""Files beside definitions: surfaces, data channels, trajectories (thesis, section 6.3.3).

The thesis names the format of the Surface Manager (SM) but does not print it. Here it is text: the
words `SM`, number of corners, number of triangles; three coordinates per corner; three numbers of
corners, from 0, per triangle. A channel is its time step, how many values follow, and these. A
trajectory is lines of actor, state, time and position.
"""

from __future__ import annotations

import math
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import numpy as np

from bioscope.errors import FormatError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from bioscope.lsystem.animation.shapes import Shape
    from bioscope.lsystem.animation.vectors import Vector

LARGEST = 64 << 20
"""Most bytes of a file."""
CHANNELS = 10
"""Most data channels of a definition."""


def located(name: str, folder: Path | None, place: str) -> Path:
    """Return a file beside the definition; others are not read.

    Raises
    ------
    FormatError
        If there is no such file within the folder, or it is too large.
    """
    if folder is None:
        raise FormatError(f"{place}: file '{name}' cannot be read: the definition has no folder")
    path = (folder / name).resolve()
    if not path.is_relative_to(folder.resolve()):
        raise FormatError(f"{place}: file '{name}' is outside the folder of the definition")
    if not path.is_file():
        raise FormatError(f"{place}: there is no file '{path}'")
    if path.stat().st_size > LARGEST:
        raise FormatError(f"{path}: a file has at most {LARGEST >> 20} MiB")
    return path


def _numbers(path: Path, words: Sequence[str]) -> list[float]:
    found = []
    for word in words:
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise FormatError(f"{path}: expected a number, found '{word[:40]}'")
        found.append(value)
    return found


def read_surface(path: Path) -> Shape:
    """Return a triangulated surface of an SM file.

    Raises
    ------
    FormatError
        If it is none.
    """
    words = path.read_text(encoding="utf-8", errors="replace").split()
    if words[:1] != ["SM"] or len(words) < 3 or not (words[1] + words[2]).isdecimal():
        raise FormatError(f"{path}: expected 'SM', the number of corners and that of triangles")
    corners, triangles = int(words[1]), int(words[2])
    values = _numbers(path, words[3:])
    if len(values) != 3 * (corners + triangles):
        raise FormatError(
            f"{path}: {corners} corners and {triangles} triangles are "
            f"{3 * (corners + triangles)} numbers, found {len(values)}"
        )
    points = [(values[at], values[at + 1], values[at + 2]) for at in range(0, 3 * corners, 3)]
    faces = [
        (int(values[at]), int(values[at + 1]), int(values[at + 2]))
        for at in range(3 * corners, len(values), 3)
    ]
    if any(not 0 <= one < corners for face in faces for one in face):
        raise FormatError(f"{path}: a triangle has a corner that is not there")
    return points, [*faces]


def surface_text(corners: NDArray[np.float64], triangles: NDArray[np.uint32]) -> str:
    """Return a triangulated surface as an SM file."""
    lines = [f"SM {len(corners)} {len(triangles)}"]
    lines += [" ".join(f"{one:.9g}" for one in corner) for corner in corners.tolist()]
    lines += [" ".join(map(str, triangle)) for triangle in triangles.tolist()]
    return "\n".join(lines) + "\n"


class Channel:
    """A series of values, linear between them and constant outside."""

    def __init__(self, path: Path) -> None:
        words = path.read_text(encoding="utf-8", errors="replace").split()
        values = _numbers(path, words)
        if len(values) < 3 or values[0] <= 0 or values[1] != len(values) - 2:
            raise FormatError(f"{path}: expected a time step, the number of values, and these")
        self.step, self.values = values[0], values[2:]

    def at(self, time: float) -> float:
        """Return the value at a time in seconds."""
        place = min(max(time / self.step, 0.0), len(self.values) - 1.0)
        low = min(int(place), len(self.values) - 1)
        high = min(low + 1, len(self.values) - 1)
        share = place - low
        return self.values[low] + (self.values[high] - self.values[low]) * share


class Trajectory:
    """Where an actor was at its times."""

    def __init__(self, path: Path, actor: int) -> None:
        self.times: list[float] = []
        self.places: list[Vector] = []
        for number, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1):
            values = _numbers(path, line.split())
            if not values:
                continue
            if len(values) != 6:
                raise FormatError(
                    f"{path}:{number}: expected actor, state, time and three coordinates"
                )
            if int(values[0]) == actor:
                self.times.append(values[2])
                self.places.append((values[3], values[4], values[5]))
        if not self.times or self.times != sorted(self.times):
            raise FormatError(f"{path}: no records of actor {actor} in the order of their times")

    def at(self, time: float) -> tuple[Vector, Vector]:
        """Return place and direction at a time; the ends outside."""
        after = int(np.searchsorted(self.times, time, side="right"))
        low, high = max(0, after - 1), min(after, len(self.times) - 1)
        span = self.times[high] - self.times[low]
        share = (time - self.times[low]) / span if span > 0 else 0.0
        a, b = self.places[low], self.places[high]
        x, y, z = (one + (other - one) * share for one, other in zip(a, b, strict=True))
        if low == high and low:
            a = self.places[low - 1]
        return (x, y, z), (b[0] - a[0], b[1] - a[1], b[2] - a[2])


def record(actor: int, state: int, time: float, place: Vector) -> str:
    """Return a line of a trajectory."""
    return f"{actor} {state} {time:.9g} " + " ".join(f"{one:.9g}" for one in place)


def plain(name: str) -> str:
    """Return the last part of a path that a definition names, so that it leads nowhere else."""
    found = PurePosixPath(name.replace("\\", "/")).name
    return found if found not in ("", ".", "..") else "unnamed"
