//! What living things want: steering, the arbitration of conflicting wishes, and minds.
//!
//! A mind sees [`Percepts`](bioscope_core::Percepts) and returns an
//! [`Intention`](bioscope_core::Intention), both plain data. It reaches no body, sense, scene or
//! physics, so any mind drives any body and is tested with typed-in percepts.

pub mod arbitration;
pub mod attention;
mod behavior_network;
mod character;
pub mod drives;
mod free_flow;
mod intentions;
mod mind;
mod nature;
mod roamer;
pub mod routines;
pub mod steering;

pub use attention::Behavior;
pub use behavior_network::BehaviorNetwork;
pub use free_flow::FreeFlow;
pub use intentions::{Circumstances, Fatigue, Generator, Intentions};
pub use mind::{Mind, place};
pub use nature::{Habits, Nature, Relation, Role, Temper};
pub use roamer::{Roamer, RoamerParameters};
