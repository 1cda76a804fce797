//! Fishes that swim with muscles: the spring body of [`bioscope_dynamics::spring_body`] under nine motor controllers
//! (Tu, "Artificial Animals for Computer Animation", 1999, chapter 4).
//!
//! [`FishModel`] is a body with its calibrated tables, [`Swimmers`] are many fishes of one model, [`Command`] is what
//! one of them is to do.

pub mod calibration;
mod fins;
mod frame;
mod individual;
mod model;
mod motor;
mod replay;
mod rig;
mod saved;
mod swimmers;
mod tables;
#[cfg(test)]
mod tests;
mod together;
mod turning;

pub use fins::Fins;
pub use frame::Frame;
pub(crate) use frame::wrapped;
pub use model::{FishDesign, FishModel};
pub use motor::{Command, Effort, Feeling, Motor, published_parameters};
pub use replay::{Repertoire, Replica, Segment, advance_replicas};
pub use rig::pose_from_nodes;
pub use swimmers::Swimmers;
pub use tables::{Bend, FinSettings, Stroke, SwimTable, TurnTable};
pub use turning::{Stage, Turn};
