"""A mind that does what it is told from outside."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.errors import InvalidValueError
from bioscope.minds import Mind

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

TURN = np.pi / 2
"""Greatest turn that one action can ask for, radians."""
CLIMB = np.pi / 4
"""Greatest climb that one action can ask for, radians."""
FULL_SPEED = 4.0
"""Greatest speed that an action can ask for, body lengths per second."""


class Pupil(Mind):
    """A fish's mind with its decisions left to a policy: it reports percepts and obeys.

    An action has four numbers: turn (-1 right to 1 left), climb (-1 down to 1 up), speed (-1 rest
    to 1 full) and mouth (above 0 opens it, to snap at the nearest morsel).

    Parameters
    ----------
    food
        Species that it snaps at.
    """

    kind = "bioscope.training.Pupil"

    def __init__(self, food: Sequence[str] = ()) -> None:
        self.food = tuple(food)
        self.percepts: dict[str, Any] = {}
        self.turn = 0.0
        self.climb = 0.0
        self.speed = 0.0
        self.mouth = 0.0

    def obey(self, action: NDArray[np.float32]) -> None:
        """Take up an action of four numbers; those beyond -1 to 1 count as the nearest of these.

        Raises
        ------
        InvalidValueError
            For other than four finite numbers.
        """
        try:
            numbers = np.asarray(action, dtype=np.float64)
        except (TypeError, ValueError):
            numbers = np.full(0, np.nan)
        if numbers.shape != (4,) or not np.isfinite(numbers).all():
            raise InvalidValueError(f"action = {action!r}: expected four finite numbers")
        turn, climb, speed, mouth = np.clip(numbers, -1.0, 1.0)
        self.turn = float(turn) * TURN
        self.climb = float(climb) * CLIMB
        self.speed = 0.5 * (float(speed) + 1.0) * FULL_SPEED
        self.mouth = 1.0 if mouth > 0.0 else 0.0

    def decide(self, percepts: dict[str, Any]) -> dict[str, Any]:
        """Return what was asked for last."""
        self.percepts = percepts
        level = np.cos(self.climb)
        heading = (np.sin(self.turn) * level, np.sin(self.climb), np.cos(self.turn) * level)
        return {
            "behavior": "obey",
            "heading": tuple(float(axis) for axis in heading),
            "speed": self.speed,
            "mouth": self.mouth,
            "target": self._nearest_morsel(percepts) if self.mouth else None,
        }

    def _nearest_morsel(self, percepts: dict[str, Any]) -> int | None:
        noticed = [*percepts["smelled"], *percepts["seen"]]
        morsels = [one for one in noticed if one["species"] in self.food]
        nearest = min(morsels, key=lambda one: np.linalg.norm(one["position"]), default=None)
        return None if nearest is None else nearest["id"]
