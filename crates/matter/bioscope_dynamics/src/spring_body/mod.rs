//! Bodies of springs: point masses joined by viscoelastic units, some of which are muscles, whose skin
//! pushes water.
//!
//! [`fish`](fish::fish) builds the fish of 23 nodes, [`Mechanics`] advances it. A body is computed in [`Real`]:
//! `f64` or `f32` for one alone, [`Lanes`] for eight side by side.

mod anatomy;
mod dispatch;
pub mod fish;
mod guard;
mod medium;
mod real;
mod skyline;
mod solver;
#[cfg(test)]
mod tests;

pub use anatomy::{Anatomy, Unit, signed_volume};
pub use dispatch::Dispatch;
pub use medium::{Law, Medium, Surface};
pub use real::{Lanes, Real, Triple};
pub use skyline::{Block, Skyline};
pub use solver::{Body, Integrator, Mechanics, Workspace};
