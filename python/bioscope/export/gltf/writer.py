"""A take as a binary glTF file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bioscope.export.gltf.animation import Animation, placement
from bioscope.export.gltf.batches import Batches
from bioscope.export.gltf.container import Container
from bioscope.export.gltf.materials import Materials
from bioscope.export.gltf.meshes import Meshes
from bioscope.export.gltf.recording import Recording
from bioscope.export.lights import from_minus_z
from bioscope.files import written_whole
from bioscope.geometry.balls import Balls

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from bioscope._engine import Batch, Camera, Scene
    from bioscope.export.take import Frame, Take

_SUN = "KHR_lights_punctual"


def write_glb(take: Take, path: Path, say: Callable[[str], object]) -> None:
    """Run a take and write it; see `bioscope.export.export_world`."""
    with written_whole(path) as temporary:
        gathering = Gathering()
        for frame in take.frames():
            gathering.add(frame)
        times = (np.arange(take.frame_count) / take.frames_per_second).astype(np.float32)
        gathering.write(temporary, times, take.world.seed, say)


class Gathering:
    """All that a take shows, gathered frame by frame."""

    def __init__(self) -> None:
        self._recordings: dict[tuple[str, str], Recording] = {}
        self._cameras: dict[str, list[tuple[int, Camera]]] = {}
        self._scene: Scene | None = None

    def add(self, frame: Frame) -> None:
        """Take in a frame."""
        scene = frame.scene
        self._scene = self._scene or scene
        for batch in scene.batches:
            if len(batch.ids) and len(batch.mesh.triangles):
                self._record(("batch", batch.name), frame.number, batch)
        for points in scene.points:
            if len(points.ids):
                self._record(("points", points.name), frame.number, Balls(points))
        for name, camera in frame.cameras.items():
            self._cameras.setdefault(name, []).append((frame.number, camera))

    def _record(self, key: tuple[str, str], frame: int, batch: Batch | Balls) -> None:
        if key not in self._recordings:
            self._recordings[key] = Recording(batch)
        self._recordings[key].add(frame, batch)

    def write(
        self, path: Path, times: NDArray[np.float32], seed: int, say: Callable[[str], object]
    ) -> None:
        """Write the file."""
        assert self._scene is not None
        container = Container()
        animation = Animation(container, times)
        parts = Materials(container), Meshes(container)
        batches = Batches(container, animation, *parts, times, say)
        for recording in self._recordings.values():
            batches.write(recording)
        roots = batches.roots
        for name, track in self._cameras.items():
            roots.append(_camera(container, animation, name, track, len(times)))
        roots.append(_sun(container, self._scene))
        animation.write("take")
        medium = {name: value for name, value in self._scene.medium.items() if value is not None}
        extras = {"seed": seed, "start_seconds": self._scene.time, "medium": medium}
        container.write(path, {"name": "world", "nodes": roots, "extras": extras})


def _camera(
    container: Container,
    animation: Animation,
    name: str,
    track: list[tuple[int, Camera]],
    frame_count: int,
) -> int:
    """Write a camera; where it has no subject it stays where it was."""
    first = track[0][1]
    lens = {"yfov": min(first.field_of_view, 2.6), "znear": first.near, "zfar": first.far}
    camera = container.add("cameras", {"name": name, "type": "perspective", "perspective": lens})
    values = np.zeros((frame_count, 8), np.float32)
    numbers = np.searchsorted([frame for frame, _ in track], np.arange(frame_count), "right") - 1
    for frame, number in enumerate(np.maximum(numbers, 0).tolist()):
        seen = track[number][1]
        values[frame] = [*seen.position, 1.0, *seen.rotation]
    node = container.add("nodes", {"name": name, "camera": camera, **placement(values[0])})
    animation.transform(node, values, np.ones(frame_count, bool))
    return node


def _sun(container: Container, scene: Scene) -> int:
    """Write the sun; its intensity is the scene's irradiance, as the other lights of the scene."""
    color = np.array(scene.sun["color"])
    peak = max(float(color.max()), 1e-9)
    light = {
        "name": "sun",
        "type": "directional",
        "color": (color / peak).tolist(),
        "intensity": peak,
    }
    container.extensions.add(_SUN)
    container.shared[_SUN] = {"lights": [light]}
    turn = from_minus_z(-np.array(scene.sun["direction"], np.float64))
    entry = {"name": "sun", "rotation": turn.tolist(), "extensions": {_SUN: {"light": 0}}}
    return container.add("nodes", entry)
