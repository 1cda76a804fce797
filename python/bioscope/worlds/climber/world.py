"""Vines circle until they meet a pole, and wind up it.

Watch for: free stems that sweep round in circles while they grow; the contact, after which a signal
runs down the stem and its joints freeze; coils that close upon the pole. A day lasts a third of a
second.

Source: P. Prusinkiewicz, M. Hammel, R. Měch, J. Hanan, "The artificial life of plants", SIGGRAPH
1995 course notes, section 8, figure 26.
"""

import math

import bioscope as bio
from bioscope.populations.place import Habitat
from bioscope.worlds import landscape

SIZE = 1 / 3
"""Metres per unit of the model."""

POLES = [(-2.6, -0.4), (-0.9, 0.5), (0.9, -0.5), (2.6, 0.3)]
"""Feet of the poles, x and z in metres."""

_DAY = 41
"""Steps of a day, by the model."""


def world(seed: int) -> bio.World:
    """Make the row of poles, each with its vine."""
    land = bio.World(seed=seed, dt=1 / 30, title="climber")
    landscape.rolling(land, extent=50.0, relief=2.5, flat=9.0)
    landscape.daylight(land, elevation=38.0, azimuth=-30.0)
    landscape.meadow(land, radius=13.0, tufts=2200, wind=1.2)
    poles = Habitat(area=POLES)
    land.add(
        bio.Plants("pole", len(POLES), habitat=poles, size=1.0, variants=1, flexibility=0.0),
        "poles",
    )
    for number, (x, z) in enumerate(POLES):
        land.environment.cylinder((x, 0.0, z), (x, 3.3, z), 0.3 * SIZE)
        land.add(vine((x, z), angle=1.2 + 0.5 * number), f"vine-{number + 1}")
    cameras = land.cameras
    cameras.orbit("round", target=(0.0, 1.3, 0.0), radius=6.4, height=1.6, period=100)
    cameras.fixed("close", position=(-1.6, 1.5, 3.2), target=(-0.9, 1.35, 0.4), field_of_view=48)
    cameras.fixed("row", position=(-4.6, 1.4, 3.4), target=(0.4, 1.3, -0.1), field_of_view=46)
    land.shots = [("round", 10.0), ("close", 6.0), ("row", 8.0)]
    return land


def vine(
    pole: tuple[float, float],
    *,
    angle: float,
    rate: float = 3 * _DAY,
    steps: int = 2350,
    start: int = 0,
) -> bio.Plants:
    """Return a vine that grows beside a pole (x and z in metres), at this angle from it."""
    foot = (pole[0] - SIZE * math.cos(angle), pole[1] - SIZE * math.sin(angle))
    way = ((pole[0] - foot[0]) / SIZE, (pole[1] - foot[1]) / SIZE)
    return bio.Plants(
        "twiner",
        1,
        species="vine",
        habitat=Habitat(area=[foot]),
        size=SIZE,
        rate=rate,
        steps=steps,
        start=start,
        environment=bio.environments.Pole(x=way[0], z=way[1], radius=0.3),
        turned=False,
        flexibility=0.0,
        variety=0.1,
    )
