"""The file itself: a JSON chunk that describes, a binary chunk that holds the numbers."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from bioscope._engine import VERSION
from bioscope.errors import LimitError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_COMPONENTS = {"uint8": 5121, "uint16": 5123, "uint32": 5125, "float32": 5126}
_SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_VERTICES, _INDICES = 34962, 34963
_MOST_BYTES = 2**31
"""Readers keep the whole file in memory and count in 32 bits."""


class Container:
    """A glTF file in the making: `lists` by the format's own names, entries by their index."""

    def __init__(self) -> None:
        self.lists: dict[str, list[Any]] = {}
        self.extensions: set[str] = set()
        """Extensions used; none is required."""
        self.shared: dict[str, Any] = {}
        """What extensions say of the whole file."""
        self._blocks: list[bytes] = []
        self._length = 0

    def add(self, kind: str, entry: dict[str, Any]) -> int:
        """Append an entry to a list (`nodes`, `meshes`, …); return its index."""
        entries = self.lists.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def vertices(self, values: NDArray[Any], *, bounds: bool = False) -> int:
        """Store a vertex attribute (n, width); return the accessor."""
        return self._accessor(values, bounds=bounds, target=_VERTICES)

    def indices(self, values: NDArray[np.integer], vertices: int) -> int:
        """Store vertex numbers in the narrowest type."""
        dtype = np.uint16 if vertices < 0xFFFF else np.uint32
        return self._accessor(values.reshape(-1).astype(dtype), target=_INDICES)

    def numbers(self, values: NDArray[Any], *, bounds: bool = False) -> int:
        """Store numbers that are no vertices: times, matrices, keyframes, instances."""
        return self._accessor(values, bounds=bounds)

    def _accessor(
        self, values: NDArray[Any], *, bounds: bool = False, target: int | None = None
    ) -> int:
        width = 1 if values.ndim == 1 else values.shape[1]
        entry: dict[str, Any] = {
            "bufferView": self.view(np.ascontiguousarray(values).tobytes(), target),
            "componentType": _COMPONENTS[values.dtype.name],
            "count": len(values),
            "type": _SHAPES[width],
        }
        if bounds:
            rows = values.reshape(len(values), width)
            entry["min"], entry["max"] = rows.min(axis=0).tolist(), rows.max(axis=0).tolist()
        return self.add("accessors", entry)

    def view(self, data: bytes, target: int | None = None) -> int:
        """Store bytes; return the buffer view.

        Raises
        ------
        LimitError
            If the file would grow beyond what its readers can open.
        """
        entry: dict[str, Any] = {"buffer": 0, "byteOffset": self._length, "byteLength": len(data)}
        if target is not None:
            entry["target"] = target
        padded = data + bytes(-len(data) % 4)
        self._blocks.append(padded)
        self._length += len(padded)
        if self._length > _MOST_BYTES:
            raise LimitError("a .glb holds 2 GiB: export fewer seconds, or to .usdc")
        return self.add("bufferViews", entry)

    def write(self, path: Path, scene: dict[str, Any]) -> None:
        """Write the file with one scene."""
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": f"Bioscope {VERSION}"},
            "scene": 0,
            "scenes": [scene],
            **self.lists,
        }
        if self._length:
            document["buffers"] = [{"byteLength": self._length}]
        if self.extensions:
            document["extensionsUsed"] = sorted(self.extensions)
        if self.shared:
            document["extensions"] = self.shared
        text = msgspec.json.encode(document)
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + (8 + self._length if self._length else 0)
        with path.open("wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, total))
            file.write(struct.pack("<I4s", len(text), b"JSON"))
            file.write(text)
            if self._length:
                file.write(struct.pack("<I4s", self._length, b"BIN\0"))
                file.writelines(self._blocks)
