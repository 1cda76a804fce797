"""Points seen as instances of a ball, so that writers and renderers know one kind of thing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from bioscope.geometry.ball import ball

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Mesh, Points


@dataclass(frozen=True)
class Grain:
    """Appearance of small round things; the fields of a `Material`, and opacity."""

    name: str
    color: tuple[float, float, float]
    opacity: float
    glassy: bool
    roughness: float
    specular: float
    translucency: float = 0.0
    texture: None = None
    texture_key: None = None
    cutout: bool = False
    two_sided: bool = False

    @property
    def key(self) -> object:
        """By which it is recognized."""
        return self.name, self.color, self.opacity


class Balls:
    """A `Points`, with the attributes of a `Batch`."""

    alive = False

    def __init__(self, points: Points) -> None:
        self.name, self.species, self.ids = points.name, points.species, points.ids
        self.mesh = shared_ball()
        roughness, specular = (0.05, 0.02) if points.glassy else (0.8, 0.04)
        red, green, blue = points.color
        color = (red, green, blue)
        self.material = Grain(
            points.name, color, points.opacity, points.glassy, roughness, specular
        )
        count = len(points.ids)
        self.transforms = np.zeros((count, 8), np.float32)
        self.transforms[:, :3], self.transforms[:, 3] = points.positions, points.radii
        self.transforms[:, 7] = 1.0
        self.tints: NDArray[np.float32] = np.empty((0, 3), np.float32)
        self.velocities = self.tints
        self.poses: NDArray[np.float32] = np.empty((0, 0, 8), np.float32)

    @property
    def positions(self) -> NDArray[np.float32]:
        """Centers."""
        return self.transforms[:, :3]

    @property
    def rotations(self) -> NDArray[np.float32]:
        """None."""
        return self.transforms[:, 4:]

    @property
    def scales(self) -> NDArray[np.float32]:
        """Radii."""
        return self.transforms[:, 3]


@cache
def shared_ball() -> Mesh:
    """Return the ball of radius 1 that all share."""
    return ball()
