"""The pieces of a frame as meshes, which stay the same objects as long as what they show does."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bioscope._engine import Mesh

if TYPE_CHECKING:
    from bioscope.lsystem.animation.frame import Frame, Piece
    from bioscope.lsystem.animation.materials import Material
    from bioscope.lsystem.animation.vectors import Vector


class Part(NamedTuple):
    """All that is of one material, and of the body of one actor or of none."""

    material: Material
    mesh: Mesh
    body: int | None
    """Whose body it is of."""


class Meshes:
    """Makes meshes of frames; those of the last frame are kept."""

    def __init__(self) -> None:
        self._known: dict[tuple[Material, int | None], tuple[list[Piece], Part | None]] = {}

    def of(self, frame: Frame, stroke: float = 0.0) -> list[Part]:
        """Return one mesh per material and body, in the order in which they were drawn.

        Parameters
        ----------
        frame
            What is shown.
        stroke
            Thickness of strokes in units of the model; they are left out if it is 0.
        """
        grouped: dict[tuple[Material, int | None], list[Piece]] = {}
        drawn = [line.piece(stroke) for line in frame.lines] if stroke > 0 else []
        for piece in [*frame.pieces, *drawn]:
            grouped.setdefault((piece.material, piece.body), []).append(piece)
        known, self._known = self._known, {}
        for key, pieces in grouped.items():
            before = known.get(key)
            if before is not None and before[0] == pieces:
                self._known[key] = before
            else:
                mesh = _mesh(pieces)
                part = None if mesh is None else Part(key[0], mesh, key[1])
                self._known[key] = pieces, part
        return [part for _, part in self._known.values() if part is not None]


def _mesh(pieces: list[Piece]) -> Mesh | None:
    """Return pieces as a mesh; corners are shared where they are smooth."""
    positions: list[Vector] = []
    found: list[tuple[int, int, int]] = []
    for piece in pieces:
        made = piece.triangles()
        if piece.smooth:
            base = len(positions)
            positions += piece.corners
            found += [(base + a, base + b, base + c) for a, b, c in made]
            continue
        for triangle in made:
            base = len(positions)
            positions += [piece.corners[one] for one in triangle]
            found.append((base, base + 1, base + 2))
    if not found:
        return None
    return Mesh(np.array(positions, np.float32), np.array(found, np.uint32))
