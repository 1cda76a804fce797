//! A swimmer by geometric flight: it goes where it looks.
//!
//! The body is a point with an attitude that moves through the water along its own +Z (Reynolds,
//! "Flocks, herds, and schools", 1987, section on geometric flight). What mind may ask is bounded by
//! what fishes can do: they turn about as tightly as a share of their length whatever their speed, so
//! the turn rate grows with speed; they accelerate with limited thrust; they slow down by drag, faster
//! with spread fins; they bank into turns a little. Steady swimming alternates bursts and glides about
//! the speed wanted. The water carries them. The spine follows: its wave beats with the thrust, its bend
//! begins at the head.

mod flight;
#[cfg(test)]
mod tests;

pub use flight::{Swimmer, SwimmerParameters};
