"""L-systems: plants as texts that rewrite themselves, and the turtle that draws them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bioscope.lsystem.attributes import Attributes
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

if TYPE_CHECKING:
    from bioscope.lsystem.animation import Animation

__all__ = [
    "AnimateFile",
    "Animation",
    "Attributes",
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


def __getattr__(name: str) -> Any:
    """Import what few programs need when it is asked for."""
    if name == "Animation":
        from bioscope.lsystem.animation import Animation

        return Animation
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
