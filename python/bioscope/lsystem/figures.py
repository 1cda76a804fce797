"""Productions on figures: Koch constructions, and growth that moves what stands above.

A production on a string and one on a figure are the same triple of what is replaced, of what it is
glued by, and of what replaces it; they differ in the maps by which it is applied (P. Prusinkiewicz
and others, "The artificial life of plants", Problems 3.1 to 3.4 and 4.3):

- `Figure.koch` maps the generator by the similarity that takes it from start to end of the edge.
  End points never move.
- `Figure.grown` keeps the lengths of the generator and glues it at the start of the edge. What
  stands above is moved as one rigid body, as the turtle does with the rest of a string.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bioscope.errors import InvalidValueError, LimitError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

EDGE_LIMIT = 5_000_000
MEET = 1e-9
"""Points nearer than this, in the frame of a generator, are one."""


@dataclass(frozen=True)
class Figure:
    """Oriented edges in the plane, as complex numbers; each stands on another or on the ground."""

    start: NDArray[np.complex128]
    """Where each edge begins (n,)."""
    end: NDArray[np.complex128]
    """Where it ends (n,)."""
    labels: NDArray[np.str_]
    """What it is called (n,)."""
    parent: NDArray[np.int64]
    """Number of the edge that it stands on, smaller than its own; -1 for none (n,)."""

    @classmethod
    def polygon(cls, corners: Sequence[complex], label: str = "F") -> Figure:
        """Return a closed polygon; none of its edges stands on another."""
        start = np.asarray(corners, np.complex128)
        count = len(start)
        labels, ground = np.full(count, label), np.full(count, -1)
        return cls(start, np.roll(start, -1), labels, ground)

    @classmethod
    def edge(cls, label: str = "F", end: complex = 1j) -> Figure:
        """Return one edge from the origin."""
        one = np.array([end], np.complex128)
        return cls(np.zeros(1, np.complex128), one, np.array([label]), np.array([-1]))

    def koch(self, productions: Mapping[str, Generator]) -> Figure:
        """Replace every edge by its generator between the same end points."""
        pieces = [self._pieces(number, productions) for number in range(len(self.start))]
        bounded(sum(len(one.labels) for one in pieces))
        start, end, labels, parent = [], [], [], []
        first = 0
        for number, piece in enumerate(pieces):
            side = (self.end[number] - self.start[number]) / piece.tip
            start.append(self.start[number] + side * piece.start)
            end.append(self.start[number] + side * piece.end)
            labels.append(piece.labels)
            parent.append(np.where(piece.parent < 0, -1, piece.parent + first))
            first += len(piece.labels)
        return Figure(*map(np.concatenate, (start, end, labels, parent)))

    def grown(self, productions: Mapping[str, Generator]) -> Figure:
        """Replace every edge by its generator, and move what stands above to its tip."""
        bounded(sum(len(self._pieces(number, productions).labels) for number in range(len(self))))
        start: list[complex] = []
        end: list[complex] = []
        labels: list[str] = []
        parent: list[int] = []
        # By old edge: the rigid motion of what stands on it, and the new edge at its tip.
        turned: list[complex] = []
        moved: list[complex] = []
        tips: list[int] = []
        for number, (begin, over) in enumerate(zip(self.start, self.end, strict=True)):
            below = int(self.parent[number])
            turn, motion = (turned[below], moved[below]) if below >= 0 else (1 + 0j, 0j)
            piece = self._pieces(number, productions)
            place, side = turn * begin + motion, turn * (over - begin)
            ground, first = (tips[below] if below >= 0 else -1), len(start)
            start += (place + side * piece.start).tolist()
            end += (place + side * piece.end).tolist()
            labels += piece.labels.tolist()
            parent += [ground if one < 0 else first + int(one) for one in piece.parent]
            turned.append(turn * piece.turn)
            moved.append(place + side * piece.tip - turn * piece.turn * over)
            tips.append(ground if piece.tip_edge < 0 else first + piece.tip_edge)
        arrays = np.array(start), np.array(end), np.array(labels), np.array(parent)
        return Figure(*arrays)

    def __len__(self) -> int:
        """Return the number of edges."""
        return len(self.start)

    def _pieces(self, number: int, productions: Mapping[str, Generator]) -> Generator:
        label = str(self.labels[number])
        return productions.get(label) or Generator.of_pieces([(label, 0j, 1 + 0j)])


@dataclass(frozen=True)
class Generator:
    """What replaces an edge, in the frame in which the edge goes from 0 to 1."""

    start: NDArray[np.complex128]
    """Where each piece begins (n,)."""
    end: NDArray[np.complex128]
    """Where it ends (n,)."""
    labels: NDArray[np.str_]
    """What it is called (n,)."""
    parent: NDArray[np.int64]
    """Number of the piece that it stands on; -1 for none (n,)."""
    tip: complex
    """Where what stood at the end of the edge stands now."""
    turn: complex = 1 + 0j
    """By which rotation it is turned there."""
    tip_edge: int = -1
    """The piece that ends at the tip; -1 for none."""

    @classmethod
    def of_pieces(cls, pieces: Sequence[tuple[str, complex, complex]]) -> Generator:
        """Return a generator of pieces (label, start, end), sides of any length; its tip is 1.

        Raises
        ------
        InvalidValueError
            If there are no pieces.
        """
        if not pieces:
            raise InvalidValueError("a generator has at least one piece")
        start = np.array([one for _, one, _ in pieces], np.complex128)
        end = np.array([one for _, _, one in pieces], np.complex128)
        parent = [
            next((other for other in range(number) if abs(end[other] - begin) < MEET), -1)
            for number, begin in enumerate(start)
        ]
        labels = np.array([label for label, _, _ in pieces])
        return cls(start, end, labels, np.array(parent), 1 + 0j, 1 + 0j, _ending(end, 1 + 0j))

    @classmethod
    def of_word(cls, word: str, angle: float) -> Generator:
        """Return what the turtle draws of a word of letters, `+`, `-` (degrees) and brackets.

        The same word is the successor of a production of an L-system: every letter is as long as
        the edge that it replaces.

        Raises
        ------
        InvalidValueError
            If the word draws nothing, or returns to where it began.
        """
        here, heading, last = 0j, 1 + 0j, -1
        stack: list[tuple[complex, complex, int]] = []
        start, end, labels, parent = [], [], [], []
        for symbol in word:
            if symbol in "+-":
                degrees = angle if symbol == "+" else -angle
                heading *= cmath.rect(1, math.radians(degrees))
            elif symbol == "[":
                stack.append((here, heading, last))
            elif symbol == "]" and stack:
                here, heading, last = stack.pop()
            elif symbol.isalpha():
                start.append(here)
                here += heading
                end.append(here)
                labels.append(symbol)
                parent.append(last)
                last = len(labels) - 1
            else:
                raise InvalidValueError(f"word '{word}': '{symbol}' is not known here")
        if not labels or abs(here) < MEET:
            raise InvalidValueError(f"word '{word}': expected one that leads from 0 elsewhere")
        arrays = np.array(start), np.array(end), np.array(labels), np.array(parent)
        return cls(*arrays, here, heading, last)


def _ending(end: NDArray[np.complex128], tip: complex) -> int:
    near = np.flatnonzero(np.abs(end - tip) < MEET)
    return int(near[-1]) if len(near) else -1


def bounded(count: int) -> None:
    """Raise an error if there are too many edges.

    Raises
    ------
    LimitError
        For more than five million.
    """
    if count > EDGE_LIMIT:
        raise LimitError(f"a figure of {count} edges; at most {EDGE_LIMIT}")
