"""Percepts as numbers for a policy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium import spaces

if TYPE_CHECKING:
    from numpy.typing import NDArray

ATTENTION = 6
"""How many of the nearest things seen, and smelled, are told of each kind."""
_SELF = 11
_THING = 9


class Observation:
    """Turns percepts into one vector.

    The first 11 numbers are velocity (3) and flow (3) in body lengths per second, the way home (3)
    in tens of body lengths, depth in metres and light. Then follow 9 numbers for each of the
    nearest `ATTENTION` things of each species of interest, zeros where there are fewer: 1, the
    direction (3), closeness (1 at contact, 1/2 at one body length), velocity (3) and size in body
    lengths. All in the own frame: x left, y up, z ahead.

    Parameters
    ----------
    species
        Species of interest, in the order in which the vector tells of them.
    """

    def __init__(self, *species: str) -> None:
        self._species = species
        length = _SELF + _THING * ATTENTION * len(species)
        self.space: spaces.Box = spaces.Box(-10.0, 10.0, (length,), np.float32)

    def of(self, percepts: dict[str, Any]) -> NDArray[np.float32]:
        """Return the vector of these percepts; zeros before the first ones."""
        vector = np.zeros(self.space.shape or (0,), np.float32)
        if percepts:
            length = percepts["body_length"]
            vector[0:3] = np.asarray(percepts["velocity"]) / length
            vector[3:6] = np.asarray(percepts["flow"]) / length
            vector[6:9] = np.asarray(percepts["home"]) / (10.0 * length)
            vector[9:_SELF] = percepts["depth"], percepts["light"]
            noticed = self._noticed(percepts)
            for block, things in enumerate(noticed):
                for number, thing in enumerate(things[:ATTENTION]):
                    start = _SELF + _THING * (block * ATTENTION + number)
                    vector[start : start + _THING] = _told(thing, length)
        low, high = self.space.low, self.space.high
        clipped: NDArray[np.float32] = np.clip(vector, low, high)
        return clipped

    def _noticed(self, percepts: dict[str, Any]) -> list[list[dict[str, Any]]]:
        things = {one["id"]: one for one in percepts.get("smelled", [])}
        things |= {one["id"]: one for one in percepts["seen"]}
        ordered = sorted(things.values(), key=_distance)
        return [[one for one in ordered if one["species"] == name] for name in self._species]


def _distance(thing: dict[str, Any]) -> float:
    return float(np.linalg.norm(thing["position"]))


def _told(thing: dict[str, Any], length: float) -> NDArray[np.float64]:
    distance = _distance(thing)
    direction = np.asarray(thing["position"]) / max(distance, 1e-9)
    closeness = 1.0 / (1.0 + distance / length)
    velocity = np.asarray(thing["velocity"]) / length
    return np.concatenate([[1.0], direction, [closeness], velocity, [thing["size"] / length]])


def actions() -> spaces.Box:
    """Return the space of a `Pupil`'s actions."""
    return spaces.Box(-1.0, 1.0, (4,), np.float32)
