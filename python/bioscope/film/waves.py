"""The ripples of the water surface: slopes and caustics on a square tile.

See `bioscope_geometry/src/rasterizer/waves.rs` for the model; both give the same pattern at the
same time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bioscope.film.light import smoothstep, unit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope.film.light import Floats, Light

_WAVES = np.array(
    [
        [2.0, 1.0, 0.10, 0.23],
        [-1.0, 3.0, 0.09, 0.29],
        [3.0, -2.0, 0.09, 0.31],
        [1.0, 4.0, 0.08, 0.37],
        [-4.0, -2.0, 0.07, 0.41],
        [5.0, 2.0, 0.06, 0.47],
        [-3.0, 5.0, 0.05, 0.53],
        [6.0, -3.0, 0.04, 0.61],
        [4.0, 7.0, 0.03, 0.67],
    ]
)
"""Waves per tile along x and z, slope amplitude, turns per second."""
_CELLS = 5.0
_FOCUS = 0.13
"""How far sunlight is thrown, in tiles per unit of slope."""
_FLAT = 150.0
"""Beyond this distance the surface looks flat, metres."""
_SIZE = 256


class Waves:
    """Slopes and caustics of one moment."""

    def __init__(self, light: Light, time: float) -> None:
        self._light = light
        self._frequency = 1.0 / (_CELLS * light.caustic_scale)
        self._slopes = _slopes(time)
        self._levels = [_gathered(self._slopes)]
        while self._levels[-1].size > 16:
            last = self._levels[-1]
            half = len(last) // 2
            self._levels.append(last.reshape(half, 2, half, 2).mean(axis=(1, 3)))

    def tilt(self, points: Floats, distance: Floats) -> Floats:
        """Return the upward normals of the surface at points (…, 3) of it, calmer with distance."""
        calm = 0.5 / (1.0 + distance * 0.06) * np.maximum(1.0 - distance / _FLAT, 0.0)
        x, z = points[..., 0] * self._frequency, points[..., 2] * self._frequency
        slope = _read(self._slopes, x, z) + _read(self._slopes, z * 0.31, -x * 0.31)
        slope = slope * calm[..., None]
        up = np.ones_like(x)
        return unit(np.stack([-slope[..., 0], up, -slope[..., 1]], axis=-1).astype(np.float32))

    def caustic(self, points: Floats, depth: Floats) -> Floats:
        """Return the brightness of sunlight at points (…, 3), mean 1."""
        light = self._light
        strength = light.caustics * smoothstep(0.0, 2.0, depth / light.caustic_scale)
        strength = strength * 14.0 / (14.0 + np.maximum(depth, 0.0))
        shown = np.ones_like(depth)
        softness = 1 + (np.clip(depth, 0.0, 1e4) * 0.35).astype(int)
        levels = np.minimum(np.log2(softness).astype(int), len(self._levels) - 1)
        for level in np.unique(levels[depth > 0]).tolist():
            there = (levels == level) & (depth > 0)
            shown[there] = self.pattern(points[there], depth[there], level)
        return 1.0 + strength * (shown - 1.0)

    def pattern(self, points: Floats, depth: Floats, level: int) -> Floats:
        """Return the pattern alone, read along the sun's rays; each level halves its detail."""
        sun = self._light.sun_below
        along = depth / sun[1]
        x = (points[..., 0] + sun[0] * along) * self._frequency
        z = (points[..., 2] + sun[2] * along) * self._frequency
        values = self._levels[min(level, len(self._levels) - 1)]
        return _read(values[..., None], x, z)[..., 0]


def _slopes(time: float) -> Floats:
    """Slope along x and z on the tile's grid, (rows, columns, 2)."""
    steps = np.arange(_SIZE) / _SIZE
    slopes = np.zeros((_SIZE, _SIZE, 2))
    for number, (x, z, amplitude, speed) in enumerate(_WAVES):
        column, row = number * 0.37 + x * steps, time * speed + z * steps
        sine = np.sin(2 * np.pi * ((column[None, :] + row[:, None]) % 1.0))
        slopes += sine[..., None] * np.array([x, z]) * (amplitude / np.hypot(x, z))
    return slopes.astype(np.float32)


def _gathered(slopes: Floats) -> Floats:
    """Sunlight thrown by the slopes, gathered on the same grid; mean 1."""
    light = np.zeros(_SIZE * _SIZE)
    throw = _FOCUS * _SIZE
    right, below = np.roll(slopes, -1, axis=1), np.roll(slopes, -1, axis=0)
    rows, columns = np.mgrid[0:_SIZE, 0:_SIZE]
    for u, v in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)):
        here = slopes + (right - slopes) * u + (below - slopes) * v
        x, z = columns + u + here[..., 0] * throw, rows + v + here[..., 1] * throw
        for place, share in _corners(x, z, _SIZE):
            light += np.bincount(place.ravel(), share.ravel() * 0.25, _SIZE * _SIZE)
    return light.reshape(_SIZE, _SIZE).astype(np.float32)


def _corners(x: Floats, z: Floats, size: int) -> list[tuple[NDArray[np.int64], Floats]]:
    """Return the four grid points about places given in grid steps, and their shares."""
    left, top = np.floor(x), np.floor(z)
    u, v = x - left, z - top
    columns = left.astype(np.int64) % size, (left.astype(np.int64) + 1) % size
    rows = top.astype(np.int64) % size, (top.astype(np.int64) + 1) % size
    return [
        (rows[0] * size + columns[0], (1 - u) * (1 - v)),
        (rows[0] * size + columns[1], u * (1 - v)),
        (rows[1] * size + columns[0], (1 - u) * v),
        (rows[1] * size + columns[1], u * v),
    ]


def _read(table: Floats, x: Floats, z: Floats) -> Floats:
    """Values (…, k) of a repeating square table (size, size, k) at places in tiles."""
    size = len(table)
    flat = table.reshape(size * size, -1)
    parts = _corners(x * size, z * size, size)
    total = sum(flat[place] * share[..., None] for place, share in parts)
    return np.asarray(total, np.float32)
