"""Adult organisms: models whose strings come to rest, wholly or in part.

L-systems have an adult language: strings that derive themselves. Plants are adult in parts only:
a palm keeps its crown while the trunk goes on. What is looked at is therefore a factor of the
string that the caller chooses (P. Prusinkiewicz and others, "The artificial life of plants",
Problem 7.2).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bioscope.errors import InvalidValueError

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

    from bioscope.lsystem.lsystem import LSystem, ModuleString


@dataclass(frozen=True, slots=True)
class Equilibrium:
    """Since when a factor of the string repeats itself."""

    step: int
    """The first step from which on it does."""
    period: int
    """After how many steps it is the same again; 1 if it does not change."""


def equilibrium(
    system: LSystem,
    factor: Callable[[ModuleString], Hashable],
    steps: int,
    *,
    longest: int = 12,
    seed: int | None = None,
    **options: Any,
) -> Equilibrium | None:
    """Return since when a factor of a model's string is constant or cyclic; None if it is not.

    Parameters
    ----------
    system
        The model.
    factor
        What is looked at in a string: a part of it, or numbers of it. What may change is left out.
    steps
        How far the model is derived; a factor counts as repeating if it does in the last half.
    longest
        The longest period that is tried.
    seed, **options
        As for `LSystem.derive`.

    Raises
    ------
    InvalidValueError
        If the steps are too few for the longest period to be seen twice.
    """
    if steps < 4 * longest:
        raise InvalidValueError(f"{steps} steps: expected at least 4 times the longest period")
    seen = [factor(system.derive(step, seed, **options)) for step in range(steps + 1)]
    for period in range(1, longest + 1):
        step = steps - period + 1
        while step > 0 and seen[step - 1] == seen[step - 1 + period]:
            step -= 1
        if step <= steps // 2:
            return Equilibrium(step, period)
    return None
