"""Materials as UsdPreviewSurface, with their pictures in a folder beside the stage.

A preview surface cannot multiply a picture by vertex colors: where a mesh has both, the picture
wins and the colors remain as `displayColor`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pxr import Gf, Sdf, Usd, UsdShade

from bioscope import _engine
from bioscope.export.names import Names
from bioscope.export.pictures import opaque, refraction
from bioscope.geometry.palette import WHITE

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from bioscope._engine import Material
    from bioscope.geometry.balls import Grain
    from bioscope.geometry.palette import Color


class Looks:
    """The materials of a stage, each written once."""

    def __init__(self, stage: Usd.Stage, scope: str, folder: Path, base: str) -> None:
        self._stage, self._scope = stage, scope
        self._folder, self._base = folder, base
        self._names = Names()
        self._pictures = Names()
        self._made: dict[object, UsdShade.Material] = {}

    def of(
        self, material: Material | Grain, tint: Color = WHITE, *, colored: bool = False
    ) -> UsdShade.Material:
        """Return a material in a tint; `colored` if it takes its color from the mesh's vertices."""
        key = (material.key, tint, colored)
        if key not in self._made:
            made, surface = self._begin(key, material.name)
            color = [one * two for one, two in zip(material.color, tint, strict=True)]
            if material.texture is not None:
                self._picture(made, surface, material, color)
            elif colored:
                reader = self._node(made, "Colors", "UsdPrimvarReader_float3")
                reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("displayColor")
                reader.CreateInput("fallback", Sdf.ValueTypeNames.Float3).Set(Gf.Vec3f(*color))
                output = reader.CreateOutput("result", Sdf.ValueTypeNames.Float3)
                surface.GetInput("diffuseColor").ConnectToSource(output)
            else:
                surface.GetInput("diffuseColor").Set(Gf.Vec3f(*color))
            surface.GetInput("roughness").Set(float(material.roughness))
            surface.GetInput("ior").Set(refraction(material.specular))
            opacity = getattr(material, "opacity", 1.0)
            if opacity < 1.0:
                surface.CreateInput("opacity", Sdf.ValueTypeNames.Float).Set(opacity)
            self._made[key] = made
        return self._made[key]

    def _begin(self, key: object, name: str) -> tuple[UsdShade.Material, UsdShade.Shader]:
        """Return a material and its surface with the inputs that every material sets."""
        made = UsdShade.Material.Define(self._stage, f"{self._scope}/{self._names.of(key, name)}")
        surface = self._node(made, "Surface", "UsdPreviewSurface")
        surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
        surface.CreateInput("roughness", Sdf.ValueTypeNames.Float)
        surface.CreateInput("ior", Sdf.ValueTypeNames.Float)
        surface.CreateInput("metallic", Sdf.ValueTypeNames.Float).Set(0.0)
        output = surface.CreateOutput("surface", Sdf.ValueTypeNames.Token)
        made.CreateSurfaceOutput().ConnectToSource(output)
        return made, surface

    def _node(self, made: UsdShade.Material, name: str, kind: str) -> UsdShade.Shader:
        node = UsdShade.Shader.Define(self._stage, made.GetPath().AppendChild(name))
        node.CreateIdAttr(kind)
        return node

    def _picture(
        self,
        made: UsdShade.Material,
        surface: UsdShade.Shader,
        material: Material | Grain,
        color: list[float],
    ) -> None:
        types = Sdf.ValueTypeNames
        reader = self._node(made, "Coordinates", "UsdPrimvarReader_float2")
        reader.CreateInput("varname", types.String).Set("st")
        sampler = self._node(made, "Picture", "UsdUVTexture")
        sampler.CreateInput("file", types.Asset).Set(self._file(material))
        sampler.CreateInput("sourceColorSpace", types.Token).Set("sRGB")
        sampler.CreateInput("wrapS", types.Token).Set("repeat")
        sampler.CreateInput("wrapT", types.Token).Set("repeat")
        sampler.CreateInput("scale", types.Float4).Set(Gf.Vec4f(*color, 1.0))
        coordinates = reader.CreateOutput("result", types.Float2)
        sampler.CreateInput("st", types.Float2).ConnectToSource(coordinates)
        surface.GetInput("diffuseColor").ConnectToSource(sampler.CreateOutput("rgb", types.Float3))
        if material.cutout:
            opacity = surface.CreateInput("opacity", types.Float)
            opacity.ConnectToSource(sampler.CreateOutput("a", types.Float))
            surface.CreateInput("opacityThreshold", types.Float).Set(0.5)

    def _file(self, material: Material | Grain) -> Sdf.AssetPath:
        name = f"{self._pictures.of(material.texture_key, material.name)}.png"
        path = self._folder / name
        texture = material.texture
        if texture is not None and not path.exists():
            path.write_bytes(_engine.encode_png(opaque(texture)))
        return Sdf.AssetPath(f"{self._base}/{name}")

    def sky(self, pixels: NDArray[np.uint8]) -> Sdf.AssetPath:
        """Write the picture of the sky; return its asset."""
        (self._folder / "sky.png").write_bytes(_engine.encode_png(pixels))
        return Sdf.AssetPath(f"{self._base}/sky.png")
