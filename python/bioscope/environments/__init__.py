r"""What surrounds plants: light, space, water, things in the way, and environments of one's own.

A model asks with communication modules `?E(...)`; after every step the environment takes note of
all of them and answers by changing their numbers.

>>> import bioscope as bio
>>> system = bio.LSystem("Lsystem: x\naxiom: A?E(0.5)\nA --> F(1)A\nendlsystem\n")
>>> bio.environments.derive(system, steps=2, environment=bio.environments.SkyLight()).string()
'F(1)F(1)A?E(1)'
"""

from bioscope.environments.amounts import Amounts
from bioscope.environments.crowns import Crowns
from bioscope.environments.environment import Environment, derive, named, names, read, rebuild
from bioscope.environments.kinds import (
    Collision,
    Community,
    Field,
    LeafBalls,
    Limbs,
    Neighborhood,
    Obstacles,
    PatchLight,
    Pipe,
    Pole,
    Pruning,
    ShadowVoxels,
    SkyLight,
    SoilWater,
)

__all__ = [
    "Amounts",
    "Collision",
    "Community",
    "Crowns",
    "Environment",
    "Field",
    "LeafBalls",
    "Limbs",
    "Neighborhood",
    "Obstacles",
    "PatchLight",
    "Pipe",
    "Pole",
    "Pruning",
    "ShadowVoxels",
    "SkyLight",
    "SoilWater",
    "derive",
    "named",
    "names",
    "read",
    "rebuild",
]
