"""Recorded batches as nodes.

Each individual is a node with the shared mesh, or, if it is jointed, a skeleton of nodes with a
skin. A great number of things that stay is one node with `EXT_mesh_gpu_instancing` per cell of
space; a reader that does not know the extension shows the first of each cell in its place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.export.gltf.animation import continuous, placement
from bioscope.export.gltf.meshes import brightest, same_build
from bioscope.geometry.balls import Balls
from bioscope.geometry.skinning import rest_pose
from bioscope.geometry.transforms import composed, inverse, matrices

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from bioscope._engine import Mesh
    from bioscope.export.gltf.animation import Animation
    from bioscope.export.gltf.container import Container
    from bioscope.export.gltf.materials import Materials
    from bioscope.export.gltf.meshes import Meshes
    from bioscope.export.gltf.recording import Recording

_MOST_NODES = 5000
"""Individuals of one batch that get a node each."""
_MANY = 256
"""Things that stay and are at least so many are instanced by the extension."""
_CELL_METRES = 16.0
_MOST_TARGETS = 12
"""Forms that a deforming mesh keeps besides its first."""


class Batches:
    """Writes recordings into a file; `roots` are the nodes of the scene."""

    def __init__(
        self,
        container: Container,
        animation: Animation,
        materials: Materials,
        meshes: Meshes,
        times: NDArray[np.float32],
        say: Callable[[str], object],
    ) -> None:
        self.roots: list[int] = []
        self._file, self._animation = container, animation
        self._materials, self._meshes = materials, meshes
        self._times, self._say = times, say

    def write(self, recording: Recording) -> None:
        """Write one batch."""
        presence = recording.presence(len(self._times))
        motion = recording.motion(presence)
        forms, weights = self._forms(recording)
        batch = recording.first
        factor = brightest(forms[0])
        tints = [
            (red * factor, green * factor, blue * factor)
            for red, green, blue in recording.palette.colors
        ]
        meshes = [
            self._meshes.of(batch.name, forms, self._materials.of(batch.material, tint))
            for tint in tints
        ]
        still = presence.all() and np.array_equal(motion, motion[:, :1].repeat(motion.shape[1], 1))
        crowded = len(presence) > _MOST_NODES
        if crowded and not still:
            self._say(
                f"{batch.name}: more than {_MOST_NODES} individuals; they stay where they begin"
            )
        if batch.mesh.joints and not crowded:
            group = self._jointed(recording, meshes, motion, presence)
        elif crowded and isinstance(batch, Balls):
            group = [self._cloud(recording, motion[presence[:, 0], 0, 0])]
        elif crowded or (still and len(presence) >= _MANY):
            group = self._instanced(recording, meshes, motion[:, 0, 0])
        else:
            group = self._nodes(recording, meshes, motion[:, :, 0], presence)
            for node in group if weights is not None else []:
                self._animation.channel(node, "weights", *weights)
        extras = {"species": batch.species}
        entry = {"name": batch.name, "children": group, "extras": extras}
        self.roots.append(self._file.add("nodes", entry))

    def _forms(self, recording: Recording) -> tuple[list[Mesh], Any]:
        """Return the forms of the mesh to keep, and the times and weights of their turns."""
        frames = [frame for frame, _ in recording.forms]
        forms = [form for _, form in recording.forms]
        if len(forms) == 1:
            return forms, None
        if forms[0].joints or not same_build(forms):
            self._say(
                f"{recording.first.name}: it changes its build; every frame has its first form"
            )
            return forms[:1], None
        kept = np.unique(np.linspace(0, len(forms) - 1, _MOST_TARGETS + 1).round().astype(int))
        times = self._times[[frames[index] for index in kept]]
        turns = np.eye(len(kept), dtype=np.float32)[:, 1:]
        return [forms[index] for index in kept], (times, turns.reshape(-1))

    def _nodes(
        self,
        recording: Recording,
        meshes: list[int],
        motion: NDArray[np.float32],
        presence: NDArray[np.bool_],
    ) -> list[int]:
        made = []
        for row, key in enumerate(recording.keys.tolist()):
            entry = {"mesh": meshes[recording.colors[row]], "extras": {"id": key & 0xFFFFFFFF}}
            node = self._file.add("nodes", {**entry, **placement(motion[row, 0])})
            self._animation.transform(node, motion[row], presence[row])
            made.append(node)
        return made

    def _jointed(
        self,
        recording: Recording,
        meshes: list[int],
        motion: NDArray[np.float32],
        presence: NDArray[np.bool_],
    ) -> list[int]:
        """Write skeletons; skinned meshes are roots, as their joints alone place them."""
        mesh = recording.first.mesh
        joints = [(name, parent) for name, parent, _ in mesh.joints]
        bind = self._file.numbers(_columns(inverse(rest_pose(mesh))))
        made = []
        for row, key in enumerate(recording.keys.tolist()):
            name = f"{recording.first.name} {key}"
            numbers = [
                self._file.add("nodes", {"name": joint, **placement(motion[row, 0, 1 + index])})
                for index, (joint, _) in enumerate(joints)
            ]
            for index, (_, parent) in enumerate(joints):
                if parent is not None:
                    above = self._file.lists["nodes"][numbers[parent]]
                    above.setdefault("children", []).append(numbers[index])
            top = [
                number
                for number, (_, parent) in zip(numbers, joints, strict=True)
                if parent is None
            ]
            entry = {"name": name, "children": top, "extras": {"id": key & 0xFFFFFFFF}}
            place = self._file.add("nodes", {**entry, **placement(motion[row, 0, 0])})
            skin = {"joints": numbers, "inverseBindMatrices": bind, "skeleton": place}
            body = {
                "name": f"{name} body",
                "mesh": meshes[recording.colors[row]],
                "skin": self._file.add("skins", skin),
            }
            self.roots.append(self._file.add("nodes", body))
            always = np.ones(len(self._times), bool)
            self._animation.transform(place, motion[row, :, 0], presence[row])
            for index, number in enumerate(numbers):
                self._animation.transform(number, motion[row, :, 1 + index], always)
            made.append(place)
        return made

    def _instanced(
        self, recording: Recording, meshes: list[int], places: NDArray[np.float32]
    ) -> list[int]:
        """Write instances by cells of space and color; each cell's node stands at its first."""
        self._file.extensions.add("EXT_mesh_gpu_instancing")
        colors = np.array([recording.colors[row] for row in range(len(places))])
        cells = np.floor(places[:, [0, 2]] / _CELL_METRES)
        groups, members = np.unique(np.column_stack([colors, cells]), axis=0, return_inverse=True)
        made = []
        for number, group in enumerate(groups):
            rows = np.flatnonzero(members.reshape(-1) == number)
            first = places[rows[0]]
            inside = composed(inverse(first), places[rows])
            attributes = {
                "TRANSLATION": self._file.numbers(inside[:, :3].astype(np.float32)),
                "ROTATION": self._file.numbers(_unit_rows(inside[:, 4:])),
                "SCALE": self._file.numbers(
                    np.repeat(inside[:, 3:4], 3, axis=1).astype(np.float32)
                ),
            }
            entry = {
                "mesh": meshes[int(group[0])],
                "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}},
                "extras": {"ids": (recording.keys[rows] & 0xFFFFFFFF).tolist()},
            }
            made.append(self._file.add("nodes", {**entry, **placement(first)}))
        return made

    def _cloud(self, recording: Recording, places: NDArray[np.float32]) -> int:
        """Write the points of the first frame as a cloud that stays."""
        material = self._materials.of(recording.first.material)
        positions = self._file.vertices(np.ascontiguousarray(places[:, :3]), bounds=True)
        primitive = {"attributes": {"POSITION": positions}, "mode": 0, "material": material}
        mesh = self._file.add("meshes", {"name": recording.first.name, "primitives": [primitive]})
        return self._file.add("nodes", {"mesh": mesh})


def _unit_rows(rotations: NDArray[np.floating]) -> NDArray[np.float32]:
    return np.concatenate([continuous(row[None]) for row in rotations.astype(np.float32)])


def _columns(transforms: NDArray[np.floating]) -> NDArray[np.float32]:
    """Return the matrices of similarities (n, 8), columns after each other, (n, 16)."""
    whole = np.zeros((len(transforms), 4, 4), np.float32)
    whole[:, :3] = matrices(transforms)
    whole[:, 3, 3] = 1.0
    return np.swapaxes(whole, 1, 2).reshape(-1, 16)
