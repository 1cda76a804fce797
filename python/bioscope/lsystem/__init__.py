"""L-systems: plants as texts that rewrite themselves, and the turtle that draws them."""

from bioscope.lsystem.equilibrium import Equilibrium, equilibrium
from bioscope.lsystem.figures import Figure, Generator
from bioscope.lsystem.lsystem import Fragment, LSystem, ModuleString
from bioscope.lsystem.turtle import (
    AnimateFile,
    Balls,
    Discs,
    Interpretation,
    Patches,
    Segments,
    SharedPart,
    SharedPlant,
    Turtle,
    ViewFile,
    read_colors,
)

__all__ = [
    "AnimateFile",
    "Balls",
    "Discs",
    "Equilibrium",
    "Figure",
    "Fragment",
    "Generator",
    "Interpretation",
    "LSystem",
    "ModuleString",
    "Patches",
    "Segments",
    "SharedPart",
    "SharedPlant",
    "Turtle",
    "ViewFile",
    "equilibrium",
    "read_colors",
]
