"""Bioscope brings virtual worlds to life.

>>> import bioscope as bio
>>> world = bio.World(seed=7)
>>> world.run(seconds=1)
>>> world.tick
60
"""

from bioscope._engine import VERSION as __version__
from bioscope._engine import Batch, Camera, Material, Mesh, Points, Publication, Scene
from bioscope._engine import View as WorldView
from bioscope.errors import BioscopeError
from bioscope.world import (
    Current,
    Environment,
    Event,
    EventLog,
    Field,
    Parameter,
    Population,
    World,
)

__all__ = [
    "Batch",
    "BioscopeError",
    "Camera",
    "Current",
    "Environment",
    "Event",
    "EventLog",
    "Field",
    "Material",
    "Mesh",
    "Parameter",
    "Points",
    "Population",
    "Publication",
    "Scene",
    "World",
    "WorldView",
    "__version__",
]
