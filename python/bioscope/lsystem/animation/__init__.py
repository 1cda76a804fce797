"""Behavioral L-systems as they run: definition files (.lm), frame by frame.

H. Noser, "A Behavioral Animation System Based on L-systems and Synthetic Sensors for Actors", EPFL
thesis 1609 (1997). `LSystem.read` makes a plant of a definition file; an `Animation` runs all of
it: memories, particles and their fields, cameras, materials, sounds, actors and their behaviors,
programs, files of an offline renderer. What an actor sees, and its automata, are the host's: it
gives functions.

`animation.py` is the world and its frame, `derivation.py` lets strings grow older, `walk.py` draws
them, `machine.py` and `functions.py` are the expressions.
"""

from bioscope.lsystem.animation.animation import Animation, Source
from bioscope.lsystem.animation.automata import Actor, Behavior, read_behavior
from bioscope.lsystem.animation.frame import Directive, Frame, Line, Piece
from bioscope.lsystem.animation.materials import MATERIALS, Material
from bioscope.lsystem.animation.viewing import Camera, Device

__all__ = [
    "MATERIALS",
    "Actor",
    "Animation",
    "Behavior",
    "Camera",
    "Device",
    "Directive",
    "Frame",
    "Line",
    "Material",
    "Piece",
    "Source",
    "read_behavior",
]
