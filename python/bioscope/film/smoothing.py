"""Taking the noise out of soft light: an edge-avoiding filter guided by the forms.

After Dammertz, Sewtz, Hanika and Lensch (2010), "Edge-Avoiding À-Trous Wavelet Transform for fast
Global Illumination Filtering": a 5 x 5 binomial kernel spread wider at every level, its weights
lowered where normals or distances differ.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.floating]

_KERNEL = (1 / 16, 4 / 16, 6 / 16, 4 / 16, 1 / 16)


def smoothed(light: Floats, normals: Floats, distances: Floats, levels: int) -> Floats:
    """Return irradiance (rows, columns, 3) with less noise.

    Parameters
    ----------
    light
        What is to be smoothed, without the surfaces' own colors.
    normals, distances
        Of what each pixel sees, (rows, columns, 3) and (rows, columns).
    levels
        Each doubles the reach, which begins with 2 pixels.
    """
    for level in range(levels):
        light = _level(light, normals, distances, 1 << level)
    return light


def facing(places: Floats) -> Floats:
    """Return the unit normals (rows, columns, 3) of the surfaces through places."""
    down, across = (np.gradient(places, axis=axis) for axis in (0, 1))
    normals = np.cross(down, across)
    lengths = np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.asarray(normals / np.maximum(lengths, 1e-12), np.float32)


def _level(light: Floats, normals: Floats, distances: Floats, step: int) -> Floats:
    # Separable: not exactly the two-dimensional kernel, but a fifth of its work.
    for axis in (0, 1):
        padded = [_padded(values, 2 * step, axis) for values in (light, normals, distances)]
        total, weights = np.zeros_like(light), np.zeros_like(distances)
        scale = np.float32(50.0 / step) / np.maximum(distances, np.float32(1e-3))
        for place, share in enumerate(_KERNEL):
            near, turned, far = (
                _slice(values, place * step, light.shape[axis], axis) for values in padded
            )
            alike = np.maximum(np.einsum("ijk,ijk->ij", turned, normals), np.float32(0.0))
            for _ in range(4):
                alike *= alike
            apart = (far - distances) * scale
            weight = alike * np.float32(share) / (1 + apart * apart)
            total += near * weight[..., None]
            weights += weight
        there = weights > 1e-6
        mean: Floats = total / np.maximum(weights, 1e-6)[..., None]
        light = np.where(there[..., None], mean, light)
    return light


def _padded(values: Floats, width: int, axis: int) -> Floats:
    """Values with the edges repeated along an axis."""
    widths = [(0, 0)] * values.ndim
    widths[axis] = (width, width)
    return np.pad(values, widths, mode="edge")


def _slice(values: Floats, start: int, count: int, axis: int) -> Floats:
    """Return a part along one of the first two axes, as a view."""
    return values[start : start + count] if axis == 0 else values[:, start : start + count]
