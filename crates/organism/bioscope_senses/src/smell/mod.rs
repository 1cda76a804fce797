//! Smell: food within some distance on all sides, seen or not.
//!
//! Food that drifts out of sight is not lost: it is smelled out to a radius larger than that of sight, in all
//! directions and behind obstacles (Tu 1996, section 5.3: `O_r` > `V_r`). Nothing but food is smelled.

mod sensor;
#[cfg(test)]
mod tests;

pub use sensor::{Smell, SmellParameters};
