"""Stills: what a camera of a world sees now."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bioscope import _engine
from bioscope.files import written_whole
from bioscope.film.direction import Shot
from bioscope.film.operator import Operator
from bioscope.film.options import FilmOptions
from bioscope.film.renderer import renderer as renderer_of

if TYPE_CHECKING:
    from bioscope.world import World


def take_still(
    world: World,
    output: Path | str,
    camera: str | Shot | None = None,
    *,
    size: tuple[int, int] = (1280, 720),
    renderer: str = "preview",
) -> None:
    """Write what a camera sees now to a PNG file.

    Parameters
    ----------
    world
        The world; it does not run on.
    output
        The file, whole or not there.
    camera
        A camera of the world, or a shot; the first of its shot list if none.
    size
        Width and height in pixels, both even.
    renderer
        `preview` or `path`.

    Raises
    ------
    UnknownNameError
        If the world has no such camera.
    InvalidValueError
        If an option makes no sense.
    """
    named, shots = (None, [camera]) if isinstance(camera, Shot) else (camera, None)
    options = FilmOptions(seconds=1.0, size=size, renderer=renderer, camera=named)
    view, _ = Operator(world, named, shots).camera(0.0, 0.0)
    picture = renderer_of(options).render(world.scene, view)
    with written_whole(Path(output)) as temporary:
        temporary.write_bytes(_engine.encode_png(picture))
