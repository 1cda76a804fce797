//! Open L-systems: what plants ask of their surroundings, and what they are told.
//!
//! After every derivation step (and after the axiom) the turtle walks along the string. Query
//! modules `?P ?H ?U ?L` are told its position, heading, up and left. Communication modules `?E`
//! become the [`Request`]s of one [`Environment::exchange`]; the environment first takes note of
//! all of them and then writes the [`Reply`]s it wants to give. The numbers of modules that get
//! no reply stay as they are.
//!
//! Source: R. Měch and P. Prusinkiewicz, "Visual models of plants interacting with their
//! environment", SIGGRAPH 1996, section 4.

use bioscope_core::Vec3;

/// A module that follows a communication module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following<'a> {
    /// Its symbol, such as `F` or `@o`.
    pub symbol: &'a str,
    /// Its parameters.
    pub parameters: &'a [f32],
}

/// What a communication module `?E(x1, …, xm)` says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request<'a> {
    /// Number of the module in the string.
    pub module: usize,
    /// What tells this module from others of all steps, where modules have such identities;
    /// else its number in the string.
    pub id: u64,
    /// Its parameters.
    pub parameters: &'a [f32],
    /// Where the turtle is.
    pub position: Vec3,
    /// Where the turtle looks; unit vector.
    pub heading: Vec3,
    /// The turtle's left; unit vector.
    pub left: Vec3,
    /// The turtle's up; unit vector.
    pub up: Vec3,
    /// Width of what the turtle draws.
    pub width: f32,
    /// Index of the turtle's color.
    pub color: i32,
    /// The module after it; none at the end of the string and before a bracket that closes.
    pub following: Option<Following<'a>>,
}

/// Where the answer to a request goes: the parameters of its module.
#[derive(Debug, PartialEq)]
pub struct Reply<'a> {
    /// As many as the request has, and equal to them until they are overwritten.
    pub parameters: &'a mut [f32],
}

/// Why an exchange did not happen.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EnvironmentError {
    /// The process is gone, or does not answer.
    #[error("the environment {name} is gone: {reason}")]
    Gone {
        /// Name of the environment.
        name: String,
        /// What is known about it.
        reason: String,
    },
    /// The answer makes no sense.
    #[error("the environment {name} answered nonsense: {reason}")]
    Nonsense {
        /// Name of the environment.
        name: String,
        /// What was wrong.
        reason: String,
    },
    /// What the model asks for, or the environment's own parameters, make no sense.
    #[error("the environment {name} cannot do this: {reason}")]
    Refused {
        /// Name of the environment.
        name: String,
        /// What was wrong.
        reason: String,
    },
}

/// What surrounds a plant: the other side of its communication modules.
///
/// It must be deterministic for a given order of requests.
pub trait Environment: Send {
    /// Answers the requests of one string, in its order; `step` is 0 for the axiom.
    ///
    /// There are as many replies as requests. It is called also when there are none, since
    /// water flows even where no root drinks.
    fn exchange(
        &mut self,
        step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError>;
}
