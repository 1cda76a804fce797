//! Parameters described once: name, unit, range, default, meaning and source.
//!
//! From this one description come the Python keyword, the slider on the page, the command line
//! help, the reference table and, later, mutation ranges.

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// Description of one tunable number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Name as typed: lower case, words joined by underscores.
    pub name: String,
    /// Unit: `m`, `m/s`, `BL` (body lengths), `1` for a pure number.
    pub unit: String,
    /// Least admissible value.
    pub minimum: f64,
    /// Greatest admissible value.
    pub maximum: f64,
    /// Value if nothing is said.
    pub default: f64,
    /// What it does, in one sentence.
    pub meaning: String,
    /// Where the default comes from.
    pub source: String,
}

impl Parameter {
    /// The value if it lies in the range, else an error that names the parameter.
    pub fn check(&self, value: f64) -> Result<f64> {
        if value >= self.minimum && value <= self.maximum {
            return Ok(value);
        }
        let range = format!("{} to {} {}", self.minimum, self.maximum, self.unit);
        Err(Error::value(&self.name, value, range))
    }
}

/// A set of parameters with their current values; written by [`parameters!`](crate::parameters!).
pub trait Parameters {
    /// All descriptions, in the order of declaration.
    fn descriptions(&self) -> Vec<Parameter>;
    /// Current value of one of them.
    fn get(&self, name: &str) -> Option<f64>;
    /// Sets one of them; refuses unknown names and values outside the range.
    fn set(&mut self, name: &str, value: f64) -> Result<()>;
}

/// Declares a struct of `f32` parameters together with their descriptions.
///
/// ```
/// use bioscope_core::{parameters, Parameters};
/// parameters! {
///     /// How a drifter drifts.
///     pub struct Drift {
///         /// Share of the current's speed that the drifter takes on.
///         follow: f32 = 1.0, "1", 0.0..=2.0, "choice";
///     }
/// }
/// let mut drift = Drift::default();
/// assert!(drift.set("follow", 3.0).is_err());
/// drift.set("follow", 0.5).unwrap();
/// assert_eq!(drift.follow, 0.5);
/// ```
#[macro_export]
macro_rules! parameters {
    (
        $(#[doc = $about:literal])*
        pub struct $type:ident {
            $(
                $(#[doc = $meaning:literal])+
                $name:ident : f32 = $default:expr, $unit:literal, $low:literal ..= $high:literal,
                $source:literal;
            )*
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Clone, Debug, PartialEq, ::serde::Serialize, ::serde::Deserialize)]
        pub struct $type {
            $($(#[doc = $meaning])+ pub $name: f32,)*
        }

        impl Default for $type {
            fn default() -> Self {
                Self { $($name: $default,)* }
            }
        }

        impl $crate::Parameters for $type {
            fn descriptions(&self) -> Vec<$crate::Parameter> {
                vec![$($crate::Parameter {
                    name: stringify!($name).to_owned(),
                    unit: $unit.to_owned(),
                    minimum: f64::from($low as f32),
                    maximum: f64::from($high as f32),
                    default: f64::from($default as f32),
                    meaning: concat!($($meaning,)+).trim().to_owned(),
                    source: $source.to_owned(),
                },)*]
            }

            fn get(&self, name: &str) -> Option<f64> {
                match name {
                    $(stringify!($name) => Some(f64::from(self.$name)),)*
                    _ => None,
                }
            }

            fn set(&mut self, name: &str, value: f64) -> $crate::Result<()> {
                let descriptions = $crate::Parameters::descriptions(self);
                let Some(parameter) = descriptions.iter().find(|one| one.name == name) else {
                    return Err($crate::Error::Unknown {
                        kind: "parameter",
                        name: name.to_owned(),
                        known: descriptions.into_iter().map(|one| one.name).collect(),
                    });
                };
                let value = parameter.check(value)? as f32;
                match name {
                    $(stringify!($name) => self.$name = value,)*
                    _ => unreachable!("described names are matched"),
                }
                Ok(())
            }
        }
    };
}
