"""Plants in all their detail that crowd each other out by the rule of circles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.environments.environment import Environment
from bioscope.environments.kinds import Neighborhood

if TYPE_CHECKING:
    from numpy.typing import NDArray

ROOT = 0
"""What the first number of a root's message is; of tips it is something else."""


class Crowns(Environment):
    """Of two plants whose crowns touch the smaller one dies, as in `Neighborhood`.

    What a crown is, is measured. A plant asks `?E(0,s)` at its root and then `?E(1,s)` at the tips
    of its branches; its crown is the circle around the root of the same area as the star of its
    tips, seen from above. The root (and each tip) gets s = 1 where a larger crown touches.

    So a stand of plants with branches and leaves lives by the same rule as a stand of circles
    (O. Deussen and others, SIGGRAPH 1998, section 4.2), and the two can be held side by side.
    """

    fields = ("parameters", "positions")

    def exchange(self, step: int, messages: dict[str, NDArray[Any]]) -> NDArray[np.float32] | None:
        """Measure the crowns, and tell the roots which of them lose."""
        kinds, places = messages["parameters"][:, 0], messages["positions"]
        roots = np.flatnonzero(kinds == ROOT)
        if not len(roots):
            return None
        plants = np.cumsum(kinds == ROOT) - 1
        # What comes before the first root has none.
        plants = np.maximum(plants, 0)
        away = places - places[roots][plants]
        squares = np.bincount(plants, away[:, 0] ** 2 + away[:, 2] ** 2, len(roots))
        tips = np.bincount(plants, kinds != ROOT, len(roots))
        radii = np.sqrt(squares / np.maximum(tips, 1))
        ground = places[roots][:, [0, 2, 1]] * np.array([1, 1, 0], np.float32)
        asked = np.stack([radii, np.zeros(len(radii))], axis=1)
        lost = np.array(Neighborhood().ask(asked, ground, step=step))[:, 1]
        return np.stack([kinds, lost[plants]], axis=1).astype(np.float32)
