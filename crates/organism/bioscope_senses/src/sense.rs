use bioscope_core::{Error, Parameters, Percepts, Result, state};
use bioscope_geometry::{Camera, Transform};
use serde::de::DeserializeOwned;

use crate::Surroundings;

/// One way to notice the world.
pub trait Sense: Send + Sync {
    /// Word under which saved worlds find the constructor: `sight`.
    fn kind(&self) -> &str;

    /// Adds what this sense notices to the percepts; each sense fills fields of its own.
    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()>;

    /// The point of view of an animal of `body_length` metres that is at `placement`, if this sense
    /// has one.
    fn eye(&self, _placement: &Transform, _body_length: f32) -> Option<Camera> {
        None
    }

    /// Tunable numbers, if it has any.
    fn parameters(&self) -> Option<&dyn Parameters> {
        None
    }

    /// Tunable numbers for changing.
    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        None
    }

    /// Complete state, parameters included, as bytes.
    fn save(&self) -> Result<Vec<u8>>;
}

/// The sense that [`save`](Sense::save) wrote; refuses parameters outside their ranges.
pub fn restore<T: Sense + DeserializeOwned>(kind: &str, bytes: &[u8]) -> Result<T> {
    let sense: T = state::from_bytes(kind, bytes)?;
    if let Some(parameters) = sense.parameters() {
        for parameter in parameters.descriptions() {
            let value = parameters.get(&parameter.name).unwrap_or(f64::NAN);
            parameter.check(value).map_err(|error| Error::format(kind, error.to_string()))?;
        }
    }
    Ok(sense)
}
