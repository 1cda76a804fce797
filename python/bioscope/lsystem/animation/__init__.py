"""Behavioral L-systems as they run: definition files (.lm), frame by frame.

H. Noser, "A Behavioral Animation System Based on L-systems and Synthetic Sensors for Actors", EPFL
thesis 1609 (1997). `LSystem.read` makes a plant of a definition file; an `Animation` runs all of
it: memories, particles and their fields, cameras, materials, sounds, actors and their behaviors,
programs, files of an offline renderer. Actors see: rules ask what is in their windows. Their
automata are the host's.

`animation.py` is the world and its frame, `derivation.py` lets strings grow older, `walk.py` draws
them, `machine.py` and `functions.py` are the expressions, `window.py` and `sight.py` are the eyes.
"""

from bioscope.lsystem.animation.animation import Animation, Source
from bioscope.lsystem.animation.automata import Actor, Behavior, read_behavior
from bioscope.lsystem.animation.frame import Directive, Frame, Line, Piece
from bioscope.lsystem.animation.materials import MATERIALS, Material
from bioscope.lsystem.animation.meshes import Part
from bioscope.lsystem.animation.sight import Surroundings
from bioscope.lsystem.animation.viewing import Camera, Device
from bioscope.lsystem.animation.window import Code, Window

__all__ = [
    "MATERIALS",
    "Actor",
    "Animation",
    "Behavior",
    "Camera",
    "Code",
    "Device",
    "Directive",
    "Frame",
    "Line",
    "Material",
    "Part",
    "Piece",
    "Source",
    "Surroundings",
    "Window",
    "read_behavior",
]
