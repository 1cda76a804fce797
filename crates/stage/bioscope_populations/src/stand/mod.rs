//! Stands: plants that grow while the world runs, and compete with each other.
//!
//! Each plant is a derivation that goes on: a string of modules with its own seed, rewritten at a settable number of
//! steps per second. All plants of a stand share one environment (light, space, water …): in every step all of them are
//! rewritten, in parallel, then their messages are answered together in the order of their identities. The
//! rewriting of one step is spread evenly over the ticks that it lasts. A plant that is bitten or cut loses a branch;
//! modules that the stand knows as seeds and litter leave the plant, fall, drift with the wind, and seeds germinate
//! where there is room; a plant that draws nothing any more is dead.
//!
//! What is seen of a plant is one bending mesh of its wood, made anew when the string has changed, and its leaves as
//! instances of few shared meshes. Everything that is published follows from the saved state.
//!
//! Source of the exchange with the environment: R. Měch and P. Prusinkiewicz, "Visual models of plants interacting with
//! their environment", SIGGRAPH 1996.
//!
//! | file | question it answers |
//! |---|---|
//! | `options` | what can be said about a stand |
//! | `model` | how are its texts read |
//! | `plant` | how does one plant go on, and what can be cut off it |
//! | `space` | where is the stand, and where in it is a plant |
//! | `growing` | how does a step of the whole stand go |
//! | `falling` | where do seeds and leaves fall, and which germinate |
//! | `look` | what is seen of one plant |
//! | `show` | how are all of them published |
//! | `population` | the five verbs |

mod falling;
mod field;
mod growing;
mod look;
mod model;
mod options;
mod plant;
mod population;
mod show;
mod space;
#[cfg(test)]
mod tests;

pub use options::{StandOptions, StandParameters, Surroundings};
pub use population::Stand;
