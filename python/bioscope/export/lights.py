"""Sun and sky in the terms of files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SKY_ROWS = 64


def from_minus_z(direction: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return the shortest rotation (xyzw) that takes −Z to a unit vector."""
    axis = np.cross([0.0, 0.0, -1.0], direction)
    turn = np.append(axis, 1.0 - direction[2])
    length = float(np.linalg.norm(turn))
    return np.array([0.0, 1.0, 0.0, 0.0]) if length < 1e-9 else turn / length


def sky_picture(sky: dict[str, Any]) -> tuple[NDArray[np.uint8], float]:
    """Return the sky as an sRGB picture of all directions, rows from straight up, and its peak."""
    rise = np.cos(np.pi * (np.arange(_SKY_ROWS) + 0.5) / _SKY_ROWS)[:, None]
    zenith, level, nadir = (np.array(sky[name]) for name in ("zenith", "horizon", "nadir"))
    above = level + (zenith - level) * np.sqrt(np.maximum(rise, 0))
    below = level + (nadir - level) * np.minimum(-rise * 4, 1)
    radiance = np.where(rise > 0, above, below)
    peak = max(float(radiance.max()), 1e-9)
    rows = np.rint(srgb(radiance / peak) * 255).astype(np.uint8)
    return np.repeat(rows[:, None, :], 2 * _SKY_ROWS, axis=1), peak


def srgb(linear: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return linear values 0 to 1 as sRGB ones."""
    low = linear * 12.92
    high = 1.055 * np.power(np.maximum(linear, 1e-9), 1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, low, high)
