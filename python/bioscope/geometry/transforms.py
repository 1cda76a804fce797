"""Arrays of similarities as the scene has them: x, y, z, scale, qx, qy, qz, qw in the last axis."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.floating]

IDENTITY = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
"""Leaves everything where it is."""


def rotated(rotations: Floats, vectors: Floats) -> Floats:
    """Return vectors (…, 3) turned by unit quaternions (…, 4) xyzw."""
    axis, real = rotations[..., :3], rotations[..., 3:]
    twice = 2.0 * _cross(axis, vectors)
    turned: Floats = vectors + real * twice + _cross(axis, twice)
    return turned


def _cross(a: Floats, b: Floats) -> Floats:
    """Return the cross product of vectors (…, 3); quicker than numpy's for few."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def product(first: Floats, second: Floats) -> Floats:
    """Return the rotations (…, 4) that turn by `second`, then by `first`."""
    a, b = first[..., :3], second[..., :3]
    p, q = first[..., 3:], second[..., 3:]
    real = p * q - np.sum(a * b, axis=-1, keepdims=True)
    return np.concatenate([p * b + q * a + _cross(a, b), real], axis=-1)


def conjugate(rotations: Floats) -> Floats:
    """Return the rotations (…, 4) that turn back."""
    return rotations * np.array([-1.0, -1.0, -1.0, 1.0], rotations.dtype)


def composed(outer: Floats, inner: Floats) -> Floats:
    """Return the similarities (…, 8): first `inner`, then `outer`."""
    scale = outer[..., 3:4]
    position = outer[..., :3] + rotated(outer[..., 4:], scale * inner[..., :3])
    rotation = product(outer[..., 4:], inner[..., 4:])
    return np.concatenate([position, scale * inner[..., 3:4], rotation], axis=-1)


def inverse(transforms: Floats) -> Floats:
    """Return the similarities (…, 8) that undo these."""
    scale, back = 1.0 / transforms[..., 3:4], conjugate(transforms[..., 4:])
    position = -scale * rotated(back, transforms[..., :3])
    return np.concatenate([position, scale, back], axis=-1)


def matrices(transforms: Floats) -> Floats:
    """Return the matrices (…, 3, 4) of similarities (…, 8), to be applied to columns."""
    axes = np.broadcast_to(np.eye(3, dtype=transforms.dtype), (*transforms.shape[:-1], 3, 3))
    rows = rotated(transforms[..., None, 4:], axes) * transforms[..., None, 3:4]
    return np.concatenate([np.swapaxes(rows, -1, -2), transforms[..., :3, None]], axis=-1)


def relative_to_parents(transforms: Floats, parents: list[int | None]) -> Floats:
    """Return joint transforms (…, joints, 8) relative to their parents; roots stay as they are."""
    local = np.array(transforms)
    children = [number for number, parent in enumerate(parents) if parent is not None]
    above = [parent for parent in parents if parent is not None]
    if children:
        inside = inverse(transforms[..., above, :])
        local[..., children, :] = composed(inside, transforms[..., children, :])
    return local
