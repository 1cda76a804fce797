"""Renderers: a scene and a camera in, a picture out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from bioscope import _engine

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from bioscope._engine import Camera, Scene
    from bioscope.film.options import FilmOptions


class Renderer(Protocol):
    """Turns a scene seen by a camera into a picture."""

    def render(self, scene: Scene, camera: Camera) -> NDArray[np.uint8]:
        """Return the picture: (height, width, 3) sRGB bytes."""


class PreviewRenderer:
    """The rasterizer of the animals' eyes, with shadows and smooth edges."""

    def __init__(self, size: tuple[int, int]) -> None:
        self._size = size
        self._rasterizer = _engine.Rasterizer(picture=True)

    def render(self, scene: Scene, camera: Camera) -> NDArray[np.uint8]:
        """Return the picture: (height, width, 3) sRGB bytes."""
        return self._rasterizer.picture(scene, camera, *self._size)


def renderer(options: FilmOptions) -> Renderer:
    """Return the renderer that the options name."""
    if options.renderer == "path":
        from bioscope.film.path import PathRenderer

        return PathRenderer(options.size, samples=options.samples)
    return PreviewRenderer(options.size)
