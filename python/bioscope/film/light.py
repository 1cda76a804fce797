"""How light reaches a thing and how it reaches the eye, on arrays of pixels.

The formulae are those of the rasterizer (`bioscope_geometry/src/rasterizer/light.rs`) under the
same names, so that a path-traced picture and a preview show the same water. Radiance is linear
RGB in the last axis, lengths are metres, depth is metres below the surface.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Scene

    Floats = NDArray[np.floating]

REFRACTION = 1.34
"""Index of refraction of sea water against air."""


class Light:
    """All that is the same for every thing in the scene."""

    def __init__(self, scene: Scene) -> None:
        medium: dict[str, Any] = scene.medium
        self.sun = unit(_numbers(scene.sun["direction"]))
        """Towards the sun, in air."""
        level = self.sun * _numbers([1, 0, 1]) / REFRACTION
        up = np.sqrt(max(1.0 - float(level @ level), 0.1))
        self.sun_below = unit(level + _numbers([0, up, 0]))
        """Towards the sun as seen from under water."""
        self.sun_color = _numbers(scene.sun["color"])
        self.zenith = _numbers(scene.sky["zenith"])
        self.horizon = _numbers(scene.sky["horizon"])
        self.nadir = _numbers(scene.sky["nadir"])
        self.surface: float | None = medium["surface"]
        self.absorption = np.maximum(_numbers(medium["absorption"]), 0.0)
        self.extinction = self.absorption + np.maximum(_numbers(medium["scattering"]), 0.0)
        self.glow = _numbers(medium["glow"])
        self.caustics: float = medium["caustics"]
        self.caustic_scale: float = max(medium["caustic_scale"], 1e-3)
        self.shafts: float = medium["shafts"]

    def depth(self, height: Any) -> Any:
        """Return metres below the surface; negative in air."""
        return -1.0 + 0 * height if self.surface is None else self.surface - height

    def daylight(self, depth: Floats | np.floating) -> Floats:
        """Return what is left of daylight at depths (…)."""
        return _decayed(self.absorption, np.maximum(depth, 0.0))

    def sunlight(self, depth: Floats) -> Floats:
        """Return what is left of sunlight at depths (…)."""
        return _decayed(self.extinction, np.maximum(depth, 0.0) / self.sun_below[1])

    def sky(self, direction: Floats) -> Floats:
        """Return the radiance of the sky without the sun in directions (…, 3)."""
        rise = direction[..., 1:2]
        above = mixed(self.horizon, self.zenith, np.sqrt(np.maximum(rise, 0.0)))
        below = mixed(self.horizon, self.nadir, np.clip(-rise * 4.0, 0.0, 1.0))
        return np.where(rise > 0.0, above, below)

    def sun_disc(self, direction: Floats, blur: float) -> Floats:
        """Return the radiance of the sun's disc, widened by `blur`, and of its halo."""
        away = 1.0 - (direction @ self.sun)[..., None]
        disc = smoothstep(0.00012 + blur, 0.00005, away) * (40.0 / (1.0 + blur * 4000.0))
        halo = 0.6 * np.exp(-away * 60.0) + 1.5 * np.exp(-away * 900.0)
        return self.sun_color * (disc + halo)

    def ambient_below(self, direction: Floats) -> Floats:
        """Return the diffuse radiance just below the surface from directions (…, 3)."""
        up = 0.5 + 0.5 * direction[..., 1:2]
        through = self.zenith + self.horizon
        above = self.glow * 0.9 + through * 0.22
        level = self.glow * 0.7 + through * 0.06
        below = self.glow * 0.25 + through * 0.05
        lower = mixed(below, level, np.minimum(up * 2.0, 1.0))
        return mixed(lower, above, np.maximum(up * 2.0 - 1.0, 0.0))

    def water_glow(self, dim: Floats, direction: Floats, distance: Floats) -> Floats:
        """Return what water sends to an eye in daylight `dim` over distances (…)."""
        towards = np.maximum(direction @ self.sun_below, 0.0)[..., None]
        forward = 1.0 + 0.8 * towards**5
        rate = np.maximum(self.extinction - self.absorption * direction[..., 1:2], 1e-6)
        with np.errstate(under="ignore"):
            collected = self.extinction / rate * (1.0 - np.exp(-rate * distance[..., None]))
        return self.glow * dim * collected * forward

    def kept(self, distance: Floats) -> Floats:
        """Return the share of light that passes distances (…) of the medium."""
        return _decayed(self.extinction, distance)


def window(light: Light, direction: Floats, tilt: Floats) -> Floats:
    """Return the underside of the water surface with the open sky above it.

    Directions and upward normals of the surface are (…, 3).
    """
    inside = np.maximum(np.sum(direction * tilt, axis=-1, keepdims=True), 0.0)
    mirrored = direction - tilt * (2.0 * inside)
    mirrored[..., 1] = np.minimum(mirrored[..., 1], 0.0)
    far = np.full(direction.shape[:-1], np.inf, np.float32)
    deep = light.water_glow(np.ones(3, np.float32), mirrored, far)
    rest = 1.0 - REFRACTION**2 * (1.0 - inside * inside)
    outside = np.sqrt(np.maximum(rest, 0.0))
    bent = direction * REFRACTION + tilt * (outside - REFRACTION * inside)
    raised = bent.copy()
    raised[..., 1] = np.maximum(raised[..., 1], 0.02)
    seen = light.sky(raised) * 1.3 + light.sun_disc(bent, 0.002)
    return np.where(rest <= 0.0, deep, mixed(seen, deep, fresnel(inside, outside)))


def water_from_above(light: Light, direction: Floats, tilt: Floats, below: Floats) -> Floats:
    """Return the surface seen from the air: the mirrored sky over what comes from `below`."""
    outside = np.maximum(-np.sum(direction * tilt, axis=-1, keepdims=True), 0.02)
    inside = np.sqrt(1.0 - (1.0 - outside * outside) / REFRACTION**2)
    mirrored = direction + tilt * (2.0 * outside)
    raised = mirrored.copy()
    raised[..., 1] = np.maximum(raised[..., 1], 0.02)
    shine = light.sky(raised) + light.sun_disc(mirrored, 0.0005)
    return mixed(below, shine, fresnel(inside, outside))


def fresnel(inside: Floats, outside: Floats) -> Floats:
    """Return the unpolarized reflectance of the surface for the cosines of the two angles."""
    a = (inside - REFRACTION * outside) / np.maximum(inside + REFRACTION * outside, 1e-6)
    b = (REFRACTION * inside - outside) / np.maximum(REFRACTION * inside + outside, 1e-6)
    share: Floats = np.clip(0.5 * (a * a + b * b), 0.0, 1.0)
    return share


def filmic(radiance: Floats) -> Floats:
    """Return display values 0 to 1 of radiance: Narkowicz' fit of the ACES curve."""
    x: Floats = np.maximum(radiance, 0.0) * 0.8
    white = (x @ _numbers([0.2126, 0.7152, 0.0722]))[..., None]
    x = mixed(x, white, 0.35 * smoothstep(0.6, 4.0, white))
    curve = (x * (x * 2.51 + 0.03)) / (x * (x * 2.43 + 0.59) + 0.14)
    return np.clip(curve, 0.0, 1.0)


def developed(radiance: Floats) -> NDArray[np.uint8]:
    """Return the picture for a screen: filmic tone curve, sRGB bytes."""
    shown = filmic(radiance)
    high = 1.055 * np.power(np.maximum(shown, 1e-9), 1 / 2.4) - 0.055
    coded = np.where(shown <= 0.0031308, shown * 12.92, high)
    return np.rint(coded * 255.0).astype(np.uint8)


def mixed(first: Floats, second: Floats, share: Any) -> Floats:
    """Return the first at share 0, the second at share 1."""
    return np.asarray(first + (second - first) * share)


def smoothstep(low: float, high: float, value: Floats) -> Floats:
    """Return 0 at `low`, 1 at `high`, smooth between."""
    x = np.clip((value - low) / (high - low), 0.0, 1.0)
    return np.asarray(x * x * (3.0 - 2.0 * x))


def unit(vectors: Floats) -> Floats:
    """Return vectors (…, 3) at length 1."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def _numbers(values: Any) -> Floats:
    return np.array(values, np.float32)


def _decayed(rate: Floats, distance: Floats | np.floating) -> Floats:
    with np.errstate(under="ignore"):
        left: Floats = np.exp(-rate * np.asarray(distance)[..., None])
    return left
