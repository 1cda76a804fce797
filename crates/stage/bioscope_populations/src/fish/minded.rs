//! Fishes that decide for themselves: the senses of an artificial fish with one of its minds.

use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Error, Parameters, Result};
use bioscope_minds::{BehaviorNetwork, FreeFlow, Intentions, Mind, Nature, Temper};
use bioscope_senses::{
    Eye, Hearing, LateralLine, Light, Sense, Sight, SightParameters, Smell, SmellParameters, Touch,
};
use serde::Deserialize;

use super::FishSpecies;

/// The kinds of minds that a fish can be asked for with.
pub const MINDS: [&str; 3] = ["behavior_network", "free_flow", "intentions"];

/// A mind as files and bindings ask for it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MindRequest {
    /// One of [`MINDS`].
    pub kind: String,
    /// What the fish is; as its species are if not given.
    pub nature: Option<Nature>,
    /// How it feels and acts, where that differs from the default.
    #[serde(default)]
    pub temper: BTreeMap<String, f64>,
    /// Whether the fish looks with a retina, so that its mind may see pictures and knows brightness from them.
    #[serde(default)]
    pub eye: bool,
}

impl MindRequest {
    /// The mind.
    pub fn build(&self) -> Result<Box<dyn Mind>> {
        let mut temper = Temper::default();
        for (name, value) in &self.temper {
            temper.set(name, *value)?;
        }
        let nature = self.nature.clone().unwrap_or_default();
        match self.kind.as_str() {
            "intentions" => Ok(Box::new(Intentions::new(nature, temper))),
            "behavior_network" => Ok(Box::new(BehaviorNetwork::new(nature, temper))),
            "free_flow" => Ok(Box::new(FreeFlow::new(nature, temper))),
            _ => Err(unknown(&self.kind)),
        }
    }

    /// The senses that go with it: cyclopean sight within 15 times the size of what is seen, smell of its food,
    /// touch, hearing, lateral line, light.
    pub fn senses(&self) -> Vec<Box<dyn Sense>> {
        let food = self.nature.as_ref().map(|nature| nature.food.clone()).unwrap_or_default();
        let mut senses: Vec<Box<dyn Sense>> = vec![
            Box::new(Sight::new(SightParameters::fish())),
            Box::new(Smell::new(food, SmellParameters::default())),
            Box::new(Touch::default()),
            Box::new(Hearing::default()),
            Box::new(LateralLine),
            Box::new(Light),
        ];
        if self.eye {
            senses.push(Box::new(Eye::default()));
        }
        senses
    }

    /// The same for a fish of this species, as far as it does not say otherwise. Names of families stand for their
    /// species.
    pub fn of(mut self, species: &FishSpecies) -> Self {
        let nature = self.nature.get_or_insert_with(|| species.nature.clone());
        if nature.species.is_empty() {
            nature.species = Arc::from(species.name.as_str());
        }
        for names in [&mut nature.enemies, &mut nature.food, &mut nature.leaders] {
            let meant: Vec<_> = names.iter().flat_map(|name| FishSpecies::meant(name)).collect();
            for name in meant {
                if !names.iter().any(|known| **known == *name) {
                    names.push(Arc::from(name));
                }
            }
        }
        self
    }
}

/// The mind of this kind that was saved.
pub fn mind(kind: &str, bytes: &[u8]) -> Result<Box<dyn Mind>> {
    match kind {
        "intentions" => Ok(Box::new(Intentions::restore(bytes)?)),
        "behavior_network" => Ok(Box::new(BehaviorNetwork::restore(bytes)?)),
        "free_flow" => Ok(Box::new(FreeFlow::restore(bytes)?)),
        _ => Err(unknown(kind)),
    }
}

fn unknown(kind: &str) -> Error {
    let known = MINDS.map(str::to_owned).to_vec();
    Error::Unknown { kind: "mind", name: kind.to_owned(), known }
}
