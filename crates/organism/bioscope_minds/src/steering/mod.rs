//! Steering behaviors as pure functions: state in, acceleration wanted out.
//!
//! Seek, flee, pursuit, evasion, arrival and following answer in m/s²: the error of the velocity is to be
//! made good within one second. [`arbitration::request`](crate::arbitration::request) turns that
//! into a request. [`steer_aside`] and [`give_way`] answer with requests at once, 1 being all the
//! acceleration there is. All work in any one frame, the world's or the animal's own.
//!
//! Source: Reynolds, "Flocks, herds, and schools", SIGGRAPH 1987, and "Steering behaviors for
//! autonomous characters", GDC 1999.

mod avoidance;
mod following;
mod target;
mod wander;

pub use avoidance::{give_way, steer_aside};
pub use following::{follow_path, follow_wall};
pub use target::{arrive, evade, flee, pursue, rendezvous, seek};
pub use wander::wander;

use bioscope_core::Vec3;

/// Something that moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moving {
    /// Where it is, metres.
    pub position: Vec3,
    /// How it moves, metres per second.
    pub velocity: Vec3,
}
