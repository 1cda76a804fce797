"""L-systems: plants as texts that rewrite themselves, and the turtle that draws them."""

from bioscope.lsystem.lsystem import LSystem, ModuleString
from bioscope.lsystem.turtle import Interpretation, Segments, Turtle

__all__ = ["Interpretation", "LSystem", "ModuleString", "Segments", "Turtle"]
