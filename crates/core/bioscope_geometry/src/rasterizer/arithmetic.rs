//! Quick approximations for the inner loops: the same bits on every machine, no calls into a C
//! library, and simple enough for the compiler to vectorize. Shaders use their built-in functions.

use std::f32::consts::{FRAC_PI_2, LN_2, LOG2_E, PI};

use bioscope_core::Vec3;
use glam::Vec4;
use wide::{f32x4, i32x4};

/// A color (radiance, irradiance, or share per channel): red, green, blue, and a fourth number without
/// meaning, so that one instruction works on all.
pub(crate) type Rgb = Vec4;

/// The color of these channels.
#[inline(always)]
pub(crate) fn rgb([red, green, blue]: [f32; 3]) -> Rgb {
    Rgb::new(red, green, blue, 0.0)
}

/// The channels of a color.
#[inline(always)]
pub(crate) fn channels(color: Rgb) -> [f32; 3] {
    [color.x, color.y, color.z]
}

/// e^x with a relative error below 4e-6; arguments beyond ±41 saturate, so that products of two results
/// stay clear of the numbers too small for full speed.
#[inline(always)]
pub(crate) fn exp(x: f32) -> f32 {
    const ROUNDING: f32 = 12_582_912.0;
    let scaled = (x * LOG2_E).clamp(-60.0, 60.0);
    let shifted = scaled + ROUNDING;
    let rest = scaled - (shifted - ROUNDING);
    let power = f32::from_bits(((shifted.to_bits() as i32) << 23).wrapping_add(0x3f80_0000) as u32);
    let series = 0.055_504_1 + rest * (0.009_618_1 + rest * 0.001_333_4);
    power * (1.0 + rest * (LN_2 + rest * (0.240_226_5 + rest * series)))
}

/// [`exp`] of each channel.
#[inline(always)]
pub(crate) fn exp_rgb(color: Rgb) -> Rgb {
    const ROUNDING: f32 = 12_582_912.0;
    let x: f32x4 = bytemuck::cast(color);
    let scaled =
        (x * f32x4::splat(LOG2_E)).fast_max(f32x4::splat(-60.0)).fast_min(f32x4::splat(60.0));
    let shifted = scaled + f32x4::splat(ROUNDING);
    let rest = scaled - (shifted - f32x4::splat(ROUNDING));
    let bits: i32x4 = bytemuck::cast(shifted);
    let power: f32x4 = bytemuck::cast((bits << 23) + i32x4::splat(0x3f80_0000));
    let series = rest * (rest * 0.001_333_4 + 0.009_618_1) + 0.055_504_1;
    let series = rest * (rest * (rest * series + 0.240_226_5) + LN_2) + 1.0;
    bytemuck::cast(power * series)
}

/// Binary logarithm of a positive number with an absolute error below 0.09: enough to choose
/// among pictures of halved sizes.
#[inline(always)]
pub(crate) fn rough_log2(x: f32) -> f32 {
    let bits = x.to_bits();
    let exponent = ((bits >> 23) as i32 - 127) as f32;
    exponent + f32::from_bits((bits & 0x007f_ffff) | 0x3f80_0000) - 1.0
}

/// Angle in 0..π of the point (along, aside) from the positive axis, for `aside` ≥ 0; the error is
/// below 2e-5.
#[inline(always)]
pub(crate) fn angle(aside: f32, along: f32) -> f32 {
    let size = along.abs();
    let ratio = aside.min(size) / aside.max(size).max(1e-30);
    let square = ratio * ratio;
    let series = 0.180_141 + square * (-0.085_133 + square * 0.020_835_1);
    let small = ratio * (0.999_866 + square * (-0.330_299_5 + square * series));
    let quarter = if aside > size { FRAC_PI_2 - small } else { small };
    if along < 0.0 { PI - quarter } else { quarter }
}

/// The vector made one long; zero stays zero.
#[inline(always)]
pub(crate) fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / v.dot(v).max(1e-36).sqrt())
}

/// 0 below `low`, 1 above `high`, a smooth cubic in between.
#[inline(always)]
pub(crate) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn approximations_stay_within_their_errors() {
        for step in -3000..3000 {
            let x = step as f32 * 0.0135;
            assert!((exp(x) / x.exp() - 1.0).abs() < 1e-5, "exp {x}");
            let color = exp_rgb(Rgb::new(x, 0.5 * x, -x, 0.0));
            for (channel, x) in channels(color).into_iter().zip([x, 0.5 * x, -x]) {
                assert!((channel / x.exp() - 1.0).abs() < 1e-5, "exp_rgb {x}");
            }
            let turn = (step as f32 / 3000.0 + 1.0) * 0.5 * PI;
            assert!(
                (angle(turn.sin() * 3.0, turn.cos() * 3.0) - turn).abs() < 2e-5,
                "angle {turn}"
            );
            let size = (x * 0.4).exp();
            assert!((rough_log2(size) - size.log2()).abs() < 0.09, "log2 {size}");
        }
        assert_eq!(exp(f32::NEG_INFINITY), exp(-200.0));
        assert!(exp(-200.0) < 1e-17);
    }
}
