use std::collections::BTreeMap;

use bioscope_core::{Annotation, Intention, Parameters, Percepts, Random, Result, Value, state};
use serde::{Deserialize, Serialize};

use super::{Circumstances, Generator};
use crate::Mind;
use crate::attention::{Behavior, Focus};
use crate::character::Character;
use crate::nature::{Nature, Temper};
use crate::routines::Stage;

/// The mind of an artificial fish; see the [module](super).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Intentions {
    character: Character,
    generator: Generator,
}

impl Intentions {
    /// A mind of this nature and temper.
    pub fn new(nature: Nature, temper: Temper) -> Self {
        Self { character: Character::new(nature, temper), generator: Generator::default() }
    }

    /// The mind that [`save`](Mind::save) wrote.
    pub fn restore(bytes: &[u8]) -> Result<Self> {
        let mind: Self = state::from_bytes("intentions", bytes)?;
        mind.character.check()?;
        Ok(mind)
    }

    /// The current intention.
    pub fn behavior(&self) -> Behavior {
        self.generator.behavior
    }
}

impl Mind for Intentions {
    fn name(&self) -> &str {
        "intentions"
    }

    fn decide(
        &mut self,
        percepts: &Percepts,
        random: &mut Random,
        annotations: &mut Vec<Annotation>,
    ) -> Result<Intention> {
        let character = &mut self.character;
        let situation = character.perceive(percepts, random);
        let threat = character.threat(&situation);
        let state = (&character.nature, &character.temper, &character.drives);
        let courting = character.courtship.stage >= Stage::Loop;
        let circumstances = Circumstances { threatened: threat.is_some(), courting };
        let behavior = self.generator.intend(&situation, circumstances, state, random);
        let target = self.generator.target;
        let focus = Focus { behavior, target, threat: threat.as_ref() };
        let preferences = character.preferences(&situation, &focus);
        let deed = character.perform(&situation, &focus, &preferences, random);
        self.generator.target = deed.target;
        Ok(character.intention(&deed, &situation, annotations))
    }

    fn values(&self) -> BTreeMap<String, Value> {
        let mut values = self.character.values();
        values.insert("resumed".into(), self.generator.resumed.into());
        values
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.character)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.character)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}
