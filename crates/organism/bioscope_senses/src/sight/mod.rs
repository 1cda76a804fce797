//! Sight: who is near, where, how large and how they move.
//!
//! One cyclopean eye near the mouth with a field of view of up to 300 degrees (Terzopoulos, Tu and
//! Grzeszczuk, "Artificial fishes", 1994). It takes living things straight from the scene instead of
//! recognizing them in an image. A thing is seen if it is within range (of the eye, and of what
//! the haze of the medium lets through), within the field of view, large enough on the retina, and
//! not wholly hidden by obstacles or ground. Other animals hide nothing: short occlusions should not make
//! attention jump. Of all that is seen the nearest are attended to, what moves before what stays.
//!
//! Tu's range grows with the target's size, `s V_r`. That is a limit on the angle under which a thing
//! appears: with `s` its size in own body lengths and `V_r` = 15 body lengths it is 1/15 rad, 3.8 degrees,
//! the [`acuity`](SightParameters::acuity) of [`SightParameters::fish`].

mod cover;
mod sensor;
#[cfg(test)]
mod tests;

pub use sensor::{Sight, SightParameters};
