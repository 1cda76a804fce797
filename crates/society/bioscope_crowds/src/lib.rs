//! What many do together: flocks and schools as arrays, the grid in which they find their
//! neighbors, how they pass obstacles, and figures that describe them.
//!
//! Results depend on seed and surroundings only, never on the number of threads: all read the
//! state of the last tick, every sum has a fixed order, and chance is keyed by individual.

pub mod avoid;
mod columns;
pub mod flock;
mod grid;
mod parameters;
pub mod statistics;
mod surroundings;

pub use flock::{Flock, Percept, Region};
pub use grid::Grid;
pub use parameters::FlockParameters;
pub use surroundings::{Goal, Home, Surroundings, Threat};
