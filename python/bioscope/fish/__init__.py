"""Fish bodies that swim with muscles: springs, water and motor controllers."""

from bioscope.fish.capture import Segment, capture
from bioscope.fish.shoal import Shoal
from bioscope.fish.tank import Preset, Tank

__all__ = ["Preset", "Segment", "Shoal", "Tank", "capture"]
