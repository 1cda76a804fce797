use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::Id;

/// Something that happened: a birth, a bite, a collision.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Tick in which it happened.
    pub tick: u64,
    /// World time in seconds.
    pub time: f64,
    /// One word of the field, lower case: `eaten`, `born`, `startled`.
    pub kind: Cow<'static, str>,
    /// The individual it happened to.
    pub subject: Id,
    /// The other individual involved, if any.
    pub object: Option<Id>,
    /// Further figures, each with its unit in the name.
    pub data: BTreeMap<String, Value>,
}

/// A plain value: what events, inspectors and percepts carry beside their fixed fields.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// A truth value.
    Flag(bool),
    /// A number.
    Number(f64),
    /// A word or sentence.
    Text(String),
    /// A vector or list of numbers.
    Numbers(Vec<f64>),
}

impl From<bool> for Value {
    fn from(value: bool) -> Self {
        Self::Flag(value)
    }
}

impl From<f32> for Value {
    fn from(value: f32) -> Self {
        Self::Number(f64::from(value))
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

impl From<glam::Vec3> for Value {
    fn from(value: glam::Vec3) -> Self {
        Self::Numbers(value.to_array().map(f64::from).to_vec())
    }
}
