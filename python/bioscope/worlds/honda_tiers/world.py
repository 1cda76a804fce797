"""Two trees spread their tiers of branches until their clusters of leaves meet.

Watch for: the tiers that fork in step; the apices that stop where their leaves would overlap those
of the neighbor; how each tree grows away from the other.

Source: R. Měch and P. Prusinkiewicz, "Visual models of plants interacting with their environment",
SIGGRAPH 1996, section 4.1, after J. B. Fisher and H. Honda (1979).
"""

import bioscope as bio
from bioscope.populations.place import Habitat
from bioscope.worlds import landscape

DISTANCE = 4.8
"""Between the stems, metres: with clusters of radius 0.89 m the published 138 segments grow."""

_STEM = 2.2


def world(seed: int) -> bio.World:
    """Make the clearing with its two seedlings."""
    land = bio.World(seed=seed, dt=1 / 30, title="honda_tiers")
    landscape.rolling(land, extent=60.0, relief=2.5, flat=9.0)
    landscape.daylight(land, elevation=42.0, azimuth=-38.0)
    landscape.meadow(land, radius=20.0, tufts=2000, wind=1.6)
    half = DISTANCE / 2
    clusters = bio.environments.Collision(0.89, [(-half, 0.0, _STEM), (half, 0.0, _STEM)])
    land.add(
        bio.Plants(
            "tier_tree",
            2,
            habitat=Habitat(area=[(-half, 0.0), (half, 0.0)]),
            rate=0.4,
            environment=clusters,
            origin=(0.0, 0.0, 0.0),
            lying=True,
            turned=False,
            unfold=True,
            variety=0.1,
        )
    )
    cameras = land.cameras
    cameras.orbit("round", target=(0.0, 1.9, 0.0), radius=11.5, height=3.0, period=80)
    cameras.fixed("above", position=(0.0, 13.5, 4.5), target=(0.0, 1.5, 0.2), field_of_view=48)
    cameras.fixed("between", position=(0.4, 1.3, 7.8), target=(0.0, 2.0, 0.0), field_of_view=58)
    land.shots = [("round", 8.0), ("above", 5.0), ("between", 6.0)]
    return land
