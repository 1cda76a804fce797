//! Sight: who is near, where, how large and how they move.
//!
//! One cyclopean eye near the mouth with a field of view of up to 300 degrees (Terzopoulos, Tu and
//! Grzeszczuk, "Artificial fishes", 1994). It takes living things straight from the scene instead of
//! recognizing them in an image. A thing is seen if it is within range (of the eye, and of what
//! the haze of the medium lets through), within the field of view, large enough on the retina, and
//! not hidden by obstacles or ground. Other animals hide nothing: short occlusions should not make
//! attention jump. Of all that is seen the nearest are attended to.

mod sensor;
#[cfg(test)]
mod tests;

pub use sensor::{Sight, SightParameters};
