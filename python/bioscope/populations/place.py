"""Where things are put."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

Pair = tuple[float, float]


@dataclass(frozen=True)
class Rectangle:
    """Everything between two corners on the level, x and z in metres."""

    low: Pair = (-8.0, -8.0)
    high: Pair = (8.0, 8.0)

    def asked(self) -> dict[str, Any]:
        """Return the engine's form."""
        return {"Rectangle": {"low": self.low, "high": self.high}}


@dataclass(frozen=True)
class Disk:
    """Everything around a point on the level, x and z and radius in metres."""

    center: Pair = (0.0, 0.0)
    radius: float = 5.0

    def asked(self) -> dict[str, Any]:
        """Return the engine's form."""
        return {"Disk": {"center": self.center, "radius": self.radius}}


Area = Rectangle | Disk | list[Pair]
"""A rectangle, a disk, or a list of places (x, z)."""


def asked_area(area: Area) -> dict[str, Any]:
    """Return the engine's form of an area."""
    return {"Points": area} if isinstance(area, list) else area.asked()


@dataclass(frozen=True)
class Habitat:
    """The kind of ground on which something grows or lies."""

    area: Area = field(default_factory=Rectangle)
    slope: Pair = (0.0, 90.0)
    """Least and greatest steepness in degrees."""
    height: Pair = (-1e6, 1e6)
    """Least and greatest height of the ground in metres."""
    patchiness: float = 0.0
    """0 (spread evenly) to 1 (only in patches)."""
    patch: float = 3.0
    """Size of a patch in metres."""

    def asked(self) -> dict[str, Any]:
        """Return the engine's form."""
        return {
            "area": asked_area(self.area),
            "slope": self.slope,
            "height": self.height,
            "patchiness": self.patchiness,
            "patch": self.patch,
        }
