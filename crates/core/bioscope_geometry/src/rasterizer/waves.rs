//! The ripples of the water surface and what they do to light: slopes (for Snell's window) and
//! caustics (sunlight gathered below), both on a square tile that repeats without seams.
//!
//! The surface is a sum of sine waves. Sunlight that meets it at x is thrown sideways in proportion to
//! the slope there and lands at x + F·slope; so each small square of sunlight is carried to its place
//! and spread over the four nearest texels, which gives folds and cusps as in nature and keeps the
//! mean at 1. A shader does the same by drawing a displaced grid into a texture.

use std::f64::consts::TAU;

use bioscope_core::Vec3;

use super::arithmetic::{smoothstep, unit};
use super::light::Light;

/// Waves per tile along x and z, slope amplitude, and turns per second.
const WAVES: [[f32; 4]; 9] = [
    [2.0, 1.0, 0.10, 0.23],
    [-1.0, 3.0, 0.09, 0.29],
    [3.0, -2.0, 0.09, 0.31],
    [1.0, 4.0, 0.08, 0.37],
    [-4.0, -2.0, 0.07, 0.41],
    [5.0, 2.0, 0.06, 0.47],
    [-3.0, 5.0, 0.05, 0.53],
    [6.0, -3.0, 0.04, 0.61],
    [4.0, 7.0, 0.03, 0.67],
];

/// Caustic cells per tile side.
const CELLS: f32 = 5.0;

/// How far sunlight is thrown, in tiles per unit of slope.
const FOCUS: f32 = 0.13;

/// Entries per side of the table of slopes.
const SMOOTH: usize = 64;

/// Beyond this distance the surface looks flat, metres.
const FLAT: f32 = 150.0;

/// Slopes and caustics of one moment.
#[derive(Debug)]
pub(crate) struct Waves {
    /// Tiles per metre.
    frequency: f32,
    size: usize,
    /// Slope of the surface along x and z, on a coarse grid of its own: it is smooth, and read often.
    slopes: Box<[[f32; 2]; SMOOTH * SMOOTH]>,
    /// Brightness of caustics, mean 1; full size first, then halved sizes.
    levels: Vec<Vec<f32>>,
}

impl Waves {
    /// No waves.
    pub fn still() -> Self {
        Self {
            frequency: 1.0,
            size: 1,
            slopes: Box::new([[0.0; 2]; SMOOTH * SMOOTH]),
            levels: vec![vec![1.0]],
        }
    }

    /// The waves at a time in seconds; `size` is a power of two. Without water all is still.
    pub fn new(light: &Light, time: f64, size: usize) -> Self {
        if !light.has_water() {
            return Self::still();
        }
        let frequency = 1.0 / (CELLS * light.caustic_scale);
        let mut levels = vec![gathered(&slopes(time, size), size)];
        while levels[levels.len() - 1].len() > 16 {
            let last = &levels[levels.len() - 1];
            levels.push(halved(last, size >> (levels.len() - 1)));
        }
        let mut coarse = Box::new([[0.0; 2]; SMOOTH * SMOOTH]);
        coarse.copy_from_slice(&slopes(time, SMOOTH));
        Self { frequency, size, slopes: coarse, levels }
    }

    /// Unit normal of the surface (upward) at a point of it, seen from `distance` metres; calmer with
    /// distance, where the eye sees the mean of many ripples.
    #[inline(always)]
    pub fn slope(&self, point: Vec3, distance: f32) -> Vec3 {
        if distance > FLAT {
            return Vec3::Y;
        }
        let calm = 0.5 / (1.0 + distance * 0.06) * (1.0 - distance / FLAT);
        let (x, z) = (point.x * self.frequency, point.z * self.frequency);
        let place = Place::new(x, z, SMOOTH);
        let [x_slope, z_slope] = [0, 1].map(|axis| place.mix(|index| self.slopes[index][axis]));
        // A second, wider set of waves hides the repetition.
        let place = Place::new(z * 0.31, -x * 0.31, SMOOTH);
        let [wide_x, wide_z] = [0, 1].map(|axis| place.mix(|index| self.slopes[index][axis]));
        unit(Vec3::new(-(x_slope + wide_x) * calm, 1.0, -(z_slope + wide_z) * calm))
    }

    /// Brightness of sunlight at a point `depth` metres below the surface, mean 1: faint just below
    /// the surface, sharpest a little deeper, fading and softening with depth.
    #[inline(always)]
    pub fn caustic(&self, light: &Light, point: Vec3, depth: f32) -> f32 {
        let focus = depth / light.caustic_scale;
        let strength = light.caustics * smoothstep(0.0, 2.0, focus) * 14.0 / (14.0 + depth);
        let pattern = self.pattern(light, point, depth, 1 + (depth * 0.35) as usize);
        1.0 + strength * (pattern - 1.0)
    }

    /// The pattern alone, read along the sun's rays; `softness` 1 is sharp, each doubling halves
    /// its detail.
    #[inline(always)]
    pub fn pattern(&self, light: &Light, point: Vec3, depth: f32, softness: usize) -> f32 {
        let along = depth / light.sun_below.y;
        let x = (point.x + light.sun_below.x * along) * self.frequency;
        let z = (point.z + light.sun_below.z * along) * self.frequency;
        let level = (softness.ilog2() as usize).min(self.levels.len() - 1);
        let values = &self.levels[level];
        Place::new(x, z, self.size >> level).mix(|index| values[index])
    }
}

/// Four neighboring entries of a repeating table and their weights.
struct Place {
    corners: [usize; 4],
    u: f32,
    v: f32,
}

impl Place {
    #[inline(always)]
    fn new(x: f32, z: f32, size: usize) -> Self {
        let (x, z) = (x * size as f32 + 32_768.0, z * size as f32 + 32_768.0);
        let (column, row) = (x as usize, z as usize);
        let mask = size - 1;
        let (left, top) = (column & mask, (row & mask) * size);
        let (right, bottom) = ((column + 1) & mask, ((row + 1) & mask) * size);
        let corners = [top + left, top + right, bottom + left, bottom + right];
        Self {
            corners,
            u: (x - column as f32).clamp(0.0, 1.0),
            v: (z - row as f32).clamp(0.0, 1.0),
        }
    }

    #[inline(always)]
    fn mix(&self, value: impl Fn(usize) -> f32) -> f32 {
        let [a, b, c, d] = self.corners.map(value);
        let near = a + (b - a) * self.u;
        let far = c + (d - c) * self.u;
        near + (far - near) * self.v
    }
}

/// Slope along x and z on a square grid over one tile.
fn slopes(time: f64, size: usize) -> Vec<[f32; 2]> {
    let turn = |turns: f64| {
        let (sine, cosine) = (turns.fract() * TAU).sin_cos();
        [cosine as f32, sine as f32]
    };
    let along = |wave: usize, axis: usize, start: f64| -> Vec<[f32; 2]> {
        let step = f64::from(WAVES[wave][axis]) / size as f64;
        (0..size).map(|index| turn(start + step * index as f64)).collect()
    };
    let mut slopes = vec![[0.0; 2]; size * size];
    for (number, &[x, z, amplitude, speed]) in WAVES.iter().enumerate() {
        let columns = along(number, 0, number as f64 * 0.37);
        let rows = along(number, 1, time * f64::from(speed));
        let share = amplitude / (x * x + z * z).sqrt();
        for (row, line) in rows.iter().zip(slopes.chunks_exact_mut(size)) {
            for (column, slope) in columns.iter().zip(line) {
                let sine = row[1] * column[0] + row[0] * column[1];
                slope[0] += sine * (share * x);
                slope[1] += sine * (share * z);
            }
        }
    }
    slopes
}

/// Sunlight thrown by the slopes, gathered on the same grid; mean 1.
fn gathered(slopes: &[[f32; 2]], size: usize) -> Vec<f32> {
    let mut light = vec![0.0; size * size];
    let throw = FOCUS * size as f32;
    for row in 0..size {
        for column in 0..size {
            let [x, z] = slopes[row * size + column];
            let [right, below] = [[0, 1], [1, 0]].map(|[down, aside]| {
                slopes[((row + down) & (size - 1)) * size + ((column + aside) & (size - 1))]
            });
            for [u, v] in [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5f32]] {
                let x = x + (right[0] - x) * u + (below[0] - x) * v;
                let z = z + (right[1] - z) * u + (below[1] - z) * v;
                let landing = [column as f32 + u + x * throw, row as f32 + v + z * throw];
                spread(&mut light, size, landing);
            }
        }
    }
    light
}

/// Shares a quarter unit of light among the four texels round a place given in texels.
#[inline(always)]
fn spread(light: &mut [f32], size: usize, place: [f32; 2]) {
    let place = Place::new(place[0] / size as f32, place[1] / size as f32, size);
    let (u, v) = (place.u, place.v);
    let shares = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
    for (corner, share) in place.corners.into_iter().zip(shares) {
        light[corner] += 0.25 * share;
    }
}

/// Means of squares of four.
fn halved(values: &[f32], size: usize) -> Vec<f32> {
    let half = size / 2;
    let mean = |row: usize, column: usize| {
        let first = 2 * row * size + 2 * column;
        0.25 * (values[first] + values[first + 1] + values[first + size] + values[first + size + 1])
    };
    (0..half).flat_map(|row| (0..half).map(move |column| mean(row, column))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    #[test]
    fn caustics_keep_the_mean_and_move() {
        let mut scene = Scene::default();
        scene.medium.surface = Some(0.0);
        scene.medium.caustics = 1.0;
        let light = Light::new(&scene);
        let [now, later] = [1.0, 1.2].map(|time| Waves::new(&light, time, 64));
        for values in &now.levels {
            let mean = values.iter().sum::<f32>() / values.len() as f32;
            assert!((mean - 1.0).abs() < 1e-3, "{mean}");
        }
        let brightest = now.levels[0].iter().copied().fold(0.0, f32::max);
        assert!(brightest > 2.0, "{brightest}");
        let points = (0..50).map(|index| Vec3::new(index as f32 * 0.1, -3.0, 0.3));
        let change: f32 = points
            .map(|point| {
                (now.caustic(&light, point, 3.0) - later.caustic(&light, point, 3.0)).abs()
            })
            .sum();
        assert!(change > 1.0, "{change}");
    }
}
