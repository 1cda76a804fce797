"""The ground that a camera is not to sink into."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bioscope import _engine

if TYPE_CHECKING:
    from bioscope._engine import Camera, Mesh, Scene

_CELL, _WIDEST = 0.25, 200.0
"""Side of a cell of the map, and of the largest map, metres: wider grounds have corners so far
apart that they do not tell how high it is between them."""
_DOWN, _UP = 0.2, 0.2
"""Largest share of the area of a ground that faces down, and least that is seen from above."""
_MARGIN = 2
"""Cells round the ground that are on the map too."""
_CLEARANCE = 0.15
"""Least height of a lens over the ground, metres."""
_AROUND = (-1, 0, 1)


class Ground:
    """How high the ground of a scene is, by the corners of what was built where it stands."""

    def __init__(self, scene: Scene) -> None:
        still = [one for one in scene.batches if not one.alive and len(one.ids) == 1]
        meshes = [one.mesh for one in still if _is_unmoved(one.transforms[0])]
        built = [one.positions for one in meshes if _faces_up(one)]
        corners = np.concatenate([np.zeros((0, 3), np.float32), *built]).astype(float)
        if len(corners) and np.ptp(corners, axis=0).max() > _WIDEST:
            corners = corners[:0]
        low = corners[:, [0, 2]].min(axis=0) if len(corners) else np.zeros(2)
        high = corners[:, [0, 2]].max(axis=0) if len(corners) else np.zeros(2)
        self._low = low - _MARGIN * _CELL
        size = (high - self._low) / _CELL
        cells = np.full(size.astype(int) + 2 * _MARGIN, -np.inf)
        rows, columns = ((corners[:, [0, 2]] - self._low) / _CELL).astype(int).T
        np.maximum.at(cells, (rows, columns), corners[:, 1])
        shifted = [np.roll(cells, (one, other), (0, 1)) for one in _AROUND for other in _AROUND]
        # The highest of what is near each cell.
        self._heights = np.max(shifted, axis=0)

    def height(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the height of what is highest near places (n x 3), metres; -inf off the ground."""
        at = (places[:, [0, 2]] - self._low) / _CELL - 0.5
        corner = np.floor(at).astype(int)
        far = np.array(self._heights.shape) - 2
        inside = np.equal(corner, np.clip(corner, 0, far)).all(axis=1)
        row, column = np.where(inside[:, None], corner, 0).T
        u, v = (at - corner).T
        heights = [self._heights[row + i, column + j] for i in (0, 1) for j in (0, 1)]
        weights = [(1 - u) * (1 - v), (1 - u) * v, u * (1 - v), u * v]
        highest = np.max(heights, axis=0)
        known = inside & np.isfinite(highest)
        found = np.zeros(len(places))
        for one, weight in zip(heights, weights, strict=True):
            found += weight * np.where(np.isfinite(one), one, np.where(known, highest, 0.0))
        return np.where(known, found, -np.inf)

    def above(self, camera: Camera) -> Camera:
        """Return the camera, lifted if it is in the ground or just over it."""
        x, y, z = camera.position
        least = float(self.height(np.array([[x, y, z]], float))[0]) + _CLEARANCE
        if y >= least:
            return camera
        return _engine.Camera((x, least, z), camera.rotation, camera.field_of_view)


def _faces_up(mesh: Mesh) -> bool:
    """Whether a mesh is a sheet seen from above: no wall, no roof, no body."""
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles.reshape(-1, 3)].astype(float), 1, 0)
    areas = np.cross(b - a, c - a)
    whole, up = np.linalg.norm(areas, axis=1).sum(), areas[:, 1]
    down = np.minimum(up, 0.0).sum()
    return bool(down >= -_DOWN * whole and up.sum() > _UP * whole)


def _is_unmoved(transform: NDArray[np.float32]) -> bool:
    return np.array_equal(transform, [0, 0, 0, 1, 0, 0, 0, 1])
