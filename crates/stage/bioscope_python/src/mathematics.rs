//! Transcendental functions for simulation code in Python, the same on every machine; radians.

use bioscope_core::math::double;
use pyo3::prelude::*;

/// The sine of an angle.
#[pyfunction]
pub fn sine(angle: f64) -> f64 {
    double::sin(angle)
}

/// The cosine of an angle.
#[pyfunction]
pub fn cosine(angle: f64) -> f64 {
    double::cos(angle)
}

/// The angle whose sine is `value`; not a number outside -1 to 1.
#[pyfunction]
pub fn arc_sine(value: f64) -> f64 {
    double::asin(value)
}

/// The angle from the direction of `x` to that of `(x, y)`.
#[pyfunction]
pub fn arc_tangent(y: f64, x: f64) -> f64 {
    double::atan2(y, x)
}

/// e to the power of `exponent`.
#[pyfunction]
pub fn exponential(exponent: f64) -> f64 {
    double::exp(exponent)
}

/// The hyperbolic tangent.
#[pyfunction]
pub fn hyperbolic_tangent(value: f64) -> f64 {
    double::tanh(value)
}

/// `base` to the power of `exponent`; not a number where it is not real.
#[pyfunction]
pub fn power(base: f64, exponent: f64) -> f64 {
    double::pow(base, exponent)
}
