//! A body of muscles for any mind: the muscle-driven fish of [`crate::fish`] behind the contract
//! [`Body`](crate::Body).
//!
//! The intention's turn, climb, speed and brake go to the motor controllers, which contract the muscles; springs and
//! water do the rest. The form of the species bends as the center line of the 23 nodes does (Tu, "Artificial
//! Animals for Computer Animation", section 5.1, binds NURBS control points to the nodes; here the
//! spine of the skinned form follows the same line).

mod physics;
mod swimmer;
#[cfg(test)]
mod tests;

pub use physics::MusclePhysics;
pub use swimmer::MuscleSwimmer;
