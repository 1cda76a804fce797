"""Filming: the world runs, cameras look, microphones listen; what is finished is never lost.

A film in the making lives in a folder beside its file, `.NAME.partial`: finished segments, and
after each of them the world, the camera and the sounds so far. The same command goes on from there.
"""

from __future__ import annotations

import shutil
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from bioscope import _engine
from bioscope.errors import BioscopeError
from bioscope.files import written_whole
from bioscope.film.encoding import encoder, write_wav
from bioscope.film.operator import Operator
from bioscope.film.options import FilmOptions
from bioscope.film.renderer import renderer

if TYPE_CHECKING:
    from bioscope._engine import Camera, Scene
    from bioscope.film.direction import Shot
    from bioscope.world import World

SAMPLE_RATE = 48_000
_SEGMENT_FRAMES = {"preview": 30, "path": 4}
# A picture's preparation has serial parts, during which another can be painted.
_PICTURES_AHEAD = {"preview": 2, "path": 0}
_SOUND_BLOCK_SECONDS = 1.0

Say = Callable[..., None]


class Progress(msgspec.Struct):
    """Where a film stands after its finished segments."""

    version: str
    seed: int
    title: str
    start_tick: int
    options: FilmOptions
    frames_done: int = 0
    segments: int = 0
    world: bytes = b""
    operator: dict[str, Any] = {}
    sounds: list[dict[str, Any]] = []
    poses: list[tuple[float, tuple[float, ...], tuple[float, ...], bool]] = []


def film_world(
    world: World,
    output: Path | str | None,
    options: FilmOptions,
    *,
    shots: Sequence[Shot] | None = None,
    frames: Path | str | None = None,
    say: Say = print,
) -> None:
    """Film a world with sound.

    Parameters
    ----------
    world
        The world; it runs for the length of the film.
    output
        The MP4 to write; whole or not there. None for pictures only.
    options
        What the film is to be.
    shots
        Its shot list; the world's own if none.
    frames
        Folder for the pictures as PNG files, numbered from 1.
    say
        Called with messages.

    Raises
    ------
    MissingExtraError
        If nothing is installed that writes MP4.
    OSError
        If the file or folder cannot be written.
    """
    output = None if output is None else Path(output)
    folder = None if frames is None else Path(frames)
    if output is not None and not output.parent.is_dir():
        raise FileNotFoundError(f"{output.parent} does not exist: make the folder first")
    if output is not None and output.suffix.lower() != ".mp4":
        raise BioscopeError(f"{output}: expected a name that ends in .mp4")
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    shooting = Shooting(world, output, options, shots, folder, say)
    shooting.shoot()


def seed_of_partial(output: Path | None, frames: Path | None, options: FilmOptions) -> int | None:
    """Return the seed of an interrupted film with these options; none if there is no such one."""
    try:
        progress = _read(_work_folder(output, frames) / "progress")
    except (OSError, msgspec.MsgspecError):
        return None
    return progress.seed if progress.options == options else None


def _work_folder(output: Path | None, frames: Path | None) -> Path:
    if output is not None:
        return output.with_name(f".{output.name}.partial")
    assert frames is not None
    return frames / ".partial"


def _read(path: Path) -> Progress:
    return msgspec.msgpack.decode(path.read_bytes(), type=Progress)


class Shooting:
    """One film being made."""

    def __init__(
        self,
        world: World,
        output: Path | None,
        options: FilmOptions,
        shots: Sequence[Shot] | None,
        frames: Path | None,
        say: Say,
    ) -> None:
        self._world, self._output, self._options, self._frames = world, output, options, frames
        self._say = say
        self._encoder = None if output is None else encoder()
        self._work = _work_folder(output, frames)
        self._operator = Operator(world, options.camera, shots)
        self._renderer = renderer(options)
        self._started = time.perf_counter()
        self._progress = self._begun()

    def _begun(self) -> Progress:
        """Return where the film stands: at its beginning, or where an interrupted one stopped."""
        world = self._world
        fresh = Progress(
            version=_engine.VERSION,
            seed=world.seed,
            title=world.title,
            start_tick=world.tick,
            options=self._options,
        )
        try:
            old = _read(self._work / "progress")
        except (OSError, msgspec.MsgspecError):
            old = fresh
        same = (old.version, old.seed, old.title, old.start_tick, old.options) == (
            fresh.version,
            fresh.seed,
            fresh.title,
            fresh.start_tick,
            fresh.options,
        )
        if not same or not old.frames_done or not self._segments_there(old):
            shutil.rmtree(self._work, ignore_errors=True)
            self._work.mkdir(parents=True)
            return fresh
        world._engine.return_to(old.world)
        self._operator.restore(old.operator)
        self._say(f"going on after {old.frames_done} of {self._options.frame_count} pictures")
        return old

    def _segments_there(self, progress: Progress) -> bool:
        if self._encoder is None:
            return True
        return all(self._segment(number).is_file() for number in range(progress.segments))

    def _segment(self, number: int) -> Path:
        return self._work / f"segment-{number:05}.mp4"

    def shoot(self) -> None:
        """Make what is missing, then join it."""
        total = self._options.frame_count
        length = _SEGMENT_FRAMES[self._options.renderer]
        while self._progress.frames_done < total:
            first = self._progress.frames_done
            self._shoot_segment(first, min(first + length, total))
        if self._output is not None:
            self._join(self._output)
        shutil.rmtree(self._work, ignore_errors=True)
        took = time.perf_counter() - self._started
        made = self._output or self._frames
        self._say(f"{made}: {total} pictures in {took:.1f} s")

    def _shoot_segment(self, first: int, end: int) -> None:
        pictures = self._pictures(first, end)
        if self._encoder is None:
            for _ in pictures:
                pass
        else:
            path = self._segment(self._progress.segments)
            self._encoder.segment(path, pictures, self._options.frames_per_second)
        progress = self._progress
        progress.frames_done, progress.segments = end, progress.segments + 1
        progress.world = self._world._engine.save()
        progress.operator = self._operator.state()
        with written_whole(self._work / "progress") as temporary:
            temporary.write_bytes(msgspec.msgpack.encode(progress))
        took = time.perf_counter() - self._started
        self._say(f"picture {end} of {self._options.frame_count}, {took:.1f} s")

    def _pictures(self, first: int, end: int) -> Iterator[NDArray[np.uint8]]:
        """Run the world from picture to picture and render each; it runs on meanwhile."""
        ahead = _PICTURES_AHEAD[self._options.renderer]
        making: deque[Future[NDArray[np.uint8]]] = deque()
        with ThreadPoolExecutor(max(ahead, 1)) as pool:
            for number in range(first, end):
                camera = self._advance(number)
                making.append(pool.submit(self._picture, number, self._world.scene, camera))
                while len(making) > ahead:
                    yield making.popleft().result()
            for picture in making:
                yield picture.result()

    def _advance(self, number: int) -> Camera:
        """Run the world to the time of a picture; return the camera for it."""
        world, rate = self._world, self._options.frames_per_second
        due = self._progress.start_tick + round(number / rate / world.dt)
        while world.tick < due:
            world.step()
            self._progress.sounds.extend(world.sounds)
        camera, cut = self._operator.camera(number / rate, 1 / rate)
        pose = (number / rate, tuple(camera.position), tuple(camera.rotation), cut)
        self._progress.poses.append(pose)
        return camera

    def _picture(self, number: int, scene: Scene, camera: Camera) -> NDArray[np.uint8]:
        picture = self._renderer.render(scene, camera)
        if self._frames is not None:
            path = self._frames / f"frame-{number + 1:05}.png"
            with written_whole(path) as temporary:
                temporary.write_bytes(_engine.encode_png(picture))
        return picture

    def _join(self, output: Path) -> None:
        assert self._encoder is not None
        sound = self._work / "sound.wav"
        write_wav(sound, self._sound_blocks(), SAMPLE_RATE)
        segments = [self._segment(number) for number in range(self._progress.segments)]
        with written_whole(output) as temporary:
            self._encoder.join(segments, sound, temporary)

    def _sound_blocks(self) -> Iterator[NDArray[np.float32]]:
        """Render the sound track as heard at the camera, a second at a time."""
        progress, world = self._progress, self._world
        start = progress.start_tick * world.dt
        under_water = world.scene.medium["surface"] is not None
        track = _engine.SoundTrack(SAMPLE_RATE, world.seed, under_water)
        track.add(progress.sounds)
        for seconds, position, rotation, cut in progress.poses:
            x, y, z = position
            qx, qy, qz, qw = rotation
            track.listen(start + seconds, (x, y, z), (qx, qy, qz, qw), cut)
        total = round(self._options.frame_count / self._options.frames_per_second * SAMPLE_RATE)
        block = round(_SOUND_BLOCK_SECONDS * SAMPLE_RATE)
        for first in range(0, total, block):
            yield track.render(start + first / SAMPLE_RATE, min(block, total - first))
