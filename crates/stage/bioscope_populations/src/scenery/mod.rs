//! What stays: the [`Ground`] with its sand and rock, [`Rocks`] that lie on it, [`Corals`] that grow
//! on it, and [`Props`], shapes of the user's own.
//!
//! All shapes and pictures are made from seeded noise when the population settles or is restored;
//! their state holds the options and where things are, never a mesh (but for props).

mod corals;
mod forms;
mod ground;
mod props;
mod rocks;
mod seabed;
#[cfg(test)]
mod tests;
mod textures;

pub use corals::{CoralKind, CoralParameters, Corals, CoralsOptions};
pub(crate) use forms::tube;
pub use ground::{Ground, GroundOptions};
pub use props::{Picture, Prop, Props, PropsOptions};
pub use rocks::{Rocks, RocksOptions};
