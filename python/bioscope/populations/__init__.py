"""The engine's populations: what can live in a world."""

from bioscope.populations.animated import Animated
from bioscope.populations.drifters import Bubbles, Plankton
from bioscope.populations.fish import FishSchool, RoamingFish
from bioscope.populations.fishing import FishingLine
from bioscope.populations.place import Disk, Habitat, Rectangle
from bioscope.populations.plants import Plants
from bioscope.populations.scenery import Corals, Ground, Pillars, Props, Rocks

__all__ = [
    "Animated",
    "Bubbles",
    "Corals",
    "Disk",
    "FishSchool",
    "FishingLine",
    "Ground",
    "Habitat",
    "Pillars",
    "Plankton",
    "Plants",
    "Props",
    "Rectangle",
    "RoamingFish",
    "Rocks",
]
