use std::collections::BTreeMap;

use bioscope_core::{
    Annotation, Id, Intention, NOTHING, Parameters, Percepts, Random, Result, Value, state,
};
use serde::{Deserialize, Serialize};

use super::network::{Facts, Network, STEPS, Wants};
use crate::Mind;
use crate::attention::{Behavior, Focus, Preferences, Situation};
use crate::character::Character;
use crate::nature::{Nature, Role, Temper};

/// Want of the routine nobody else claims.
const CURIOSITY: f32 = 0.15;
/// Want of company, by habit.
const COMPANY: f32 = 0.25;

/// A mind that chooses by a behavior network; see the [module](super).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BehaviorNetwork {
    character: Character,
    network: Network,
    behavior: Behavior,
    target: Id,
}

impl BehaviorNetwork {
    /// A mind of this nature and temper.
    pub fn new(nature: Nature, temper: Temper) -> Self {
        Self { character: Character::new(nature, temper), ..Self::default() }
    }

    /// The mind that [`save`](Mind::save) wrote.
    pub fn restore(bytes: &[u8]) -> Result<Self> {
        let mind: Self = state::from_bytes("behavior_network", bytes)?;
        mind.character.check()?;
        Ok(mind)
    }
}

/// What is the case, each as a yes or no.
fn facts(situation: &Situation, threatened: bool, afraid: bool, discomfort: f32) -> Facts {
    [
        threatened,
        afraid,
        situation.company(),
        !situation.food.is_empty(),
        !situation.mates.is_empty(),
        discomfort > 0.0,
    ]
}

/// How much the goal of each node is wanted.
fn wants(character: &Character, facts: &Facts, discomfort: f32) -> Wants {
    let Nature { role, habits, .. } = &character.nature;
    let drives = &character.drives;
    let given = |allowed: bool, want: f32| if allowed { want } else { 0.0 };
    let company = given(habits.school, COMPANY + 0.3 * drives.fear);
    let hunger = given(drives.hunger > character.temper.drive_threshold, drives.hunger);
    let libido = given(drives.libido > character.temper.drive_threshold, drives.libido);
    let fear = given(drives.fear > character.temper.fear_threshold, drives.fear);
    [
        f32::from(u8::from(facts[0])),
        given(role.flees(), fear),
        given(role.flees(), company),
        hunger,
        0.0,
        given(role.courts(), libido),
        0.0,
        given(*role != Role::Predator, discomfort.min(0.5)),
        CURIOSITY,
    ]
}

impl Mind for BehaviorNetwork {
    fn name(&self) -> &str {
        "behavior_network"
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
        let discomfort = situation.discomfort(&character.nature, &character.temper);
        let afraid = character.drives.fear > character.temper.fear_threshold;
        let facts = facts(&situation, threat.is_some(), afraid, discomfort);
        let wants = wants(character, &facts, discomfort);
        let before = self.behavior;
        for _ in 0..STEPS {
            self.behavior = self.network.step(&facts, &wants);
        }
        if self.behavior != before {
            self.target = NOTHING;
        }
        let focus = Focus { behavior: self.behavior, target: self.target, threat: threat.as_ref() };
        let deed = character.perform(&situation, &focus, &Preferences::default(), random);
        self.target = deed.target;
        Ok(character.intention(&deed, &situation, annotations))
    }

    fn values(&self) -> BTreeMap<String, Value> {
        self.character.values()
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
