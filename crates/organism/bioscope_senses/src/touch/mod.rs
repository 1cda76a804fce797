//! Touch at a distance: what the animal will run into if it goes on as it does.
//!
//! A feeler as long as a few body lengths, or as the way of the next seconds, points straight ahead.
//! It feels obstacles, the ground and the surface of the water. What lies alongside is not felt, so
//! that an animal can swim along a wall in peace (Reynolds, "Not bumping into things", 1988). The height
//! above the ground is felt as well, as `altitude` in metres among the other percepts.

mod sensor;
#[cfg(test)]
mod tests;

pub use sensor::{Touch, TouchParameters, impact_ahead};
