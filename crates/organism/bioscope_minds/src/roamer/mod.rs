//! A large fish that roams a home range.
//!
//! It cruises along a wandering course, turns home when it has strayed, keeps off surface,
//! seabed and obstacles, inspects schools that it sees and sometimes dashes at them. It alternates
//! bursts with glides and hesitates before it changes its mind. All durations are drawn anew each
//! time. A choice of ours throughout; the steering is that of [`steering`](crate::steering).

mod parameters;
mod plan;
#[cfg(test)]
mod tests;
mod wishes;

pub use parameters::RoamerParameters;

use bioscope_core::{Annotation, Intention, Parameters, Percepts, Random, Result, Vec3, state};
use serde::{Deserialize, Serialize};

use crate::Mind;
use plan::Plan;

/// The mind of a large fish that roams a home range; see the module for how it behaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Roamer {
    parameters: RoamerParameters,
    plan: Plan,
    /// Where it would like to wander: unit vector in the own frame.
    whim: Vec3,
}

impl Roamer {
    /// A roamer that begins by cruising.
    pub fn new(parameters: RoamerParameters) -> Self {
        Self { parameters, plan: Plan::default(), whim: Vec3::Z }
    }

    /// The roamer that [`save`](Mind::save) wrote.
    pub fn restore(bytes: &[u8]) -> Result<Self> {
        let roamer: Self = state::from_bytes("roamer", bytes)?;
        for parameter in roamer.parameters.descriptions() {
            parameter.check(roamer.parameters.get(&parameter.name).unwrap_or(f64::NAN))?;
        }
        Ok(roamer)
    }
}

impl Default for Roamer {
    fn default() -> Self {
        Self::new(RoamerParameters::default())
    }
}

impl Mind for Roamer {
    fn name(&self) -> &str {
        "roamer"
    }

    fn decide(
        &mut self,
        percepts: &Percepts,
        random: &mut Random,
        annotations: &mut Vec<Annotation>,
    ) -> Result<Intention> {
        let school = wishes::school(percepts);
        self.plan.advance(percepts, school.as_ref(), &self.parameters, random);
        self.wander(percepts.dt, random);
        Ok(self.intention(percepts, school.as_ref(), annotations))
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.parameters)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.parameters)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}
