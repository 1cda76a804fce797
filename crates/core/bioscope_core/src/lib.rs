//! What everything stands on: mathematics that is the same on every machine, counter-based
//! randomness, parameters described once, and the plain data that passes between the rooms
//! of the house (events, sounds, percepts, intentions, annotations).

mod annotation;
mod display;
mod error;
mod event;
mod intention;
pub mod math;
pub mod parameter;
mod percept;
pub mod philox;
mod random;
mod sound;
pub mod state;

pub use annotation::{Annotation, Mark};
pub use display::{Act, Display, Sex};
pub use error::{Error, Result};
pub use event::{Event, Value};
pub use intention::Intention;
pub use parameter::{Parameter, Parameters};
pub use percept::{Hearing, Impact, Percepts, Retina, Sighting};
pub use random::{Purpose, Random};
pub use sound::SoundEvent;

pub use glam::{Mat3, Quat, Vec2, Vec3};

/// Identity of one thing in one world: given once, never reused. Zero means nothing.
pub type Id = u32;

/// The identity of nothing: the background of an identity image, a missing target.
pub const NOTHING: Id = 0;
