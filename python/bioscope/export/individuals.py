"""Who is who from frame to frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def keys(ids: NDArray[np.uint32]) -> NDArray[np.int64]:
    """Return a number of its own for each instance: its id, and 2³² more for each equal before."""
    whole = ids.astype(np.int64)
    if len(np.unique(whole)) == len(whole):
        return whole
    seen: dict[int, int] = {}
    found = np.empty_like(whole)
    for index, one in enumerate(whole.tolist()):
        found[index] = one + (seen.get(one, 0) << 32)
        seen[one] = seen.get(one, 0) + 1
    return found


class Slots:
    """A row for every individual that was ever there; rows are never used twice."""

    def __init__(self) -> None:
        self.keys = np.empty(0, np.int64)
        """Key of each row."""
        self._of: dict[int, int] = {}
        self._last = np.empty(0, np.int64)
        self._rows = np.empty(0, np.int64)

    def rows(self, present: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the row of each key (n,), with new rows for new keys."""
        if np.array_equal(present, self._last):
            return self._rows
        for key in present.tolist():
            self._of.setdefault(key, len(self._of))
        self.keys = np.fromiter(self._of, np.int64, len(self._of))
        self._last = present.copy()
        self._rows = np.array([self._of[key] for key in present.tolist()], np.int64)
        return self._rows


def placed(
    table: NDArray[np.floating], rows: NDArray[np.int64], values: NDArray[np.floating], count: int
) -> NDArray[np.floating]:
    """Return a copy of `table` grown to `count` rows with `values` put in these rows."""
    grown = np.zeros((count, *values.shape[1:]), values.dtype)
    grown[: len(table)] = table
    grown[rows] = values
    return grown
