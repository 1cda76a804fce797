"""Cameras, sun and sky."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from pxr import Gf, UsdGeom, UsdLux

from bioscope.export.names import Names

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Camera, Scene
    from bioscope.export.usd.looks import Looks
    from bioscope.export.usd.samples import Samples

_FILM_WIDTH = 0.36
"""A 36 mm film in USD's unit, a tenth of the scene's metre."""
_ASPECT = 16 / 9
_SUN_DEGREES = 0.53
_SKY_ROWS = 64


class Cameras:
    """The cameras of a stage."""

    def __init__(self, stage: Any, path: str, samples: Samples) -> None:
        self._stage, self._path, self._samples = stage, path, samples
        self._names = Names()
        self._made: dict[str, Any] = {}
        UsdGeom.Scope.Define(stage, path)

    def frame(self, cameras: dict[str, Camera]) -> None:
        """Put every camera where it is now."""
        for name, camera in cameras.items():
            if name not in self._made:
                self._made[name] = self._make(name, camera)
            place, turn = self._made[name]
            place.set(np.array(camera.position))
            turn.set(np.array(camera.rotation))

    def _make(self, name: str, camera: Camera) -> Any:
        prim = UsdGeom.Camera.Define(self._stage, f"{self._path}/{self._names.of(name, name)}")
        height = _FILM_WIDTH / _ASPECT
        angle = min(camera.field_of_view, math.radians(150))
        prim.CreateHorizontalApertureAttr(_FILM_WIDTH)
        prim.CreateVerticalApertureAttr(height)
        prim.CreateFocalLengthAttr(height / 2 / math.tan(angle / 2))
        prim.CreateClippingRangeAttr(Gf.Vec2f(camera.near, camera.far))
        form = UsdGeom.Xformable(prim)
        place = self._samples.channel(form.AddTranslateOp().GetAttr())
        turn = self._samples.channel(form.AddOrientOp().GetAttr())
        return place, turn


class Lights:
    """The sun as a distant light, the sky as a dome."""

    def __init__(self, stage: Any, path: str, scene: Scene, looks: Looks, samples: Samples) -> None:
        self._sun = UsdLux.DistantLight.Define(stage, f"{path}/Sun")
        self._sun.CreateAngleAttr(_SUN_DEGREES)
        self._sun.CreateNormalizeAttr(True)
        form = UsdGeom.Xformable(self._sun)
        self._turn = samples.channel(form.AddOrientOp().GetAttr())
        self._light = samples.channel(self._sun.CreateColorAttr(), self._sun.CreateIntensityAttr())
        pixels, peak = sky_picture(scene.sky)
        dome = UsdLux.DomeLight.Define(stage, f"{path}/Sky")
        dome.CreateTextureFileAttr(looks.sky(pixels))
        dome.CreateTextureFormatAttr(UsdLux.Tokens.latlong)
        dome.CreateIntensityAttr(peak)

    def frame(self, scene: Scene) -> None:
        """Light the frame."""
        sun = scene.sun
        self._turn.set(from_minus_z(-np.array(sun["direction"], np.float64)))
        color = np.array(sun["color"], np.float32)
        peak = max(float(color.max()), 1e-9)
        self._light.set(color / peak, peak)


def from_minus_z(direction: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return the shortest rotation (xyzw) that takes −Z to a unit vector."""
    axis = np.cross([0.0, 0.0, -1.0], direction)
    turn = np.append(axis, 1.0 - direction[2])
    length = float(np.linalg.norm(turn))
    return np.array([0.0, 1.0, 0.0, 0.0]) if length < 1e-9 else turn / length


def sky_picture(sky: dict[str, Any]) -> tuple[NDArray[np.uint8], float]:
    """Return the sky as an sRGB picture of all directions, rows from straight up, and its peak."""
    rise = np.cos(np.pi * (np.arange(_SKY_ROWS) + 0.5) / _SKY_ROWS)[:, None]
    zenith, level, nadir = (np.array(sky[name]) for name in ("zenith", "horizon", "nadir"))
    above = level + (zenith - level) * np.sqrt(np.maximum(rise, 0))
    below = level + (nadir - level) * np.minimum(-rise * 4, 1)
    radiance = np.where(rise > 0, above, below)
    peak = max(float(radiance.max()), 1e-9)
    rows = np.rint(srgb(radiance / peak) * 255).astype(np.uint8)
    return np.repeat(rows[:, None, :], 2 * _SKY_ROWS, axis=1), peak


def srgb(linear: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return linear values 0 to 1 as sRGB ones."""
    low = linear * 12.92
    high = 1.055 * np.power(np.maximum(linear, 1e-9), 1 / 2.4) - 0.055
    return np.where(linear <= 0.0031308, low, high)


