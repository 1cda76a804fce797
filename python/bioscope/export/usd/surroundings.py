"""Cameras, sun and sky."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdLux

from bioscope.export.lights import from_minus_z, sky_picture
from bioscope.export.names import Names

if TYPE_CHECKING:
    from bioscope._engine import Camera, Scene
    from bioscope.export.usd.looks import Looks
    from bioscope.export.usd.samples import Channel, Samples

_FILM_WIDTH = 0.36
"""A 36 mm film in USD's unit, a tenth of the scene's metre."""
_ASPECT = 16 / 9
_SUN_DEGREES = 0.53


class Cameras:
    """The cameras of a stage."""

    def __init__(self, stage: Usd.Stage, path: str, samples: Samples) -> None:
        self._stage, self._path, self._samples = stage, path, samples
        self._names = Names()
        self._made: dict[str, tuple[Channel, Channel]] = {}
        UsdGeom.Scope.Define(stage, path)

    def frame(self, cameras: dict[str, Camera]) -> None:
        """Put every camera where it is now."""
        for name, camera in cameras.items():
            if name not in self._made:
                self._made[name] = self._make(name, camera)
            place, turn = self._made[name]
            place.set(np.array(camera.position))
            turn.set(np.array(camera.rotation))

    def _make(self, name: str, camera: Camera) -> tuple[Channel, Channel]:
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

    def __init__(
        self, stage: Usd.Stage, path: str, scene: Scene, looks: Looks, samples: Samples
    ) -> None:
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
