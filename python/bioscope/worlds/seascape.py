"""The stage of the fish films: sea, sand, rock, a garden of corals and weeds, pillars."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

import bioscope as bio
from bioscope.populations.place import Disk, Habitat, Rectangle

Place = tuple[float, float, float]

_ARRIVED, _WARY = 0.35, 0.45
"""Distances of a corner that counts as reached, and of an obstacle that is minded, metres."""
SAND = -5.5
"""Height of the sand in the middle of the stage, metres."""


class Guide(bio.Mind):
    """Swims from corner to corner of a way, to and fro, round what is in it.

    Parameters
    ----------
    way
        Its corners, metres.
    home
        The place that the fish calls home, metres.
    speed
        Body lengths per second.
    """

    kind = "guide"

    def __init__(self, way: list[Place], home: Place, speed: float = 1.2) -> None:
        self.way = [np.subtract(corner, home).tolist() for corner in way]
        self.speed, self.corner, self.step = speed, 0, 1

    def decide(self, percepts: dict[str, Any]) -> dict[str, Any]:
        """Head for the next corner, or beside the obstacle ahead."""
        ahead = percepts["ahead"]
        if ahead and ahead["distance"] < _WARY:
            return {"behavior": "avoid", "heading": ahead["aim"], "speed": self.speed}
        if np.linalg.norm(self._offset(percepts)) < _ARRIVED:
            if not 0 <= self.corner + self.step < len(self.way):
                self.step = -self.step
            self.corner += self.step
        heading = tuple(map(float, self._offset(percepts)))
        return {"behavior": "lead", "heading": heading, "speed": self.speed}

    def _offset(self, percepts: dict[str, Any]) -> NDArray[np.float64]:
        """Return where the next corner is, own frame."""
        corner = np.array(self.way[self.corner])
        x, y, z, w = percepts["attitude"]
        axis = np.array([-x, -y, -z])
        turned = corner + 2 * w * np.cross(axis, corner)
        turned += 2 * np.cross(axis, np.cross(axis, corner))
        return np.asarray(turned + np.array(percepts["home"]), float)


def seascape(seed: int, title: str, *, current: bio.Current | None = None) -> bio.World:
    """Make a calm bay before a reef; animals are at home at x = -4 to 4, z = -3 to 3.

    Parameters
    ----------
    seed, title
        Of the world.
    current
        Its current; a weak swell if not given.
    """
    bay = bio.World(seed=seed, dt=1 / 30, title=title)
    gentle = bio.Current(direction=(1.0, 0.0, 0.3), speed=0.02, surge=0.03, turbulence=0.01)
    bay.environment.water(surface=0.0, current=current or gentle)
    bay.environment.set(turbidity=0.55, sun_elevation=64.0, sun_azimuth=35.0)
    bay.add(bio.Ground(relief={}))
    slope = Rectangle((-8.0, -8.0), (8.0, 4.0))
    bay.add(bio.Rocks(26, habitat=Habitat(area=slope, patchiness=0.6), radius=(0.12, 0.6)))
    colonies = {"Brain": 8, "Lobes": 10, "Table": 5, "Bush": 14, "Tubes": 7, "Fan": 8, "Whips": 6}
    garden = Habitat(area=Rectangle((-7.0, -7.0), (7.0, 2.5)), patchiness=0.7, patch=2.5)
    bay.add(bio.Corals(colonies, habitat=garden))
    sand = Habitat(area=Rectangle((-7.0, -5.0), (7.0, 4.0)), slope=(0.0, 25.0), patchiness=0.8)
    bay.add(bio.Plants("seagrass", 36, habitat=sand, size=(0.7, 1.4)))
    left = Habitat(area=Disk((-5.2, -2.0), 2.2), slope=(0.0, 40.0))
    bay.add(bio.Plants("kelp", 8, habitat=left, size=(0.8, 1.3), room=0.5))
    rocks = Habitat(area=Rectangle((-7.0, -7.0), (8.0, 1.0)), slope=(5.0, 60.0), patchiness=0.4)
    bay.add(bio.Plants("sea_fan", 10, habitat=rocks, size=(0.7, 1.3), variety=0.6))
    return bay


def pillar(bay: bio.World, place: tuple[float, float], radius: float, top: float) -> None:
    """Put up a pillar of rock at x, z, of this radius, up to this height (all metres).

    Animals steer round it and see nothing behind it.
    """
    x, z = place
    foot = SAND - 0.4
    bay.environment.cylinder((x, foot, z), (x, top, z), radius)
    bay.add(_rock_column(radius, top - foot, (x, foot, z)))


def _rock_column(radius: float, height: float, at: tuple[float, float, float]) -> bio.Props:
    """Return a weathered column: lumpy, wider at the foot, encrusted in reddish and green."""
    around, up = 72, 90
    angle = np.linspace(0, 2 * math.pi, around, endpoint=False)[None, :]
    level = np.linspace(0, 1, up)[:, None]
    y = height * level
    lumps = (
        0.09 * np.sin(2 * angle + 2.1 * y)
        + 0.07 * np.sin(5 * angle - 3.3 * y + 1.3)
        + 0.06 * np.abs(np.sin(4 * angle + 5 * y)) * np.sin(7 * y + 3 * angle)
        + 0.035 * np.sin(13 * angle + 11 * y) * np.sin(9 * y - 5 * angle)
        + 0.02 * np.sin(23 * angle - 19 * y)
    )
    ledges = 0.07 * np.tanh(4 * np.sin(3.1 * y + 0.6 * np.sin(angle)))
    crown = np.sqrt(np.clip(1 - np.clip((level - 0.94) / 0.06, 0, 1) ** 2, 0.01, 1))
    foot = 0.55 * np.exp(-9 * level)
    reach = radius * (0.9 + lumps + ledges + foot) * crown
    places = np.stack([reach * np.cos(angle), y + 0 * angle, reach * np.sin(angle)], axis=-1)
    crust = 0.5 + 0.5 * np.sin(3 * angle + 4 * y) * np.sin(5 * y - 2 * angle)
    stone, red, green = np.array([[0.26, 0.25, 0.2], [0.38, 0.14, 0.13], [0.16, 0.27, 0.1]])
    colors = stone + crust[..., None] ** 3 * (red - stone)
    colors = colors + (1 - crust[..., None]) ** 4 * (green - stone)
    colors = colors * (0.75 + 2.5 * (lumps + ledges))[..., None].clip(0.5, 1.3)
    row, column = np.meshgrid(np.arange(up - 1), np.arange(around), indexing="ij")
    a, b = row * around + column, row * around + (column + 1) % around
    quads = np.stack([a, a + around, b, b, a + around, b + around], axis=-1)
    return bio.Props(
        places.reshape(-1, 3),
        quads.reshape(-1, 3),
        places=[at],
        species="rock",
        color=(1.0, 1.0, 1.0),
        colors=colors.reshape(-1, 3),
    )
