"""A ball of triangles."""

from __future__ import annotations

import numpy as np

from bioscope._engine import Mesh


def ball(rings: int = 4, columns: int = 8) -> Mesh:
    """Return a sphere of radius 1 about the origin, with this many bands from pole to pole."""
    rise = np.pi * np.arange(1, rings) / rings
    turn = 2 * np.pi * np.arange(columns) / columns
    ring = np.stack([np.sin(turn), np.zeros(columns), np.cos(turn)], axis=1)
    bands = np.sin(rise)[:, None, None] * ring + np.cos(rise)[:, None, None] * [0.0, 1.0, 0.0]
    points = np.concatenate([[[0.0, 1.0, 0.0]], bands.reshape(-1, 3), [[0.0, -1.0, 0.0]]])
    return Mesh(
        points.astype(np.float32),
        np.array(_triangles(rings, columns), np.uint32),
        normals=points.astype(np.float32),
    )


def _triangles(rings: int, columns: int) -> list[tuple[int, int, int]]:
    last = (rings - 1) * columns + 1
    found = []
    for column in range(columns):
        following = (column + 1) % columns
        found.append((0, 1 + column, 1 + following))
        for ring in range(rings - 2):
            a, b = 1 + ring * columns + column, 1 + ring * columns + following
            found += [(a, a + columns, b), (b, a + columns, b + columns)]
        bottom = last - columns
        found.append((last, bottom + following, bottom + column))
    return found
