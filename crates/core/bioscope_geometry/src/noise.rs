//! Noise for natural forms: the same on every machine, from integer hashes and plain arithmetic.

use bioscope_core::Vec3;

/// A source of noise: a pure function of place, seed and period.
///
/// ```
/// use bioscope_geometry::Noise;
/// use bioscope_core::Vec3;
/// let noise = Noise::new(7);
/// assert_eq!(noise.smooth(Vec3::splat(0.3)), noise.smooth(Vec3::splat(0.3)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Noise {
    seed: u32,
    /// Lattice cells after which it repeats along each axis; zero for never.
    period: i32,
}

/// What surrounds a point in a foam of random cells (Worley 1996).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Distance to the center of the own cell.
    pub nearest: f32,
    /// Distance to the center of the next cell.
    pub second: f32,
    /// A random number in [0, 1) that belongs to the own cell.
    pub random: f32,
}

impl Noise {
    /// Noise that never repeats.
    pub fn new(seed: u32) -> Self {
        Self { seed, period: 0 }
    }

    /// Noise that repeats after `period` cells along each axis, for textures without seams.
    pub fn repeating(seed: u32, period: u32) -> Self {
        Self { seed, period: period.min(1 << 12) as i32 }
    }

    /// Gradient noise (Perlin 2002) with features one unit wide, about −1 to 1, zero on average.
    pub fn smooth(&self, point: Vec3) -> f32 {
        let [x, y, z] = point.to_array().map(floor);
        let part = point - Vec3::new(x as f32, y as f32, z as f32);
        let fade = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
        let [xs, ys, zs] = self.marks([x, y, z], |one| [one, one.wrapping_add(1)]);
        let corner = |i: usize, j: usize, k: usize| {
            let offset = part - Vec3::new(i as f32, j as f32, k as f32);
            slope(scramble(xs[i] ^ ys[j] ^ zs[k]), offset)
        };
        let along_x = |j, k| {
            let low = corner(0, j, k);
            low + (corner(1, j, k) - low) * fade.x
        };
        let along_y = |k| {
            let low = along_x(0, k);
            low + (along_x(1, k) - low) * fade.y
        };
        let low = along_y(0);
        low + (along_y(1) - low) * fade.z
    }

    /// Sum of `octaves` layers of [`smooth`](Self::smooth), each half as wide and half as strong as
    /// the one before; about −1 to 1.
    pub fn fractal(&self, point: Vec3, octaves: u32) -> f32 {
        self.layers(point, octaves, |value| value)
    }

    /// Like [`fractal`](Self::fractal) with sharp crests: 0 in the valleys, about 1 on the crests.
    pub fn ridged(&self, point: Vec3, octaves: u32) -> f32 {
        let folded = |value: f32| {
            let crest = 1.0 - value.abs();
            crest * crest
        };
        let whole = 2.0 - 0.5f32.powi(octaves.max(1) as i32 - 1);
        self.layers(point, octaves, folded) / whole
    }

    fn layers(&self, point: Vec3, octaves: u32, shape: impl Fn(f32) -> f32) -> f32 {
        let (mut sum, mut strength, mut scale) = (0.0, 1.0, 1);
        for octave in 0..octaves.min(16) {
            let seed = self.seed.wrapping_add(octave.wrapping_mul(0x9E37_79B9));
            let layer = Self { seed, period: self.period * scale };
            sum += strength * shape(layer.smooth(point * scale as f32));
            strength *= 0.5;
            scale *= 2;
        }
        sum
    }

    /// The cells nearest to a point, one cell center per unit cube.
    pub fn cell(&self, point: Vec3) -> Cell {
        let [x, y, z] = point.to_array().map(floor);
        let part = point - Vec3::new(x as f32, y as f32, z as f32);
        let around = |one: i32| [one.wrapping_sub(1), one, one.wrapping_add(1)];
        let [xs, ys, zs] = self.marks([x, y, z], around);
        let mut cell = Cell { nearest: f32::MAX, second: f32::MAX, random: 0.0 };
        for index in 0..27 {
            let (i, j, k) = (index % 3, index / 3 % 3, index / 9);
            let hash = scramble(xs[i] ^ ys[j] ^ zs[k]);
            let corner = Vec3::new(i as f32, j as f32, k as f32) - 1.0;
            let distance = (corner + jitter(hash)).distance_squared(part);
            if distance < cell.nearest {
                let random = unit(scramble(hash ^ 0xA511_E9B3));
                cell = Cell { nearest: distance, second: cell.nearest, random };
            } else {
                cell.second = cell.second.min(distance);
            }
        }
        Cell { nearest: cell.nearest.sqrt(), second: cell.second.sqrt(), ..cell }
    }

    /// One word for each lattice plane around a point; exclusive-ored and scrambled, three of them
    /// make the random word of a lattice point.
    fn marks<const N: usize>(
        &self,
        base: [i32; 3],
        planes: impl Fn(i32) -> [i32; N],
    ) -> [[u32; N]; 3] {
        let wrap =
            |one: i32| if self.period > 0 { one.rem_euclid(self.period) } else { one } as u32;
        let seed = self.seed.wrapping_mul(0x9E37_79B1);
        let [x, y, z] = base.map(planes);
        [
            x.map(|one| wrap(one).wrapping_mul(0x8DA6_B343) ^ seed),
            y.map(|one| wrap(one).wrapping_mul(0xD816_3841)),
            z.map(|one| wrap(one).wrapping_mul(0xCB1A_B31F)),
        ]
    }
}

/// The greatest whole number that is not greater.
fn floor(value: f32) -> i32 {
    let whole = value as i32;
    whole.wrapping_sub(i32::from((whole as f32) > value))
}

/// Inner product of `offset` with one of the twelve directions to the edges of a cube.
fn slope(hash: u32, offset: Vec3) -> f32 {
    // Twelve of sixteen cases are the twelve edges, four occur twice (Perlin 2002).
    let case = hash & 15;
    let a = if case < 8 { offset.x } else { offset.y };
    let b = if case < 4 {
        offset.y
    } else if case == 12 || case == 14 {
        offset.x
    } else {
        offset.z
    };
    (if case & 1 == 0 { a } else { -a }) + (if case & 2 == 0 { b } else { -b })
}

/// A point in the unit cube from ten bits for each coordinate.
fn jitter(hash: u32) -> Vec3 {
    let share = |shift: u32| ((hash >> shift) & 1023) as f32 * (1.0 / 1024.0);
    Vec3::new(share(0), share(10), share(20))
}

fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Every bit of the result depends on every bit of the word (Wellons, "lowbias32").
fn scramble(mut word: u32) -> u32 {
    word ^= word >> 16;
    word = word.wrapping_mul(0x7FEB_352D);
    word ^= word >> 15;
    word = word.wrapping_mul(0x846C_A68B);
    word ^ (word >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points() -> impl Iterator<Item = Vec3> {
        (0..4000).map(|n| Vec3::new(n as f32 * 0.371, n as f32 * 0.173, n as f32 * -0.219))
    }

    #[test]
    fn is_centered_bounded_and_smooth() {
        let noise = Noise::new(3);
        let mean = points().map(|point| noise.smooth(point)).sum::<f32>() / 4000.0;
        assert!(mean.abs() < 0.03, "{mean}");
        for point in points() {
            let value = noise.smooth(point);
            assert!(value.abs() <= 1.1, "{value}");
            let beside = noise.smooth(point + Vec3::X * 1e-3);
            assert!((value - beside).abs() < 5e-3, "jump at {point}");
            assert!((0.0..=1.01).contains(&noise.ridged(point, 4)));
        }
    }

    #[test]
    fn repeats_after_its_period_and_only_then() {
        let noise = Noise::repeating(5, 4);
        let shifted = |shift: Vec3| {
            points().take(200).map(|one| one.abs() * 0.1).all(|point| {
                (noise.fractal(point, 3) - noise.fractal(point + shift, 3)).abs() < 1e-3
                    && (noise.cell(point).nearest - noise.cell(point + shift).nearest).abs() < 1e-3
            })
        };
        assert!(shifted(Vec3::new(4.0, 0.0, 8.0)));
        assert!(!shifted(Vec3::new(2.0, 0.0, 0.0)));
    }

    #[test]
    fn the_nearest_cell_is_nearer_than_the_second() {
        for point in points().take(500) {
            let cell = Noise::new(1).cell(point);
            assert!(cell.nearest <= cell.second && cell.nearest < 1.8);
            assert!((0.0..1.0).contains(&cell.random));
        }
    }
}
