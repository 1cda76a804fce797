//! Attention: what of all that is noticed matters to what a fish wants (Tu 1996, sections 5.4 and 5.5).
//!
//! [`Situation`] sorts the percepts by what they are to the fish. A focusser passes on the one target of
//! the current intention; all else that is relevant survives only as [`Preferences`]: how much is to be said
//! for and against each motor skill. So a fish can do one thing in a way that suits its other wishes.

mod preferences;
mod situation;
mod strengths;
mod target;
#[cfg(test)]
mod tests;
mod threat;

pub use preferences::{Preferences, Skill, azimuth, elevation};
pub use situation::{Morsel, Situation};
pub use strengths::{Behavior, Focus, Strengths, preferences};
pub use target::{Candidate, choose};
pub use threat::{Region, Threat};
