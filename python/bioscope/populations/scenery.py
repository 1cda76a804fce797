"""What stays: ground, rocks, corals, and things of one's own."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.populations.native import Asked

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from bioscope.populations.place import Habitat

Color = tuple[float, float, float]


class Ground(Asked):
    """The ground as it is seen: sand where it is level, rock where it is steep or high.

    Parameters
    ----------
    relief
        Fields of the reef's relief to make it from (`seed`, `size`, `spacing`, `floor`, `crest`,
        `wall`, `wall_width`, `embrace`, `roughness`, `bommies`, `mounds`, `channel`,
        `channel_width`, `sand_waves`); none shows the terrain that the world has.
    rock_slope, rock_height
        Steepness in degrees and height in metres from which there is rock.
    sand_color, rock_color
        Linear colours.
    """

    def __init__(
        self,
        relief: dict[str, Any] | None = None,
        *,
        rock_slope: float | None = None,
        rock_height: float | None = None,
        sand_color: Color | None = None,
        rock_color: Color | None = None,
    ) -> None:
        options = {
            "rock_slope": rock_slope,
            "rock_height": rock_height,
            "sand_color": sand_color,
            "rock_color": rock_color,
        }
        super().__init__("ground", options, {}, relief=relief)


class Rocks(Asked):
    """Boulders and ledges, overgrown with crusts; each is an obstacle.

    Parameters
    ----------
    count, habitat
        How many, and where.
    radius
        Least and greatest radius in metres; small ones are many.
    flatness
        How much wider than high: 1 (boulders) to 4 (slabs).
    color
        Linear colour by which they are tinted.
    """

    def __init__(
        self,
        count: int = 20,
        *,
        habitat: Habitat | None = None,
        radius: tuple[float, float] | None = None,
        flatness: float | None = None,
        color: Color | None = None,
    ) -> None:
        options = {
            "count": count,
            "habitat": habitat and habitat.asked(),
            "radius": radius,
            "flatness": flatness,
            "color": color,
        }
        super().__init__("rocks", options, {})


class Corals(Asked):
    """Colonies of corals, sponges and fans, and the shrimps that crackle among them.

    Parameters
    ----------
    colonies
        How many of each kind: `Brain`, `Lobes`, `Table`, `Bush`, `Tubes`, `Fan`, `Whips`.
    habitat
        Where.
    size
        Least and greatest size relative to the usual one of the kind.
    **parameters
        See `World.parameters`.
    """

    def __init__(
        self,
        colonies: dict[str, int] | None = None,
        *,
        habitat: Habitat | None = None,
        size: tuple[float, float] | None = None,
        **parameters: float,
    ) -> None:
        options = {
            "colonies": colonies and list(colonies.items()),
            "habitat": habitat and habitat.asked(),
            "size": size,
        }
        super().__init__("corals", options, parameters)


class Pillars(Asked):
    """Round pillars: animals steer round them and see nothing behind them.

    Parameters
    ----------
    places
        Middle of the foot of each, metres.
    radius, height
        Metres.
    color
        Linear colour.
    """

    def __init__(
        self,
        places: Sequence[tuple[float, float, float]],
        *,
        radius: float = 0.35,
        height: float = 3.0,
        color: Color = (0.34, 0.33, 0.29),
    ) -> None:
        upright = (0.0, 0.0, 0.0, 1.0)
        positions, triangles = _pillar(radius, height)
        options = {
            "species": "pillar",
            "positions": positions.tolist(),
            "triangles": triangles.tolist(),
            "color": color,
            "roughness": 0.9,
            "alive": True,
            "places": [{"position": at, "scale": 1.0, "rotation": upright} for at in places],
            "obstacles": [
                {"Cylinder": {"base": at, "top": (at[0], at[1] + height, at[2]), "radius": radius}}
                for at in places
            ],
        }
        super().__init__("props", options, {})


def _pillar(radius: float, height: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return a round pillar on its foot, closed at both ends."""
    sides = 24
    angles = np.arange(sides) * (math.tau / sides)
    ring = np.stack([radius * np.sin(angles), 0 * angles, radius * np.cos(angles)], axis=1)
    lid = ring + np.array([0.0, height, 0.0])
    # The ends have vertices of their own, so that their edges are sharp.
    ends = [[0.0, 0.0, 0.0], [0.0, height, 0.0]]
    positions = np.concatenate([ring, lid, ring, lid, ends])
    here = np.arange(sides)
    after = (here + 1) % sides
    foot, top = 4 * sides, 4 * sides + 1
    wall = [[here, after, here + sides], [after, after + sides, here + sides]]
    caps = [
        [after + 2 * sides, here + 2 * sides, np.full(sides, foot)],
        [here + 3 * sides, after + 3 * sides, np.full(sides, top)],
    ]
    triangles = np.concatenate([np.stack(one, axis=1) for one in [*wall, *caps]])
    return positions, triangles


class Props(Asked):
    """Things of one's own that stay: a wreck, a pillar, a scanned stone.

    Parameters
    ----------
    positions, triangles
        Vertices (n, 3) in metres and vertex numbers (m, 3), counterclockwise seen from outside.
    places
        Where each copy stands, metres.
    species, color, uvs, colors
        Species in the scene, linear colour, texture coordinates (n, 2), linear vertex colours (n,
        3).
    """

    def __init__(
        self,
        positions: ArrayLike,
        triangles: ArrayLike,
        *,
        places: Sequence[tuple[float, float, float]] = ((0.0, 0.0, 0.0),),
        species: str = "prop",
        color: Color = (0.8, 0.8, 0.8),
        uvs: ArrayLike | None = None,
        colors: ArrayLike | None = None,
    ) -> None:
        upright = (0.0, 0.0, 0.0, 1.0)
        options = {
            "species": species,
            "positions": np.asarray(positions, float).tolist(),
            "triangles": np.asarray(triangles, int).tolist(),
            "uvs": None if uvs is None else np.asarray(uvs, float).tolist(),
            "colors": None if colors is None else np.asarray(colors, float).tolist(),
            "color": color,
            "places": [{"position": at, "scale": 1.0, "rotation": upright} for at in places],
        }
        super().__init__("props", options, {})
