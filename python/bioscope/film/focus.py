"""Where the lens is focused: on what lives, is near the middle and large in the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bioscope.geometry.transforms import conjugate, rotated

if TYPE_CHECKING:
    from bioscope._engine import Camera, Scene

_NEAREST = 0.1
_ATTENTION = 0.35
"""Share of the angle of view within which a subject is sought, as a standard deviation."""


def focus_distance(scene: Scene, camera: Camera) -> float | None:
    """Return the distance in metres along the view axis; none if nothing alive is in view.

    A weighted mean over all that is alive, so that it moves smoothly as the animals do.
    """
    turn = conjugate(np.array(camera.rotation, np.float64))
    total = weights = 0.0
    for batch in scene.batches:
        if not batch.alive or not len(batch.ids):
            continue
        places = batch.positions.astype(np.float64) - np.array(camera.position)
        inward = rotated(turn, places)
        ahead = -inward[:, 2]
        there = ahead > _NEAREST
        if not there.any():
            continue
        inward, ahead = inward[there], ahead[there]
        extent = float(np.ptp(batch.mesh.positions, axis=0).max())
        size = extent * batch.scales[there] / ahead
        off = np.hypot(inward[:, 0], inward[:, 1]) / ahead / (_ATTENTION * camera.field_of_view)
        weight = size**2 * np.exp(-0.5 * off**2)
        total += float(weight @ np.log(ahead))
        weights += float(weight.sum())
    return float(np.exp(total / weights)) if weights > 1e-9 else None
