//! Bounds of a derivation, and why one stops.

use crate::{EnvironmentError, Place};

/// What a derivation may use before it is stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Modules in one string.
    pub modules: usize,
    /// Bytes of one string, its parameters included.
    pub bytes: usize,
    /// Modules looked at, and instructions run, in all steps together.
    pub operations: u64,
}

impl Default for Limits {
    /// 500 million modules, 2 GiB, 20 thousand million operations.
    fn default() -> Self {
        Self { modules: 500_000_000, bytes: 2 << 30, operations: 20_000_000_000 }
    }
}

impl Limits {
    /// The first that a string of so many modules and parameters, or so much work, exceeds.
    pub(super) fn exceeded(
        &self,
        modules: usize,
        parameters: usize,
        operations: u64,
    ) -> Option<String> {
        if modules > self.modules {
            Some(format!("more than {} modules", self.modules))
        } else if modules + size_of::<f32>() * parameters > self.bytes {
            Some(format!("more than {} bytes of modules and parameters", self.bytes))
        } else if operations > self.operations {
            Some(format!("more than {} operations", self.operations))
        } else {
            None
        }
    }
}

/// Why a derivation stopped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DerivationError {
    /// A bound was reached.
    #[error("{place}: {what} at step {step}; the string grows most by '{production}'")]
    Limit {
        /// Where the production stands that made most of the string.
        place: Place,
        /// The bound.
        what: String,
        /// The derivation step, from 1.
        step: u64,
        /// The production, as it is written.
        production: String,
    },
    /// A production could not be evaluated.
    #[error("{place}: {what} at step {step} in '{production}'")]
    Fault {
        /// Where the production stands.
        place: Place,
        /// What went wrong.
        what: String,
        /// The derivation step, from 1; 0 for the axiom.
        step: u64,
        /// The production, as it is written, or the name of the block.
        production: String,
    },
    /// The surroundings failed.
    #[error("{error} (after step {step})")]
    Environment {
        /// What happened.
        error: EnvironmentError,
        /// The derivation step, 0 for the axiom.
        step: u64,
    },
}

impl From<DerivationError> for bioscope_core::Error {
    fn from(error: DerivationError) -> Self {
        match error {
            DerivationError::Limit { place, what, step, production } => Self::Format {
                place: place.to_string(),
                message: format!("{what} at step {step}; the string grows most by '{production}'"),
            },
            DerivationError::Fault { place, what, step, production } => Self::Format {
                place: place.to_string(),
                message: format!("{what} at step {step} in '{production}'"),
            },
            DerivationError::Environment { error, step } => {
                Self::Format { place: format!("step {step}"), message: error.to_string() }
            }
        }
    }
}

impl From<Box<DerivationError>> for DerivationError {
    fn from(error: Box<DerivationError>) -> Self {
        *error
    }
}
