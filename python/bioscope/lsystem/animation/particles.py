"""Particles with mass that feel each other's fields (thesis, section 2.3.1).

m a = g(own state, t) + Σ f_k, by the method of Runge and Kutta of fourth order, all particles
together, a frame in as many parts as `nbrCalcStep` says.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from bioscope.lsystem.animation.scope import Scope
from bioscope.lsystem.animation.vectors import ZERO, Vector, add, length, subtract, times

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bioscope.lsystem.animation.derivation import Instance
    from bioscope.lsystem.animation.scope import Stage

    Programs = tuple[Callable[[Scope], float], ...]
    State = tuple[list[Vector], list[Vector]]


@dataclass(slots=True, eq=False)
class Particle:
    """A point with mass that belongs to a symbol `C`."""

    owner: Instance
    field: Programs | None = None
    """What others feel of it."""
    own: Programs | None = None
    """What it feels on its own."""
    mass: float = 1.0
    position: Vector = ZERO
    velocity: Vector = ZERO
    placed: bool = False
    phase: float = 0.0
    """Of its swimming, radians."""
    swam_at: int = -1
    grounded: bool = False

    @property
    def free(self) -> bool:
        """Whether forces move it; others are led by a path, an actor or the turtle."""
        return self.placed and self.owner.mode(1) == 0


def force_of(source: Particle, felt: Scope, position: Vector, velocity: Vector) -> Vector:
    """Return what is felt of a particle with this state; `felt` is who feels it where."""
    if source.field is None:
        return ZERO
    felt.source, felt.source_velocity = position, velocity
    felt.distance = length(subtract(position, felt.place))
    felt.identity, felt.layer = source.owner.id, source.owner.layer
    first, second, third = source.field
    return first(felt), second(felt), third(felt)


def advance(particles: Sequence[Particle], stage: Stage, time: float, parts: int) -> None:
    """Move all free particles by the interval of a frame, which begins at `time`."""
    h = stage.interval / parts
    for part in range(parts):
        now = time + part * h
        state = [one.position for one in particles], [one.velocity for one in particles]
        k1 = _slope(particles, stage, now, state)
        k2 = _slope(particles, stage, now + h / 2, _ahead(state, k1, h / 2))
        k3 = _slope(particles, stage, now + h / 2, _ahead(state, k2, h / 2))
        k4 = _slope(particles, stage, now + h, _ahead(state, k3, h))
        for at, one in enumerate(particles):
            if one.free:
                one.position, one.velocity = (
                    add(was[at], times(_mean(a[at], b[at], c[at], d[at]), h))
                    for was, a, b, c, d in zip(state, k1, k2, k3, k4, strict=True)
                )


def _mean(a: Vector, b: Vector, c: Vector, d: Vector) -> Vector:
    return times(add(add(a, d), times(add(b, c), 2.0)), 1 / 6)


def _ahead(state: State, slope: State, h: float) -> State:
    first, second = (
        [add(was, times(change, h)) for was, change in zip(*both, strict=True)]
        for both in zip(state, slope, strict=True)
    )
    return first, second


def _slope(particles: Sequence[Particle], stage: Stage, time: float, state: State) -> State:
    """Return velocities and accelerations; what is led is where it is at that time."""
    positions, velocities = state
    positions = [
        one.owner.path(stage, time, one) if one.owner.mode(1) == 1 and one.placed else at
        for one, at in zip(particles, positions, strict=True)
    ]
    changes = []
    for index, one in enumerate(particles):
        if not one.free:
            changes.append(ZERO)
            continue
        felt = Scope(stage, time, age=one.owner.age, particle=one, layer=one.owner.layer)
        felt.place, felt.velocity = positions[index], velocities[index]
        force = ZERO
        if one.own is not None:
            first, second, third = one.own
            force = first(felt), second(felt), third(felt)
        for other, source in enumerate(particles):
            if other != index and source.placed:
                force = add(force, force_of(source, felt, positions[other], velocities[other]))
        changes.append(times(force, 1 / one.mass))
    return velocities, changes
