"""Meshes: written once, or as samples while they deform."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pxr import Sdf, Usd, UsdGeom

if TYPE_CHECKING:
    from bioscope._engine import Material, Mesh
    from bioscope.export.usd.samples import Samples
    from bioscope.geometry.balls import Grain
    from bioscope.geometry.palette import Color


class Shape:
    """One mesh prim; follows a mesh that is published anew."""

    def __init__(
        self, stage: Usd.Stage, path: str, mesh: Mesh, material: Material | Grain, samples: Samples
    ) -> None:
        self.path = path
        self.prim = UsdGeom.Mesh.Define(stage, path)
        self.prim.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        self.prim.CreateDoubleSidedAttr(material.two_sided)
        self.prim.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
        self._material = material
        prim = self.prim
        self._form = samples.channel(
            prim.CreatePointsAttr(), prim.CreateNormalsAttr(), prim.CreateExtentAttr()
        )
        self._topology = samples.channel(
            prim.CreateFaceVertexCountsAttr(), prim.CreateFaceVertexIndicesAttr()
        )
        self._uvs = self._colors = None
        if len(mesh.uvs):
            uvs = _primvar(prim, "st", Sdf.ValueTypeNames.TexCoord2fArray)
            self._uvs = samples.channel(uvs.GetAttr())
        if len(mesh.colors):
            colors = _primvar(prim, "displayColor", Sdf.ValueTypeNames.Color3fArray)
            self._colors = samples.channel(colors.GetAttr())
        self.key = -1
        self.follow(mesh)

    @property
    def colored(self) -> bool:
        """Whether the mesh has vertex colors."""
        return self._colors is not None

    def follow(self, mesh: Mesh) -> None:
        """Take the form of `mesh` from this frame on."""
        if mesh.key == self.key:
            return
        self.key = mesh.key
        positions = np.array(mesh.positions)
        extent = np.stack([positions.min(axis=0), positions.max(axis=0)])
        self._form.set(positions, np.array(mesh.normals), extent)
        triangles = np.array(mesh.triangles)
        self._topology.set(np.full(len(triangles), 3), triangles.reshape(-1))
        if self._uvs is not None and len(mesh.uvs):
            self._uvs.set(mesh.uvs * [1.0, -1.0] + [0.0, 1.0])
        if self._colors is not None and len(mesh.colors):
            self._colors.set(mesh.colors * np.array(self._material.color, np.float32))

    def tint(self, prim: Usd.Prim, mesh: Mesh, color: Color) -> None:
        """Write the vertex colors of a tinted copy of this mesh, if it has such."""
        if self.colored:
            primvar = _primvar(UsdGeom.Mesh(prim), "displayColor", Sdf.ValueTypeNames.Color3fArray)
            scale = np.array(self._material.color, np.float32) * np.array(color, np.float32)
            primvar.Set((mesh.colors * scale).tolist())


def _primvar(prim: UsdGeom.Mesh, name: str, kind: Sdf.ValueTypeName) -> UsdGeom.Primvar:
    return UsdGeom.PrimvarsAPI(prim).CreatePrimvar(name, kind, UsdGeom.Tokens.vertex)
