//! How bodies move: from what a mind wants to the pose of a body.
//!
//! Bodies look along their own +Z, so +X is their left and +Y is up.

mod body;
pub mod fish;
mod muscle_swimmer;
mod swimmer;
pub mod undulation;

pub use body::Body;
pub use muscle_swimmer::MuscleSwimmer;
pub use swimmer::{Swimmer, SwimmerParameters};
