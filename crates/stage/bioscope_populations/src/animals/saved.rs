use std::sync::Arc;

use bioscope_core::{Error, Id, Result, state};
use serde::{Deserialize, Serialize};

use super::individual::{Individual, Record};
use super::{Animal, Animals, AnimalsOptions, Kinds};
use crate::bites::Gone;

const PART: &str = "animals";
/// How many of the first individuals are looked at for what newcomers may be like.
const MOST_PATTERNS: usize = 16;

#[derive(Serialize, Deserialize)]
struct State {
    options: AnimalsOptions,
    individuals: Vec<SavedIndividual>,
    patterns: Vec<SavedIndividual>,
    caught: Vec<Gone>,
}

#[derive(Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedIndividual {
    id: Id,
    look: SavedPart,
    senses: Vec<SavedPart>,
    mind: SavedPart,
    body: SavedPart,
    may_fail: bool,
    record: Record,
}

#[derive(Clone, PartialEq, Serialize, Deserialize)]
struct SavedPart {
    kind: String,
    bytes: Vec<u8>,
}

impl Animals {
    /// The animals that `save` stored; their parts are built with `kinds`.
    pub fn from_saved(bytes: &[u8], kinds: Arc<Kinds>) -> Result<Self> {
        let state: State = state::from_bytes(PART, bytes)?;
        let State { options, patterns, caught, .. } = state;
        let (individuals, felt) = (Vec::new(), Vec::new());
        let mut animals = Self { options, individuals, patterns, kinds, caught, felt };
        for saved in state.individuals {
            let individual = animals.rebuild(saved)?;
            animals.individuals.push(individual);
        }
        Ok(animals)
    }

    /// One individual, sharing its look with those that look alike.
    pub(super) fn rebuild(&self, saved: SavedIndividual) -> Result<Individual> {
        let known = self.individuals.iter().map(|one| &one.parts.look);
        let mut known = known
            .filter(|look| look.kind == saved.look.kind && look.description == saved.look.bytes);
        let look = match known.next() {
            Some(look) => look.clone(),
            None => self.kinds.look(&saved.look.kind, &saved.look.bytes)?,
        };
        let senses = saved.senses.iter().map(|one| self.kinds.sense(&one.kind, &one.bytes));
        let senses = senses.collect::<Result<_>>()?;
        let mind = self.kinds.mind(&saved.mind.kind, &saved.mind.bytes)?;
        let body = self.kinds.body(&saved.body.kind, &saved.body.bytes, &look)?;
        let parts = Animal { senses, mind, body, look, may_fail: saved.may_fail };
        super::population::check(&parts).map_err(|error| Error::format(PART, error.to_string()))?;
        Ok(Individual { id: saved.id, parts, record: saved.record })
    }

    /// Builds the parts again from a saved state, keeping looks that are already known.
    pub(super) fn restore_from(&mut self, bytes: &[u8]) -> Result<()> {
        let state: State = state::from_bytes(PART, bytes)?;
        let restored = state
            .individuals
            .into_iter()
            .map(|saved| self.rebuild(saved))
            .collect::<Result<_>>()?;
        (self.options, self.individuals, self.caught) = (state.options, restored, state.caught);
        self.patterns = state.patterns;
        Ok(())
    }

    pub(super) fn to_saved(&self) -> Result<Vec<u8>> {
        let individuals = self.individuals.iter().map(save_one).collect::<Result<_>>()?;
        let (options, caught) = (self.options.clone(), self.caught.clone());
        let patterns = self.patterns.clone();
        Ok(state::to_bytes(&State { options, individuals, patterns, caught }))
    }

    /// The distinct kinds of individuals there are, as newcomers are made.
    pub(super) fn distinct(&self) -> Result<Vec<SavedIndividual>> {
        let mut patterns: Vec<SavedIndividual> = Vec::new();
        for one in self.individuals.iter().take(MOST_PATTERNS) {
            let saved = save_one(one)?;
            if !patterns.contains(&saved) {
                patterns.push(saved);
            }
        }
        Ok(patterns)
    }
}

fn save_one(individual: &Individual) -> Result<SavedIndividual> {
    let Animal { senses, mind, body, look, may_fail } = &individual.parts;
    let part = |kind: &str, bytes: Vec<u8>| SavedPart { kind: kind.to_owned(), bytes };
    let senses = senses.iter().map(|one| Ok(part(one.kind(), one.save()?)));
    Ok(SavedIndividual {
        id: individual.id,
        look: part(&look.kind, look.description.clone()),
        senses: senses.collect::<Result<_>>()?,
        mind: part(mind.name(), mind.save()?),
        body: part(body.kind(), body.save()?),
        may_fail: *may_fail,
        record: individual.record.clone(),
    })
}
