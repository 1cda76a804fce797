use thiserror::Error as ThisError;

/// What can go wrong in an engine crate; each message names the thing and what was expected.
#[derive(Debug, ThisError)]
pub enum Error {
    /// A parameter, option or argument has a value outside its meaning.
    #[error("{name} = {value}: expected {expected}")]
    Value {
        /// Name of the parameter or argument.
        name: String,
        /// The offending value as text.
        value: String,
        /// What would have been accepted.
        expected: String,
    },
    /// A name is not known.
    #[error("unknown {kind} '{name}'{}", suggestion(.known))]
    Unknown {
        /// What kind of thing was asked for.
        kind: &'static str,
        /// The unknown name.
        name: String,
        /// The names that are known.
        known: Vec<String>,
    },
    /// Bytes or text are not in the format they should have.
    #[error("{place}: {message}")]
    Format {
        /// File, line and column, or the name of the part.
        place: String,
        /// What was found and what was expected.
        message: String,
    },
    /// A callback of the user's own failed; `trace` holds its traceback.
    #[error("{name} failed in {verb}: {message}")]
    Callback {
        /// Name of the population, mind, body or field.
        name: String,
        /// The verb that failed.
        verb: &'static str,
        /// The message of the failure.
        message: String,
        /// Handle under which the binding keeps the original exception.
        trace: u64,
    },
    /// A bound on time, memory or count was reached.
    #[error("{what} exceeds the limit of {limit}")]
    Limit {
        /// What grew too large.
        what: String,
        /// The limit and its unit.
        limit: String,
    },
}

fn suggestion(known: &[String]) -> String {
    if known.is_empty() { String::new() } else { format!("; known: {}", known.join(", ")) }
}

impl Error {
    /// A value outside its meaning.
    pub fn value(
        name: impl Into<String>,
        value: impl ToString,
        expected: impl Into<String>,
    ) -> Self {
        Self::Value { name: name.into(), value: value.to_string(), expected: expected.into() }
    }

    /// Bytes or text in a wrong format.
    pub fn format(place: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Format { place: place.into(), message: message.into() }
    }
}

/// Result of fallible engine calls.
pub type Result<T> = core::result::Result<T, Error>;
