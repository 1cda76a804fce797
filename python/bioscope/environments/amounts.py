"""What an environment keeps in its cells, such as water, made visible."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from bioscope import _engine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from bioscope._engine import Mesh


@dataclass(frozen=True, slots=True)
class Amounts:
    """Amounts of something in the cells of a box; any field of numbers on a grid can be one."""

    values: NDArray[np.float32]
    """Amount in each cell (z, y, x); a flat field has one layer."""
    low: tuple[float, float, float]
    """Lowest corner of the box, in units of the model."""
    cell: float
    """Width of a cell, in units of the model."""

    @property
    def deep(self) -> bool:
        """Whether the field has depth."""
        return bool(min(self.values.shape) > 1)

    def surface(self, amount: float) -> Mesh:
        """Return the surface on which a deep field has this amount; empty for a flat one.

        It looks to where there is less. By surface nets (S. F. F. Gibson, MICCAI 1998).
        """
        return _engine.amounts_surface(self.values, self.low, self.cell, amount)

    def sheet(self, most: float) -> Mesh:
        """Return the first layer painted on a sheet: black where nothing is, blue for `most`."""
        return _engine.amounts_sheet(self.values, self.low, self.cell, most)
