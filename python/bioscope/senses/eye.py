"""The synthetic eye: colour, depth and identity of a scene in one pass."""

from __future__ import annotations

import colorsys
import math
import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bioscope import _engine
from bioscope.errors import UnknownNameError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from bioscope._engine import Camera, Scene
    from bioscope.world.world import World

_local = threading.local()


@dataclass(frozen=True, slots=True)
class View:
    """What an eye sees; rows from the top."""

    color: NDArray[np.float32]
    """Linear radiance (height, width, 3), RGB."""
    depth: NDArray[np.float32]
    """Distance along each pixel's ray (height, width) in metres; infinite where nothing is."""
    identity: NDArray[np.uint32]
    """Id of what is seen (height, width), as in the scene; 0 where nothing is."""

    def picture(self, exposure: float = 1.0, *, alpha: bool = False) -> NDArray[np.uint8]:
        """Return the color for a screen: (height, width, 3 or 4) sRGB bytes, tone-mapped."""
        light = 1.0 - np.exp(-1.4 * exposure * np.maximum(self.color, 0.0))
        display = np.where(light < 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
        pixels = (display * 255.0 + 0.5).astype(np.uint8)
        if not alpha:
            return pixels
        opaque = np.full((*pixels.shape[:2], 1), 255, np.uint8)
        return np.concatenate([pixels, opaque], axis=2)

    def identity_map(self, scene: Scene) -> NDArray[np.uint8]:
        """Return a picture (height, width, 3) in which every individual has a color of its own.

        Individuals of one species have one hue; the background is black. After Tu 1996, 5.6.
        """
        picture = np.zeros((*self.identity.shape, 3), np.uint8)
        colors = identity_colors(scene)
        for one in np.unique(self.identity[self.identity > 0]):
            picture[self.identity == one] = colors[int(one)]
        return picture

    def range_map(self, far: float) -> NDArray[np.uint8]:
        """Return a grey picture (height, width): white at the eye, black from `far` metres on."""
        grey: NDArray[np.uint8] = (255 * (1 - np.clip(self.depth / far, 0, 1))).astype(np.uint8)
        return grey


def identity_colors(scene: Scene) -> dict[int, tuple[int, int, int]]:
    """Return a color for every individual of a scene, each different, of one hue per species."""
    members: dict[str, list[int]] = {}
    groups = [(one.species, one.ids) for one in scene.batches]
    groups += [(one.species, one.ids) for one in scene.points]
    for species, ids in groups:
        members.setdefault(species, []).extend(int(one) for one in ids)
    colors: dict[int, tuple[int, int, int]] = {}
    taken: set[tuple[int, int, int]] = {(0, 0, 0)}
    for number, species in enumerate(sorted(members)):
        hue = (number * 0.381966) % 1.0
        for rank, one in enumerate(sorted(members[species])):
            # Shades of the hue that hardly repeat; the few that do move by a step.
            bright, pure = (
                1.0 - 0.6 * ((rank * 0.618034) % 1.0),
                1.0 - 0.5 * ((rank * 0.75488) % 1.0),
            )
            color = _bytes(colorsys.hsv_to_rgb(hue, pure, bright))
            while color in taken:
                bright = bright - 1 / 255 if bright > 0.3 else 1.0
                pure = pure - 1 / 255 if pure > 0.4 else 1.0
                color = _bytes(colorsys.hsv_to_rgb(hue, pure, bright))
            taken.add(color)
            colors[one] = color
    return colors


def _bytes(color: tuple[float, float, float]) -> tuple[int, int, int]:
    red, green, blue = (round(255 * one) for one in color)
    return red, green, blue


def eyes(
    world: World, animal: int, *, apart: float = 0.12, pan: float = 0.0, tilt: float = 0.0
) -> tuple[Camera, Camera]:
    """Return the left and the right eye of an animal, for `look`.

    Parameters
    ----------
    world, animal
        Where it lives, and its id.
    apart
        Distance of the eyes, own body lengths.
    pan, tilt
        Degrees by which both are turned to the left and up; 0 looks along the body.

    Raises
    ------
    UnknownNameError
        If it is not in the world, or cannot see.
    """
    inspection = world.inspect(animal)
    camera = None if inspection is None else inspection["eye"]
    if inspection is None or camera is None:
        raise UnknownNameError(f"no animal with eyes has the id {animal}")
    half = 0.5 * apart * inspection["values"]["body_length_m"]
    return turned(camera, pan, tilt, half), turned(camera, pan, tilt, -half)


def turned(camera: Camera, pan: float, tilt: float, aside: float = 0.0) -> Camera:
    """Return a camera turned to the left and up (degrees), and moved aside to its left (metres)."""
    if pan == tilt == aside == 0.0:
        return camera
    rotation = np.array(camera.rotation)
    left = _rotated(rotation, np.array([-1.0, 0.0, 0.0]))
    return _engine.Camera(
        tuple(np.array(camera.position) + aside * left),
        tuple(_product(rotation, _product(_about(1, pan), _about(0, tilt)))),
        camera.field_of_view,
        camera.fisheye,
        camera.near,
        camera.far,
    )


def _about(axis: int, degrees: float) -> NDArray[np.float64]:
    half = math.radians(degrees) / 2
    turn = np.array([0.0, 0.0, 0.0, math.cos(half)])
    turn[axis] = math.sin(half)
    return turn


def _product(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.append(vector, a[3] * b[3] - a[:3] @ b[:3])


def _rotated(rotation: NDArray[np.float64], vector: NDArray[np.float64]) -> NDArray[np.float64]:
    inverse = rotation * np.array([-1.0, -1.0, -1.0, 1.0])
    return _product(_product(rotation, np.append(vector, 0.0)), inverse)[:3]


def look(scene: Scene, camera: Camera, size: tuple[int, int] = (64, 64)) -> View:
    """Look at a scene through a camera.

    Parameters
    ----------
    scene
        What to look at: `world.scene`.
    camera
        From where and how: perspective, or equidistant fish-eye up to 300 degrees.
    size
        Width and height in pixels.

    Examples
    --------
    >>> import bioscope as bio
    >>> world = bio.World(seed=1)
    >>> camera = bio.Camera.looking_at((0, 1, 5), (0, 0, 0), 0.8)
    >>> bio.look(world.scene, camera, (32, 24)).identity.shape
    (24, 32)
    """
    return look_many(scene, [camera], size)[0]


def look_many(scene: Scene, cameras: Sequence[Camera], size: tuple[int, int]) -> list[View]:
    """Look at a scene through many cameras at once, in parallel; see `look`."""
    width, height = size
    return [View(*arrays) for arrays in _rasterizer().look(scene, list(cameras), width, height)]


def _rasterizer() -> _engine.Rasterizer:
    """Return this thread's rasterizer, which remembers meshes and textures between looks."""
    rasterizer: _engine.Rasterizer | None = getattr(_local, "rasterizer", None)
    if rasterizer is None:
        rasterizer = _local.rasterizer = _engine.Rasterizer()
    return rasterizer
