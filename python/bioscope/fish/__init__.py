"""Fish bodies that swim with muscles: springs, water and motor controllers, one fish at a time."""

from bioscope.fish.tank import Preset, Tank

__all__ = ["Preset", "Tank"]
