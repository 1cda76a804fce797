"""Where the string of a definition is drawn: once, or many times in a square (section 3.3.7)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from bioscope.lsystem.animation.scope import uniform
from bioscope.lsystem.animation.vectors import Pose, Vector, around

if TYPE_CHECKING:
    from collections.abc import Callable

    from bioscope.lsystem.definition.grammar import Definition

MOST = 10_000
"""Most repetitions."""
TRIALS = 10_000
"""Attempts to find a place that is far enough from the others."""
ROTATION, SHIFT, SIZE, SPOT = 0, 3, 6, 16


@dataclass(frozen=True, slots=True)
class Placement:
    """Where and how large a string is drawn."""

    pose: Pose
    scale: float


def placements(
    definition: Definition, seed: int, layer: int, remark: Callable[[str], None]
) -> list[Placement]:
    """Return where a definition asks to be drawn; what is chance depends on the seed alone."""
    told = definition.repetition
    start, side, number, distance = told.get("startp_sidel_nbr_dist", [0.0, 0.0, 1.0, 0.0])
    count = int(min(max(number, 1), MOST))
    if number > MOST:
        remark(f"{definition.file}: {MOST} repetitions rather than {number:g}")

    def ranged(name: str, otherwise: float, axis: int, index: int, purpose: int) -> float:
        low = told.get(name, [otherwise] * 3)[axis]
        high = told.get(f"{name}_max", told.get(name, [otherwise] * 3))[axis]
        return low + (high - low) * uniform(seed, layer, index, purpose + axis)

    found: list[Placement] = []
    spots: list[tuple[float, float]] = []
    apart = distance * side / math.sqrt(count) if "startp_sidel_nbr_dist" in told else 0.0
    for index in range(count):
        x, z = _spot(spots, apart / side if side else 0.0, (seed, layer, index))
        if not math.isfinite(x):
            remark(f"{definition.file}: only {index} of {count} repetitions are {apart:g} apart")
            break
        spots.append((x, z))
        pose = Pose()
        for axis in range(3):
            angle = math.radians(ranged("rotate", 0.0, axis, index, ROTATION))
            pose = _rotated(pose, axis, angle)
        shift = [ranged("translate", 0.0, axis, index, SHIFT) for axis in range(3)]
        place = (start + x * side + shift[0], shift[1], start + z * side + shift[2])
        if "startp_sidel_nbr_dist" not in told:
            place = (shift[0], shift[1], shift[2])
        found.append(Placement(pose.at(place), ranged("scale", 1.0, 0, index, SIZE)))
    return found


def _spot(
    taken: list[tuple[float, float]], apart: float, keys: tuple[int, int, int]
) -> tuple[float, float]:
    """Return a place in the unit square that is far enough from others; not a number if none is."""
    for trial in range(TRIALS):
        x, z = (uniform(*keys, SPOT + axis, trial) for axis in (0, 1))
        if all((x - a) ** 2 + (z - b) ** 2 >= apart * apart for a, b in taken):
            return x, z
    return math.nan, math.nan


def _rotated(pose: Pose, axis: int, angle: float) -> Pose:
    about: list[Vector] = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    turn = [around(one, about[axis], angle) for one in (pose.heading, pose.left, pose.up)]
    return Pose(pose.position, *turn)
