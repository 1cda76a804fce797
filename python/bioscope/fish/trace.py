"""What one animal does in each tick, from what it perceives to how it moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bioscope.errors import UnknownNameError

if TYPE_CHECKING:
    from bioscope.world import World

Vector = tuple[float, float, float]

_ACTUATION = ("bend", "tail_beat_hz", "energy_j")


@dataclass(frozen=True)
class Tick:
    """One tick of an animal; its parts in the order in which they come about.

    The centers of an artificial animal are those of X. Tu, "Artificial animals for computer
    animation", 1996: perception, behavior, motor control, body.
    """

    tick: int
    """Tick of the world."""
    perceived: dict[str, Any]
    """What the senses told at its beginning: named values with units."""
    focus: int | None
    """Identity of the one that it attends to; none if it attends to nobody."""
    intention: str
    """What it wants: the behavior that won."""
    wanted: tuple[Vector, float]
    """What the routine asks of the body: a direction, own frame, and body lengths per second."""
    actuated: dict[str, float]
    """What its motor controllers do about it; empty for bodies without muscles."""
    place: Vector
    """Where the body is at the tick's end, metres."""
    velocity: Vector
    """And how fast, metres per second."""


def trace(world: World, animal: int, ticks: int) -> list[Tick]:
    """Run the world by some ticks and return what one animal perceived, wanted and did in each.

    Raises
    ------
    UnknownNameError
        If there is no such animal; if it dies on the way, the trace ends.
    """
    if world.inspect(animal) is None:
        raise UnknownNameError(f"animal = {animal}: expected the identity of one in the scene")
    ticks_of_it: list[Tick] = []
    for _ in range(ticks):
        world.step()
        known = world.inspect(animal)
        if known is None:
            break
        ticks_of_it.append(_tick(world, animal, known))
    return ticks_of_it


def _tick(world: World, animal: int, known: dict[str, Any]) -> Tick:
    values = known["values"]
    focus = values.get("target")
    place, velocity = _motion(world, animal)
    x, y, z = values.get("wanted_heading", (0.0, 0.0, 0.0))
    return Tick(
        tick=world.tick,
        perceived=known["percepts"],
        focus=None if focus is None else int(focus),
        intention=known["behavior"],
        wanted=((x, y, z), values.get("wanted_speed_body_lengths_per_s", 0.0)),
        actuated={name: values[name] for name in _ACTUATION if name in values},
        place=place,
        velocity=velocity,
    )


def _motion(world: World, animal: int) -> tuple[Vector, Vector]:
    for batch in world.scene.batches:
        for index in (batch.ids == animal).nonzero()[0]:
            px, py, pz = map(float, batch.positions[index])
            vx, vy, vz = map(float, batch.velocities[index])
            return (px, py, pz), (vx, vy, vz)
    raise UnknownNameError(f"animal = {animal}: expected the identity of one in the scene")
