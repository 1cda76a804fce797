//! Transcendental functions with the same result on every machine and C library.
//!
//! Simulation code calls these instead of the methods of `f32`, whose last bit depends on the
//! platform, so that one seed gives one `state_hash` everywhere.

pub use core::f32::consts::{PI, TAU};
pub use libm::{
    acosf as acos, asinf as asin, atan2f as atan2, cosf as cos, expf as exp, logf as ln,
    powf as pow, sinf as sin, sqrtf as sqrt, tanf as tan,
};

/// The same functions in double precision.
pub mod double {
    pub use libm::{asin, atan2, cos, exp, pow, sin, tanh};
}

/// Linear interpolation from `a` (at `t` = 0) to `b` (at `t` = 1).
pub fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// 0 below `low`, 1 above `high`, a smooth cubic in between.
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Share of the remaining way covered in `dt` seconds by first-order relaxation with the given
/// time constant in seconds; a time constant of zero arrives at once.
pub fn relaxation(dt: f32, time_constant: f32) -> f32 {
    if time_constant <= 0.0 { 1.0 } else { 1.0 - exp(-dt / time_constant) }
}
