"""A definition file as it runs, before its own camera: to a film, or to a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bioscope.errors import FormatError, InvalidValueError
from bioscope.film import FilmOptions, film_world, take_still
from bioscope.lsystem.specimen import FLOOR, floor
from bioscope.populations.animated import Animated
from bioscope.populations.scenery import Props
from bioscope.world import World

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_RATES = (1.0, 60.0)
"""Least and most pictures per second of a film."""


def show_animation(
    path: Path,
    output: Path,
    *,
    seconds: float = 8.0,
    size: tuple[int, int] = (960, 960),
    seed: int | None = None,
    say: Callable[..., None] = print,
) -> None:
    """Film a definition file that runs, or take a picture of it after some seconds.

    Parameters
    ----------
    path
        The definition; its camera looks on.
    output
        The .mp4 or .png to write; whole or not there.
    seconds, size
        Length of the film, and width and height in pixels.
    seed, say
        Of chance, the definition's own if not given; called with messages.

    Raises
    ------
    InvalidValueError
        For another suffix.
    FormatError
        If the definition is wrong, or draws nothing.
    """
    if output.suffix not in (".mp4", ".png"):
        raise InvalidValueError(f"{output}: expected a name that ends in .mp4 or .png")
    animated = Animated(path, seed=seed)
    world = stage(animated, path.stem)
    if output.suffix == ".png":
        world.run(seconds)
        take_still(world, output, "own", size=size)
        return
    rate = min(max(1 / world.dt, _RATES[0]), _RATES[1])
    options = FilmOptions(seconds=seconds, size=size, frames_per_second=rate, camera="own")
    film_world(world, output, options, say=say)


def stage(animated: Animated, name: str) -> World:
    """Return a world with an animation of this name, a floor below it, and its own camera `own`.

    Raises
    ------
    FormatError
        If the animation draws nothing.
    """
    animation = animated.animation
    points = np.array(list(animation.frame.points()), np.float32)
    if not len(points):
        raise FormatError(f"{name}: nothing to see: the turtle draws neither shapes nor strokes")
    low, high = points.min(axis=0), points.max(axis=0)
    size = float(np.linalg.norm(high - low))
    # A little lower than what lies on the ground.
    ground = floor((low + high) / 2, min(float(low[1]), 0.0) - 0.001 * size, size)
    world = World(seed=animation.seed, dt=animation.interval, title=name)
    world.add(Props(ground.positions, ground.triangles, species="floor", color=FLOOR), "floor")
    world.add(animated, name)
    camera = animation.camera
    world.cameras.fixed(
        "own", position=camera.eye, target=camera.target, field_of_view=camera.angle
    )
    return world
