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

mod amounts;
mod cells;
mod collision;
mod guides;
mod letters;
mod limbs;
mod patch_light;
mod pipe;
mod registry;
mod settings;
mod shadow;
mod sky_light;
mod soil;
mod takenaka;

use bioscope_core::Vec3;

pub use amounts::Amounts;
pub use collision::{Collision, Competition};
pub use guides::{Obstacles, Pole, Pruning, Shape};
pub use letters::{Letter, Mailbox};
pub use limbs::Limbs;
pub use patch_light::{LightMap, PatchLight};
pub use pipe::Pipe;
pub use registry::{built_in, environment_names, read_environment};
pub use settings::Settings;
pub use shadow::{Density, DensityVoxels, ShadowVoxels};
pub use sky_light::SkyLight;
pub use soil::SoilWater;
pub use takenaka::LeafBalls;

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

    /// What it remembers from one exchange to the next, for saved worlds; nothing where every
    /// exchange begins anew.
    fn memory(&self) -> bioscope_core::Result<Vec<u8>> {
        Ok(Vec::new())
    }

    /// Whether it knows only who asks in this very step, as the sky does: plants that ask in other steps must be
    /// told of again, or they throw no shade.
    fn forgets(&self) -> bool {
        false
    }

    /// What can be seen of it: the amounts of something in the cells of a box, where it keeps such.
    fn amounts(&self) -> Option<Amounts> {
        None
    }

    /// Goes back to what [`memory`](Self::memory) gave.
    fn recall(&mut self, _memory: &[u8]) -> bioscope_core::Result<()> {
        Ok(())
    }
}

/// A turtle's heading, left and up, for tests: up as near as possible to +Z.
#[cfg(test)]
fn frame(heading: Vec3) -> (Vec3, Vec3, Vec3) {
    let left = Vec3::Z.cross(heading).normalize_or(Vec3::X);
    (heading, left, heading.cross(left))
}

/// Asks an environment once, for tests: parameters, place and heading of each message.
#[cfg(test)]
fn ask(environment: &mut dyn Environment, asked: &[(&[f32], Vec3, Vec3)]) -> Vec<Vec<f32>> {
    let request =
        |(module, &(parameters, position, heading)): (usize, &(&'_ [f32], Vec3, Vec3))| {
            (module, parameters.to_vec(), position, frame(heading))
        };
    let all: Vec<_> = asked.iter().enumerate().map(request).collect();
    let requests: Vec<Request> = all
        .iter()
        .map(|(module, parameters, position, (heading, left, up))| Request {
            module: *module,
            id: *module as u64,
            parameters,
            position: *position,
            heading: *heading,
            left: *left,
            up: *up,
            width: 0.1,
            color: 1,
            following: None,
        })
        .collect();
    let mut answers: Vec<Vec<f32>> = asked.iter().map(|one| one.0.to_vec()).collect();
    let mut replies: Vec<Reply> =
        answers.iter_mut().map(|answer| Reply { parameters: answer }).collect();
    environment.exchange(0, &requests, &mut replies).unwrap();
    drop(replies);
    answers
}
