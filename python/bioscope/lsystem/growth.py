"""A film of one plant that grows up, from nothing to its last step."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bioscope.errors import InvalidValueError
from bioscope.film import FilmOptions, film_world
from bioscope.lsystem.lsystem import LSystem
from bioscope.lsystem.specimen import (
    HAZELESS,
    VIEW_DEGREES,
    Specimen,
    camera,
    floor,
    levels,
    shape,
    surroundings,
)
from bioscope.lsystem.turtle import Turtle
from bioscope.populations.place import Disk, Habitat
from bioscope.populations.plants import Plants
from bioscope.world import World

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from bioscope.environments import Environment

_GROWING = 0.85
"""Share of the film in which the plant grows; then it is there to be looked at."""
_TICKS_PER_SECOND = 30
_STAGES = (0.5, 0.8)
"""Ages, as shares of the last, at which the plant must fit into the picture too."""


def film_growth(
    path: Path,
    output: Path,
    *,
    seconds: float = 8.0,
    size: tuple[int, int] = (960, 960),
    steps: int | None = None,
    seed: int = 1,
    say: Callable[..., None] = print,
) -> None:
    """Film a plant that grows from its axiom to its last step, without jumps between the steps.

    Parameters
    ----------
    path
        The L-system file; what surrounds the plant is what the file asks for.
    output
        The MP4 to write; whole or not there. An interrupted film goes on where it stopped.
    seconds, size
        Length of the film, and its width and height in pixels.
    steps
        Derivation steps of the complete plant; as many as the file says if not given.
    seed, say
        Seed of the plant; called with messages.

    Raises
    ------
    InvalidValueError
        If it has no step to grow in.
    FormatError
        If the model is wrong, or draws nothing.
    """
    system = LSystem.read(path)
    steps = system.steps if steps is None else steps
    if steps < 1:
        raise InvalidValueError(f"{path}: expected a model of one step or more to film its growth")
    options = FilmOptions(seconds=seconds, size=size, camera="portrait")
    around = surroundings(system)
    points = _reached(path, system, steps, seed, around)
    world = _stage(points, size[0] / size[1], seed)
    # What the last step makes grows for as long as a step lasts.
    pace = (steps + 1) / (seconds * _GROWING)
    world.add(
        Plants(
            path,
            1,
            rate=pace,
            steps=steps,
            size=min(1.0, HAZELESS / _extent(points)),
            unfold=pace < _TICKS_PER_SECOND,
            habitat=Habitat(area=Disk((0.0, 0.0), 1e-3)),
            turned=False,
            variety=0.0,
            flexibility=0.0,
            levels=levels(around) or None,
        )
    )
    film_world(world, output, options, say=say)


def _reached(
    path: Path, system: LSystem, steps: int, seed: int, around: Environment | None
) -> NDArray[np.float32]:
    """Return points (n, 3) that the plant reaches while it grows, metres."""
    points = [shape(path, system, steps, seed, environment=around).positions]
    if not system.environment:
        for age in _STAGES:
            drawn = Turtle().interpret(system.derive(max(1, round(age * steps)), seed))
            points.append(drawn.mesh().positions)
    return np.concatenate(points)


def _extent(points: NDArray[np.float32]) -> float:
    return max(float(np.linalg.norm(np.ptp(points, axis=0))), 1e-3)


def _stage(points: NDArray[np.float32], aspect: float, seed: int) -> World:
    """Return a world with a floor and a camera before which all points have room."""
    points = points * np.float32(min(1.0, HAZELESS / _extent(points)))
    low, high = points.min(axis=0), points.max(axis=0)
    world = World(seed=seed, dt=1 / _TICKS_PER_SECOND, title="growth")
    world.add(Specimen(floor((low + high) / 2, min(float(low[1]), 0.0), _extent(points)), "floor"))
    place, target = camera(points, aspect)
    world.cameras.fixed("portrait", position=place, target=target, field_of_view=VIEW_DEGREES)
    return world
