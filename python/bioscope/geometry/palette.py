"""Tints of a batch, reduced to the few colors that a format's materials can hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Batch
    from bioscope.geometry.balls import Balls

Color = tuple[float, float, float]

WHITE: Color = (1.0, 1.0, 1.0)
_STEPS = (16, 8, 4, 2, 1)


class Palette:
    """The tints of one batch, rounded to at most `limit`; each id keeps its first."""

    def __init__(self, batch: Batch | Balls, limit: int = 12) -> None:
        self.colors: list[Color] = []
        self._limit = limit
        self._steps = next(
            step for step in _STEPS if self._count(batch, step) <= limit or step == 1
        )
        self._of_id: dict[int, int] = {}

    @staticmethod
    def _count(batch: Batch | Balls, steps: int) -> int:
        if not len(batch.tints):
            return 1
        return len(np.unique(np.rint(batch.tints * steps), axis=0))

    def assign(self, batch: Batch | Balls) -> NDArray[np.int32]:
        """Return the number of each instance's color, (n,); new colors are appended to `colors`."""
        tints = batch.tints
        for index, one in enumerate(batch.ids.tolist()):
            if one not in self._of_id:
                tint = tints[index] if len(tints) else np.ones(3)
                self._of_id[one] = self._number(tint)
        return np.array([self._of_id[one] for one in batch.ids.tolist()], np.int32)

    def _number(self, tint: NDArray[np.floating]) -> int:
        red, green, blue = (float(one) for one in np.rint(tint * self._steps) / self._steps)
        color = (red, green, blue)
        if color in self.colors:
            return self.colors.index(color)
        if len(self.colors) < self._limit:
            self.colors.append(color)
            return len(self.colors) - 1
        away = np.abs(np.array(self.colors) - np.array(color)).sum(axis=1)
        return int(away.argmin())
