//! A school of fish: a flock in the water, each member with a body that swims.
//!
//! The flock (Reynolds, "Flocks, herds, and schools", 1987) decides where everybody goes: it keeps off
//! seabed, surface and rocks, splits round them and closes again, flees from large moving animals
//! that it sees coming, is drawn on by a goal that wanders slowly through its home range, and is carried by
//! the current. Each fish differs in size, color, pace and phase; it swims in bursts and glides, and
//! its spine beats with the thrust that its motion asks for. Or it replays motion captured from the muscle-driven fish, and
//! those nearest to an observer are driven by muscles.

mod bodies;
mod course;
mod fish;
mod inspection;
mod options;
mod population;
mod saved;
mod settings;
mod show;
#[cfg(test)]
mod tests;
mod threats;

pub use options::{FishSchoolOptions, SchoolParameters};
pub use population::FishSchool;
