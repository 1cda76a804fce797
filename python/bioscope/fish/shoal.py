"""Many muscle-driven fishes at once, or as many that replay their captured motion."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from bioscope import _engine
from bioscope.errors import InvalidValueError

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Shoal:
    """Fishes of one species at their cruising speed, a body length apart along X, heading along +Z.

    Parameters
    ----------
    species
        A species by name.
    count
        How many.
    replayed
        Replay motion captured from the muscle-driven fish (synthetic motion capture) in place of
        computing muscles and water: swimming, and turns of 30 and 90 degrees, blended.

    Examples
    --------
    >>> shoal = Shoal("anthias", 10)
    >>> shoal.step(1 / 60, ticks=60)
    >>> shoal.nodes.shape
    (10, 23, 3)
    """

    def __init__(self, species: str = "anthias", count: int = 1, *, replayed: bool = False) -> None:
        if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < 0:
            raise InvalidValueError(f"count = {count!r}: expected a whole number, 0 or more")
        if not isinstance(species, str):
            raise InvalidValueError(f"species = {species!r}: expected the name of a species")
        self._engine = _engine.Shoal(species, count, replayed)

    def step(self, dt: float, ticks: int = 1) -> None:
        """Advance all by `dt` seconds, `ticks` times; the same on any number of threads."""
        self._engine.step(dt, ticks)

    def turn(self, index: int, angle: float) -> None:
        """Let one fish turn by this angle in radians, positive to the left."""
        if not abs(angle) <= 2 * math.pi:
            raise InvalidValueError(f"angle = {angle}: expected radians, -2 pi to 2 pi")
        self._engine.turn(index, angle)

    @property
    def natural_step(self) -> float:
        """Seconds of the step for which the body is calibrated; longer ones are divided."""
        return self._engine.natural_step

    @property
    def nodes(self) -> NDArray[np.float32]:
        """Places (n, 23, 3) of the nodes, metres."""
        return self._engine.nodes
