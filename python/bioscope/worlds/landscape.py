"""Land on which the ready-made worlds of plants stand: rolling ground, grass, wind and sky."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import bioscope as bio
from bioscope.populations.place import Disk, Habitat

if TYPE_CHECKING:
    from numpy.typing import NDArray

LOAM = (0.11, 0.115, 0.052)
"""Linear colour of a forest floor in the shade."""

_GRASS = "meadow_grass"


def rolling(world: bio.World, extent: float, relief: float, flat: float = 0.0) -> None:
    """Lay rolling ground around the origin.

    Parameters
    ----------
    world
        The world.
    extent
        Half the width of the land, metres.
    relief
        Height of the hills, metres.
    flat
        Radius around the origin in which the ground is level, metres.
    """
    spacing = extent / 60
    axis = np.linspace(-extent, extent, 121)
    x, z = np.meshgrid(axis, axis)
    random = np.random.default_rng(world.seed)
    heights = np.zeros_like(x)
    for wave in (2.4, 1.3, 0.6, 0.28):
        for _ in range(3):
            angle, phase = random.uniform(0, 2 * np.pi, 2)
            along = (x * np.cos(angle) + z * np.sin(angle)) / (wave * extent)
            heights += wave * np.sin(2 * np.pi * along + phase)
    heights *= relief / 4
    distance = np.hypot(x, z)
    if flat > 0:
        heights *= np.clip((distance - flat) / flat, 0.0, 1.0) ** 2
    # The land rises towards the horizon, so that one never looks over its edge.
    heights += relief * np.clip(distance / extent - 0.45, 0.0, None) ** 2 * 4
    world.environment.terrain(heights.astype(np.float32), spacing=spacing)


def meadow(
    world: bio.World,
    radius: float,
    tufts: int,
    *,
    wind: float = 2.0,
    soil: tuple[float, float, float] = (0.17, 0.20, 0.07),
) -> None:
    """Cover the ground with a meadow that the wind goes through.

    Parameters
    ----------
    world
        The world, with its terrain.
    radius
        How far grass grows, metres.
    tufts
        How many tufts.
    wind
        Its mean speed, metres per second.
    soil
        Linear colour of the ground between them.
    """
    world.add(bio.Ground(rock_slope=70.0, rock_height=1e4, sand_color=soil))
    breeze = bio.Current(
        (1.0, 0.0, 0.4), speed=wind, surge=0.5 * wind, surge_period=6.0, turbulence=0.4 * wind
    )
    world.environment.add(breeze, "wind")
    grass = Habitat(area=Disk((0.0, 0.0), radius), patchiness=0.35, patch=2.5)
    world.add(
        bio.Plants(
            _GRASS,
            tufts,
            habitat=grass,
            species="grass",
            size=(0.9, 2.0),
            variants=10,
            room=0.05,
            variety=0.35,
            flexibility=0.9,
            yielding=5.0,
            period=1.4,
        )
    )


def daylight(world: bio.World, *, elevation: float = 34.0, azimuth: float = 62.0) -> None:
    """Let a low sun shine, so that plants throw long shadows."""
    world.environment.set(sun_elevation=elevation, sun_azimuth=azimuth, sunlight=1.15)


def lawn(world: bio.World, soil: tuple[float, float, float] = (0.125, 0.17, 0.062)) -> None:
    """Cover the ground with a mown lawn, with a light wind over it."""
    world.add(bio.Ground(rock_slope=70.0, rock_height=1e4, sand_color=soil))
    world.environment.add(
        bio.Current((1.0, 0.0, 0.4), speed=1.0, surge=0.4, turbulence=0.3), "wind"
    )


class Sheet(bio.Population):
    """A surface of points in rows and columns with a linear color each: painted earth.

    Parameters
    ----------
    positions
        Places in metres (rows, columns, 3); rows run upward and columns to the right, as one
        sees it.
    colors
        Linear colors (rows, columns, 3).
    """

    transient = ("mesh", "material")

    def __init__(self, positions: NDArray[np.float64], colors: NDArray[np.float64]) -> None:
        self.positions = positions.astype(np.float32)
        self.colors = colors.astype(np.float32)

    def settle(self) -> int:
        """Take one identity."""
        return 1

    def born(self, ids: NDArray[np.uint32]) -> None:
        """Remember it."""
        self.ids = ids

    def publish(self, scene: bio.Publication) -> None:
        """Show the surface."""
        if getattr(self, "mesh", None) is None:
            self.mesh = self._mesh()
            self.material = bio.Material(name="earth", roughness=0.95)
        places = np.zeros((1, 3), np.float32)
        scene.instances(
            "earth", self.mesh, self.material, ids=self.ids, positions=places, alive=False
        )

    def _mesh(self) -> bio.Mesh:
        rows, columns, _ = self.positions.shape
        corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
        first = np.stack([corner, corner + 1, corner + columns], axis=-1)
        second = np.stack([corner + 1, corner + columns + 1, corner + columns], axis=-1)
        return bio.Mesh(
            positions=self.positions.reshape(-1, 3),
            triangles=np.concatenate([first, second]).astype(np.uint32),
            colors=self.colors.reshape(-1, 3),
        )


Patch = tuple[tuple[float, float], float]
"""Place (x, z) and radius in metres."""


def floor(bright: Patch, glade: Patch, half: float) -> Sheet:
    """Return a forest floor with a patch in full light and a half-lit one.

    Parameters
    ----------
    bright, glade
        The two patches.
    half
        Half the width of the floor, metres; it fades to the loam around.
    """
    axis = np.linspace(-1.02 * half, 1.02 * half, 181)
    x, z = np.meshgrid(axis, axis)
    angle = np.arctan2(z, x)
    # No compass has drawn its edge.
    reach = half * (0.9 + 0.06 * np.sin(3 * angle) + 0.04 * np.sin(7 * angle + 1))
    within = np.clip((reach - np.hypot(x, z)) / 0.9, 0.0, 1.0)
    light = np.full_like(x, 0.3)
    for ((px, pz), radius), level in zip((bright, glade), (1.0, 0.6), strict=True):
        edge = np.clip((radius - np.hypot(x - px, z - pz)) / 0.12 + 0.5, 0.0, 1.0)
        light = light + (level - light) * edge
    grain = np.random.default_rng(5).uniform(0.75, 1.25, x.shape)
    colors = (0.12 + 0.88 * light * grain)[..., None] * np.array([0.25, 0.235, 0.115])
    fading = within[..., None]
    colors = colors * fading + np.array(LOAM) * (1 - fading)
    # Crumbs keep it from being taken for one flat triangle.
    relief = 0.016 * (grain - 1.0) + 0.006 - 0.05 * (1.0 - within) ** 2
    # The other way round along z, so that it is seen from above.
    return Sheet(np.stack([x, relief, z], axis=-1)[::-1], colors[::-1])
