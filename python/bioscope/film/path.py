"""The path tracer: light that bounces, soft sky, depth of field, with Mitsuba 3.

A picture is made of some renderings and the water's own formulae:

* the distance of what each pixel sees, and its color in the light of a lamp at the eye;
* the sun alone, without bounces: sharp and free of noise;
* the sun with its bounces, of which only the bounced part is used;
* the sky alone, with bounces; under water the sky is the glow of the water all round.

Bounced and sky light are smoothed where surfaces are smooth. Then the sun's part gets its
caustics, all light is dimmed by its depth, and the water between thing and eye takes and adds its
share. So water costs no noise and looks as it does in the preview and on the page. Pixels are
rendered as 2 x 2 parts, each of them put under water by itself, so that edges stay clean.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bioscope.errors import InvalidValueError
from bioscope.film.focus import focus_distance
from bioscope.film.light import Light, developed, water_from_above, window
from bioscope.film.shafts import shafts
from bioscope.film.smoothing import facing, smoothed
from bioscope.film.staging import Staging
from bioscope.film.variant import variant
from bioscope.film.waves import Waves

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Camera, Scene

    Floats = NDArray[np.floating]

_PARTS = 2
"""Parts of a pixel along each side."""
_BOUNCES = 3
_SKY_ROWS = 32
_APERTURE = 0.0012
"""Radius of the lens as a share of the distance in focus: far things blur by about two pixels."""
_SMOOTHING = 3


class PathRenderer:
    """Renders scenes by path tracing.

    Parameters
    ----------
    size
        Width and height in pixels.
    samples
        Paths per pixel: half for the sky, a quarter each for the sun and its bounces.
    mitsuba_variant
        Variant of Mitsuba; the fastest that works if not given.
    depth_of_field
        Whether what is far from the subject is out of focus.

    Raises
    ------
    MissingExtraError
        Without the extra `film`.
    """

    def __init__(
        self,
        size: tuple[int, int],
        samples: int = 64,
        *,
        mitsuba_variant: str | None = None,
        depth_of_field: bool = True,
    ) -> None:
        name = mitsuba_variant or variant()
        import mitsuba

        mitsuba.set_variant(name)
        self._mitsuba = mitsuba
        self._size = size
        self._parts = _PARTS if samples >= 4 * _PARTS**2 else 1
        self._samples = max(1, samples // self._parts**2)
        self._depth_of_field = depth_of_field
        self._staging = Staging(mitsuba)
        self._sky_peak = 0.0

    def render(self, scene: Scene, camera: Camera) -> NDArray[np.uint8]:
        """Return the picture: (height, width, 3) sRGB bytes.

        Raises
        ------
        InvalidValueError
            For a fish-eye camera.
        """
        if camera.fisheye:
            raise InvalidValueError("fish-eye camera: the path tracer has perspective ones only")
        light = Light(scene)
        directions = self._directions(camera)
        seen = self._seen(scene, camera, light, directions)
        radiance = Water(scene, light, camera).around(seen, directions)
        parts = self._parts
        width, height = self._size
        radiance = radiance.reshape(height, parts, width, parts, 3).mean(axis=(1, 3))
        return developed(radiance)

    def _seen(self, scene: Scene, camera: Camera, light: Light, directions: Floats) -> Seen:
        """Render the sun, its bounces and the sky."""
        mitsuba = self._mitsuba
        under = light.depth(camera.position[1]) > 0
        solid, holed = self._staging.shapes(scene)
        entries = {"type": "scene", **solid, **holed}
        entries["the sun"] = self._sun(light, under)
        entries["the sky"] = self._sky(light, under)
        entries["the lamp"] = _lamp(camera)
        entries["the camera"] = self._sensor(scene, camera)
        staged = mitsuba.load_dict(entries)
        values = mitsuba.traverse(staged)
        quarter, half = max(1, self._samples // 4), max(1, self._samples // 2)
        distance = self._distance(entries, (solid, holed), quarter, scene.tick)
        self._choose(values, "lamp", light)
        colors = self._pass(staged, _DIRECT, quarter, scene.tick)
        self._choose(values, "sun", light)
        direct = self._pass(staged, _DIRECT, quarter, scene.tick)
        bounced = self._pass(staged, _BOUNCING, quarter, scene.tick)
        self._choose(values, "sky", light)
        sky = self._pass(staged, _BOUNCING, half, scene.tick)
        eye = np.array(camera.position, np.float32)
        limits = float(light.sun_color.max()) / math.pi, self._sky_peak
        return Seen(eye, directions, (distance, colors, direct, bounced, sky), limits)

    def _distance(
        self, entries: dict[str, Any], shapes: tuple[dict[str, Any], ...], samples: int, seed: int
    ) -> Floats:
        """Return the distance of what each part of a pixel sees, 0 for nothing.

        Mitsuba measures to where holes would be, so things with holes are measured by themselves.
        """
        around = {name: entries[name] for name in ("type", "the camera", "the lamp")}
        found = []
        for own in shapes:
            staged = self._mitsuba.load_dict({**around, **own})
            measured = self._pass(staged, _DISTANCE, samples, seed)
            shown = np.maximum(measured[..., 3], 1e-6)
            found.append(measured[..., 0] / shown)
        solid, holed = found
        if not shapes[1]:
            return solid
        there = self._pass(staged, _DIRECT, samples, seed)[..., 3] > 0.5
        return np.where(there & ((holed < solid) | (solid == 0)), holed, solid)

    def _pass(self, staged: Any, integrator: dict[str, Any], samples: int, seed: int) -> Floats:
        loaded = self._mitsuba.load_dict(integrator)
        image = self._mitsuba.render(staged, integrator=loaded, spp=samples, seed=seed % 2**31)
        return np.array(image, np.float32)

    @staticmethod
    def _choose(values: Any, name: str, light: Light) -> None:
        """Switch on one of the lights alone."""
        off = [0.0, 0.0, 0.0]
        for one in ("sun", "sky", "lamp"):
            values[f"the {one}.sampling_weight"] = float(one == name)
        sun = [float(one) for one in light.sun_color]
        values["the sun.irradiance.value"] = sun if name == "sun" else off
        values["the lamp.intensity.value"] = [math.pi] * 3 if name == "lamp" else off
        values["the sky.scale"] = float(name == "sky")
        values.update()

    def _sun(self, light: Light, under: bool) -> dict[str, Any]:
        towards = light.sun_below if under else light.sun
        return {
            "type": "directional",
            "direction": [-float(one) for one in towards],
            "irradiance": {"type": "rgb", "value": [float(one) for one in light.sun_color]},
        }

    def _sky(self, light: Light, under: bool) -> dict[str, Any]:
        """Return the light from all round: of the sky, or of the water just below its surface."""
        rows = np.pi * (np.arange(_SKY_ROWS) + 0.5) / _SKY_ROWS
        rise = np.stack([np.sin(rows), np.cos(rows), 0 * rows], axis=1).astype(np.float32)
        radiance = light.ambient_below(rise) if under else light.sky(rise)
        self._sky_peak = float(radiance.max())
        pixels = np.repeat(radiance[:, None], 2 * _SKY_ROWS, axis=1).astype(np.float32)
        return {"type": "envmap", "bitmap": self._mitsuba.Bitmap(np.ascontiguousarray(pixels))}

    def _sensor(self, scene: Scene, camera: Camera) -> dict[str, Any]:
        width, height = (side * self._parts for side in self._size)
        axes = _axes(camera)
        place = np.array(camera.position)
        mitsuba = self._mitsuba
        target = place + axes[:, 2]
        sensor: dict[str, Any] = {
            "type": "perspective",
            "fov": math.degrees(camera.field_of_view),
            "fov_axis": "y",
            "near_clip": camera.near,
            "far_clip": camera.far,
            "to_world": mitsuba.ScalarTransform4f().look_at(
                place.tolist(), target.tolist(), axes[:, 1].tolist()
            ),
            "film": {
                "type": "hdrfilm",
                "width": width,
                "height": height,
                "pixel_format": "rgba",
                "rfilter": {"type": "box"},
            },
            "sampler": {"type": "independent"},
        }
        focus = focus_distance(scene, camera) if self._depth_of_field else None
        if focus is not None:
            sensor |= {
                "type": "thinlens",
                "focus_distance": focus,
                "aperture_radius": focus * _APERTURE,
            }
        return sensor

    def _directions(self, camera: Camera) -> Floats:
        """Return the unit rays through the middles of all parts of pixels."""
        width, height = (side * self._parts for side in self._size)
        reach = math.tan(camera.field_of_view / 2)
        across = ((np.arange(width) + 0.5) / width * 2 - 1) * reach * width / height
        down = (1 - (np.arange(height) + 0.5) / height * 2) * reach
        x, y = np.meshgrid(across, down)
        axes = _axes(camera)
        rays = x[..., None] * axes[:, 0] + y[..., None] * axes[:, 1] + axes[:, 2]
        rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
        return np.asarray(rays, np.float32)


# Mitsuba's `volpath` rather than `path`: its shadows have the holes of cut-out surfaces, and its
# way of hiding emitters goes together with instances (3.9.1's `path` crashes).
_BOUNCING = {"type": "volpath", "max_depth": _BOUNCES + 1, "hide_emitters": True}
_DIRECT = {"type": "volpath", "max_depth": 2, "hide_emitters": True}
_DISTANCE = {"type": "depth"}


def _lamp(camera: Camera) -> dict[str, Any]:
    """Return a lamp at the eye, whose shadows the eye cannot see."""
    place = [float(one) for one in camera.position]
    return {"type": "point", "position": place, "intensity": {"type": "rgb", "value": math.pi}}


def _axes(camera: Camera) -> NDArray[np.floating]:
    """Return the camera's right, up and ahead as columns."""
    from bioscope.geometry.transforms import rotated

    turn = np.array(camera.rotation, np.float64)
    return rotated(turn, np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, -1]])).T


class Seen:
    """What the renderings say of each part of a pixel."""

    def __init__(
        self,
        eye: Floats,
        directions: Floats,
        passes: tuple[Floats, ...],
        limits: tuple[float, float],
    ) -> None:
        # `limits`: bounced and sky light that no white surface can exceed; more is noise.
        distance, lamp, direct, bounced, sky = passes
        self.cover = np.clip(direct[..., 3], 0.0, 1.0)
        """Share of the part that sees any thing."""
        self.distance = distance
        self.place = eye + directions * self.distance[..., None]
        normals = facing(self.place)
        slant = np.abs(np.sum(normals * directions, axis=-1))
        lit = self.distance**2 / np.maximum(slant, 0.15)
        color = np.clip(lamp[..., :3] * lit[..., None], 0.02, 1.0)
        soft = []
        for light, most in zip(
            (bounced[..., :3] - direct[..., :3], sky[..., :3]), limits, strict=True
        ):
            even = np.clip(light / color, -most, most)
            soft.append(smoothed(even, normals, self.distance, _SMOOTHING) * color)
        self.sun = direct[..., :3]
        """Sunlight thrown back at once, as if there were no water."""
        self.rest = np.maximum(soft[0], 0.0) + soft[1]
        """All other light, as if there were no water."""


class Water:
    """What the medium makes of a picture."""

    def __init__(self, scene: Scene, light: Light, camera: Camera) -> None:
        self._light = light
        self._eye = np.array(camera.position, np.float32)
        self._depth = float(light.depth(self._eye[1]))
        self._waves = Waves(light, scene.time) if light.surface is not None else None

    def around(self, seen: Seen, directions: Floats) -> Floats:
        """Return the radiance that arrives at the eye."""
        light = self._light
        lit = seen.sun + seen.rest
        if self._waves is not None:
            depth = light.depth(seen.place[..., 1])
            dimmed = light.sunlight(depth) * self._waves.caustic(seen.place, depth)[..., None]
            under = seen.sun * dimmed + seen.rest * light.daylight(depth)
            lit = np.where((depth > 0)[..., None], under, lit)
        cover = seen.cover[..., None]
        thing = self._arriving(lit, directions, seen.distance, seen.cover)
        whole = thing + self._background(directions) * (1.0 - cover)
        if self._waves is None or self._depth <= 0 or light.shafts <= 0:
            return whole
        ends = np.where(seen.cover > 0.5, seen.distance, np.inf)
        return np.maximum(whole + shafts(light, self._waves, self._eye, directions, ends), 0.0)

    def _arriving(
        self, radiance: Floats, directions: Floats, distance: Floats, cover: Floats
    ) -> Floats:
        """Return what arrives of things' radiance (weighted by their cover)."""
        light = self._light
        share = cover[..., None]
        if self._waves is None:
            kept = light.kept(distance)
            return radiance * kept + light.glow * (1.0 - kept) * share
        crossing = self._crossing(directions)
        crosses = (crossing > 0) & (crossing < distance)
        if self._depth > 0:
            run = np.where(crosses, crossing, distance)
            dim = light.daylight(np.float32(self._depth))
            glow = light.water_glow(dim, directions, run)
            return radiance * light.kept(run) + glow * share
        run = np.where(crosses, distance - crossing, 0.0).astype(np.float32)
        glow = light.water_glow(np.ones(3, np.float32), directions, run)
        below = radiance * light.kept(run) + glow * share
        surface = self._tilt(directions, crossing)
        above = water_from_above(light, directions, surface, below / np.maximum(share, 1e-6))
        return np.where(crosses[..., None], above * share, radiance)

    def _background(self, directions: Floats) -> Floats:
        """Return what arrives where there is nothing."""
        light = self._light
        far = np.full(directions.shape[:-1], np.inf, np.float32)
        if self._waves is None:
            sky = light.sky(directions) + light.sun_disc(directions, 0.0)
            if not light.extinction.any():
                return sky
            kept = light.kept(300.0 / np.maximum(directions[..., 1], 0.01))
            return sky * kept + light.glow * (1.0 - kept)
        crossing = self._crossing(directions)
        tilt = self._tilt(directions, crossing)
        if self._depth > 0:
            dim = light.daylight(np.float32(self._depth))
            rising = crossing > 0
            run = np.where(rising, crossing, far)
            glow = light.water_glow(dim, directions, run)
            seen = window(light, directions, tilt) * light.kept(run)
            return np.where(rising[..., None], seen, 0.0) + glow
        deep = light.water_glow(np.ones(3, np.float32), directions, far)
        sky = light.sky(directions) + light.sun_disc(directions, 0.0)
        surface = water_from_above(light, directions, tilt, deep)
        return np.where((crossing > 0)[..., None], surface, sky)

    def _crossing(self, directions: Floats) -> Floats:
        """Return the distances at which rays meet the water surface; negative where never."""
        rise = directions[..., 1]
        steep = np.where(np.abs(rise) < 1e-6, 1e-6, rise)
        return (self._depth / steep).astype(np.float32)

    def _tilt(self, directions: Floats, crossing: Floats) -> Floats:
        """Return the normals of the surface where rays meet it."""
        assert self._waves is not None
        run = np.clip(crossing, 0.0, 1e4)
        return self._waves.tilt(self._eye + directions * run[..., None], run)
