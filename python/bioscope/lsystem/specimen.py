"""One grown plant, alone: to a model file or a picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bioscope import _engine
from bioscope.errors import FormatError, InvalidValueError
from bioscope.files import written_whole
from bioscope.lsystem.lsystem import LSystem
from bioscope.lsystem.turtle import Turtle
from bioscope.world import Population, World

if TYPE_CHECKING:
    from bioscope._engine import Mesh, Publication

SUFFIXES = (".glb", ".obj", ".usdc", ".usda", ".png")


def grow(path: Path, output: Path, steps: int | None, seed: int) -> Mesh:
    """Grow the plant of a model file and write its shape; return the mesh.

    Raises
    ------
    InvalidValueError
        For another suffix than .glb, .obj, .usdc, .usda or .png.
    FormatError
        If the model is wrong, or draws nothing.
    """
    if output.suffix not in SUFFIXES:
        raise InvalidValueError(f"{output}: expected a name that ends in {', '.join(SUFFIXES)}")
    string = LSystem.read(path).derive(steps, seed)
    mesh = Turtle().interpret(string).mesh(palette=palette_beside(path))
    if len(mesh.triangles) == 0:
        raise FormatError(f"{path}: nothing to see: the turtle draws neither strokes nor surfaces")
    if output.suffix == ".obj":
        _write_obj(output, mesh)
    elif output.suffix == ".png":
        _write_picture(output, mesh)
    else:
        from bioscope.export import export_world

        world = World(seed=seed, title=path.stem)
        world.add(Specimen(mesh, path.stem))
        export_world(world, output, world.dt, 1 / world.dt, say=lambda *_: None)
    return mesh


def palette_beside(path: Path) -> list[tuple[float, float, float]] | None:
    """Return the colours of the .colors file beside a model; none if there is no such file."""
    file = path.with_suffix(".colors")
    if not file.is_file():
        return None
    colors: dict[int, tuple[float, float, float]] = {}
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        try:
            index, red, green, blue = int(words[0]), *map(float, words[1:4])
        except (ValueError, IndexError):
            raise FormatError(f"{file}:{number}: expected a number, red, green and blue") from None
        colors[index] = (red, green, blue)
    return [colors.get(index, (0.5, 0.5, 0.5)) for index in range(max(colors, default=0) + 1)]


class Specimen(Population):
    """One mesh that stands still."""

    transient = ("mesh", "material")

    def __init__(self, mesh: Mesh, title: str) -> None:
        self.title = title
        self.mesh = mesh
        self.material = _engine.Material(title, color=(1.0, 1.0, 1.0), two_sided=True)
        self.ids = np.empty(0, np.uint32)

    def settle(self) -> int:
        """Ask for one."""
        return 1

    def born(self, ids: np.ndarray) -> None:
        """Take its identity."""
        self.ids = ids

    def publish(self, scene: Publication) -> None:
        """Stand at the origin."""
        place = np.zeros((len(self.ids), 3), np.float32)
        scene.instances(self.title, self.mesh, self.material, ids=self.ids, positions=place)


def _write_obj(output: Path, mesh: Mesh) -> None:
    lines = [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in mesh.positions]
    lines += [f"vn {x:.4f} {y:.4f} {z:.4f}" for x, y, z in mesh.normals]
    lines += [f"f {a}//{a} {b}//{b} {c}//{c}" for a, b, c in mesh.triangles + 1]
    with written_whole(output) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _write_picture(output: Path, mesh: Mesh) -> None:
    world = World(seed=1, title="specimen")
    world.add(Specimen(mesh, "specimen"))
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    middle = tuple(float(one) for one in (low + high) / 2)
    reach = float(np.linalg.norm(high - low)) * 1.35
    place = (middle[0] + reach * 0.3, middle[1] + reach * 0.12, middle[2] + reach * 0.95)
    camera = _engine.Camera.looking_at(place, middle, math.radians(40))
    picture = _engine.Rasterizer(picture=True).picture(world.scene, camera, 960, 960)
    with written_whole(output) as temporary:
        temporary.write_bytes(_engine.encode_png(picture))
