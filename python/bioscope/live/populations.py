"""Who lives in a world, and who could, for the panels of the page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bioscope import _engine
from bioscope.errors import BioscopeError
from bioscope.populations import plants
from bioscope.world.changes import HUNTERS

if TYPE_CHECKING:
    from bioscope.world import World

_ORDERS = {
    "animals": ["number", "remove", "place", "trait", "steer"],
    "fish_school": ["number", "remove"],
    "plankton": ["number"],
    "plants": ["number", "place"],
    "props": ["place"],
}
"""What populations of each kind can be told."""

_MOST = {"animals": 2_000, "fish_school": 20_000, "plankton": 100_000, "plants": 5_000}
"""Most individuals that a page may ask for: more would stop the world for all who watch it."""


def residents(world: World) -> list[dict[str, Any]]:
    """Return all populations: name, kind, species, count, and what they can be told."""
    species = _species(world)
    return [
        {
            "name": name,
            "kind": kind,
            "species": species.get(name, ""),
            "count": count,
            "most": _MOST.get(kind, 0),
            "orders": _ORDERS.get(kind, []),
        }
        for name, kind, count in world._engine.populations
    ]


def _species(world: World) -> dict[str, str]:
    """Return the species of the populations whose individuals can be inspected."""
    species: dict[str, str] = {}
    for batch in world.scene.batches:
        found = world.inspect(int(batch.ids[0])) if len(batch.ids) else None
        if found is not None:
            species[found["population"]] = batch.species
    return species


def check_count(world: World, population: str, count: int) -> None:
    """Refuse more individuals than a page may ask for."""
    kinds = {name: kind for name, kind, _ in world._engine.populations}
    most = _MOST.get(kinds.get(population, ""), 0)
    if most and count > most:
        raise BioscopeError(f"{population}: count = {count}: expected up to {most:,}")


def check_addition(kind: str, count: int) -> None:
    """Refuse more newcomers than a page may ask for."""
    most = {"fish": _MOST["animals"], "pillars": 100}.get(kind, _MOST.get(kind, 0))
    if count > most:
        raise BioscopeError(f"count = {count}: expected up to {most:,} {kind}")


def catalog() -> dict[str, Any]:
    """Return the species of fish and the plant models that can be added to a world.

    `leaves` says of the models that count them how many a plant has.
    """
    models = {path.stem: path for path in plants.marine()}
    leaves = {name: plants.leaves_of(path) for name, path in models.items()}
    return {
        "fish": _engine.fish_species(),
        "hunters": [*HUNTERS],
        "plants": sorted(models),
        "leaves": {name: number for name, number in leaves.items() if number is not None},
    }
