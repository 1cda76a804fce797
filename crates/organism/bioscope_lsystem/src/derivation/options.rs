//! What a derivation needs to know beside the L-system.

use std::{path::PathBuf, sync::Arc};

use super::Limits;
use crate::{
    Environment, EnvironmentError, Functions, LSystem, ModuleString, Settings, TurtleOptions,
    built_in, read_environment,
};

/// What a derivation needs to know beside the L-system.
pub struct DerivationOptions {
    /// Seed of the random numbers. Without one, files of the cpfg dialect draw the numbers of
    /// the reference program, and files of our own notation have seed 0.
    pub seed: Option<u64>,
    /// What it may use.
    pub limits: Limits,
    /// Seconds after which it is stopped.
    pub seconds: Option<f64>,
    /// Whether it may use several threads; the string does not depend on that.
    pub threads: bool,
    /// Functions and curves that the model looks up.
    pub functions: Option<Arc<dyn Functions>>,
    /// A string of the same model that is taken for the axiom.
    pub start: Option<ModuleString>,
    /// What surrounds the plant.
    pub environment: Option<Box<dyn Environment>>,
    /// How the turtle walks, for modules that ask for its place.
    pub turtle: TurtleOptions,
    /// The folder in which the model may read and write files.
    pub folder: Option<PathBuf>,
}

impl Default for DerivationOptions {
    /// No seed, default limits, several threads, no surroundings.
    fn default() -> Self {
        Self {
            seed: None,
            limits: Limits::default(),
            seconds: None,
            threads: true,
            functions: None,
            start: None,
            environment: None,
            turtle: TurtleOptions::default(),
            folder: None,
        }
    }
}

impl DerivationOptions {
    /// The defaults, with the angle and the environment that the file asks for.
    pub fn of(system: &LSystem) -> Result<Self, EnvironmentError> {
        let mut options = Self::default();
        if let Some(angle) = system.angle() {
            options.turtle.angle = angle;
        }
        options.environment = system.environment().map(Self::environment_of).transpose()?;
        Ok(options)
    }

    /// The environment of an environment file (`….e`), or the built-in one that a line such as
    /// `leaf_discs rho=0.89` names.
    pub fn environment_of(words: &str) -> Result<Box<dyn Environment>, EnvironmentError> {
        let refused =
            |name: &str, reason: String| EnvironmentError::Refused { name: name.into(), reason };
        if words.trim().ends_with(".e") {
            let path = std::path::Path::new(words.trim());
            return read_environment(path).map_err(|error| refused(words, error.to_string()));
        }
        let mut parts = words.split_whitespace();
        let name = parts.next().unwrap_or_default();
        let mut settings = Settings::default();
        for part in parts {
            let Some((key, value)) = part.split_once('=') else {
                return Err(refused(name, format!("expected name=value, found '{part}'")));
            };
            settings.set(key, value);
        }
        built_in(name, &settings, None)
    }
}
