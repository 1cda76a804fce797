"""What an expression refers to while it is evaluated."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from bioscope.lsystem.animation.vectors import ZERO, Vector

if TYPE_CHECKING:
    from collections.abc import Callable

    from bioscope.lsystem.animation.particles import Particle
    from bioscope.lsystem.animation.sounds import Air

_MIX = 0x9E3779B97F4A7C15
_BITS = (1 << 64) - 1


def uniform(*keys: int) -> float:
    """Return a number from 0 to 1 that depends on the keys alone (SplitMix64)."""
    state = 0
    for key in keys:
        state = (state ^ (key & _BITS)) + _MIX & _BITS
        state = (state ^ state >> 30) * 0xBF58476D1CE4E5B9 & _BITS
        state = (state ^ state >> 27) * 0x94D049BB133111EB & _BITS
        state ^= state >> 31
    return (state >> 11) / (1 << 53)


class Stage(Protocol):
    """The world that all definitions share, as far as expressions see it."""

    seed: int
    interval: float
    senses: dict[str, Callable[[int], float]]
    air: Air
    arrays: list[dict[int, list[float]]]
    """Constant arrays of each definition; −1 is its constant P."""
    racket: Vector
    """The force of the last `?15`."""
    shape: float
    """The last `?21`."""
    generic: float
    """The last `?23`."""

    @property
    def tick(self) -> int:
        """Number of the frame."""

    def channel(self, number: float, at: float) -> float:
        """Return the value of a data channel."""

    def touch(self, place: Vector, actor: int) -> float:
        """Return the magnitude of the fields of all particles."""

    def remark(self, text: str) -> None:
        """Keep a remark, once."""


@dataclass(slots=True)
class Scope:
    """What the letters of an expression stand for."""

    stage: Stage
    time: float
    age: float = 0.0
    place: Vector = ZERO
    """`x y z`: the parameters of a symbol; in fields the place that feels."""
    velocity: Vector = ZERO
    """`u v w`: of what feels a field, or of its source if that has none."""
    source: Vector = ZERO
    """`X Y Z`: where the source of a field is."""
    source_velocity: Vector = ZERO
    """`U V W`."""
    distance: float = 0.0
    """`r`: between the two."""
    memory: list[float] = field(default_factory=lambda: [0.0] * 8)
    growth: Vector = ZERO
    """Growth values of the symbol that is replaced."""
    replaced_memory: list[float] = field(default_factory=lambda: [0.0] * 8)
    particle: Particle | None = None
    actor: int = 0
    identity: int = 0
    """Of the symbol, for random numbers."""
    slot: int = 0
    """Of the expression, for random numbers."""
    drawn: int = 0
    """How many random numbers it has taken."""
    layer: int = 0
    repetition: int = 0

    @property
    def arrays(self) -> dict[int, list[float]]:
        """Constant arrays of the definition that the expression is of."""
        return self.stage.arrays[self.layer]

    def draw(self) -> float:
        """Return the next random number of this symbol, expression and frame."""
        self.drawn += 1
        stage = self.stage
        return uniform(stage.seed, self.identity, self.slot, stage.tick, self.drawn)

    def remark(self, text: str) -> None:
        """Keep a remark, once."""
        self.stage.remark(text)
