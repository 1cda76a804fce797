"""Time samples: written only when something changes, into one file or into value clips.

An attribute that never changes has a plain value. At its first change it gets the old value at the
beginning and at the frame before, then a sample per change, so that nothing drifts in between.

Long takes are cut into clips of a few seconds, each a file of its own that is written and
forgotten, so memory stays bounded. The manifest names the attributes that vary and their first
values.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, Usd, Vt

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

Value = str | float | NDArray[Any]
"""What a channel takes: a token, a number, or numpy numbers (rotations xyzw)."""

_ARRAYS: dict[str, tuple[Any, type]] = {
    "point3f[]": (Vt.Vec3fArray, np.float32),
    "vector3f[]": (Vt.Vec3fArray, np.float32),
    "normal3f[]": (Vt.Vec3fArray, np.float32),
    "float3[]": (Vt.Vec3fArray, np.float32),
    "color3f[]": (Vt.Vec3fArray, np.float32),
    "texCoord2f[]": (Vt.Vec2fArray, np.float32),
    "half3[]": (Vt.Vec3hArray, np.float16),
    "quath[]": (Vt.QuathArray, np.float16),
    "quatf[]": (Vt.QuatfArray, np.float32),
    "int[]": (Vt.IntArray, np.int32),
    "int64[]": (Vt.Int64Array, np.int64),
    "float[]": (Vt.FloatArray, np.float32),
}

_SINGLES: dict[str, Callable[[Any], Any]] = {
    "double3": lambda v: Gf.Vec3d(*map(float, v)),
    "float3": lambda v: Gf.Vec3f(*map(float, v)),
    "color3f": lambda v: Gf.Vec3f(*map(float, v)),
    "quatf": lambda v: Gf.Quatf(float(v[3]), *map(float, v[:3])),
    "float": float,
    "token": str,
}


def usd_value(attribute: Usd.Attribute, value: Value) -> object:
    """Return a value as the type that the attribute holds; rotations come as xyzw."""
    kind = str(attribute.GetTypeName())
    if kind in _SINGLES:
        return _SINGLES[kind](value)
    array, dtype = _ARRAYS[kind]
    return array.FromNumpy(np.ascontiguousarray(value, dtype))


class Channel:
    """Attributes that change together."""

    def __init__(
        self, samples: Samples, attributes: tuple[Usd.Attribute, ...], tolerance: float
    ) -> None:
        self.attributes, self._samples, self._tolerance = attributes, samples, tolerance
        self._last: tuple[Value, ...] = ()
        self._from = samples.frame
        self._written = -1
        self.first: tuple[Value, ...] = ()
        """Values before the first change."""
        self.varies = False

    def begin(self, *values: Value) -> None:
        """Say what was before now, since the beginning of the take."""
        self.set(*values)
        self._from = 0

    def set(self, *values: Value) -> None:
        """Say what is now."""
        if not self._last:
            self.first = self._last = values
            for attribute, value in zip(self.attributes, values, strict=True):
                attribute.Set(usd_value(attribute, value))
            return
        if self._same(values):
            return
        now = self._samples.frame
        if not self.varies:
            self.varies = True
            self._samples.start(self)
            self.write(max(self._from, self._samples.clip_start))
        if now - 1 > self._written:
            self.write(max(now - 1, self._from))
        self._last = values
        self.write(now)

    def _same(self, values: tuple[Value, ...]) -> bool:
        return all(map(self._equal, values, self._last))

    def _equal(self, one: Value, other: Value) -> bool:
        if isinstance(one, str):
            return bool(one == other)
        one, other = np.asarray(one), np.asarray(other)
        if one.shape != other.shape:
            return False
        if not self._tolerance:
            return np.array_equal(one, other)
        return not one.size or bool(np.abs(one - other).max() <= self._tolerance)

    def write(self, frame: int) -> None:
        """Write the last values as samples of a frame."""
        self._written = frame
        for attribute, value in zip(self.attributes, self._last, strict=True):
            self._samples.write(attribute, frame, usd_value(attribute, value))


class Samples:
    """Where samples go; without a clip length, into the stage's own layer."""

    def __init__(self, stage: Usd.Stage, clip_frames: int | None, folder: Path) -> None:
        self.frame = 0
        """Frame being written."""
        self.clip_start = 0
        """First frame of the present file."""
        self._stage, self._folder = stage, folder
        self._clip_frames = clip_frames
        self._layer = stage.GetRootLayer() if clip_frames is None else _clip_layer()
        self._known: set[Any] = set()
        self._varying: list[Channel] = []
        self._clips: list[tuple[int, str]] = []

    def channel(self, *attributes: Usd.Attribute, tolerance: float = 0.0) -> Channel:
        """Return a channel for attributes that change together.

        A change smaller than `tolerance` in every number is none.
        """
        return Channel(self, attributes, tolerance)

    def start(self, channel: Channel) -> None:
        """Note that a channel varies from now on."""
        self._varying.append(channel)
        if self._clip_frames is not None:
            for attribute in channel.attributes:
                attribute.ClearDefault()  # A value in the stage would hide the clips.

    def write(self, attribute: Usd.Attribute, frame: int, value: object) -> None:
        """Write one sample."""
        path = attribute.GetPath()
        if self._clip_frames is not None and path not in self._known:
            _declare(self._layer, path, attribute.GetTypeName())
            self._known.add(path)
        self._layer.SetTimeSample(path, float(frame), value)

    def end_frame(self) -> None:
        """Close the present clip if it is full, and begin the next with the same frame."""
        if self._clip_frames is None or self.frame - self.clip_start < self._clip_frames:
            return
        self._close_clip()
        self._layer, self.clip_start = _clip_layer(), self.frame
        for channel in self._varying:
            channel.write(self.frame)

    def _close_clip(self) -> None:
        name = f"clip_{len(self._clips):04}.usdc"
        for channel in self._varying:
            channel.write(self.frame)
        exported(self._layer, self._folder / name)
        self._clips.append((self.clip_start, name))
        self._known.clear()

    def finish(self, path: Path, name: str) -> None:
        """Write the stage to `path`, with its clips in the folder that will be called `name`."""
        if self._clip_frames is None:
            exported(self._stage.GetRootLayer(), path)
            return
        if self.frame > self.clip_start or not self._clips:
            self._close_clip()
        manifest = Sdf.Layer.CreateAnonymous(".usda")
        for channel in self._varying:
            for attribute, value in zip(channel.attributes, channel.first, strict=True):
                _declare(manifest, attribute.GetPath(), attribute.GetTypeName())
                spec = manifest.GetAttributeAtPath(attribute.GetPath())
                spec.default = usd_value(attribute, value)
        exported(manifest, self._folder / "manifest.usda")
        topology = self._stage.GetRootLayer()
        exported(topology, self._folder / "topology.usdc")
        exported(self._root(topology, name), path)

    def _root(self, topology: Sdf.Layer, name: str) -> Sdf.Layer:
        """Return the layer that puts topology and clips together."""
        layer = Sdf.Layer.CreateAnonymous(".usda")
        layer.TransferContent(topology)
        for prim in list(layer.rootPrims):
            del layer.rootPrims[prim.name]
        default = topology.defaultPrim
        layer.subLayerPaths.append(f"./{name}/topology.usdc")
        prim = Sdf.CreatePrimInLayer(layer, f"/{default}")
        starts = [start for start, _ in self._clips]
        files = [Sdf.AssetPath(f"./{name}/{file}") for _, file in self._clips]
        last = float(self.frame)
        prim.SetInfo(
            "clips",
            {
                "default": {
                    "assetPaths": Sdf.AssetPathArray(files),
                    "manifestAssetPath": Sdf.AssetPath(f"./{name}/manifest.usda"),
                    "primPath": f"/{default}",
                    "active": Vt.Vec2dArray([(start, n) for n, start in enumerate(starts)]),
                    "times": Vt.Vec2dArray([(0.0, 0.0), (last, last)]),
                }
            },
        )
        return layer


def _clip_layer() -> Sdf.Layer:
    return Sdf.Layer.CreateAnonymous(".usdc")


def _declare(layer: Sdf.Layer, path: Sdf.Path, kind: Sdf.ValueTypeName) -> None:
    Sdf.JustCreatePrimAttributeInLayer(layer, path, kind, Sdf.VariabilityVarying, False)


def exported(layer: Sdf.Layer, path: Path) -> None:
    """Write a layer to a file.

    Raises
    ------
    OSError
        If it cannot be written, for want of space or permission.
    """
    from pxr import Tf

    try:
        written = layer.Export(str(path))
    except Tf.ErrorException as error:
        raise OSError(f"{path} could not be written: {error}") from None
    if not written:
        raise OSError(f"{path} could not be written: is the disk full?")
