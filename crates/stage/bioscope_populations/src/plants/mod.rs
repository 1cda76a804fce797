//! Stands of plants: grown from an L-system, rooted in the ground, bent by the current.
//!
//! A population grows a few distinct shapes ([`PlantsOptions::variants`]) from one L-system text and
//! plants copies of them, each with its own size, direction, tint and phase. In every tick the flow
//! is sampled at each plant's own place, so a gust travels through a meadow; each plant answers
//! with a chain of damped springs, stiff at the base, late and wide at the tip, whose motion is
//! solved exactly and so is stable at any length of tick. Leaves flutter faster than stems bend.
//! In air the same population is bent by the wind.
//!
//! | file | question it answers |
//! |---|---|
//! | `options` | what can be said about a stand |
//! | `shapes` | how do the shapes grow from the text |
//! | `sway` | how does one plant answer the flow |
//! | `parting` | who pushes it aside |
//! | `population` | the five verbs |

mod options;
mod parting;
mod population;
pub(crate) mod shapes;
mod sway;
#[cfg(test)]
mod tests;

pub use options::{PlantsOptions, PlantsParameters};
pub use population::Plants;
pub(crate) use sway::{Stance, Sway};
