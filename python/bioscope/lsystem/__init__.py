"""L-systems: plants as texts that rewrite themselves, and the turtle that draws them."""

from bioscope.lsystem.lsystem import LSystem, ModuleString
from bioscope.lsystem.turtle import (
    Balls,
    Discs,
    Interpretation,
    Patches,
    Segments,
    Turtle,
    ViewFile,
    read_colors,
)

__all__ = [
    "Balls",
    "Discs",
    "Interpretation",
    "LSystem",
    "ModuleString",
    "Patches",
    "Segments",
    "Turtle",
    "ViewFile",
    "read_colors",
]
