"""Nine young conifers close their ranks, and lose their lower branches in the shade.

Watch for: tiers of branches that are widest at the foot as long as there is light; branches that
stop where they meet the neighbor's; the tree in the middle, bare first, and the corners,
green to the ground on their outer sides. A year lasts two seconds.

Source: R. Měch and P. Prusinkiewicz, "Visual models of plants interacting with their environment",
SIGGRAPH 1996, section 8, figures 15 and 16, after A. Takenaka (1994).
"""

import bioscope as bio
from bioscope.populations.place import Habitat
from bioscope.worlds import landscape

SPACING = 1.6
"""Between neighbors, metres."""

_YEAR = 13
"""Steps of a year, by the model."""


def world(seed: int) -> bio.World:
    """Make the hillside with its seedlings."""
    land = bio.World(seed=seed, dt=1 / 30, title="conifer_stand")
    landscape.rolling(land, extent=60.0, relief=4.0, flat=6.0)
    landscape.daylight(land, elevation=28.0, azimuth=48.0)
    landscape.meadow(land, radius=18.0, tufts=2200, wind=2.5)
    land.add(stand(rows=3, spacing=SPACING))
    cameras = land.cameras
    cameras.orbit("round", target=(0.0, 1.9, 0.0), radius=10.5, height=2.4, period=80)
    cameras.fixed("edge", position=(4.6, 1.1, 6.2), target=(0.0, 1.7, 0.0), field_of_view=50)
    cameras.fixed("above", position=(5.0, 9.5, 6.0), target=(0.0, 1.0, 0.0), field_of_view=42)
    land.shots = [("round", 12.0), ("edge", 6.0), ("above", 6.0)]
    return land


def stand(rows: int, spacing: float, *, start: int = 1, rate: float = _YEAR / 2) -> bio.Plants:
    """Return rows × rows conifers at this spacing (metres), `start` years old."""
    places = [(spacing * (number - (rows - 1) / 2)) for number in range(rows)]
    return bio.Plants(
        "conifer",
        rows * rows,
        habitat=Habitat(area=[(x, z) for z in places for x in places]),
        size=0.4,
        rate=rate,
        start=start * _YEAR,
        variety=0.12,
        flexibility=0.05,
        flutter=0.03,
    )
