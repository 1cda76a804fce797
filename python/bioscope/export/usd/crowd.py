"""Rigid crowds and small round things: one PointInstancer per batch.

Every individual keeps its row for the whole take; those not yet born have no row, the dead are in
`invisibleIds`. So samples of one row always belong to one individual and can be interpolated.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from pxr import Usd, UsdGeom, UsdShade

from bioscope.export.individuals import Slots, keys, placed
from bioscope.export.usd.shape import Shape
from bioscope.geometry.palette import Palette

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Batch
    from bioscope.export.usd.looks import Looks
    from bioscope.export.usd.samples import Samples
    from bioscope.geometry.balls import Balls


class Instancer:
    """A PointInstancer with a row per individual that was ever there."""

    def __init__(self, stage: Usd.Stage, path: str, samples: Samples, *, moving: bool) -> None:
        self.path = path
        self.prim = UsdGeom.PointInstancer.Define(stage, path)
        self._slots = Slots()
        prim = self.prim
        places = [prim.CreatePositionsAttr(), *([prim.CreateVelocitiesAttr()] if moving else [])]
        self._moving = moving
        self._channels = {
            "places": samples.channel(*places),
            "rotations": samples.channel(prim.CreateOrientationsAttr(), tolerance=1e-6),
            "scales": samples.channel(prim.CreateScalesAttr()),
            "ids": samples.channel(prim.CreateIdsAttr(), prim.CreateProtoIndicesAttr()),
            "hidden": samples.channel(prim.CreateInvisibleIdsAttr()),
        }
        self._tables: dict[str, NDArray[Any]] = {}

    def frame(self, present: NDArray[np.int64], **values: NDArray[Any]) -> None:
        """Place individuals by rows of places, rotations, scales, velocities, prototypes."""
        rows = self._slots.rows(present)
        ids = self._slots.keys
        for name, new in values.items():
            old = self._tables.get(name, np.empty((0, *new.shape[1:]), new.dtype))
            self._tables[name] = placed(old, rows, new, len(ids))
        table = self._tables
        moves = [table["velocities"]] if self._moving else []
        self._channels["places"].set(table["places"], *moves)
        if "rotations" in table:
            self._channels["rotations"].set(table["rotations"])
        self._channels["scales"].set(np.repeat(table["scales"][:, None], 3, axis=1))
        self._channels["ids"].set(ids, table["prototypes"].astype(np.int32))
        self._channels["hidden"].set(np.setdiff1d(ids, present))

    def empty(self) -> None:
        """Show nobody."""
        self._channels["hidden"].set(self._slots.keys)

    def add_prototype(self, path: str) -> None:
        """Append a prototype."""
        self.prim.GetPrototypesRel().AddTarget(path)


class Crowd:
    """A batch of rigid instances."""

    def __init__(
        self, stage: Usd.Stage, path: str, batch: Batch | Balls, looks: Looks, samples: Samples
    ) -> None:
        self._stage, self._looks, self._samples = stage, looks, samples
        moving = len(batch.velocities) > 0
        self._instancer = Instancer(stage, path, samples, moving=moving)
        describe(self._instancer.prim, batch)
        self._variants = Variants(stage, f"{path}/Prototypes", batch, looks, samples)
        self._palette = Palette(batch)

    def frame(self, batch: Batch | Balls) -> None:
        """Show the batch as it is now."""
        prototypes = self._palette.assign(batch)
        for path in self._variants.extend(batch, self._palette.colors):
            self._instancer.add_prototype(path)
        velocities = batch.velocities
        if not len(velocities):
            velocities = np.zeros((len(batch.ids), 3), np.float32)
        self._instancer.frame(
            keys(batch.ids),
            places=batch.positions,
            rotations=batch.rotations,
            scales=batch.scales,
            velocities=velocities,
            prototypes=prototypes.astype(np.float32),
        )

    def empty(self) -> None:
        """Show nobody."""
        self._instancer.empty()


class Variants:
    """A mesh in several colors: the first is the mesh, the others refer to it."""

    def __init__(
        self, stage: Usd.Stage, path: str, batch: Batch | Balls, looks: Looks, samples: Samples
    ) -> None:
        self._stage, self._path, self._looks = stage, path, looks
        self._material = batch.material
        UsdGeom.Scope.Define(stage, path)
        self.shape = Shape(stage, f"{path}/Shape", batch.mesh, batch.material, samples)
        self._count = 0

    def extend(self, batch: Batch | Balls, colors: list[tuple[float, float, float]]) -> list[str]:
        """Follow the batch's mesh, add what colors are new, and return the new prims' paths."""
        self.shape.follow(batch.mesh)
        made = []
        for number in range(self._count, len(colors)):
            path = self.shape.path if number == 0 else f"{self._path}/Shape_{number + 1}"
            prim = self._stage.DefinePrim(path, "Mesh")
            if number:
                prim.GetReferences().AddInternalReference(self.shape.path)
            self.shape.tint(prim, batch.mesh, colors[number])
            colored = self.shape.colored
            bind(prim, self._looks.of(self._material, colors[number], colored=colored))
            made.append(path)
        self._count = len(colors)
        return made


def bind(prim: Usd.Prim, material: UsdShade.Material) -> None:
    """Give a prim its material."""
    UsdShade.MaterialBindingAPI.Apply(prim).Bind(material)


def describe(prim: UsdGeom.Imageable, published: Batch | Balls) -> None:
    """Write down whose prim it is."""
    prim.GetPrim().SetCustomDataByKey("bioscope:species", published.species)
