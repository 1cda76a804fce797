"""What one batch did during a take, gathered frame by frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bioscope.errors import LimitError
from bioscope.export.individuals import Slots, keys
from bioscope.geometry.palette import Palette
from bioscope.geometry.skinning import parents, rest_pose
from bioscope.geometry.transforms import relative_to_parents

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Batch, Mesh
    from bioscope.geometry.balls import Balls

_MOST_BYTES = 2**30
"""Motion of one batch kept in memory."""


class Recording:
    """All frames of one batch."""

    def __init__(self, batch: Batch | Balls) -> None:
        self.first = batch
        """The batch when it was first seen."""
        self.colors: dict[int, int] = {}
        """Number of each row's color in the palette."""
        self.palette = Palette(batch)
        self.forms: list[tuple[int, Mesh]] = []
        """Frames from which the mesh has a new form."""
        self._slots = Slots()
        self._parents = parents(batch.mesh)
        self._rest = rest_pose(batch.mesh)
        self._frames: list[tuple[int, NDArray[np.int64], NDArray[np.float32]]] = []
        self._bytes = 0

    @property
    def keys(self) -> NDArray[np.int64]:
        """Key of each individual that was ever there."""
        return self._slots.keys

    def add(self, frame: int, batch: Batch | Balls) -> None:
        """Take in a frame."""
        rows = self._slots.rows(keys(batch.ids))
        self.colors.update(zip(rows.tolist(), self.palette.assign(batch).tolist(), strict=True))
        if not self.forms or self.forms[-1][1].key != batch.mesh.key:
            self.forms.append((frame, batch.mesh))
        values = [batch.transforms[:, None, :]]
        if self._parents:
            poses = batch.poses if len(batch.poses) else self._resting(len(batch.ids))
            values.append(relative_to_parents(poses, self._parents))
        numbers = np.concatenate(values, axis=1).astype(np.float32)
        self._bytes += numbers.nbytes
        if self._bytes > _MOST_BYTES:
            raise LimitError(f"{batch.name} moves too much for a .glb: fewer seconds, or to .usdc")
        self._frames.append((frame, rows, numbers))

    def _resting(self, count: int) -> NDArray[np.float32]:
        return np.broadcast_to(self._rest, (count, *self._rest.shape))

    def presence(self, frame_count: int) -> NDArray[np.bool_]:
        """Return who was there when, (individuals, frames)."""
        there = np.zeros((len(self.keys), frame_count), bool)
        for frame, rows, _ in self._frames:
            there[rows, frame] = True
        return there

    def motion(self, presence: NDArray[np.bool_]) -> NDArray[np.float32]:
        """Return transforms (individuals, frames, 1 + joints, 8): place, then joints in parents.

        The absent have the values of when they were last, or first, there.
        """
        count, frames = presence.shape
        values = np.zeros((count, frames, 1 + len(self._parents), 8), np.float32)
        for frame, rows, numbers in self._frames:
            values[rows, frame] = numbers
        source = np.where(presence, np.arange(frames), -1)
        source = np.maximum.accumulate(source, axis=1)
        source = np.where(source < 0, presence.argmax(axis=1)[:, None], source)
        if not presence.all():
            values = values[np.arange(count)[:, None], source]
        return values
