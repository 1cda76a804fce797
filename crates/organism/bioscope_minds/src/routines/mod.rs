//! What a fish does about what it intends: behavior routines, each a small incremental program that turns
//! the focus of attention into a [`Command`] for this tick (Tu 1996, section 6.4).
//!
//! | routine | serves |
//! |---|---|
//! | [`Avoidance`] of static obstacles, of fishes | avoid |
//! | [`chase`], a subroutine of most | eat, mate, school |
//! | [`eat`], with suck-in | eat |
//! | [`Courtship`]: looping, circling, ascending, nuzzling | mate |
//! | [`Wandering`], also while leaving | wander, leave, forage |
//! | [`Escape`] by Tu's table of rules | escape |
//! | [`school`] | school |
//!
//! Where her figures are lost, the rule that was chosen is said at the routine.

mod avoidance;
mod chase;
mod command;
mod courtship;
mod eating;
mod escape;
mod schooling;
#[cfg(test)]
mod tests;
mod wandering;

pub use avoidance::Avoidance;
pub use chase::{Chase, chase};
pub use command::Command;
pub use courtship::{Courtship, Stage};
pub use eating::{choose_food, eat};
pub use escape::{Escape, Evasion, evasion};
pub use schooling::school;
pub use wandering::Wandering;
