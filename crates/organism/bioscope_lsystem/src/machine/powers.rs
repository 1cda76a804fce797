//! Powers that were computed before: modules that did not change ask for the same ones in every step.

use super::{Rules, operations::Binary, operations::binary};

/// How many powers are kept; a power of two.
const KEPT: usize = 1 << 10;

/// Base and exponent, as bits, and the power, by a number that is made of the first two.
pub(super) struct Powers(Box<[(u64, u64, f64)]>);

impl Default for Powers {
    fn default() -> Self {
        Self(vec![(0, 0, 1.0); KEPT].into_boxed_slice())
    }
}

impl Powers {
    /// The power, as [`binary`] computes it.
    pub fn power(&mut self, base: f64, exponent: f64) -> f64 {
        let (a, b) = (base.to_bits(), exponent.to_bits());
        // The upper bits of the product depend on all bits of both (Fibonacci hashing).
        let mixed = (a ^ b.rotate_left(32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let kept = &mut self.0[(mixed >> 54) as usize % KEPT];
        if (kept.0, kept.1) != (a, b) {
            let power = binary(Binary::Power, base, exponent, Rules::Own).unwrap_or(f64::NAN);
            *kept = (a, b, power);
        }
        kept.2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_those_that_are_computed() {
        let mut powers = Powers::default();
        let numbers = [0.0, -0.0, 1.0, 0.5, 1.5, 2.0, -2.0, 1e-3, 7.25, f64::INFINITY];
        for _ in 0..2 {
            for number in 0..4000_u32 {
                let base = numbers[number as usize % 10] * f64::from(1 + number / 100);
                for exponent in numbers {
                    let computed = binary(Binary::Power, base, exponent, Rules::Own).unwrap();
                    let kept = powers.power(base, exponent);
                    assert_eq!(kept.to_bits(), computed.to_bits(), "{base}^{exponent}");
                }
            }
        }
    }
}
