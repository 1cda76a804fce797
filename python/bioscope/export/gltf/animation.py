"""The one animation of a file; what stays as it is has no channel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope.export.gltf.container import Container

_TOLERANCE = {"translation": 2e-6, "rotation": 1e-6, "scale": 1e-6}
"""Changes below this are rounding (metres, quaternion parts, factors)."""


class Animation:
    """Samplers and channels over the frames of a take."""

    def __init__(self, container: Container, times: NDArray[np.float32]) -> None:
        self._container, self._times = container, times
        self._inputs: dict[bytes, int] = {}
        self._samplers: list[dict[str, Any]] = []
        self._channels: list[dict[str, Any]] = []

    def transform(self, node: int, values: NDArray[np.float32], shown: NDArray[np.bool_]) -> None:
        """Move a node by transforms (frames, 8); it has scale 0 while not `shown`."""
        self._smooth(node, "translation", values[:, :3])
        self._smooth(node, "rotation", continuous(values[:, 4:]))
        scales = np.repeat(values[:, 3:4], 3, axis=1)
        if shown.all():
            self._smooth(node, "scale", scales)
        else:
            self._stepped(node, "scale", scales * shown[:, None])

    def _smooth(self, node: int, path: str, values: NDArray[np.float32]) -> None:
        if np.abs(values - values[0]).max() > _TOLERANCE[path]:
            self.channel(node, path, self._times, values)

    def _stepped(self, node: int, path: str, values: NDArray[np.float32]) -> None:
        changes = np.abs(np.diff(values, axis=0)).max(axis=1) > _TOLERANCE[path]
        kept = np.flatnonzero(np.concatenate([[True], changes]))
        self.channel(node, path, self._times[kept], values[kept], "STEP")

    def channel(
        self,
        node: int,
        path: str,
        times: NDArray[np.float32],
        values: NDArray[np.float32],
        interpolation: str = "LINEAR",
    ) -> None:
        """Add a channel of keyframes."""
        key = times.tobytes()
        if key not in self._inputs:
            self._inputs[key] = self._container.numbers(times.astype(np.float32), bounds=True)
        output = self._container.numbers(values.astype(np.float32))
        sampler = {"input": self._inputs[key], "output": output, "interpolation": interpolation}
        self._samplers.append(sampler)
        target = {"node": node, "path": path}
        self._channels.append({"sampler": len(self._samplers) - 1, "target": target})

    def write(self, name: str) -> None:
        """Put the animation into the file, if anything moves."""
        if self._channels:
            entry = {"name": name, "samplers": self._samplers, "channels": self._channels}
            self._container.add("animations", entry)


def continuous(rotations: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return unit quaternions (n, 4) with signs such that each is near the one before."""
    signs = np.where(np.sum(rotations[1:] * rotations[:-1], axis=1) < 0, -1.0, 1.0)
    flips = np.concatenate([[1.0], np.cumprod(signs)])[:, None]
    lengths = np.linalg.norm(rotations.astype(np.float64), axis=1, keepdims=True)
    return np.asarray(rotations * flips / lengths, np.float32)


def placement(transform: NDArray[np.float32]) -> dict[str, Any]:
    """Return the properties of a node placed by a transform (8,)."""
    entry: dict[str, Any] = {}
    if transform[:3].any():
        entry["translation"] = transform[:3].tolist()
    rotation = continuous(transform[None, 4:])[0]
    if abs(rotation[3]) < 1.0:
        entry["rotation"] = rotation.tolist()
    if transform[3] != 1.0:
        entry["scale"] = [float(transform[3])] * 3
    return entry
