//! What moves without being alive: fields of flow and force, drifting particles.

mod current;
mod field;

pub use current::{Current, CurrentParameters};
pub use field::{Field, Influence};
