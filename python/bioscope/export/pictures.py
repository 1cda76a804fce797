"""What all formats need of pictures and surfaces."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def opaque(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return pixels (height, width, 4) without the opacity where it is full everywhere."""
    if (pixels[..., 3] == 255).all():
        return np.ascontiguousarray(pixels[..., :3])
    return np.asarray(pixels)


def refraction(specular: float) -> float:
    """Return the index of refraction whose reflectance at normal incidence is `specular`."""
    root = math.sqrt(min(max(specular, 0.0), 0.9))
    return (1 + root) / (1 - root)
