use glam::Vec3;

use crate::{Id, math, philox::philox4x32};

/// What a random number is for: one more coordinate of the counter, so that two uses by the same
/// individual in the same tick are independent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Purpose(u16);

impl Purpose {
    /// The purpose of this name (16 bits of its FNV-1a hash).
    pub const fn new(name: &str) -> Self {
        let bytes = name.as_bytes();
        let mut hash: u32 = 0x811c_9dc5;
        let mut index = 0;
        while index < bytes.len() {
            hash = (hash ^ bytes[index] as u32).wrapping_mul(0x0100_0193);
            index += 1;
        }
        Self((hash ^ (hash >> 16)) as u16)
    }
}

/// Random numbers of one individual at one tick for one purpose.
///
/// The numbers are a pure function of (seed, individual, tick, purpose) and of how many were
/// drawn before, so they depend neither on the order of individuals nor on threads, and nothing
/// needs to be stored to continue after a restore. Ticks use 48 bits.
///
/// ```
/// use bioscope_core::{Purpose, Random};
/// const WANDER: Purpose = Purpose::new("wander");
/// let draw = || Random::new(7, 12, 600, WANDER).uniform();
/// assert_eq!(draw(), draw());
/// ```
#[derive(Clone, Debug)]
pub struct Random {
    key: [u32; 2],
    counter: [u32; 4],
    words: [u32; 4],
    used: usize,
}

impl Random {
    /// The stream of `individual` at `tick` for `purpose` in the world of this `seed`.
    pub fn new(seed: u64, individual: Id, tick: u64, purpose: Purpose) -> Self {
        let tick_and_purpose = (((tick >> 32) as u32) << 16) | u32::from(purpose.0);
        Self {
            key: [seed as u32, (seed >> 32) as u32],
            counter: [0, individual, tick as u32, tick_and_purpose],
            words: [0; 4],
            used: 4,
        }
    }

    /// The next 32 random bits.
    #[inline]
    pub fn bits(&mut self) -> u32 {
        if self.used == 4 {
            self.words = philox4x32(self.counter, self.key);
            self.counter[0] = self.counter[0].wrapping_add(1);
            self.used = 0;
        }
        self.used += 1;
        self.words[self.used - 1]
    }

    /// Uniform in [0, 1).
    #[inline]
    pub fn uniform(&mut self) -> f32 {
        (self.bits() >> 8) as f32 * (1.0 / 16_777_216.0)
    }

    /// Uniform in [low, high).
    #[inline]
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.uniform()
    }

    /// Uniform among 0, 1 … count − 1; zero if `count` is zero.
    pub fn below(&mut self, count: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(count)) >> 32) as u32
    }

    /// Normally distributed with mean 0 and standard deviation 1 (Box and Muller).
    pub fn normal(&mut self) -> f32 {
        let radius = math::sqrt(-2.0 * math::ln(1.0 - self.uniform()));
        radius * math::cos(math::TAU * self.uniform())
    }

    /// A unit vector uniform on the sphere.
    pub fn direction(&mut self) -> Vec3 {
        let y = self.range(-1.0, 1.0);
        let angle = self.range(0.0, math::TAU);
        let radius = math::sqrt((1.0 - y * y).max(0.0));
        Vec3::new(radius * math::cos(angle), y, radius * math::sin(angle))
    }

    /// A point uniform in the unit ball.
    pub fn in_ball(&mut self) -> Vec3 {
        self.direction() * math::pow(self.uniform(), 1.0 / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const TEST: Purpose = Purpose::new("test");

    #[test]
    fn moments_are_those_of_the_distributions() {
        let mut random = Random::new(1, 1, 0, TEST);
        let count = 100_000;
        let uniform: f32 = (0..count).map(|_| random.uniform()).sum::<f32>() / count as f32;
        let square: f32 = (0..count).map(|_| random.normal().powi(2)).sum::<f32>() / count as f32;
        let mean: Vec3 = (0..count).map(|_| random.direction()).sum::<Vec3>() / count as f32;
        assert!((uniform - 0.5).abs() < 0.005, "{uniform}");
        assert!((square - 1.0).abs() < 0.02, "{square}");
        assert!(mean.length() < 0.01, "{mean}");
    }

    proptest! {
        #[test]
        fn each_coordinate_of_the_key_changes_the_stream(
            seed: u64, individual: u32, tick in 0u64..1 << 48, bit in 0u32..48
        ) {
            let first = |seed, individual, tick, purpose| Random::new(seed, individual, tick, purpose).bits();
            let base = first(seed, individual, tick, TEST);
            prop_assert_eq!(base, first(seed, individual, tick, TEST));
            let others = [
                first(seed ^ (1 << bit), individual, tick, TEST),
                first(seed, individual ^ (1 << (bit % 32)), tick, TEST),
                first(seed, individual, tick ^ (1 << bit), TEST),
                first(seed, individual, tick, Purpose::new("other")),
            ];
            prop_assert!(others.iter().filter(|&&other| other == base).count() <= 1);
        }

        #[test]
        fn below_stays_below(seed: u64, count in 1u32..) {
            prop_assert!(Random::new(seed, 1, 1, TEST).below(count) < count);
        }
    }
}
