use std::collections::BTreeMap;

use bioscope_core::{Error, Parameter, Parameters, Result};

use super::individual::Individual;
use super::{Animal, Animals};

/// The parameters of all parts, as `kind_name` (`roamer_cruise_speed`): read from the first animal that has
/// such a part, set for all that have one.
impl Parameters for Animals {
    fn descriptions(&self) -> Vec<Parameter> {
        let mut all: Vec<Parameter> = Vec::new();
        for individual in &self.individuals {
            for (kind, parameters) in parts(&individual.parts) {
                let own = parameters.descriptions().into_iter();
                for parameter in own.map(|one| Parameter { name: full(kind, &one.name), ..one }) {
                    if !all.iter().any(|known| known.name == parameter.name) {
                        all.push(parameter);
                    }
                }
            }
        }
        all
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.individuals.iter().find_map(|individual| {
            let parts = parts(&individual.parts);
            parts.iter().find_map(|(kind, parameters)| parameters.get(short(kind, name)?))
        })
    }

    fn set(&mut self, name: &str, value: f64) -> Result<()> {
        // Checked first, so that a refused value changes nobody.
        self.described(name)?.check(value)?;
        self.individuals.iter_mut().try_for_each(|individual| set_one(individual, name, value))
    }
}

impl Animals {
    /// The description of one parameter.
    pub(super) fn described(&self, name: &str) -> Result<Parameter> {
        let mut known = self.descriptions();
        match known.iter().position(|one| one.name == name) {
            Some(index) => Ok(known.swap_remove(index)),
            None => {
                let known = known.into_iter().map(|one| one.name).collect();
                Err(Error::Unknown { kind: "parameter", name: name.to_owned(), known })
            }
        }
    }
}

/// The parts that have parameters, with their kinds.
fn parts(animal: &Animal) -> Vec<(&str, &dyn Parameters)> {
    let senses = animal.senses.iter().map(|one| (one.kind(), one.parameters()));
    let mind = (animal.mind.name(), animal.mind.parameters());
    let body = (animal.body.kind(), animal.body.parameters());
    let all = senses.chain([mind, body]);
    all.filter_map(|(kind, parameters)| Some((kind, parameters?))).collect()
}

pub(super) fn set_one(individual: &mut Individual, name: &str, value: f64) -> Result<()> {
    let Animal { senses, mind, body, .. } = &mut individual.parts;
    let minds_word = mind.name().to_owned();
    let bodys_word = body.kind().to_owned();
    let senses = senses.iter_mut().map(|one| (one.kind().to_owned(), one.parameters_mut()));
    let others = [(minds_word, mind.parameters_mut()), (bodys_word, body.parameters_mut())];
    for (kind, parameters) in senses.chain(others) {
        let Some(parameters) = parameters else { continue };
        if let Some(short) = short(&kind, name)
            && parameters.get(short).is_some()
        {
            parameters.set(short, value)?;
        }
    }
    Ok(())
}

/// The values that this animal's own parts have, by name.
pub(super) fn traits(animal: &Animal) -> BTreeMap<String, f64> {
    let all = parts(animal).into_iter().flat_map(|(kind, parameters)| {
        let names = parameters.descriptions().into_iter().map(|one| one.name);
        names.filter_map(move |name| Some((full(kind, &name), parameters.get(&name)?)))
    });
    all.collect()
}

/// Whether an individual is born with a value of this parameter that its kin need not share.
pub(super) fn is_innate(name: &str) -> bool {
    name.ends_with("_female")
}

fn full(kind: &str, name: &str) -> String {
    format!("{kind}_{name}")
}

/// The name within a kind's parameters, if it is of this kind.
fn short<'a>(kind: &str, name: &'a str) -> Option<&'a str> {
    name.strip_prefix(kind)?.strip_prefix('_')
}
