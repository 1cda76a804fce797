"""What the water carries: plankton and bubbles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bioscope.populations.native import Asked
from bioscope.populations.place import asked_area

if TYPE_CHECKING:
    from bioscope.populations.place import Area

Vector = tuple[float, float, float]


class Plankton(Asked):
    """Motes of life in a box of water, carried by the current.

    Parameters
    ----------
    count
        How many.
    low, high
        Corners of the box, metres; what drifts out comes in at the other side as another.
    radius
        Least and greatest radius, metres.
    color
        Linear colour.
    opacity
        0 (invisible) to 1 (solid).
    species
        Its name in the scene, by which animals know it: `plankton` if not given.
    **parameters
        See `World.parameters`.
    """

    def __init__(
        self,
        count: int = 1800,
        *,
        low: Vector | None = None,
        high: Vector | None = None,
        radius: tuple[float, float] | None = None,
        color: Vector | None = None,
        opacity: float | None = None,
        species: str | None = None,
        **parameters: float,
    ) -> None:
        options = {
            "count": count,
            "low": low,
            "high": high,
            "radius": radius,
            "color": color,
            "opacity": opacity,
            "species": species,
        }
        super().__init__("plankton", options, parameters)


class Bubbles(Asked):
    """Bubbles that rise from vents in the ground, ring, and burst at the surface.

    Parameters
    ----------
    vents, area
        How many vents, and where.
    capacity
        Most bubbles at once.
    **parameters
        See `World.parameters`.
    """

    def __init__(
        self,
        vents: int = 5,
        *,
        area: Area | None = None,
        capacity: int = 400,
        **parameters: float,
    ) -> None:
        options = {
            "vents": vents,
            "area": None if area is None else asked_area(area),
            "capacity": capacity,
        }
        super().__init__("bubbles", options, parameters)
