use std::collections::BTreeMap;

use bioscope_core::{Error, Result};
use bioscope_dynamics::{Current, Field};

use crate::Population;

type Build<T> = Box<dyn Fn(&[u8]) -> Result<Box<T>> + Send + Sync>;

/// Constructors by kind, with which saved worlds are brought back.
pub struct Registry {
    populations: BTreeMap<String, Build<dyn Population>>,
    fields: BTreeMap<String, Build<dyn Field>>,
}

impl Default for Registry {
    /// Knows the fields of the engine and no population.
    fn default() -> Self {
        let mut registry = Self { populations: BTreeMap::new(), fields: BTreeMap::new() };
        registry.add_field("current", |bytes| {
            Ok(Box::new(bioscope_core::state::from_bytes::<Current>("current", bytes)?))
        });
        registry
    }
}

impl Registry {
    /// Teaches how to build a population of this kind from its saved state.
    pub fn add_population(
        &mut self,
        kind: &str,
        build: impl Fn(&[u8]) -> Result<Box<dyn Population>> + Send + Sync + 'static,
    ) {
        self.populations.insert(kind.to_owned(), Box::new(build));
    }

    /// Teaches how to build a field of this kind from its saved state.
    pub fn add_field(
        &mut self,
        kind: &str,
        build: impl Fn(&[u8]) -> Result<Box<dyn Field>> + Send + Sync + 'static,
    ) {
        self.fields.insert(kind.to_owned(), Box::new(build));
    }

    /// A population of this kind in this saved state.
    pub fn population(&self, kind: &str, bytes: &[u8]) -> Result<Box<dyn Population>> {
        match self.populations.get(kind) {
            Some(build) => build(bytes),
            None => Err(unknown("population", kind, &self.populations)),
        }
    }

    /// A field of this kind in this saved state.
    pub fn field(&self, kind: &str, bytes: &[u8]) -> Result<Box<dyn Field>> {
        match self.fields.get(kind) {
            Some(build) => build(bytes),
            None => Err(unknown("field", kind, &self.fields)),
        }
    }
}

fn unknown<T>(kind: &'static str, name: &str, known: &BTreeMap<String, T>) -> Error {
    Error::Unknown { kind, name: name.to_owned(), known: known.keys().cloned().collect() }
}
