//! What moves without being alive: fields of flow and force, drifting particles, bodies of springs.

mod current;
mod field;
pub mod spring_body;

pub use current::{Current, CurrentParameters};
pub use field::{Field, Influence};
