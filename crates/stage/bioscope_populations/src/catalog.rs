//! Populations by kind and options, as bindings and files ask for them.

use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Error, Result, Vec3};
use bioscope_lsystem::Environment;
use bioscope_minds::Mind;
use bioscope_world::Population;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::animals::{Animal, Animals, AnimalsOptions, Kinds, Place};
use crate::drifters::{Bubbles, Plankton};
use crate::fish::{self, BodyKind, FishSchool, FishSchoolOptions, FishSpecies, MindRequest};
use crate::fishing::FishingLine;
use crate::plants::Plants;
use crate::scenery::{Corals, Ground, Props, Rocks};
use crate::stand::Stand;

/// The kinds that [`population`] makes.
pub const KINDS: [&str; 11] = [
    "bubbles",
    "corals",
    "fish_school",
    "fishing_line",
    "ground",
    "plankton",
    "plants",
    "props",
    "roaming_fish",
    "rocks",
    "stand",
];

/// Most fishes with minds of their own in one population.
pub const MOST_SINGLE_FISHES: usize = 20_000;

/// A population of this kind with these options (a JSON object with the field names of its options
/// struct) and parameters.
pub fn population(
    kind: &str,
    options: &str,
    parameters: &BTreeMap<String, f64>,
) -> Result<Box<dyn Population>> {
    let population: Box<dyn Population> = match kind {
        "bubbles" => Box::new(Bubbles::new(read(kind, options)?)?),
        "corals" => Box::new(Corals::new(read(kind, options)?)?),
        "fish_school" => Box::new(FishSchool::new(school(&read(kind, options)?)?)?),
        "fishing_line" => Box::new(FishingLine::new(read(kind, options)?)?),
        "ground" => Box::new(Ground::new(read(kind, options)?)?),
        "plankton" => Box::new(Plankton::new(read(kind, options)?)?),
        "plants" => Box::new(Plants::new(read(kind, options)?)?),
        "props" => Box::new(Props::new(read(kind, options)?)?),
        "roaming_fish" => Box::new(roaming(options, &|| None, Arc::default())?),
        "rocks" => Box::new(Rocks::new(read(kind, options)?)?),
        "stand" => Box::new(Stand::new(read(kind, options)?)?),
        _ => {
            let known = KINDS.map(str::to_owned).to_vec();
            return Err(Error::Unknown { kind: "population", name: kind.to_owned(), known });
        }
    };
    tuned(population, parameters)
}

/// A stand in an environment that is none of the engine's, which `options` (a JSON object) call foreign.
pub fn stand_in(
    environment: Box<dyn Environment>,
    options: &str,
    parameters: &BTreeMap<String, f64>,
) -> Result<Box<dyn Population>> {
    let stand = Stand::in_environment(read("stand", options)?, Some(environment))?;
    tuned(Box::new(stand), parameters)
}

fn tuned(
    mut population: Box<dyn Population>,
    parameters: &BTreeMap<String, f64>,
) -> Result<Box<dyn Population>> {
    for (name, value) in parameters {
        let kind = population.kind().to_owned();
        let Some(known) = population.parameters_mut() else {
            return Err(Error::value(name, value, format!("no parameters; {kind} has none")));
        };
        known.set(name, *value)?;
    }
    Ok(population)
}

fn read<T: DeserializeOwned>(kind: &str, options: &str) -> Result<T> {
    serde_json::from_str(options).map_err(|error| {
        let plain = plain(&error);
        let what = match field_at(options, error.column()) {
            Some(field) if !plain.starts_with("missing field") => {
                format!("option '{field}': {plain}")
            }
            _ => plain,
        };
        Error::format(kind, what)
    })
}

/// What is wrong with options, in words: their text is ours, so where in it tells a user nothing.
pub fn plain(error: &serde_json::Error) -> String {
    let whole = error.to_string();
    let what = whole.split(" at line ").next().unwrap_or(&whole);
    WORDS.iter().fold(what.to_owned(), |text, (type_name, word)| {
        text.replace(&format!("expected {type_name}"), &format!("expected {word}"))
    })
}

/// What types are called in messages.
const WORDS: [(&str, &str); 4] = [
    ("usize", "a whole number, 0 or more"),
    ("u32", "a whole number, 0 or more"),
    ("f32", "a number"),
    ("f64", "a number"),
];

/// The outermost field of an object in one line of JSON in which this column lies, by which an error is understood.
fn field_at(text: &str, column: usize) -> Option<&str> {
    let (mut depth, mut quoted, mut escaped, mut begin) = (0, false, false, 0);
    let (mut last, mut field) = (None, None);
    for (index, byte) in text.bytes().enumerate().take(column) {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = quoted,
            b'"' if quoted => (quoted, last) = (false, text.get(begin..index)),
            b'"' => (quoted, begin) = (true, index + 1),
            _ if quoted => {}
            b'{' | b'[' => depth += 1,
            b'}' | b']' => depth -= 1,
            b':' if depth == 1 => field = last,
            _ => {}
        }
    }
    field
}

/// How a school of fish is asked for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct School {
    species: Species,
    count: usize,
    center: Vec3,
    half: Option<Vec3>,
    home: Option<Vec3>,
}

/// A species by name, or by name and the text of its file.
#[derive(Deserialize)]
#[serde(untagged)]
enum Species {
    Name(String),
    File(String, String),
}

impl Species {
    fn get(&self) -> Result<Arc<FishSpecies>> {
        match self {
            Self::Name(name) => FishSpecies::named(name),
            Self::File(name, text) => Ok(Arc::new(FishSpecies::parse(text, name)?)),
        }
    }
}

fn school(asked: &School) -> Result<FishSchoolOptions> {
    let mut options = FishSchoolOptions::new(asked.species.get()?, asked.count, asked.center);
    options.half = asked.half.unwrap_or(options.half);
    options.home = asked.home;
    Ok(options)
}

/// How single fishes with minds of their own are asked for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Roaming {
    species: Species,
    count: usize,
    center: Vec3,
    radius: f32,
    home: Option<Vec3>,
    /// A mind of the engine's; a roamer's if none is asked for.
    mind: Option<MindRequest>,
    /// Share of females among them, where they have such a mind.
    females: Option<f32>,
    /// Species that they smell as food, where they have no such mind, which knows its own.
    #[serde(default)]
    food: Vec<Arc<str>>,
    /// By how much of its size each differs from the others; a tenth if not given.
    variation: Option<f32>,
    /// Seconds from one decision of theirs to the next.
    #[serde(default)]
    reaction: f32,
    /// How they are moved; by muscles if they have such a mind, by geometric flight if not.
    body: Option<BodyKind>,
}

impl Roaming {
    /// The mind asked for, for the fish of this number. Females are spread evenly, and are half of those who
    /// live as their species do.
    fn mind(&self, species: &FishSpecies, number: usize) -> Option<MindRequest> {
        let mut request = self.mind.clone()?;
        let share = self.females.or(request.nature.is_none().then_some(0.5));
        request = request.of(species);
        if let (Some(share), Some(nature)) = (share, &mut request.nature) {
            let females = |count: usize| (count as f64 * f64::from(share)).floor();
            nature.habits.female = females(number + 1) > females(number);
        }
        Some(request)
    }
}

/// Single fishes as `options` (a JSON object) and parameters ask for them, each with the mind that `mind` makes;
/// `kinds` must know those minds.
pub fn fish_with_minds(
    options: &str,
    parameters: &BTreeMap<String, f64>,
    mind: &dyn Fn() -> Option<Box<dyn Mind>>,
    kinds: Arc<Kinds>,
) -> Result<Box<dyn Population>> {
    tuned(Box::new(roaming(options, mind, kinds)?), parameters)
}

fn roaming(
    options: &str,
    mind: &dyn Fn() -> Option<Box<dyn Mind>>,
    kinds: Arc<Kinds>,
) -> Result<Animals> {
    let asked: Roaming = read("fish", options)?;
    if asked.count > MOST_SINGLE_FISHES {
        let expected = format!("up to {MOST_SINGLE_FISHES}");
        return Err(Error::value("count", asked.count, expected));
    }
    if let Some(share) = asked.females.filter(|share| !(0.0..=1.0).contains(share)) {
        return Err(Error::value("females", share, "a share from 0 to 1"));
    }
    let species = asked.species.get()?;
    let look = fish::look(&species);
    let animals = (0..asked.count).map(|number| {
        if let Some(request) = asked.mind(&species, number) {
            let body = asked.body.unwrap_or(BodyKind::MuscleSwimmer);
            return fish::minded(&species, &look, &request, body);
        }
        let mind = mind();
        let foreign = mind.is_some();
        let animal =
            fish::roaming(&species, &look, mind, &asked.food, asked.body.unwrap_or_default())?;
        Ok(Animal { may_fail: foreign, ..animal })
    });
    let place = Some(Place { center: asked.center, radius: asked.radius });
    let usual = AnimalsOptions::default();
    let variation = asked.variation.unwrap_or(usual.variation);
    let settings = AnimalsOptions { place, home: asked.home, variation, reaction: asked.reaction };
    Animals::new(animals.collect::<Result<Vec<_>>>()?, settings, kinds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_field_they_are_in() {
        let text = r#"{"species":{"a\\":1,"b\"":[2,3]},"count":-1,"center":[0,0,0]}"#;
        let at = |what: &str| field_at(text, text.find(what).unwrap() + what.len());
        assert_eq!(at("[2"), Some("species"));
        assert_eq!(at("-1"), Some("count"));
        assert_eq!(at("[0,0"), Some("center"));
        assert_eq!(field_at("{", 1), None);
        assert_eq!(field_at("\"é", 3), None);
    }
}
