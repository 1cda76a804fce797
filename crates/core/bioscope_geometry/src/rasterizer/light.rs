//! How light reaches a thing and how it reaches the eye: the formulae of every picture.
//!
//! Written for translation: each function takes plain numbers and vectors and has a GLSL
//! counterpart of the same name in the page's shaders. `Light` is what a shader calls uniforms.
//! Radiance and irradiance are linear RGB, lengths are metres, "depth" is metres below the surface.
//!
//! Water: light that runs a distance d is weakened by e^(−σd) with extinction σ = absorption a +
//! scattering s (Beer-Lambert). What the water itself sends is its glow G, which darkens with depth z
//! as e^(−az). A ray that rises by `rise` per metre therefore collects
//! ∫ σ G e^(−a(z − rise·t)) e^(−σt) dt = G e^(−az) σ (1 − e^(−kd)) / k, with k = σ − a·rise;
//! a level ray collects exactly G e^(−az) (1 − e^(−σd)).

use std::f32::consts::FRAC_1_PI;

use bioscope_core::Vec3;

use super::arithmetic::{Rgb, channels, exp, exp_rgb, rgb, smoothstep, unit};
use crate::{Medium, Scene, Sky, Sun};

/// Index of refraction of sea water against air.
pub(crate) const REFRACTION: f32 = 1.34;

/// Surfaces with less gloss than this (specular × (1 − roughness)) show no mirror images.
const MATT: f32 = 0.01;

/// All that is the same for every thing in the scene.
#[derive(Clone, Debug)]
pub(crate) struct Light {
    /// Unit vector towards the sun, in air.
    pub sun: Vec3,
    /// Unit vector towards the sun as seen from under water (bent by the surface).
    pub sun_below: Vec3,
    /// Irradiance on a surface that faces the sun in air.
    pub sun_color: Rgb,
    pub zenith: Rgb,
    pub horizon: Rgb,
    pub nadir: Rgb,
    /// Height of the water surface; −∞ where all is air.
    pub surface: f32,
    pub absorption: Rgb,
    /// Absorption plus scattering.
    pub extinction: Rgb,
    pub glow: Rgb,
    pub caustics: f32,
    pub caustic_scale: f32,
    pub shafts: f32,
}

impl Light {
    pub fn new(scene: &Scene) -> Self {
        let Scene { sun: Sun { direction, color }, sky, medium, .. } = scene;
        let Sky { zenith, horizon, nadir } = *sky;
        let Medium { surface, absorption, scattering, glow, .. } = *medium;
        let sun = unit(*direction);
        let level = Vec3::new(sun.x, 0.0, sun.z) / REFRACTION;
        let sun_below = unit(level + Vec3::Y * (1.0 - level.dot(level)).max(0.1).sqrt());
        let [absorption, scattering] =
            [absorption, scattering].map(|each| rgb(each).max(Rgb::ZERO));
        Self {
            sun,
            sun_below,
            sun_color: rgb(*color),
            zenith: rgb(zenith),
            horizon: rgb(horizon),
            nadir: rgb(nadir),
            surface: surface.unwrap_or(f32::NEG_INFINITY),
            absorption,
            extinction: absorption + scattering,
            glow: rgb(glow),
            caustics: medium.caustics,
            caustic_scale: medium.caustic_scale.max(1e-3),
            shafts: medium.shafts,
        }
    }

    /// Whether there is water at all.
    pub fn has_water(&self) -> bool {
        self.surface > f32::MIN
    }

    /// Metres below the surface; negative in air.
    #[inline(always)]
    pub fn depth(&self, height: f32) -> f32 {
        if self.has_water() { self.surface - height } else { -1.0 }
    }

    /// Distance in metres at which less than one part in fifty of a thing's own light arrives.
    pub fn visibility(&self) -> f32 {
        if self.has_water() || self.glow != Rgb::ZERO {
            let [red, green, blue] = channels(self.extinction);
            4.0 / red.min(green).min(blue).max(1e-6)
        } else {
            f32::INFINITY
        }
    }
}

/// Where a view is taken from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eye {
    pub place: Vec3,
    /// Metres below the surface.
    pub depth: f32,
    /// What is left of daylight there.
    pub daylight: Rgb,
}

impl Eye {
    pub fn new(light: &Light, place: Vec3) -> Self {
        let depth = light.depth(place.y);
        Self { place, depth, daylight: daylight(light, depth) }
    }
}

/// How a point of a surface answers light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish {
    /// Share of light thrown back evenly.
    pub albedo: Rgb,
    /// Strength of the highlight at normal incidence.
    pub specular: f32,
    pub roughness: f32,
    pub translucency: f32,
}

/// Share of the medium's own light collected over `distance` along a ray that rises by `rise`
/// per metre, relative to the glow at the ray's start. Works for infinite distance.
#[inline(always)]
pub(crate) fn collected(light: &Light, rise: f32, distance: f32) -> Rgb {
    let rate = (light.extinction - light.absorption * rise).max(Rgb::splat(1e-6));
    light.extinction / rate * (Rgb::ONE - exp_rgb(rate * -distance))
}

/// What is left of daylight at a depth.
#[inline(always)]
pub(crate) fn daylight(light: &Light, depth: f32) -> Rgb {
    exp_rgb(light.absorption * -depth.max(0.0))
}

/// Radiance that water sends towards an eye over `distance` along `direction`; `dim` is the daylight at
/// the eye's depth. Water scatters mostly forward, so it is brighter towards the sun.
#[inline(always)]
pub(crate) fn water_glow(light: &Light, dim: Rgb, direction: Vec3, distance: f32) -> Rgb {
    let towards = direction.dot(light.sun_below).max(0.0);
    let square = towards * towards;
    let forward = 1.0 + 0.8 * square * square * towards;
    light.glow * dim * collected(light, direction.y, distance) * forward
}

/// Sky in a direction, without the sun.
#[inline(always)]
pub(crate) fn sky(light: &Light, direction: Vec3) -> Rgb {
    let rise = direction.y;
    if rise > 0.0 {
        light.horizon.lerp(light.zenith, rise.sqrt())
    } else {
        light.horizon.lerp(light.nadir, (-rise * 4.0).min(1.0))
    }
}

/// The sun's disc and its halo in a direction of the sky; `blur` widens the disc (0 sharp).
#[inline(always)]
pub(crate) fn sun_disc(light: &Light, direction: Vec3, blur: f32) -> Rgb {
    let away = 1.0 - direction.dot(light.sun);
    if away > 0.12 {
        return Rgb::ZERO;
    }
    let disc = smoothstep(0.000_12 + blur, 0.000_05, away) * 40.0 / (1.0 + blur * 4000.0);
    let halo = 0.6 * (exp(-away * 60.0) - 0.000_75) + 1.5 * exp(-away * 900.0);
    light.sun_color * (disc + halo)
}

/// Diffuse radiance that a surface of this unit normal sees at this depth, with the daylight there.
#[inline(always)]
pub(crate) fn ambient(light: &Light, normal: Vec3, depth: f32, dim: Rgb) -> Rgb {
    let up = 0.5 + 0.5 * normal.y;
    if depth <= 0.0 {
        let low = light.horizon.lerp(light.nadir, 0.7);
        return low.lerp(light.zenith.lerp(light.horizon, 0.3), up);
    }
    let side = light.glow * dim;
    let through = (light.zenith + light.horizon) * dim;
    let above = side * 0.9 + through * 0.22;
    let level = side * 0.7 + through * 0.06;
    let below = side * 0.25 + through * 0.05;
    below.lerp(level, (up * 2.0).min(1.0)).lerp(above, (up * 2.0 - 1.0).max(0.0))
}

/// Sunlight on a surface that faces the sun at this depth, before shadows and caustics.
#[inline(always)]
pub(crate) fn sunlight(light: &Light, depth: f32) -> Rgb {
    if depth <= 0.0 {
        return light.sun_color;
    }
    light.sun_color * exp_rgb(light.extinction * (-depth / light.sun_below.y))
}

/// Radiance that a surface sends to the eye. `sunlight` is what arrives at its place from the sun,
/// `to_eye` and `normal` are unit vectors, the normal on the eye's side.
#[inline(always)]
pub(crate) fn reflected(
    light: &Light,
    finish: &Finish,
    sunlight: Rgb,
    depth: f32,
    normal: Vec3,
    to_eye: Vec3,
) -> Rgb {
    let sun = if depth > 0.0 { light.sun_below } else { light.sun };
    let dim = daylight(light, depth);
    let facing = normal.dot(sun);
    let through = finish.translucency * (-facing).max(0.0);
    let even =
        sunlight * (FRAC_1_PI * (facing.max(0.0) * (1.0 - 0.5 * finish.translucency) + through));
    let around = ambient(light, normal, depth, dim);
    let towards = normal.dot(to_eye);
    let grazing = 1.0 - towards.clamp(0.0, 1.0);
    let square = grazing * grazing;
    let fresnel = finish.specular
        + (1.0 - finish.specular) * 0.3 * (1.0 - finish.roughness) * square * square * grazing;
    let mirror = normal * (2.0 * towards) - to_eye;
    let even = finish.albedo * (even + around) * (1.0 - fresnel);
    if finish.specular * (1.0 - finish.roughness) < MATT {
        return even + around * (fresnel * (1.0 - 0.6 * finish.roughness));
    }
    let image = ambient(light, mirror, depth, dim) * (fresnel * (1.0 - 0.6 * finish.roughness));
    if facing <= 0.0 {
        return even + image;
    }
    even + image + sunlight * (facing * highlight(finish, fresnel, normal, unit(sun + to_eye)))
}

/// Reflected share of sunlight per steradian for the unit vector `half` between sun and eye
/// (a spherical Gaussian of the roughness's width).
#[inline(always)]
fn highlight(finish: &Finish, fresnel: f32, normal: Vec3, half: Vec3) -> f32 {
    let width = (finish.roughness * finish.roughness).max(0.03);
    let sharpness = 2.0 / (width * width);
    let away = normal.dot(half) - 1.0;
    fresnel * exp(sharpness * away) * (sharpness + 2.0) * 0.125 * FRAC_1_PI
}

/// What arrives at the eye of a thing's `radiance` at `distance` (infinite: of the sky behind
/// everything), through air, water or both. `slope` is the tilt of the water surface where the ray
/// meets it (see [`super::waves::Waves::slope`]).
#[inline(always)]
pub(crate) fn arriving(
    light: &Light,
    eye: &Eye,
    direction: Vec3,
    distance: f32,
    radiance: Rgb,
    slope: impl Fn(Vec3, f32) -> Vec3,
) -> Rgb {
    if !light.has_water() {
        return through_air(light, direction, distance, radiance);
    }
    let depth = eye.depth;
    let crossing = depth / direction.y;
    let crosses = crossing > 0.0 && crossing < distance;
    if depth > 0.0 {
        let (run, seen) = if crosses {
            let tilt = slope(eye.place + direction * crossing, crossing);
            (crossing, window(light, direction, tilt, radiance, distance.is_infinite()))
        } else {
            (distance, radiance)
        };
        return seen * exp_rgb(light.extinction * -run)
            + water_glow(light, eye.daylight, direction, run);
    }
    if !crosses {
        return radiance;
    }
    let tilt = slope(eye.place + direction * crossing, crossing);
    water_from_above(light, direction, tilt, distance - crossing, radiance)
}

/// Air with fog: the glow replaces what the fog takes; the sky lies behind 300 m of height of it.
#[inline(always)]
fn through_air(light: &Light, direction: Vec3, distance: f32, radiance: Rgb) -> Rgb {
    if light.extinction == Rgb::ZERO {
        return radiance;
    }
    let run = distance.min(300.0 / direction.y.max(0.01));
    let kept = exp_rgb(light.extinction * -run);
    radiance * kept + light.glow * (Rgb::ONE - kept)
}

/// Unpolarized reflectance of the water surface for the cosines of the two angles.
#[inline(always)]
fn fresnel(inside: f32, outside: f32) -> f32 {
    let a = (inside - REFRACTION * outside) / (inside + REFRACTION * outside);
    let b = (REFRACTION * inside - outside) / (REFRACTION * inside + outside);
    0.5 * (a * a + b * b)
}

/// The underside of the surface: Snell's window (97 degrees wide) with sky and sun, the mirror of
/// the deep around it. `above` is the radiance of what stands above the water there, used instead of
/// the sky unless `open`.
#[inline(always)]
pub(crate) fn window(light: &Light, direction: Vec3, tilt: Vec3, above: Rgb, open: bool) -> Rgb {
    let inside = direction.dot(tilt).max(0.0);
    let mirrored = direction - tilt * (2.0 * inside);
    let rise = mirrored.y.min(0.0);
    let deep = water_glow(light, Rgb::ONE, Vec3::new(mirrored.x, rise, mirrored.z), f32::INFINITY);
    let rest = 1.0 - REFRACTION * REFRACTION * (1.0 - inside * inside);
    if rest <= 0.0 {
        return deep;
    }
    let outside = rest.sqrt();
    let bent = direction * REFRACTION + tilt * (outside - REFRACTION * inside);
    let seen = if open {
        let up = Vec3::new(bent.x, bent.y.max(0.02), bent.z);
        sky(light, up) * 1.3 + sun_disc(light, bent, 0.002)
    } else {
        above
    };
    seen.lerp(deep, fresnel(inside, outside))
}

/// The surface from above: mirror of the sky over what shines through `run` metres of water.
#[inline(always)]
pub(crate) fn water_from_above(
    light: &Light,
    direction: Vec3,
    tilt: Vec3,
    run: f32,
    radiance: Rgb,
) -> Rgb {
    let outside = (-direction.dot(tilt)).max(0.02);
    let inside = (1.0 - (1.0 - outside * outside) / (REFRACTION * REFRACTION)).sqrt();
    let bent = direction / REFRACTION + tilt * (outside / REFRACTION - inside);
    let kept = radiance * exp_rgb(light.extinction * -run);
    let body =
        if run.is_finite() { kept } else { Rgb::ZERO } + water_glow(light, Rgb::ONE, bent, run);
    let mirrored = direction + tilt * (2.0 * outside);
    let up = Vec3::new(mirrored.x, mirrored.y.max(0.02), mirrored.z);
    let shine = sky(light, up) + sun_disc(light, mirrored, 0.0005);
    body.lerp(shine, fresnel(inside, outside))
}

/// Scene-referred to display-referred: a filmic curve (Narkowicz' fit of the ACES curve) that
/// keeps a little of the color of very bright light. Input and output linear, output 0 to 1.
#[inline(always)]
pub(crate) fn filmic(radiance: Rgb) -> Rgb {
    let x = radiance.max(Rgb::ZERO) * 0.8;
    let white = x.dot(rgb([0.2126, 0.7152, 0.0722]));
    let x = x.lerp(Rgb::splat(white), 0.35 * smoothstep(0.6, 4.0, white));
    let top = x * (x * 2.51 + Rgb::splat(0.03));
    let bottom = x * (x * 2.43 + Rgb::splat(0.59)) + Rgb::splat(0.14);
    (top / bottom).clamp(Rgb::ZERO, Rgb::ONE)
}
