"""Beams of sunlight in the water: a march along coarse rays through the pattern of the waves.

As in the rasterizer (`bioscope_geometry/src/rasterizer/shafts.rs`), but things cast no shadows
into them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from bioscope.film.light import Floats, Light
    from bioscope.film.waves import Waves

_CELL = 8
"""Every so many pixels a ray is marched along."""
_STEPS = 24
_REACH = 16.0
"""Metres."""
_DETAIL = 3
"""Level of the wave pattern."""


def shafts(
    light: Light, waves: Waves, eye: Floats, directions: Floats, distances: Floats
) -> Floats:
    """Return the light that beams add to what an eye under water sees (rows, columns, 3).

    `distances` (rows, columns) are infinite where nothing is seen. Dark beams take light away.
    """
    rays, ends = directions[::_CELL, ::_CELL], distances[::_CELL, ::_CELL]
    surface = light.depth(eye[1]) / np.maximum(rays[..., 1], 1e-6)
    length = np.minimum(np.minimum(ends, _REACH), surface)
    towards = np.maximum(rays @ light.sun_below, 0.0)
    strength = light.shafts * (0.012 + 0.05 * towards**3)
    total = np.zeros_like(rays)
    for number in range(_STEPS):
        run = (number + 0.5) / _STEPS * length
        points = eye + rays * run[..., None]
        depth = np.maximum(light.depth(points[..., 1]), 0.0)
        change = waves.pattern(points, depth, _DETAIL) - 1.0
        # Light that went several ways fills the dark beams.
        softened = np.where(change < 0.0, 0.35 * change, 1.3 * change)
        total += light.kept(run + depth / light.sun_below[1]) * softened[..., None]
    beams = light.sun_color * total * (strength * length / _STEPS)[..., None]
    return spread(beams, directions.shape[0], directions.shape[1])


def spread(cells: Floats, rows: int, columns: int) -> Floats:
    """Return values of every `_CELL`-th pixel at all pixels, linear between."""
    for axis, count in ((0, rows), (1, columns)):
        place = np.minimum(np.arange(count) / _CELL, cells.shape[axis] - 1)
        low = place.astype(int)
        high = np.minimum(low + 1, cells.shape[axis] - 1)
        shape = (-1, 1, 1) if axis == 0 else (1, -1, 1)
        share = (place - low).astype(np.float32).reshape(shape)
        near, far = np.take(cells, low, axis=axis), np.take(cells, high, axis=axis)
        cells = near + (far - near) * share
    return cells
