//! A flock as arrays: boids, birds or fishes that keep apart, match velocities and stay near one
//! another, pass obstacles, flee and fly.
//!
//! One tick is [`sense`](Flock::sense) (what is around, from the last tick's state), then
//! [`decide`](Flock::decide) (requests by priority: obstacles, ground and surface, threats,
//! home, separation, velocity matching, centering, goal, whims), then
//! [`advance`](Flock::advance) (geometric flight). [`update`](Flock::update) is all three.
//!
//! Source: Reynolds, "Flocks, herds, and schools: a distributed behavioral model", SIGGRAPH 1987.

mod decide;
mod flight;
mod membership;
mod neighbors;
mod sense;

pub use membership::Region;
pub use sense::Percept;

use bioscope_core::{Error, Id, Mat3, Quat, Result, Vec3, state};
use serde::{Deserialize, Serialize};

use crate::columns::Row;
use crate::grid::Grid;
use crate::{FlockParameters, Surroundings};

/// Many individuals of one kind, one array per quantity, in the order in which they joined.
#[derive(Clone, Debug)]
pub struct Flock {
    /// Tunable numbers; those set directly rather than by name are not checked.
    pub parameters: FlockParameters,
    seed: u64,
    members: Members,
    scratch: Scratch,
}

/// The state proper.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Members {
    ids: Vec<Id>,
    positions: Vec<Vec3>,
    /// Through the medium, metres per second.
    velocities: Vec<Vec3>,
    /// Of the medium, metres per second.
    drifts: Vec<Vec3>,
    headings: Vec<Vec3>,
    ups: Vec<Vec3>,
    /// 0 (calm) to 1 (terrified).
    alarms: Vec<f32>,
    /// By which cruise speed is multiplied.
    paces: Vec<f32>,
}

/// What is worked out anew in every tick; in the order of the grid's slots.
#[derive(Clone, Debug, Default)]
struct Scratch {
    grid: Grid,
    rows: Vec<Row>,
    percepts: Vec<Percept>,
    decisions: Vec<decide::Decision>,
}

impl Flock {
    /// A flock without members.
    pub fn new(parameters: FlockParameters, seed: u64) -> Result<Self> {
        parameters.check()?;
        Ok(Self { parameters, seed, members: Members::default(), scratch: Scratch::default() })
    }

    /// One tick of `dt` seconds: sense, decide, advance.
    pub fn update(&mut self, dt: f32, surroundings: &Surroundings) -> Result<()> {
        self.sense(surroundings);
        self.decide(surroundings);
        self.advance(dt, surroundings)
    }

    /// How many members there are.
    pub fn len(&self) -> usize {
        self.members.ids.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.members.ids.is_empty()
    }

    /// Identity of each member.
    pub fn ids(&self) -> &[Id] {
        &self.members.ids
    }

    /// Where each is, metres.
    pub fn positions(&self) -> &[Vec3] {
        &self.members.positions
    }

    /// How each moves through the medium, metres per second; tangent to its path in still medium.
    pub fn velocities(&self) -> &[Vec3] {
        &self.members.velocities
    }

    /// Where each looks: unit vectors.
    pub fn headings(&self) -> &[Vec3] {
        &self.members.headings
    }

    /// Where the back of each points: unit vectors across the heading.
    pub fn ups(&self) -> &[Vec3] {
        &self.members.ups
    }

    /// How alarmed each is, 0 (calm) to 1 (terrified).
    pub fn alarms(&self) -> &[f32] {
        &self.members.alarms
    }

    /// By which each one's cruise speed is multiplied, for those who change their pace.
    pub fn paces_mut(&mut self) -> &mut [f32] {
        &mut self.members.paces
    }

    /// Rotation of one member from its own frame (X left, Y up, Z ahead) to the world's.
    pub fn rotation(&self, index: usize) -> Quat {
        let (up, ahead) = (self.members.ups[index], self.members.headings[index]);
        Quat::from_mat3(&Mat3::from_cols(up.cross(ahead), up, ahead)).normalize()
    }

    /// Complete state, parameters and seed included, as bytes.
    pub fn save(&self) -> Vec<u8> {
        state::to_bytes(&(&self.parameters, self.seed, &self.members))
    }

    /// The flock that [`save`](Self::save) wrote.
    pub fn restore(bytes: &[u8]) -> Result<Self> {
        let (parameters, seed, members): (FlockParameters, u64, Members) =
            state::from_bytes("flock", bytes)?;
        members.check()?;
        Ok(Self { members, ..Self::new(parameters, seed)? })
    }
}

impl Members {
    /// Refuses arrays of different lengths and numbers that are none.
    fn check(&self) -> Result<()> {
        let count = self.ids.len();
        let vectors = [&self.positions, &self.velocities, &self.drifts, &self.headings, &self.ups];
        let numbers = [&self.alarms, &self.paces];
        let complete = vectors.iter().all(|array| array.len() == count)
            && numbers.iter().all(|array| array.len() == count);
        let finite = vectors.iter().all(|array| array.iter().all(|one| one.is_finite()))
            && numbers.iter().all(|array| array.iter().all(|one| one.is_finite()));
        if complete && finite {
            return Ok(());
        }
        Err(Error::format("flock", "the arrays of the saved state do not fit together"))
    }
}
