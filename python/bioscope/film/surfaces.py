"""Materials as Mitsuba's surfaces.

| published | Mitsuba |
|---|---|
| matt, opaque | `diffuse` |
| with a highlight | `principled`, index of refraction from the strength of the highlight |
| light comes through | `principledthin` |
| cut out, or partly opaque | `mask` about it |
| bubbles | `dielectric`, gas in water |
| vertex colors | a mesh attribute; where there is a picture too, its brightness darkens them |
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.export.pictures import refraction
from bioscope.geometry.palette import WHITE

if TYPE_CHECKING:
    from types import ModuleType

    from numpy.typing import NDArray

    from bioscope._engine import Material
    from bioscope.geometry.balls import Grain
    from bioscope.geometry.palette import Color

COLOR = "vertex_color"
"""Name of the mesh attribute that holds vertex colors."""

_WATER, _GAS = 1.34, 1.0
_MATT = 0.9
_SOLID = 0.15
"""Translucency up to which a surface is solid: thin ones have no highlight."""
LARGEST = 0.96
"""No surface throws back more than this share of light."""


class Surfaces:
    """The surfaces made so far, by material, tint and kind of vertex color."""

    def __init__(self, mitsuba: ModuleType) -> None:
        self._mitsuba = mitsuba
        self._made: dict[object, Any] = {}

    def of(
        self, material: Material | Grain, tint: Color = WHITE, *, colored: bool, mapped: bool
    ) -> Any:
        """Return a surface; `colored` and `mapped` say whether the mesh has colors and uvs."""
        key = (material.key, tint, colored, mapped)
        if key not in self._made:
            description = self._description(material, tint, colored, mapped)
            self._made[key] = self._mitsuba.load_dict(description)
        return self._made[key]

    def _description(
        self, material: Material | Grain, tint: Color, colored: bool, mapped: bool
    ) -> dict[str, Any]:
        if getattr(material, "glassy", False):
            return {"type": "dielectric", "int_ior": _GAS, "ext_ior": _WATER}
        picture = material.texture if mapped else None
        if colored:
            surface = self._finish(material, {"type": "mesh_attribute", "name": COLOR})
            if picture is not None:
                bright = brightness(picture)
                dark = {"type": "diffuse", "reflectance": _rgb([0, 0, 0])}
                weight = self._bitmap((bright / bright.max())[..., None])
                surface = {"type": "blendbsdf", "weight": weight, "dark": dark, "full": surface}
        else:
            color = np.array(material.color, np.float32) * np.array(tint, np.float32)
            if picture is None:
                paint = _rgb(np.minimum(color, LARGEST).tolist())
            else:
                pixels = linear(picture[..., :3]) * color
                paint = self._bitmap(np.minimum(pixels, LARGEST))
            surface = self._finish(material, paint)
        if picture is not None and material.cutout:
            solid = (picture[..., 3:4] >= 128).astype(np.float32)
            return {"type": "mask", "opacity": self._bitmap(solid), "surface": surface}
        opacity = float(getattr(material, "opacity", 1.0))
        if opacity < 1.0:
            return {"type": "mask", "opacity": opacity, "surface": surface}
        return surface

    def _finish(self, material: Material | Grain, color: dict[str, Any]) -> dict[str, Any]:
        roughness = max(float(material.roughness), 0.08)
        shine = {"roughness": roughness, "eta": max(refraction(material.specular), 1.01)}
        if material.translucency > _SOLID:
            through = float(material.translucency)
            passed = min(2.0, 2.0 * through / (1.0 + 0.5 * through))
            return {"type": "principledthin", "base_color": color, "diff_trans": passed, **shine}
        if roughness >= _MATT:
            inside: dict[str, Any] = {"type": "diffuse", "reflectance": color}
        else:
            inside = {"type": "principled", "base_color": color, **shine}
        return {"type": "twosided", "inside": inside}

    def _bitmap(self, pixels: NDArray[np.float32]) -> dict[str, Any]:
        bitmap = self._mitsuba.Bitmap(np.ascontiguousarray(pixels, np.float32))
        return {"type": "bitmap", "bitmap": bitmap, "raw": True}


def vertex_factor(material: Material | Grain, tint: Color, *, mapped: bool) -> NDArray[np.floating]:
    """Return the color by which vertex colors are multiplied before a picture darkens them."""
    color = np.array(material.color) * np.array(tint)
    if not mapped or material.texture is None:
        return np.asarray(color)
    pixels = linear(material.texture[..., :3])
    bright = pixels.mean(axis=-1)
    hue = pixels.mean(axis=(0, 1)) / max(float(bright.mean()), 1e-6)
    return np.asarray(color * hue * bright.max())


def brightness(picture: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Return the linear brightness (height, width) of a picture, not all 0."""
    return np.asarray(np.maximum(linear(picture[..., :3]).mean(axis=-1), 1e-6), np.float32)


def _rgb(color: list[float]) -> dict[str, Any]:
    return {"type": "rgb", "value": color}


def linear(pixels: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Return sRGB bytes as linear values 0 to 1."""
    levels = np.arange(256) / 255
    curve = np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)
    return np.asarray(curve.astype(np.float32)[pixels])
