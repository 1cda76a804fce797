"""Fish bodies that swim with muscles: springs, water and motor controllers."""

from bioscope.fish.shoal import Shoal
from bioscope.fish.tank import Preset, Tank

__all__ = ["Preset", "Shoal", "Tank"]
