//! The mind of an artificial fish: an intention generator, one thing at a time (Tu 1996, chapter 6).
//!
//! In every tick the fish takes in what it notices, updates hunger, libido and fear, and generates
//! one intention by a tree of priorities: to avoid a collision, to escape or school, to eat or mate, to
//! school for company, to leave or wander. A focusser passes on the target and preferences for motor
//! skills, and a behavior routine turns these into commands. One interrupted intention is remembered and
//! taken up again; what was taken up is not easily interrupted; what is followed in vain tires.

mod fatigue;
mod generator;
mod mind;
#[cfg(test)]
mod tests;

pub use fatigue::Fatigue;
pub use generator::{Circumstances, Generator};
pub use mind::Intentions;
