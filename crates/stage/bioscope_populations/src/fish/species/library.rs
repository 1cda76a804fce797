//! The ready-made species.

use std::sync::{Arc, OnceLock};

use bioscope_core::{Error, Result};

use super::FishSpecies;

macro_rules! species {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../../species/", $name, ".toml")))),*]
    };
}

const FILES: [(&str, &str); 15] = species![
    "anchovy",
    "anthias",
    "barracuda",
    "blacktip_shark",
    "blue_tang",
    "butterflyfish",
    "cardinalfish",
    "chromis",
    "clownfish",
    "emperor_angelfish",
    "fusilier",
    "grey_reef_shark",
    "moorish_idol",
    "parrotfish",
    "yellow_tang",
];

static READ: [OnceLock<Arc<FishSpecies>>; FILES.len()] = [const { OnceLock::new() }; FILES.len()];

pub fn names() -> Vec<&'static str> {
    FILES.iter().map(|(name, _)| *name).collect()
}

pub fn named(name: &str) -> Result<Arc<FishSpecies>> {
    let number = number(name).ok_or_else(|| {
        let known = names().into_iter().map(String::from).collect();
        Error::Unknown { kind: "species of fish", name: name.to_owned(), known }
    })?;
    if let Some(species) = READ[number].get() {
        return Ok(Arc::clone(species));
    }
    let (name, text) = FILES[number];
    let species = Arc::new(FishSpecies::parse(text, &format!("{name}.toml"))?);
    Ok(Arc::clone(READ[number].get_or_init(|| species)))
}

/// Which species is called so, or the first of the family that is (`shark`).
fn number(name: &str) -> Option<usize> {
    let first = *meant(name).first()?;
    FILES.iter().position(|(known, _)| *known == first)
}

/// The species that is called so, however its words are joined (`Emperor angelfish`, `butterfly fish`); or all of
/// the family that is (`shark`).
pub fn meant(name: &str) -> Vec<&'static str> {
    let joined = |name: &str| -> String {
        let letters = name.chars().filter(|letter| !matches!(letter, '_' | '-' | ' '));
        letters.flat_map(char::to_lowercase).collect()
    };
    let asked = joined(name);
    let is_one = |known: &str| known.rsplit_once('_').is_some_and(|(_, family)| family == asked);
    match names().into_iter().find(|known| joined(known) == asked) {
        Some(species) => vec![species],
        None => names().into_iter().filter(|known| is_one(known)).collect(),
    }
}
