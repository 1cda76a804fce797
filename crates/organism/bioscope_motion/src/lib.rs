//! How bodies move: from what a mind wants to the pose of a body.
//!
//! Bodies look along their own +Z, so +X is their left and +Y is up.

mod body;
mod swimmer;
pub mod undulation;

pub use body::Body;
pub use swimmer::{Swimmer, SwimmerParameters};
