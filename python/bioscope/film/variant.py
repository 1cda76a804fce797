"""Which variant of Mitsuba runs here.

Its compiled variants abort the whole process with some drivers and LLVM versions, so each is
tried by a child process first. What was found holds for the session.
"""

from __future__ import annotations

import importlib.util
import platform
import subprocess
import sys
from functools import cache

from bioscope.errors import BioscopeError, MissingExtraError

FAST = ("cuda_ad_rgb", "llvm_ad_rgb")
"""Compiled variants, the fastest first."""
SURE = "scalar_rgb"
"""Runs everywhere."""

_SECONDS = 180.0

_TRIAL = """
import sys
import mitsuba as mi
import numpy as np
mi.set_variant(sys.argv[1])
scene = mi.load_dict({
    "type": "scene",
    "sky": {"type": "constant"},
    "ball": {"type": "sphere", "bsdf": {"type": "principled"}},
    "camera": {
        "type": "thinlens", "aperture_radius": 0.01, "focus_distance": 3.0,
        "to_world": mi.ScalarTransform4f().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0]),
        "film": {"type": "hdrfilm", "width": 8, "height": 8},
    },
})
path = mi.load_dict({"type": "volpath", "max_depth": 3})
image = np.array(mi.render(scene, integrator=path, spp=1))
print("works" if image.shape[0] == 8 and image.mean() > 0 else "fails")
"""


@cache
def variant() -> str:
    """Return the fastest variant that a child process survived.

    Raises
    ------
    MissingExtraError
        If Mitsuba is not installed.
    BioscopeError
        If there is none for this machine.
    """
    if importlib.util.find_spec("mitsuba") is None:
        if platform.system() == "Linux" and platform.machine() == "aarch64":
            raise BioscopeError(
                "Mitsuba, the path tracer, has no package for Linux on aarch64: "
                "use --renderer preview"
            )
        raise MissingExtraError("The path tracer", "film")
    return next((name for name in FAST if survives(name)), SURE)


def survives(name: str) -> bool:
    """Whether a child process can render with this variant."""
    command = [sys.executable, "-c", _TRIAL, name]
    try:
        result = subprocess.run(
            command, capture_output=True, text=True, timeout=_SECONDS, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return result.returncode == 0 and result.stdout.strip().endswith("works")
