//! The eye: the point of view of an animal, and what its retina makes of it.
//!
//! One cyclopean eye before the snout sees up to 300 degrees through an equidistant fish-eye.
//! [`eye_camera`] is that point of view for inspectors and films. The sense [`Eye`] renders the view of the cyclopean eye: color, range and
//! identity of every pixel, and from it the brightness round the animal (Tu 1996, section 5.2: the mean
//! intensity of the retinal image).

mod camera;
mod sensor;
#[cfg(test)]
mod tests;

pub use camera::eye_camera;
pub(crate) use camera::eye_position;
pub use sensor::{Eye, EyeParameters};
