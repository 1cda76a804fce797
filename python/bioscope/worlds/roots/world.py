"""Two herbs above a cut through the soil: their roots follow the water and take it from each other.

The earth behind the pane is painted by its water, blue where there is most and black where there is
none. Watch for: main roots that bend towards the wet; side roots that wait, set out, and stop where
the water is used up; the black that spreads from the roots, and how the two divide the ground.

Source: R. Měch and P. Prusinkiewicz, "Visual models of plants interacting with their environment",
SIGGRAPH 1996, section 4.3, figures 9 and 10, after V. Clausnitzer and J. W. Hopmans (1994).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import bioscope as bio
from bioscope.populations.place import Habitat
from bioscope.worlds import landscape

if TYPE_CHECKING:
    from numpy.typing import NDArray

CELL = 0.022
"""Metres per cell of the soil."""

CELLS = (96, 64)
"""Cells of the soil in x and downward."""

SPRINGS = [(-34.0, -6.0, -0.5, -24.0, 4.0, 0.5, 2.5), (14.0, -22.0, -0.5, 30.0, -12.0, 0.5, 2.5)]
"""Boxes of wet earth: lowest and highest corner in cells from the middle of the soil, and water."""

WETTEST = 2.5
"""Amount of water that is painted blue; where there is none the earth is black."""

STONES = [(-9.0, 4.0, -0.5, -2.0, 9.0, 0.5), (24.0, 6.0, -0.5, 31.0, 10.0, 0.5)]
"""Boxes without water."""


def world(seed: int) -> bio.World:
    """Make the bank with its two seedlings."""
    land = bio.World(seed=seed, dt=1 / 30, title="roots")
    land.environment.terrain(np.zeros((31, 61), np.float32), spacing=1.0, origin=(-30.0, -30.05))
    landscape.daylight(land, elevation=44.0, azimuth=24.0)
    land.add(bio.Ground(rock_slope=70.0, rock_height=1e4, sand_color=(0.15, 0.19, 0.07)))
    land.add(_section(), "soil")
    land.add(
        bio.Plants(
            "meadow_grass",
            420,
            habitat=Habitat(area=bio.Rectangle((-2.4, -2.2), (2.4, -0.05))),
            species="grass",
            size=(0.3, 0.75),
            variants=6,
            room=0.02,
            variety=0.3,
        )
    )
    land.add(herbs(), "herbs")
    cameras = land.cameras
    cameras.fixed("whole", position=(0.25, -0.3, 2.75), target=(0.0, -0.48, 0.0), field_of_view=46)
    cameras.fixed("left", position=(-0.75, -0.3, 1.15), target=(-0.5, -0.42, 0.0), field_of_view=48)
    cameras.fixed("surface", position=(0.9, 0.2, 1.3), target=(0.1, -0.12, 0.0), field_of_view=46)
    land.shots = [("whole", 12.0), ("left", 6.0), ("surface", 5.0)]
    return land


def herbs(*, rate: float = 10.0, start: int = 0) -> bio.Plants:
    """Return the two plants, which drink from the same soil."""
    soil = bio.environments.SoilWater(CELLS, cell=1.0, sources=SPRINGS, obstacles=STONES)
    return bio.Plants(
        "soil_root",
        2,
        habitat=Habitat(area=[(-0.34, 0.03), (0.34, 0.03)]),
        species="herb",
        size=CELL,
        rate=rate,
        start=start,
        environment=soil,
        origin=(0.0, -(0.5 * CELLS[1] - 0.5) * CELL, 0.03),
        turned=False,
        unfold=True,
        levels=(WETTEST,),
        flexibility=0.0,
        variety=0.06,
    )


def _section() -> landscape.Sheet:
    """Return the cut through the soil: dark where it is wet, with stones."""
    x, y = np.meshgrid(np.linspace(-3.0, 3.0, 321), np.linspace(-2.6, 0.0, 161))
    columns, rows = x / CELL, y / CELL + 0.5 * CELLS[1]
    wet = np.zeros_like(x)
    stone = np.zeros_like(x)
    for low_x, low_y, _, high_x, high_y, _, _ in SPRINGS:
        wet = np.maximum(wet, _inside(columns, rows, (low_x, low_y), (high_x, high_y), 9.0))
    for low_x, low_y, _, high_x, high_y, _ in STONES:
        stone = np.maximum(stone, _inside(columns, rows, (low_x, low_y), (high_x, high_y), 0.6))
    grain = np.random.default_rng(3).uniform(0.8, 1.2, x.shape)
    humus = np.clip(1 + y / 0.22, 0.0, 1.0)
    earth = np.array([0.23, 0.155, 0.095]) * (1 - 0.45 * humus)[..., None]
    earth = earth * (1 - 0.62 * wet)[..., None] + np.array([0.0, 0.006, 0.016]) * wet[..., None]
    colors = earth + (np.array([0.30, 0.29, 0.27]) - earth) * stone[..., None]
    colors = colors * grain[..., None]
    relief = 0.012 * (grain - 1.0) + 0.02 * stone
    positions = np.stack([x, y, relief - 0.02], axis=-1)
    return landscape.Sheet(positions, colors)


def _inside(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    low: tuple[float, float],
    high: tuple[float, float],
    edge: float,
) -> NDArray[np.float64]:
    """Return 1 in a rounded box, falling to 0 over `edge`."""
    across = np.maximum(np.maximum(low[0] - x, x - high[0]), 0.0)
    along = np.maximum(np.maximum(low[1] - y, y - high[1]), 0.0)
    return np.clip(1.0 - np.hypot(across, along) / edge, 0.0, 1.0)
