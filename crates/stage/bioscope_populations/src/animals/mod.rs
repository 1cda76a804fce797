//! Animals assembled from parts: [`Sense`]s, a [`Mind`] and a [`Body`], one individual each.
//!
//! Senses fill percepts, the mind turns percepts into an intention, the body does what it can of it.
//! Percepts and intentions are plain data in the animal's own frame, so any mind drives any body, and
//! all three may be written by the user. [`Animals`] runs any number of such individuals; where some part
//! is the user's own, all run one after the other, else in parallel.
//!
//! Saved worlds name each part by its kind. The constructors are found in [`Kinds`], to which users add
//! theirs.
//!
//! [`Sense`]: bioscope_senses::Sense
//! [`Mind`]: bioscope_minds::Mind
//! [`Body`]: bioscope_motion::Body

mod contact;
mod feeding;
mod hooked;
mod individual;
mod inspection;
mod kinds;
mod look;
mod orders;
mod population;
mod saved;
mod settings;
#[cfg(test)]
mod tests;

pub(crate) use contact::way_out;
pub use individual::Animal;
pub use kinds::Kinds;
pub use look::Look;
pub(crate) use population::tint;
pub use population::{Animals, AnimalsOptions, Place};
