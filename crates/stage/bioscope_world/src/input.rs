use serde::{Deserialize, Serialize};

use crate::Order;

/// One change made from outside while the world ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// Tick after which it was made.
    pub tick: u64,
    /// What was changed.
    pub change: Change,
}

/// What can be changed from outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Change {
    /// A parameter was set.
    Set {
        /// Whose: a population, a field, `environment` or `world`.
        owner: String,
        /// The parameter's name.
        name: String,
        /// Its new value.
        value: f64,
    },
    /// A population was told something.
    Order {
        /// Its name.
        population: String,
        /// What it was told.
        order: Order,
    },
    /// A population came to live in the world.
    Add {
        /// The name it was given.
        name: String,
        /// Its kind.
        kind: String,
        /// Its state before it settled.
        state: Vec<u8>,
    },
}

/// A run that can be repeated: where it began and what was done to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recording {
    /// The saved world at the beginning.
    pub start: Vec<u8>,
    /// All changes since, in order.
    pub inputs: Vec<Input>,
    /// Tick at the end.
    pub end: u64,
}
