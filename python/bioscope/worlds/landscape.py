"""Land on which the ready-made worlds of plants stand: rolling ground, grass, wind and sky."""

from __future__ import annotations

import numpy as np

import bioscope as bio
from bioscope.populations.place import Disk, Habitat

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


def lawn(world: bio.World, soil: tuple[float, float, float] = (0.13, 0.23, 0.06)) -> None:
    """Cover the ground with a mown lawn, with a light wind over it."""
    world.add(bio.Ground(rock_slope=70.0, rock_height=1e4, sand_color=soil))
    world.environment.add(
        bio.Current((1.0, 0.0, 0.4), speed=1.0, surge=0.4, turbulence=0.3), "wind"
    )
