"""One prim per individual: jointed bodies with UsdSkel, rigid ones for plain importers.

Each color of a batch has an abstract body (a class); every individual is an instance of one,
placed by its own transform. A jointed individual has a SkelAnimation of its own beside it; mesh
and skeleton are shared by all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel, Vt

from bioscope.export.individuals import keys
from bioscope.export.names import Names
from bioscope.export.usd.crowd import bind, describe
from bioscope.export.usd.samples import usd_value
from bioscope.export.usd.shape import Shape
from bioscope.geometry.palette import Palette
from bioscope.geometry.skinning import parents, rest_pose
from bioscope.geometry.transforms import matrices, relative_to_parents

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Batch, Mesh
    from bioscope.export.usd.looks import Looks
    from bioscope.export.usd.samples import Channel, Samples
    from bioscope.geometry.balls import Balls

_LENGTH_TOLERANCE = 2e-6
"""Metres: changes of a joint's place below this are rounding."""


class Bodies:
    """A batch of individuals, each a prim."""

    def __init__(
        self, stage: Usd.Stage, path: str, batch: Batch | Balls, looks: Looks, samples: Samples
    ) -> None:
        self._stage, self._path, self._looks, self._samples = stage, path, looks, samples
        self._mesh = batch.mesh
        self.skeleton = Joints(batch.mesh) if batch.mesh.joints else None
        root = UsdGeom.Xform.Define(stage, path)
        describe(root, batch)
        if self.skeleton:
            UsdGeom.Scope.Define(stage, f"{path}/Animations")
        self._palette = Palette(batch)
        self._shape: Shape | None = None
        self._bodies: list[str] = []
        self._individuals: dict[int, Individual] = {}

    @property
    def mesh_key(self) -> int:
        """Key of the mesh that all have."""
        key: int = self._mesh.key
        return key

    def frame(self, batch: Batch | Balls) -> None:
        """Show the batch as it is now."""
        colors = self._palette.assign(batch)
        for number in range(len(self._bodies), len(self._palette.colors)):
            self._bodies.append(self._body(batch, number))
        local = self.skeleton.local(batch) if self.skeleton else None
        present = keys(batch.ids).tolist()
        for index, key in enumerate(present):
            one = self._individuals.get(key)
            if one is None:
                one = self._individual(key, self._bodies[colors[index]])
                self._individuals[key] = one
            one.place(batch.transforms[index])
            if local is not None:
                one.pose(local[index])
        for key in self._individuals.keys() - set(present):
            self._individuals[key].hide()

    def empty(self) -> None:
        """Show nobody."""
        for one in self._individuals.values():
            one.hide()

    def _body(self, batch: Batch | Balls, number: int) -> str:
        """Write the abstract body of a color; return its path."""
        path = f"{self._path}/_body_{number + 1}"
        color = self._palette.colors[number]
        prim = self._stage.CreateClassPrim(path)
        prim.SetTypeName("SkelRoot" if self.skeleton else "Xform")
        if self._shape is None:
            self._shape = Shape(
                self._stage, f"{path}/Shape", batch.mesh, batch.material, self._samples
            )
            if self.skeleton:
                self.skeleton.write(self._stage, prim, self._shape)
        else:
            prim.GetReferences().AddInternalReference(self._bodies[0])
        shape = self._stage.OverridePrim(f"{path}/Shape")
        self._shape.tint(shape, batch.mesh, color)
        bind(shape, self._looks.of(batch.material, color, colored=self._shape.colored))
        return path

    def _individual(self, key: int, body: str) -> Individual:
        name = f"i{key}"
        prim = self._stage.DefinePrim(
            f"{self._path}/{name}", "SkelRoot" if self.skeleton else "Xform"
        )
        prim.GetReferences().AddInternalReference(body)
        prim.SetInstanceable(True)
        prim.SetCustomDataByKey("bioscope:id", key)
        motion = None
        if self.skeleton:
            motion = self.skeleton.animation(self._stage, f"{self._path}/Animations/{name}")
            UsdSkel.BindingAPI.Apply(prim).CreateAnimationSourceRel().SetTargets([motion.GetPath()])
        return Individual(prim, motion, self._samples)


class Individual:
    """One placed, perhaps jointed body."""

    def __init__(self, prim: Usd.Prim, motion: UsdSkel.Animation | None, samples: Samples) -> None:
        form = UsdGeom.Xformable(prim)
        self._place = samples.channel(form.AddTranslateOp().GetAttr())
        self._turn = samples.channel(form.AddOrientOp().GetAttr(), tolerance=1e-6)
        self._scale = samples.channel(form.AddScaleOp().GetAttr())
        self._visible = samples.channel(UsdGeom.Imageable(prim).CreateVisibilityAttr())
        if samples.frame:
            self._visible.begin(UsdGeom.Tokens.invisible)
        self._joints: list[Channel] = []
        if motion is not None:
            self._joints = [
                samples.channel(motion.CreateTranslationsAttr(), tolerance=_LENGTH_TOLERANCE),
                samples.channel(motion.CreateRotationsAttr(), tolerance=1e-6),
                samples.channel(motion.CreateScalesAttr(), tolerance=1e-5),
            ]

    def place(self, transform: NDArray[np.float32]) -> None:
        """Be here."""
        self._visible.set(UsdGeom.Tokens.inherited)
        self._place.set(transform[:3].copy())
        self._turn.set(transform[4:].copy())
        self._scale.set(np.repeat(transform[3], 3))

    def pose(self, local: NDArray[np.floating]) -> None:
        """Hold the joints so; (joints, 8) relative to their parents."""
        values = local[:, :3], local[:, 4:], np.repeat(local[:, 3:4], 3, axis=1)
        for channel, value in zip(self._joints, values, strict=True):
            channel.set(value)

    def hide(self) -> None:
        """Be no more."""
        self._visible.set(UsdGeom.Tokens.invisible)


class Joints:
    """The skeleton that all individuals of a batch share."""

    def __init__(self, mesh: Mesh) -> None:
        self._mesh = mesh
        self._parents = parents(mesh)
        self._rest = rest_pose(mesh).astype(np.float64)
        names = Names()
        paths: list[str] = []
        for number, (name, parent, _) in enumerate(mesh.joints):
            own = names.of(number, name)
            paths.append(own if parent is None else f"{paths[parent]}/{own}")
        self.tokens = Vt.TokenArray(paths)
        """Paths of the joints."""

    def local(self, batch: Batch | Balls) -> NDArray[np.floating]:
        """Return the joints relative to their parents, (instances, joints, 8)."""
        poses = batch.poses.astype(np.float64)
        if not len(poses):
            poses = np.broadcast_to(self._rest, (len(batch.ids), *self._rest.shape))
        return relative_to_parents(poses, self._parents)

    def write(self, stage: Usd.Stage, root: Usd.Prim, shape: Shape) -> None:
        """Write the skeleton under `root` and bind the shape to it."""
        skeleton = UsdSkel.Skeleton.Define(stage, root.GetPath().AppendChild("Skeleton"))
        skeleton.CreateJointsAttr(self.tokens)
        skeleton.CreateBindTransformsAttr(_matrices(self._rest))
        local = relative_to_parents(self._rest, self._parents)
        skeleton.CreateRestTransformsAttr(_matrices(local))
        UsdSkel.BindingAPI.Apply(root).CreateSkeletonRel().SetTargets([skeleton.GetPath()])
        binding = UsdSkel.BindingAPI.Apply(shape.prim.GetPrim())
        indices = binding.CreateJointIndicesPrimvar(False, 4)
        indices.GetAttr().Set(usd_value(indices.GetAttr(), self._mesh.joint_indices.reshape(-1)))
        weights = binding.CreateJointWeightsPrimvar(False, 4)
        weights.GetAttr().Set(usd_value(weights.GetAttr(), self._mesh.joint_weights.reshape(-1)))

    def animation(self, stage: Usd.Stage, path: str) -> UsdSkel.Animation:
        """Return a new animation of these joints."""
        animation = UsdSkel.Animation.Define(stage, path)
        animation.CreateJointsAttr(self.tokens)
        return animation


def _matrices(transforms: NDArray[np.floating]) -> Vt.Matrix4dArray:
    """Return similarities (n, 8) as USD's matrices, which are applied to rows."""
    columns = matrices(transforms)
    whole = np.zeros((len(transforms), 4, 4))
    whole[:, :3, :3] = np.swapaxes(columns[:, :, :3], 1, 2)
    whole[:, 3, :3] = columns[:, :, 3]
    whole[:, 3, 3] = 1.0
    return Vt.Matrix4dArray.FromNumpy(whole)
