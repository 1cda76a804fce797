use bioscope_acoustics::{Ear, Medium, has_passed, hear};
use bioscope_core::{Parameters, Percepts, Result, SoundEvent, parameters, state};
use serde::{Deserialize, Serialize};

use crate::{Sense, Surroundings};

/// Most sounds that can be under way to one ear; the oldest are forgotten first.
const UNDER_WAY: usize = 1024;

parameters! {
    /// How well an animal hears.
    pub struct HearingParameters {
        /// Least amplitude that is heard, 1 being full scale.
        threshold: f32 = 0.003, "1", 0.0..=1.0, "choice";
        /// Distance from which sounds are heard at all.
        range: f32 = 60.0, "m", 0.0..=2000.0, "choice";
    }
}

/// Hearing: every noise arrives at the speed of sound, from where its source was.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Hearing {
    parameters: HearingParameters,
    /// Sounds that have begun and may still arrive.
    under_way: Vec<SoundEvent>,
}

impl Hearing {
    /// Hearing this good.
    pub fn new(parameters: HearingParameters) -> Self {
        Self { parameters, under_way: Vec::new() }
    }
}

impl Sense for Hearing {
    fn kind(&self) -> &str {
        "hearing"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        let submerged = surroundings.medium.surface.is_some() && surroundings.depth() > 0.0;
        let medium = if submerged { Medium::WATER } else { Medium::AIR };
        let (range, now) = (self.parameters.range, surroundings.time);
        self.under_way.retain(|event| !has_passed(event, &medium, range, now));
        let near = |event: &&SoundEvent| event.position.distance(surroundings.position) <= range;
        self.under_way.extend(surroundings.sounds.iter().filter(near).cloned());
        let excess = self.under_way.len().saturating_sub(UNDER_WAY);
        self.under_way.drain(..excess);
        let ear = Ear {
            owner: surroundings.id,
            position: surroundings.position,
            velocity: surroundings.velocity,
            rotation: surroundings.attitude,
            threshold: self.parameters.threshold,
        };
        percepts.heard = hear(&ear, &medium, &self.under_way, now, surroundings.dt);
        Ok(())
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
