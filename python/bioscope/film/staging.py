"""A published scene as Mitsuba's shapes, kept from frame to frame by their meshes' keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.film.surfaces import COLOR, LARGEST, Surfaces, vertex_factor
from bioscope.geometry.balls import Balls
from bioscope.geometry.palette import Palette
from bioscope.geometry.skinning import bent, units
from bioscope.geometry.transforms import composed, matrices

if TYPE_CHECKING:
    from types import ModuleType

    from numpy.typing import NDArray

    from bioscope._engine import Batch, Mesh, Scene
    from bioscope.geometry.palette import Color

    Floats = NDArray[np.floating]

_MOST_MERGED = 400_000
"""Vertices of one batch that are placed in one mesh rather than by instances."""


class Form:
    """Vertices and triangles on their way into a Mitsuba mesh."""

    def __init__(self, mesh: Mesh, positions: Floats, normals: Floats) -> None:
        self.positions, self.normals = positions, normals
        self.triangles = np.asarray(mesh.triangles)
        self.uvs, self.colors = np.asarray(mesh.uvs), np.asarray(mesh.colors)

    @classmethod
    def joined(cls, forms: list[Form]) -> Form:
        """Return copies of one mesh as one form."""
        whole = forms[0]
        count, number = len(whole.positions), len(forms)
        steps = np.arange(number, dtype=np.uint32) * np.uint32(count)
        whole.triangles = (whole.triangles[None] + steps[:, None, None]).reshape(-1, 3)
        whole.positions = np.concatenate([form.positions for form in forms])
        whole.normals = np.concatenate([form.normals for form in forms])
        whole.uvs = np.tile(whole.uvs, (number, 1))
        whole.colors = np.tile(whole.colors, (number, 1))
        return whole


class Staging:
    """Builds scenes for one Mitsuba variant."""

    def __init__(self, mitsuba: ModuleType) -> None:
        self._mitsuba = mitsuba
        self._surfaces = Surfaces(mitsuba)
        self._palettes: dict[tuple[str, str], Palette] = {}
        self._kept: dict[object, Any] = {}
        self._used: dict[object, Any] = {}

    def shapes(self, scene: Scene) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return the shapes of a scene by name: the solid ones, and those with holes."""
        self._used = {}
        solid: dict[str, Any] = {}
        holed: dict[str, Any] = {}
        for batch in scene.batches:
            if len(batch.ids) and len(batch.mesh.triangles):
                holes = batch.material.cutout and batch.material.texture is not None
                self._add(holed if holes else solid, "batch", batch)
        for points in scene.points:
            if len(points.ids):
                self._add(solid, "points", Balls(points))
        self._kept = self._used
        return solid, holed

    def _add(self, found: dict[str, Any], kind: str, batch: Batch | Balls) -> None:
        palette = self._palettes.setdefault((kind, batch.name), Palette(batch, limit=8))
        numbers = palette.assign(batch)
        for number, tint in enumerate(palette.colors):
            rows = np.flatnonzero(numbers == number)
            if len(rows):
                # Names of scene entries must not contain dots.
                name = f"{kind} {batch.name} {number}".replace(".", "_")
                found.update(self._colored(name, batch, rows, tint))

    def _colored(
        self, name: str, batch: Batch | Balls, rows: NDArray[np.int64], tint: Color
    ) -> dict[str, Any]:
        """Return the shapes of the instances of one color."""
        mesh = batch.mesh
        if len(batch.poses):
            poses = composed(batch.transforms[rows, None], batch.poses[rows])
            forms = [Form(mesh, *bent(mesh, pose)) for pose in poses]
            return {name: self._mesh(Form.joined(forms), batch, tint)}
        places = np.ascontiguousarray(batch.transforms[rows])
        if len(rows) * len(mesh.positions) <= _MOST_MERGED:
            whole_key = (mesh.key, batch.material.key, tint, places.tobytes())
            return {name: self._keep(whole_key, lambda: self._merged(batch, places, tint))}
        key = (mesh.key, batch.material.key, tint)
        group = self._keep(key, lambda: self._group(batch, tint))
        found = {f"{name} group": group}
        for number, matrix in enumerate(matrices(places)):
            to_world = self._mitsuba.ScalarTransform4f(np.vstack([matrix, [0, 0, 0, 1]]))
            instance = {"type": "instance", "to_world": to_world, "group": group}
            found[f"{name} {number}"] = instance
        return found

    def _keep(self, key: object, make: Any) -> Any:
        if key not in self._used:
            self._used[key] = self._kept[key] if key in self._kept else make()
        return self._used[key]

    def _merged(self, batch: Batch | Balls, places: Floats, tint: Color) -> Any:
        forms = [self._placed(batch.mesh, place) for place in places]
        return self._mesh(Form.joined(forms), batch, tint)

    def _group(self, batch: Batch | Balls, tint: Color) -> Any:
        mesh = batch.mesh
        form = Form(mesh, np.asarray(mesh.positions), np.asarray(mesh.normals))
        child = self._mesh(form, batch, tint)
        return self._mitsuba.load_dict({"type": "shapegroup", "shape": child})

    @staticmethod
    def _placed(mesh: Mesh, place: Floats) -> Form:
        matrix = matrices(place)
        moved = mesh.positions @ matrix[:, :3].T + matrix[:, 3]
        return Form(mesh, moved, units(mesh.normals @ matrix[:, :3].T))

    def _mesh(self, form: Form, batch: Batch | Balls, tint: Color) -> Any:
        """Return a Mitsuba mesh with the batch's material in a tint."""
        mitsuba, material = self._mitsuba, batch.material
        colored, mapped = len(form.colors) > 0, len(form.uvs) > 0
        properties = mitsuba.Properties()
        properties["surface"] = self._surfaces.of(material, tint, colored=colored, mapped=mapped)
        mesh = mitsuba.Mesh(
            batch.name,
            len(form.positions),
            len(form.triangles),
            has_vertex_normals=True,
            has_vertex_texcoords=mapped,
            props=properties,
        )
        if colored:
            factor = vertex_factor(material, tint, mapped=mapped)
            colors = np.clip(form.colors * factor, 0.0, LARGEST)
            mesh.add_attribute(COLOR, 3, _flat(colors, np.float32))
        values = mitsuba.traverse(mesh)
        values["vertex_positions"] = _flat(form.positions, np.float32)
        values["vertex_normals"] = _flat(form.normals, np.float32)
        values["faces"] = _flat(form.triangles, np.uint32)
        if mapped:
            values["vertex_texcoords"] = _flat(form.uvs, np.float32)
        values.update()
        return mesh


def _flat(values: NDArray[Any], dtype: type) -> NDArray[Any]:
    return np.ascontiguousarray(values, dtype).reshape(-1)
