use serde::{Deserialize, Serialize};

/// One change made from outside while the world ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// Tick after which it was made.
    pub tick: u64,
    /// Whose parameter was set: a population, a field or `environment`.
    pub owner: String,
    /// The parameter's name.
    pub name: String,
    /// Its new value.
    pub value: f64,
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
