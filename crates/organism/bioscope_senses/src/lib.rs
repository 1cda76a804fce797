//! What animals notice: senses that turn last tick's world into percepts.
//!
//! A [`Sense`] looks at the [`Surroundings`] of one animal and fills in its part of the
//! [`Percepts`]. It is all that stands between world and mind: what no sense
//! tells, the mind does not know.

mod eye;
mod hearing;
mod lateral_line;
mod light;
mod outlook;
mod sense;
mod sight;
mod smell;
mod surroundings;
#[cfg(test)]
mod tests;
mod touch;

pub use eye::{Eye, EyeParameters, eye_camera};
pub use hearing::{Hearing, HearingParameters};
pub use lateral_line::LateralLine;
pub use light::Light;
pub use outlook::{Memory, Outlook, Reach, Register, Shortlist, Thing};
pub use sense::{Sense, restore};
pub use sight::{Sight, SightParameters};
pub use smell::{Smell, SmellParameters};
pub use surroundings::Surroundings;
pub use touch::{Touch, TouchParameters, impact_ahead};

pub use bioscope_core::Percepts;
