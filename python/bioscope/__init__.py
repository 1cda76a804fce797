"""Bioscope brings virtual worlds to life.

>>> import bioscope as bio
>>> world = bio.World(seed=7)
>>> world.run(seconds=1)
>>> world.tick
60
"""

from bioscope import environments, fish, gallery
from bioscope._engine import VERSION as __version__  # noqa: N811 - the name Python uses
from bioscope._engine import Batch, Camera, Material, Mesh, Points, Publication, Scene
from bioscope._engine import View as WorldView
from bioscope.errors import BioscopeError
from bioscope.lsystem import Interpretation, LSystem, ModuleString, Turtle, ViewFile
from bioscope.minds import Mind
from bioscope.populations import (
    Animated,
    Bubbles,
    Corals,
    Disk,
    FishingLine,
    FishSchool,
    Ground,
    Habitat,
    Pillars,
    Plankton,
    Plants,
    Props,
    Rectangle,
    RoamingFish,
    Rocks,
)
from bioscope.senses import View, look, look_many
from bioscope.world import (
    Current,
    Environment,
    Event,
    EventLog,
    Field,
    Parameter,
    Population,
    World,
    flow,
)
from bioscope.worlds import load

__all__ = [
    "Animated",
    "Batch",
    "BioscopeError",
    "Bubbles",
    "Camera",
    "Corals",
    "Current",
    "Disk",
    "Environment",
    "Event",
    "EventLog",
    "Field",
    "FishSchool",
    "FishingLine",
    "Ground",
    "Habitat",
    "Interpretation",
    "LSystem",
    "Material",
    "Mesh",
    "Mind",
    "ModuleString",
    "Parameter",
    "Pillars",
    "Plankton",
    "Plants",
    "Points",
    "Population",
    "Props",
    "Publication",
    "Rectangle",
    "RoamingFish",
    "Rocks",
    "Scene",
    "Turtle",
    "View",
    "ViewFile",
    "World",
    "WorldView",
    "__version__",
    "environments",
    "fish",
    "flow",
    "gallery",
    "load",
    "look",
    "look_many",
]
