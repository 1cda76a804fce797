//! What drifts: [`Plankton`] that the current carries through a box of water, and [`Bubbles`] that
//! rise from vents in the ground.
//!
//! Both publish [`Points`](bioscope_geometry::Points). Plankton keeps its number: whatever leaves the box through one
//! face is replaced by a newcomer where water flows in, so that its density stays uniform.
//! Bubbles are born in clusters at random times, rise at their terminal speed and burst at the
//! surface.

mod bubbles;
mod plankton;
#[cfg(test)]
mod tests;

pub use bubbles::{BubbleParameters, Bubbles, BubblesOptions, minnaert_frequency, rise_speed};
pub use plankton::{Plankton, PlanktonOptions, PlanktonParameters};
