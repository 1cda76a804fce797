"""A take: the world running, sampled frame by frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from bioscope.errors import InvalidValueError
from bioscope.film.operator import overview

if TYPE_CHECKING:
    from collections.abc import Iterator

    from bioscope._engine import Camera, Scene
    from bioscope.world import World

_LONGEST_SECONDS = 24 * 3600
_HIGHEST_RATE = 240


@dataclass(frozen=True)
class Frame:
    """One sample of a take."""

    number: int
    """From 0."""
    seconds: float
    """Since the beginning of the take."""
    scene: Scene
    cameras: dict[str, Camera]
    """Where each camera of the world is; a camera without a subject is not here."""


class Take:
    """A length of a world's time, sampled at its beginning, its end and evenly between."""

    def __init__(self, world: World, seconds: float, frames_per_second: float) -> None:
        if not 0 < seconds <= _LONGEST_SECONDS:
            raise InvalidValueError(f"seconds = {seconds}: expected more than 0, up to a day")
        if not 0 < frames_per_second <= _HIGHEST_RATE:
            expected = f"expected more than 0, up to {_HIGHEST_RATE}"
            raise InvalidValueError(f"frames per second = {frames_per_second}: {expected}")
        self.world, self.frames_per_second = world, frames_per_second
        self.frame_count = max(1, round(seconds * frames_per_second)) + 1
        """Samples, the one at the end included."""

    def frames(self) -> Iterator[Frame]:
        """Run the world and yield its frames; each is the state at the nearest tick."""
        world, start = self.world, self.world.tick
        cameras: dict[str, Camera] = {}
        for number in range(self.frame_count):
            seconds = number / self.frames_per_second
            due = start + round(seconds / world.dt)
            world.step(due - world.tick)
            cameras = self._cameras(cameras)
            yield Frame(number, seconds, world.scene, cameras)

    def _cameras(self, previous: dict[str, Camera]) -> dict[str, Camera]:
        names = list(self.world.cameras)
        if not names:
            return previous or {"overview": overview(self.world)}
        dt = 1 / self.frames_per_second
        found = {name: self.world.cameras.now(name, previous.get(name), dt) for name in names}
        return {name: camera for name, camera in found.items() if camera is not None}
