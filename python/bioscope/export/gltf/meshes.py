"""Meshes: attributes stored once per form, however many colors and individuals share them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.geometry.skinning import units

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Mesh
    from bioscope.export.gltf.container import Container


class Meshes:
    """The meshes of a file."""

    def __init__(self, container: Container) -> None:
        self._container = container
        self._primitives: dict[tuple[int, bool], dict[str, Any]] = {}
        self._made: dict[object, int] = {}

    def of(self, name: str, forms: list[Mesh], material: int) -> int:
        """Return a mesh in a material; further forms of it become morph targets."""
        key = (forms[0].key, len(forms), material)
        if key not in self._made:
            surface = self._container.lists["materials"][material]["pbrMetallicRoughness"]
            pictured = "baseColorTexture" in surface
            primitive = {**self._primitive(forms[0], pictured=pictured), "material": material}
            entry: dict[str, Any] = {"name": name, "primitives": [primitive]}
            if len(forms) > 1:
                primitive["targets"] = [self._target(forms[0], form) for form in forms[1:]]
                entry["weights"] = [0.0] * (len(forms) - 1)
            self._made[key] = self._container.add("meshes", entry)
        return self._made[key]

    def _primitive(self, mesh: Mesh, *, pictured: bool) -> dict[str, Any]:
        key = (mesh.key, pictured)
        if key not in self._primitives:
            file = self._container
            attributes = {
                "POSITION": file.vertices(mesh.positions, bounds=True),
                "NORMAL": file.vertices(units(mesh.normals)),
            }
            if pictured and len(mesh.uvs):
                attributes["TEXCOORD_0"] = file.vertices(mesh.uvs)
            if len(mesh.colors):
                attributes["COLOR_0"] = file.vertices(
                    (mesh.colors / brightest(mesh)).astype(np.float32)
                )
            if mesh.joints:
                indices, weights = bindings(mesh)
                attributes["JOINTS_0"] = file.vertices(indices)
                attributes["WEIGHTS_0"] = file.vertices(weights)
            triangles = file.indices(mesh.triangles, len(mesh.positions))
            self._primitives[key] = {"attributes": attributes, "indices": triangles}
        return self._primitives[key]

    def _target(self, base: Mesh, form: Mesh) -> dict[str, int]:
        file = self._container
        moved = form.positions - base.positions
        turned = units(form.normals) - units(base.normals)
        return {"POSITION": file.vertices(moved, bounds=True), "NORMAL": file.vertices(turned)}


def brightest(mesh: Mesh) -> float:
    """Return the factor by which vertex colors are divided, as glTF's reach 1 only."""
    return max(1.0, float(mesh.colors.max())) if len(mesh.colors) else 1.0


def same_build(forms: list[Mesh]) -> bool:
    """Whether meshes differ only in where their vertices are."""
    first = forms[0]
    return all(
        len(form.positions) == len(first.positions)
        and np.array_equal(form.triangles, first.triangles)
        for form in forms[1:]
    )


def bindings(mesh: Mesh) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Return joint numbers and weights (n, 4) as glTF wants them.

    No joint twice at a vertex, joint 0 where the weight is 0, sums of exactly 1.
    """
    indices, weights = np.array(mesh.joint_indices), mesh.joint_weights.astype(np.float64)
    for later in range(1, 4):
        for earlier in range(later):
            same = indices[:, later] == indices[:, earlier]
            weights[same, earlier] += weights[same, later]
            weights[same, later] = 0.0
    indices[weights == 0.0] = 0
    weights /= weights.sum(axis=1, keepdims=True)
    return indices, weights.astype(np.float32)
