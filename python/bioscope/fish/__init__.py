"""Fish bodies that swim with muscles, and surfaces of control points that go with them."""

from bioscope.fish.capture import Segment, capture
from bioscope.fish.form import Fin, Form, Skin
from bioscope.fish.nurbs import Nurbs
from bioscope.fish.shoal import Shoal
from bioscope.fish.tank import Preset, Tank
from bioscope.fish.trace import Tick, trace

__all__ = [
    "Fin",
    "Form",
    "Nurbs",
    "Preset",
    "Segment",
    "Shoal",
    "Skin",
    "Tank",
    "Tick",
    "capture",
    "trace",
]
