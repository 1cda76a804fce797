//! What living things want: steering, the arbitration of conflicting wishes, and minds.
//!
//! A mind sees [`Percepts`](bioscope_core::Percepts) and returns an
//! [`Intention`](bioscope_core::Intention), both plain data. It reaches no body, sense, scene or
//! physics, so any mind drives any body and is tested with typed-in percepts.

pub mod arbitration;
mod mind;
mod roamer;
pub mod steering;

pub use mind::{Mind, place};
pub use roamer::{Roamer, RoamerParameters};
