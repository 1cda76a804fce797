//! The eye: the point of view of an animal.
//!
//! One cyclopean eye before the snout sees up to 300 degrees through an equidistant fish-eye.
//! [`eye_camera`] is that point of view for inspectors and films.

mod sensor;
#[cfg(test)]
mod tests;

pub use sensor::eye_camera;
pub(crate) use sensor::eye_position;
