"""Attributes of a plant's modules, worked out over the whole plant in one pass.

In an L-system what one module knows goes on to its neighbor in a step: a signal takes as many steps
as the way has modules. An attribute grammar (D. E. Knuth, "Semantics of context-free languages",
Mathematical Systems Theory 2, 1968) gives each node of a tree its attributes at once: synthesized
ones from its children's, tips first (basipetal), inherited ones from its parent's, root first
(acropetal). Where a signal comes to rest, it comes to rest at the attribute.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np

from bioscope.errors import UnknownNameError

if TYPE_CHECKING:
    from collections.abc import Callable

    from bioscope.lsystem.lsystem import ModuleString

Value = TypeVar("Value")


class Attributes:
    r"""The modules of one symbol in a string, as the tree that brackets make of them.

    Other modules are passed over, as `ignore:` lets contexts do.

    Parameters
    ----------
    string
        The plant.
    symbol
        Which modules are the nodes; they are numbered in the order of the string, so that a node
        comes after its parent.

    Raises
    ------
    UnknownNameError
        If the string has no such symbol.

    Examples
    --------
    How many tips each internode bears, and how many internodes lead to it:

    >>> import bioscope as bio
    >>> plant = bio.LSystem("axiom: I[I[I]I]I\nA --> A\n").derive(0)
    >>> tree = bio.lsystem.Attributes(plant, "I")
    >>> tree.synthesized(lambda node, tips: sum(tips) if tips else 1)
    [3, 2, 1, 1, 1]
    >>> tree.inherited(lambda node, before: (before or 0) + 1)
    [1, 2, 3, 3, 2]
    """

    def __init__(self, string: ModuleString, symbol: str) -> None:
        symbols = string.symbols
        if symbol not in symbols:
            raise UnknownNameError(f"no module '{symbol}' in the alphabet of this string")
        self.parents: list[int] = []
        """Number of the node below each; -1 where there is none."""
        modules = []
        stack, last = [], -1
        for place, code in enumerate(string.kinds.tolist()):
            here = symbols[code]
            if here == symbol:
                self.parents.append(last)
                modules.append(place)
                last = len(self.parents) - 1
            elif here == "[":
                stack.append(last)
            elif here == "]":
                last = stack.pop() if stack else -1
        arities = string.arities.astype(np.int64)[string.kinds]
        counts, ends = arities[modules], np.cumsum(arities)[modules]
        starts = (ends - counts).tolist()
        rows = zip(starts, ends.tolist(), strict=True)
        self.numbers = [tuple(string.parameters[start:end].tolist()) for start, end in rows]
        """The parameters of each node."""

    def __len__(self) -> int:
        """Return the number of nodes."""
        return len(self.parents)

    def synthesized(self, rule: Callable[[int, list[Value]], Value]) -> list[Value]:
        """Return an attribute that goes from the tips to the root.

        Parameters
        ----------
        rule
            Called once for each node, after all of its children: with its number and with their
            values, in the order of the string.
        """
        children: list[list[Value]] = [[] for _ in self.parents]
        values: list[Value] = []
        for node in range(len(self) - 1, -1, -1):
            value = rule(node, children[node][::-1])
            values.append(value)
            if self.parents[node] >= 0:
                children[self.parents[node]].append(value)
        return values[::-1]

    def inherited(self, rule: Callable[[int, Value | None], Value]) -> list[Value]:
        """Return an attribute that goes from the root to the tips.

        Parameters
        ----------
        rule
            Called once for each node, after its parent: with its number and with the parent's
            value, None at a root.
        """
        values: list[Value] = []
        for node, parent in enumerate(self.parents):
            values.append(rule(node, values[parent] if parent >= 0 else None))
        return values
