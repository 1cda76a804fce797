"""One grown plant, alone: to a model file or a picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope import _engine
from bioscope.environments import Amounts, named
from bioscope.errors import FormatError, InvalidValueError
from bioscope.files import written_whole
from bioscope.lsystem.lsystem import LSystem
from bioscope.lsystem.turtle import Turtle, read_colors
from bioscope.world import Population, World

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Material, Mesh, Publication
    from bioscope.environments import Environment

SUFFIXES = (".glb", ".obj", ".usdc", ".usda", ".png")
VIEW_DEGREES = 30.0
VIEW_ANGLE = math.radians(VIEW_DEGREES)
VIEW_LIMITS = (16, 4096)
FLOOR = (0.50, 0.48, 0.44)
LEVELS = (0.45, 0.8)
"""Amounts whose surfaces are seen, as shares of the way from the least to the greatest."""
WATER = (0.06, 0.30, 0.85)
"""Linear color of the surface of the greatest amount; those of less are darker."""
VEIL = 0.3
"""How much of what is behind such a surface it hides."""
HAZELESS = 20.0
"""Size in metres from which haze would hide what is far away."""


def grow(path: Path, output: Path, steps: int | None, seed: int | None, **files: Any) -> Mesh:
    """Grow the plant of a model file and write its shape; return the mesh.

    Parameters
    ----------
    path, output
        The L-system file; what to write.
    steps, seed
        As many steps as the file says, if not given; a file of the cpfg dialect without a seed
        gives the plant of the reference program.
    **files
        `view` (a .v file), `environment` (a name with parameters, or an .e file) and `colors`
        (a .map, .mat or .colors file), as cpfg takes them.

    Raises
    ------
    InvalidValueError
        For another suffix than .glb, .obj, .usdc, .usda or .png.
    FormatError
        If the model is wrong, or draws nothing.
    """
    if output.suffix not in SUFFIXES:
        known = ", ".join((*SUFFIXES, ".mp4"))
        raise InvalidValueError(f"{output}: expected a name that ends in {known}")
    system = LSystem.read(path)
    around = surroundings(system, files.pop("environment", None))
    mesh = shape(path, system, steps, seed, environment=around, **files)
    if output.suffix == ".obj":
        _write_obj(output, mesh)
    elif output.suffix == ".png":
        with written_whole(output) as temporary:
            pixels = portrait(mesh, 960, 960, around=around)
            temporary.write_bytes(_engine.encode_png(pixels))
    else:
        from bioscope.export import export_world

        world = World(seed=seed or 0, title=path.stem)
        world.add(Specimen(mesh, path.stem))
        export_world(world, output, world.dt, 1 / world.dt, say=lambda *_: None)
    return mesh


def surroundings(system: LSystem, asked: str | None = None) -> Environment | None:
    """Return the environment that is asked for, or else that of the model; None without one.

    Environment files of a model are left to the derivation, which finds them in the model's folder.
    """
    words = system.environment if asked is None else asked
    if not words or (asked is None and words.strip().endswith(".e")):
        return None
    return named(words)


def shape(
    path: Path,
    system: LSystem,
    steps: int | None,
    seed: int | None,
    *,
    view: Path | None = None,
    environment: Environment | str | None = None,
    colors: Path | None = None,
) -> Mesh:
    """Return the mesh of a plant after so many steps; for the files see `grow`.

    Raises
    ------
    FormatError
        If the model cannot be derived, or draws nothing.
    """
    given = {"view": view, "environment": environment}
    options = {name: value for name, value in given.items() if value is not None}
    drawn = Turtle(view).interpret(system.derive(steps, seed, **options))
    is_table = colors is not None and colors.suffix != ".colors"
    palette = read_colors(colors) if colors and is_table else palette_beside(colors or path)
    mesh = drawn.mesh(palette=palette)
    if len(mesh.triangles) == 0:
        raise FormatError(f"{path}: nothing to see: the turtle draws neither strokes nor surfaces")
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
    """One mesh that stands still, in the size `scale`."""

    transient = ("mesh", "material")

    def __init__(
        self, mesh: Mesh, title: str, scale: float = 1.0, material: Material | None = None
    ) -> None:
        self.title = title
        self.scale = scale
        self.mesh = mesh
        white = _engine.Material(title, color=(1.0, 1.0, 1.0), two_sided=True)
        self.material = white if material is None else material
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
        scales = np.full(len(self.ids), self.scale, np.float32)
        scene.instances(
            self.title, self.mesh, self.material, ids=self.ids, positions=place, scales=scales
        )


def _write_obj(output: Path, mesh: Mesh) -> None:
    lines = [f"v {x:.6g} {y:.6g} {z:.6g}" for x, y, z in mesh.positions]
    lines += [f"vn {x:.4f} {y:.4f} {z:.4f}" for x, y, z in mesh.normals]
    lines += [f"f {a}//{a} {b}//{b} {c}//{c}" for a, b, c in mesh.triangles + 1]
    with written_whole(output) as temporary:
        temporary.write_text("\n".join(lines) + "\n", encoding="utf-8")


def portrait(
    mesh: Mesh,
    width: int,
    height: int,
    *,
    full: Mesh | None = None,
    around: Environment | None = None,
) -> NDArray[np.uint8]:
    """Return a picture (height, width, 3) of a plant that stands on level ground.

    Parameters
    ----------
    mesh
        The plant.
    width, height
        Pixels.
    full
        What the picture has room for; the plant itself if not given. Stages of one plant that are
        to be compared share the last one.
    around
        What surrounds the plant: the amounts that it keeps in its cells (water in the soil) are
        seen, in a deep field as surfaces that one looks through.
    """
    if not (VIEW_LIMITS[0] <= min(width, height) and max(width, height) <= VIEW_LIMITS[1]):
        raise InvalidValueError(f"{width}x{height}: expected {VIEW_LIMITS[0]} to {VIEW_LIMITS[1]}")
    points = (mesh if full is None else full).positions
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    # Whole fields are shown as models of themselves: haze would hide what is far away.
    scale = min(1.0, HAZELESS / max(size, 1e-3))
    points, size = points * np.float32(scale), size * scale
    low, high = points.min(axis=0), points.max(axis=0)
    world = World(seed=1, title="specimen")
    world.add(Specimen(mesh, "specimen", scale))
    for number, (field, material) in enumerate(_fields(around)):
        world.add(Specimen(field, f"field {number}", scale, material))
    world.add(Specimen(floor((low + high) / 2, float(low[1]), size), "floor"))
    view = _engine.Camera.looking_at(*camera(points, width / height), VIEW_ANGLE)
    return _engine.Rasterizer(picture=True).picture(world.scene, view, width, height)


def levels(around: Environment | None) -> list[float]:
    """Return the amounts that are seen of what an environment keeps: surfaces in a deep field."""
    amounts = None if around is None else around.amounts
    if amounts is None or not amounts.values.size:
        return []
    least, most = float(amounts.values.min()), float(amounts.values.max())
    if not most > least:
        return []
    return [least + share * (most - least) for share in LEVELS] if amounts.deep else [most]


def _fields(around: Environment | None) -> list[tuple[Mesh, Material]]:
    """Return what is seen of the amounts that an environment keeps, from least to most."""
    shown = levels(around)
    amounts = around.amounts if around is not None and shown else None
    if amounts is None:
        return []
    if not amounts.deep:
        least, most = float(amounts.values.min()), shown[0]
        matt = _engine.Material("field", color=(1.0, 1.0, 1.0), roughness=1.0, two_sided=True)
        above = Amounts(amounts.values - np.float32(least), amounts.low, amounts.cell)
        return [(above.sheet(most - least), matt)]
    fields = []
    for share, level in zip(LEVELS, shown, strict=True):
        color = tuple((0.25 + 0.75 * share) * part for part in WATER)
        veil = _engine.Material("field", color=color, opacity=VEIL, roughness=0.35, two_sided=True)
        fields.append((amounts.surface(level), veil))
    return fields


Place = tuple[float, float, float]


def camera(points: NDArray[np.float32], aspect: float) -> tuple[Place, Place]:
    """Return place and target of the nearest camera of a fixed direction that sees all points."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    back = np.array([0.30, 0.16, 0.94]) / np.linalg.norm([0.30, 0.16, 0.94])
    right = np.cross([0.0, 1.0, 0.0], back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    away = points - middle
    rise = math.tan(VIEW_ANGLE / 2) * 0.92
    # Centre what is seen, then step back until the outermost points are in the picture.
    middle = middle + right * _mid(away @ right) + up * _mid(away @ up)
    away = points - middle
    reach = away @ back
    distance = max(
        float((reach + np.abs(away @ up) / rise).max()),
        float((reach + np.abs(away @ right) / (rise * aspect)).max()),
        1e-3,
    )
    x, y, z = (middle + back * distance).tolist()
    to_x, to_y, to_z = middle.tolist()
    return (x, y, z), (to_x, to_y, to_z)


def _mid(values: NDArray[np.float64]) -> float:
    return float(values.min() + values.max()) / 2


def floor(middle: NDArray[np.float32], level: float, size: float) -> Mesh:
    """Return a pale disc below a plant, large enough to reach the horizon."""
    rings = np.array([0.0, 0.5, 1.0, 2.0, 4.0, 10.0, 40.0, 200.0]) * max(size, 1e-3)
    corners = 48
    angles = np.linspace(0, 2 * math.pi, corners, endpoint=False)
    places = [
        [middle[0] + ring * math.cos(angle), level, middle[2] + ring * math.sin(angle)]
        for ring in rings
        for angle in angles
    ]
    triangles = []
    for ring in range(len(rings) - 1):
        for corner in range(corners):
            a, b = ring * corners + corner, ring * corners + (corner + 1) % corners
            triangles += [[a, b + corners, a + corners], [a, b, b + corners]]
    positions = np.array(places, np.float32)
    colors = np.tile(np.array(FLOOR, np.float32), (len(positions), 1))
    normals = np.tile(np.array([0, 1, 0], np.float32), (len(positions), 1))
    faces = np.array(triangles, np.uint32)
    return _engine.Mesh(positions, faces, normals=normals, colors=colors)
