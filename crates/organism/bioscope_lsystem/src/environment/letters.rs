//! Requests that are kept, to be answered together with those of other plants.

use std::sync::{Arc, Mutex, PoisonError};

use bioscope_core::Vec3;
use serde::{Deserialize, Serialize};

use super::{Environment, EnvironmentError, Following, Reply, Request};

/// A [`Request`] that owns what it says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Letter {
    /// Number of the module in the string.
    pub module: usize,
    /// What tells the module from others, see [`Request::id`].
    pub id: u64,
    /// Its parameters.
    pub parameters: Vec<f32>,
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
    /// Symbol and parameters of the module after it.
    pub following: Option<(String, Vec<f32>)>,
}

impl Letter {
    /// The letter as a request.
    pub fn request(&self) -> Request<'_> {
        let following = self.following.as_ref();
        Request {
            module: self.module,
            id: self.id,
            parameters: &self.parameters,
            position: self.position,
            heading: self.heading,
            left: self.left,
            up: self.up,
            width: self.width,
            color: self.color,
            following: following.map(|(symbol, parameters)| Following { symbol, parameters }),
        }
    }

    fn of(request: &Request) -> Self {
        let following =
            request.following.map(|next| (next.symbol.to_owned(), next.parameters.to_vec()));
        Self {
            module: request.module,
            id: request.id,
            parameters: request.parameters.to_vec(),
            position: request.position,
            heading: request.heading,
            left: request.left,
            up: request.up,
            width: request.width,
            color: request.color,
            following,
        }
    }
}

/// An environment that answers nothing and keeps the requests of the last exchange: where many plants share one
/// environment, each writes to a mailbox, and the environment then answers all at once.
#[derive(Clone, Debug, Default)]
pub struct Mailbox(Arc<Mutex<Vec<Letter>>>);

impl Mailbox {
    /// Takes the letters out.
    pub fn take(&self) -> Vec<Letter> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Environment for Mailbox {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        _replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let letters = requests.iter().map(Letter::of).collect();
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = letters;
        Ok(())
    }
}
