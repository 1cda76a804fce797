"""Materials and their pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bioscope import _engine
from bioscope.export.pictures import opaque, refraction
from bioscope.geometry.palette import WHITE

if TYPE_CHECKING:
    from bioscope._engine import Material
    from bioscope.export.gltf.container import Container
    from bioscope.geometry.balls import Grain
    from bioscope.geometry.palette import Color

_USUAL_SPECULAR = 0.04
"""Reflectance at normal incidence that glTF assumes if nothing is said."""


class Materials:
    """The materials of a file, each written once."""

    def __init__(self, container: Container) -> None:
        self._container = container
        self._made: dict[object, int] = {}
        self._textures: dict[int | None, int] = {}

    def of(self, material: Material | Grain, tint: Color = WHITE) -> int:
        """Return the number of a material in a tint."""
        key = (material.key, tint)
        if key not in self._made:
            self._made[key] = self._container.add("materials", self._entry(material, tint))
        return self._made[key]

    def _entry(self, material: Material | Grain, tint: Color) -> dict[str, Any]:
        opacity = float(getattr(material, "opacity", 1.0))
        color = [min(1.0, one * two) for one, two in zip(material.color, tint, strict=True)]
        surface: dict[str, Any] = {
            "baseColorFactor": [*color, opacity],
            "metallicFactor": 0.0,
            "roughnessFactor": float(material.roughness),
        }
        if material.texture is not None:
            surface["baseColorTexture"] = {"index": self._texture(material)}
        entry: dict[str, Any] = {"name": material.name, "pbrMetallicRoughness": surface}
        if material.two_sided:
            entry["doubleSided"] = True
        if material.cutout and material.texture is not None:
            entry["alphaMode"] = "MASK"
        elif opacity < 1.0:
            entry["alphaMode"] = "BLEND"
        if abs(material.specular - _USUAL_SPECULAR) > 1e-3:
            self._container.extensions.add("KHR_materials_ior")
            entry["extensions"] = {"KHR_materials_ior": {"ior": refraction(material.specular)}}
        return entry

    def _texture(self, material: Material | Grain) -> int:
        texture = material.texture
        if texture is not None and material.texture_key not in self._textures:
            container = self._container
            view = container.view(_engine.encode_png(opaque(texture)))
            image = container.add(
                "images", {"name": material.name, "bufferView": view, "mimeType": "image/png"}
            )
            if not container.lists.get("samplers"):
                container.add("samplers", {"magFilter": 9729, "minFilter": 9987})
            self._textures[material.texture_key] = container.add(
                "textures", {"source": image, "sampler": 0}
            )
        return self._textures[material.texture_key]
