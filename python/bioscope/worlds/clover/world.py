"""Clover looks for light under trees: runners cross the shade and settle where the sun falls.

Watch for: runners that leave the half-lit glade in which they begin, cross the poor shade and find
the bright one, which fills with leaves; how leaves age, die and make room, and how the first glade
is given up and taken again.

Source: R. Měch and P. Prusinkiewicz, "Visual models of plants interacting with their environment",
SIGGRAPH 1996, section 4.2, after B. Ford (1987).
"""

import numpy as np

import bioscope as bio
from bioscope.populations.place import Habitat
from bioscope.worlds import landscape

UNIT = 0.1
"""Metres per unit of the model."""

BRIGHT, GLADE = ((-1.6, 1.6), 1.3), ((1.8, -1.8), 1.0)
"""Patches I and II of the source: place (x, z) and radius, metres."""


FOUNDERS = [(1.8, -1.8, 135.0), (0.4, 0.6, 80.0), (-0.3, -1.7, 200.0), (1.3, 1.5, 70.0)]
"""Where plants begin (x and z, metres), and their first headings in degrees to the left of -z."""


def world(seed: int) -> bio.World:
    """Make the forest floor with its first plants."""
    land = bio.World(seed=seed, dt=1 / 30, title="clover")
    landscape.rolling(land, extent=40.0, relief=2.2, flat=6.0)
    land.add(bio.Ground(rock_slope=70.0, rock_height=1e4, sand_color=landscape.LOAM))
    landscape.daylight(land, elevation=58.0, azimuth=-120.0)
    land.add(landscape.floor(BRIGHT, GLADE, half=4.4), "floor")
    land.add(clone(), "clover")
    random = np.random.default_rng(seed)
    angles, ways = random.uniform(0, 2 * np.pi, 1500), 3.2 + 11 * random.uniform(0, 1, 1500) ** 1.6
    edge = [(float(r * np.cos(a)), float(r * np.sin(a))) for a, r in zip(angles, ways, strict=True)]
    land.add(
        bio.Plants(
            "meadow_grass", len(edge), habitat=Habitat(area=edge), species="grass", room=0.02
        )
    )
    cameras = land.cameras
    cameras.fixed("floor", position=(-3.4, 2.5, 4.6), target=(-0.5, 0.0, 0.5), field_of_view=46)
    cameras.orbit("round", target=(0.0, 0.0, 0.2), radius=4.6, height=3.0, period=120)
    cameras.fixed("above", position=(0.0, 7.2, 1.2), target=(0.0, 0.0, 0.0), field_of_view=46)
    cameras.fixed("low", position=(-0.5, 0.42, 2.6), target=(-1.5, 0.06, 1.3), field_of_view=48)
    land.shots = [("round", 9.0), ("above", 6.0), ("low", 5.0), ("floor", 6.0)]
    return land


def clone(*, rate: float = 6.0, start: int = 0) -> bio.Plants:
    """Return the plants: one in the glade that heads for the bright patch, others about."""
    return bio.Plants(
        "clover",
        len(FOUNDERS),
        habitat=Habitat(area=[(x, z) for x, z, _ in FOUNDERS]),
        numbers={"START": [heading for _, _, heading in FOUNDERS]},
        size=UNIT,
        rate=rate,
        start=start,
        environment=bio.environments.PatchLight(),
        origin=(0.0, 0.0, 0.0),
        lying=True,
        turned=False,
        unfold=True,
        seeds="S",
        room=0.25,
        most=60,
        dispersal=0.5,
        germination=0.6,
        flexibility=0.0,
    )
