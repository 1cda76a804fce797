//! Fishing: a [`FishingLine`] with a baited hook, and what becomes of the fish that takes it.
//!
//! The bait is food that fishes notice like any other. The first mouth that closes on it is hooked: the line
//! publishes [`HOOKED`](crate::bites::HOOKED) and hauls; the animal is held by the mouth, struggles and goes where
//! the hook goes, until it is lifted out of the water and leaves the world as caught.

mod line;
mod tackle;
#[cfg(test)]
mod tests;

pub use line::{FishingLine, FishingLineOptions, FishingLineParameters};
