//! Painted surfaces: small pictures made from noise, which repeat without seams. Each is painted once
//! and shared by all who use it.

use std::sync::{Arc, OnceLock};

use bioscope_core::{Purpose, Random, Vec2, Vec3, math};
use bioscope_geometry::{Noise, Texture};
use rayon::prelude::*;

const WAVES: Purpose = Purpose::new("texture waves");

/// A square texture; `paint` gives linear color and opacity at (u, v), each in [0, 1).
fn painted(size: u32, paint: impl Fn(Vec2) -> ([f32; 3], f32) + Sync) -> Arc<Texture> {
    let curve: Vec<u8> = (0..=4096).map(|step| srgb(step as f32 / 4096.0)).collect();
    let byte = |linear: f32| curve[(linear.clamp(0.0, 1.0) * 4096.0) as usize];
    let pixels = (0..size * size).into_par_iter().map(|index| {
        let (column, row) = (index % size, index / size);
        let ([red, green, blue], opacity) =
            paint(Vec2::new(column as f32, row as f32) / size as f32);
        [byte(red), byte(green), byte(blue), (opacity.clamp(0.0, 1.0) * 255.0) as u8]
    });
    Arc::new(Texture::new(size, size, pixels.collect()))
}

fn srgb(linear: f32) -> u8 {
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * math::pow(linear, 1.0 / 2.4) - 0.055
    };
    (encoded * 255.0 + 0.5) as u8
}

fn mix3(a: [f32; 3], b: [f32; 3], share: f32) -> [f32; 3] {
    [0, 1, 2].map(|channel| math::mix(a[channel], b[channel], share))
}

fn gray(value: f32) -> ([f32; 3], f32) {
    ([value; 3], 1.0)
}

/// Noise that repeats `cells` times finer than the texture.
fn repeating(seed: u32, cells: u32) -> impl Fn(Vec2) -> (Noise, Vec3) {
    move |uv| {
        (Noise::repeating(seed, cells), Vec3::new(uv.x, 0.0, uv.y) * cells as f32 + Vec3::Y * 0.37)
    }
}

/// Coral sand with ripples, grit and broken shell; about 1 on average, to be tinted.
pub(crate) fn sand() -> Arc<Texture> {
    static PAINTED: OnceLock<Arc<Texture>> = OnceLock::new();
    PAINTED.get_or_init(paint_sand).clone()
}

fn paint_sand() -> Arc<Texture> {
    painted(512, |uv| {
        let at = |seed, cells| repeating(seed, cells)(uv);
        let (noise, point) = at(1, 3);
        let bend = noise.fractal(point, 3) * 0.5;
        let (noise, point) = at(2, 2);
        let strength = 0.45 + 0.55 * noise.fractal(point, 2).clamp(-0.8, 0.8);
        let phase = (uv.y * 9.0 + bend) * math::TAU;
        let ripple = 0.7 * math::sin(phase + 0.5 * math::sin(phase)) * strength;
        let (noise, point) = at(3, 64);
        let grit = noise.fractal(point, 3);
        let (noise, point) = at(4, 90);
        let shell = noise.cell(point);
        let size = 0.12 + 0.22 * (shell.random * 13.0).fract();
        let fleck = match shell.random {
            _ if shell.nearest + 0.15 * grit > size => 0.0,
            bright if bright > 0.9 => 0.3,
            dark if dark > 0.8 => -0.3,
            _ => 0.0,
        };
        let value = 0.72 + 0.16 * ripple + 0.12 * grit + fleck;
        let warm = [1.0, 0.98 - 0.03 * ripple, 0.95 - 0.05 * ripple];
        (warm.map(|channel| channel * value), 1.0)
    })
}

/// Reef rock: pitted, grainy limestone with specks of algae; pale, to be tinted by crusts.
pub(crate) fn rock() -> Arc<Texture> {
    static PAINTED: OnceLock<Arc<Texture>> = OnceLock::new();
    PAINTED.get_or_init(paint_rock).clone()
}

fn paint_rock() -> Arc<Texture> {
    painted(512, |uv| {
        let at = |seed, cells| repeating(seed, cells)(uv);
        let (noise, point) = at(11, 12);
        let mottle = noise.fractal(point, 4);
        let mut color = mix3([0.58, 0.57, 0.55], [0.92, 0.90, 0.86], 0.5 + 0.8 * mottle);
        let specks = [
            (21, 18, [0.74, 0.54, 0.60]),
            (22, 15, [0.55, 0.58, 0.42]),
            (23, 22, [0.82, 0.68, 0.50]),
        ];
        for (seed, cells, speck) in specks {
            let (noise, point) = at(seed, cells);
            let share = math::smoothstep(0.15, 0.4, noise.fractal(point, 3));
            color = mix3(color, speck, 0.6 * share);
        }
        let (noise, point) = at(31, 34);
        let pit = noise.cell(point);
        let depth =
            math::smoothstep(0.08, 0.30, pit.nearest) + if pit.random > 0.5 { 0.6 } else { 0.0 };
        let (noise, point) = at(32, 64);
        let grain = 0.88 + 0.3 * noise.fractal(point, 2);
        let shade = (0.66 + 0.34 * depth.min(1.0)) * grain;
        (color.map(|one| one * shade), 1.0)
    })
}

/// The winding grooves of brain coral: zero lines of waves of one length in all directions.
pub(crate) fn meanders() -> Arc<Texture> {
    static PAINTED: OnceLock<Arc<Texture>> = OnceLock::new();
    PAINTED.get_or_init(paint_meanders).clone()
}

fn paint_meanders() -> Arc<Texture> {
    let mut random = Random::new(41, 1, 0, WAVES);
    let ring: Vec<(f32, f32)> = (-13..=13i32)
        .flat_map(|x| (0..=13i32).map(move |y| (x, y)))
        .filter(|&(x, y)| (132..=168).contains(&(x * x + y * y)) && (y > 0 || x > 0))
        .map(|(x, y)| (x as f32, y as f32))
        .collect();
    let waves: Vec<(f32, f32, f32)> = (0..18)
        .map(|_| {
            let (x, y) = ring[random.below(ring.len() as u32) as usize];
            (x, y, random.range(0.0, math::TAU))
        })
        .collect();
    painted(256, |uv| {
        let sum: f32 = waves
            .iter()
            .map(|(x, y, phase)| math::sin((x * uv.x + y * uv.y) * math::TAU + phase))
            .sum();
        let ridge = math::smoothstep(-1.6, 1.6, sum);
        let seam = 1.0 - 0.35 * math::smoothstep(2.6, 4.5, sum);
        let (noise, point) = repeating(42, 64)(uv);
        gray((0.30 + 0.62 * ridge * seam) * (1.0 + 0.18 * noise.fractal(point, 2)))
    })
}

/// The cups of many small polyps: pale rims, dark middles.
pub(crate) fn polyps() -> Arc<Texture> {
    static PAINTED: OnceLock<Arc<Texture>> = OnceLock::new();
    PAINTED.get_or_init(paint_polyps).clone()
}

fn paint_polyps() -> Arc<Texture> {
    painted(256, |uv| {
        let (noise, point) = repeating(51, 26)(uv);
        let cup = noise.cell(Vec3::new(point.x, 0.5, point.z));
        let rim = math::smoothstep(0.1, 0.42, cup.nearest)
            * (1.0 - 0.3 * math::smoothstep(0.5, 0.75, cup.nearest));
        let (noise, point) = repeating(52, 5)(uv);
        gray((0.58 + 0.36 * rim) * (1.0 + 0.3 * noise.fractal(point, 4)))
    })
}

/// Sponge: soft lengthwise ridges and pores.
pub(crate) fn sponge() -> Arc<Texture> {
    static PAINTED: OnceLock<Arc<Texture>> = OnceLock::new();
    PAINTED.get_or_init(paint_sponge).clone()
}

fn paint_sponge() -> Arc<Texture> {
    painted(256, |uv| {
        let (noise, point) = repeating(61, 20)(uv);
        let pore = math::smoothstep(0.1, 0.36, noise.cell(point).nearest);
        let (noise, point) = repeating(62, 6)(uv);
        let fold = noise.ridged(point, 3);
        gray((0.5 + 0.5 * pore) * (0.6 + 0.55 * fold))
    })
}

/// A sea fan: a net of fine branches on thicker veins that spread from the lower edge; the meshes
/// of the net are holes.
pub(crate) fn fan() -> Arc<Texture> {
    static PAINTED: OnceLock<Arc<Texture>> = OnceLock::new();
    PAINTED.get_or_init(paint_fan).clone()
}

fn paint_fan() -> Arc<Texture> {
    painted(512, |uv| {
        let from_foot = Vec2::new(uv.x - 0.5, 1.02 - uv.y);
        let distance = from_foot.length();
        let angle = math::atan2(from_foot.x, from_foot.y);
        let noise = Noise::new(71);
        let wander = noise.fractal(Vec3::new(uv.x * 5.0, 0.37, uv.y * 5.0), 3) * 0.16;
        let net =
            noise.cell(Vec3::new((angle + wander) * 15.0 * (0.4 + distance), 0.5, distance * 26.0));
        let thread = net.second - net.nearest < 0.13;
        let veins = |count: f32, width: f32| {
            let turn = (angle + wander * 1.6) * count / math::PI;
            ((turn - turn.floor()) - 0.5).abs() * math::PI / count * distance < width
        };
        let edge = 1.0 + 0.16 * noise.fractal(Vec3::new(angle * 3.0, 2.37, 0.0), 3);
        let (x, y) = ((uv.x - 0.5) / 0.43, (0.54 - uv.y) / 0.44);
        let inside = math::sqrt(x * x + y * y) < edge || (distance < 0.2 && angle.abs() < 0.25);
        let thick = veins(5.0, 0.011 * (1.1 - distance)) || veins(11.0, 0.006 * (1.1 - distance));
        let stem = distance < 0.06;
        let opacity = if inside && (thread || thick || stem) { 1.0 } else { 0.0 };
        let value = if thick { 0.62 } else { 0.8 + 0.2 * distance };
        ([value; 3], opacity)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_repeat_without_seams_and_use_the_middle_of_the_range() {
        for (name, texture) in
            [("sand", sand()), ("rock", rock()), ("meanders", meanders()), ("polyps", polyps())]
        {
            let size = texture.width as usize;
            let value =
                |column: usize, row: usize| i32::from(texture.pixels[row * size + column][1]);
            let step = |columns: (usize, usize)| {
                let steps =
                    (0..size).map(|row| (value(columns.0, row) - value(columns.1, row)).abs());
                steps.sum::<i32>() as f32 / size as f32
            };
            let (seam, inner) = (step((size - 1, 0)), step((size / 2, size / 2 + 1)));
            assert!(seam < 1.6 * inner + 2.0, "{name}: {seam} at the seam, {inner} inside");
            let mean = (0..size * size).map(|index| value(index % size, index / size)).sum::<i32>()
                as f32
                / (size * size) as f32;
            assert!((90.0..245.0).contains(&mean), "{name}: {mean}");
        }
    }

    #[test]
    fn a_fan_has_branches_and_holes() {
        let texture = fan();
        let solid = texture.pixels.iter().filter(|pixel| pixel[3] > 127).count();
        let share = solid as f32 / texture.pixels.len() as f32;
        assert!((0.1..0.5).contains(&share), "{share}");
    }
}
