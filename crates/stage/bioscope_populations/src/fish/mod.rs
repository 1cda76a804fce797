//! Fish: species as data, the bodies built from them, and schools of them.

mod atlas;
mod color;
mod fins;
mod form;
mod minded;
mod paint;
mod roaming;
mod school;
mod species;
mod trunk;

pub use color::Color;
pub use form::FishForm;
pub use minded::{MINDS, MindRequest, mind};
pub(crate) use roaming::look_from;
pub use roaming::{BodyKind, look, minded, roaming};
pub use school::{FishSchool, FishSchoolOptions, SchoolParameters};
pub use species::{Detail, FishSpecies};
