"""Changes from outside that can be kept, written down and made again: scripts of worlds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec

from bioscope.errors import FormatError

if TYPE_CHECKING:
    from bioscope.world.world import World

Word = Annotated[str, msgspec.Meta(max_length=200)]
Number = Annotated[int, msgspec.Meta(ge=0, le=10_000)]
Coordinate = Annotated[float, msgspec.Meta(ge=-1e5, le=1e5)]

HUNTERS = ("barracuda", "blacktip_shark", "grey_reef_shark")
"""Ready-made species that eat other fishes."""


class Change(msgspec.Struct, tag_field="change", forbid_unknown_fields=True, frozen=True):
    """Base of all changes."""


class Setting(Change, tag="set", frozen=True):
    """A parameter of a population, a field, `environment` or `world` is set."""

    owner: Word
    name: Word
    value: float


class Order(Change, tag="order", frozen=True):
    """A population is told something; see `World.order`."""

    population: Word
    order: dict[str, Any]


class Addition(Change, tag="add", frozen=True):
    """A population comes to live in the world."""

    kind: Literal["fish", "plankton", "plants", "pillars"]
    count: Number
    position: tuple[Coordinate, Coordinate, Coordinate]
    """Round which place, metres."""
    species: Word = ""
    """Of fishes; the model of plants."""
    role: Literal["predator", "prey", "pacifist", "generic"] = "generic"
    """How fishes live."""
    leaves: Annotated[int, msgspec.Meta(ge=1, le=100)] | None = None
    """Of each plant whose model counts them; as many as the model says if none."""


AnyChange = Setting | Order | Addition


def perform(world: World, change: AnyChange) -> None:
    """Make a change between two ticks; one that is refused changes nothing."""
    match change:
        case Setting(owner=owner, name=name, value=value):
            world.set(owner, name, value)
        case Order(population=population, order=order):
            world.order(population, order)
        case Addition():
            _add(world, change)


def _add(world: World, addition: Addition) -> None:
    from bioscope import populations

    place, count = addition.position, addition.count
    match addition.kind:
        case "fish":
            mind = _mind(addition)
            world.add(populations.RoamingFish(addition.species, count, center=place, mind=mind))
        case "plankton":
            low, high = (tuple(one + reach for one in place) for reach in (-2.0, 2.0))
            world.add(populations.Plankton(count, low=low, high=high))  # type: ignore[arg-type]
        case "plants":
            area = populations.Disk((place[0], place[2]), 0.5 * max(1.0, count) ** 0.5)
            habitat = populations.Habitat(area=area)
            numbers = None if addition.leaves is None else {"LEAVES": addition.leaves}
            plants = populations.Plants(addition.species, count, habitat=habitat, numbers=numbers)
            world.add(plants)
        case "pillars":
            world.add(populations.Pillars(_ring(place, count)))


def _mind(addition: Addition) -> Any:
    from bioscope import _engine, minds

    others = [one for one in _engine.fish_species() if one not in HUNTERS]
    hunts = addition.role == "predator"
    food = [one for one in others if one != addition.species] if hunts else ["plankton"]
    enemies = [] if hunts else [one for one in HUNTERS if one != addition.species]
    return minds.Intentions(
        addition.role,
        enemies=enemies,
        food=food,
        habits=["school"] if addition.role == "prey" else [],
    )


def _ring(place: tuple[float, float, float], count: int) -> list[tuple[float, float, float]]:
    """Return places round a middle, 1.5 m apart."""
    if count == 1:
        return [place]
    radius = 1.5 * count / math.tau
    angles = [math.tau * number / max(count, 1) for number in range(count)]
    x, y, z = place
    return [(x + radius * math.sin(one), y, z + radius * math.cos(one)) for one in angles]


class Step(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A change and the tick after which it was made."""

    tick: Annotated[int, msgspec.Meta(ge=0, le=10_000_000)]
    change: AnyChange


class Script(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A world as it was made and what was done to it: enough to make it again, to the bit."""

    world: Annotated[str, msgspec.Meta(max_length=4000)]
    """Name or path of the world."""
    seed: Annotated[int, msgspec.Meta(ge=0)]
    tick: Annotated[int, msgspec.Meta(ge=0, le=10_000_000)]
    """Tick to which it goes."""
    steps: Annotated[list[Step], msgspec.Meta(max_length=100_000)] = []

    def text(self) -> str:
        """Return the script as a readable text, JSON."""
        return msgspec.json.format(msgspec.json.encode(self)).decode() + "\n"

    def play(self, world: World) -> None:
        """Take a new world of this seed to the script's last tick."""
        for step in sorted(self.steps, key=lambda one: one.tick):
            if step.tick > self.tick:
                break
            world.step(max(0, step.tick - world.tick))
            perform(world, step.change)
        world.step(max(0, self.tick - world.tick))


def read_script(text: str | bytes, place: str = "script") -> Script:
    """Return the script in a text.

    Raises
    ------
    FormatError
        If it is none; `place` is named.
    """
    try:
        return msgspec.json.decode(text, type=Script)
    except (msgspec.DecodeError, ValueError) as error:
        raise FormatError(f"{place}: not a script of a world: {error}") from None


def brief(steps: list[Step]) -> list[Step]:
    """Return the steps without those that a later one of the same tick makes useless."""
    kept: list[Step] = []
    decided: set[tuple[object, ...]] = set()
    for step in reversed(steps):
        subject = _subject(step.change)
        if subject is not None:
            if (step.tick, *subject) in decided:
                continue
            decided.add((step.tick, *subject))
        kept.append(step)
    return kept[::-1]


def _subject(change: AnyChange) -> tuple[object, ...] | None:
    """Return what only the last of several changes decides, to the bit; none if each counts."""
    match change:
        case Setting(owner=owner, name=name) if name != "bearing":
            return ("set", owner, name)
        case Order(population=population, order={"steer": {"id": individual}}):
            return ("steer", population, individual)
        case Order(population=population, order={"trait": {"id": individual, "name": name}}):
            return ("trait", population, individual, name)
        case _:
            return None
