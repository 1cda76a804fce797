"""The synthetic eye: colour, depth and identity of a scene in one pass."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bioscope import _engine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from bioscope._engine import Camera, Scene

_local = threading.local()


@dataclass(frozen=True, slots=True)
class View:
    """What an eye sees; rows from the top."""

    color: NDArray[np.float32]
    """Linear radiance (height, width, 3), RGB."""
    depth: NDArray[np.float32]
    """Distance along each pixel's ray (height, width) in metres; infinite where nothing is."""
    identity: NDArray[np.uint32]
    """Id of what is seen (height, width), as in the scene; 0 where nothing is."""

    def picture(self, exposure: float = 1.0, *, alpha: bool = False) -> NDArray[np.uint8]:
        """Return the color for a screen: (height, width, 3 or 4) sRGB bytes, tone-mapped."""
        light = 1.0 - np.exp(-1.4 * exposure * np.maximum(self.color, 0.0))
        display = np.where(light < 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
        pixels = (display * 255.0 + 0.5).astype(np.uint8)
        if not alpha:
            return pixels
        opaque = np.full((*pixels.shape[:2], 1), 255, np.uint8)
        return np.concatenate([pixels, opaque], axis=2)


def look(scene: Scene, camera: Camera, size: tuple[int, int] = (64, 64)) -> View:
    """Look at a scene through a camera.

    Parameters
    ----------
    scene
        What to look at: `world.scene`.
    camera
        From where and how: perspective, or equidistant fish-eye up to 300 degrees.
    size
        Width and height in pixels.

    Examples
    --------
    >>> import bioscope as bio
    >>> world = bio.World(seed=1)
    >>> camera = bio.Camera.looking_at((0, 1, 5), (0, 0, 0), 0.8)
    >>> bio.look(world.scene, camera, (32, 24)).identity.shape
    (24, 32)
    """
    return look_many(scene, [camera], size)[0]


def look_many(scene: Scene, cameras: Sequence[Camera], size: tuple[int, int]) -> list[View]:
    """Look at a scene through many cameras at once, in parallel; see `look`."""
    width, height = size
    return [View(*arrays) for arrays in _rasterizer().look(scene, list(cameras), width, height)]


def _rasterizer() -> _engine.Rasterizer:
    """Return this thread's rasterizer, which remembers meshes and textures between looks."""
    rasterizer: _engine.Rasterizer | None = getattr(_local, "rasterizer", None)
    if rasterizer is None:
        rasterizer = _local.rasterizer = _engine.Rasterizer()
    return rasterizer
