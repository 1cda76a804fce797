use std::sync::Arc;

use bioscope_core::{Error, Parameter, Result, Sex, Sighting};
use serde::{Deserialize, Serialize};

/// How a fish lives (Tu 1996, section 6.5): which intentions its kind does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Hunts; fears nobody, does not school, court or leave.
    Predator,
    /// Schools and flees; does not court.
    Prey,
    /// Feeds and courts; does not flee from predators.
    #[default]
    Pacifist,
    /// Has every intention: the generic fish of which the others are specializations.
    Generic,
}

impl Role {
    /// Whether it flees, and schools for safety or company.
    pub fn flees(self) -> bool {
        matches!(self, Self::Prey | Self::Generic)
    }

    /// Whether it courts.
    pub fn courts(self) -> bool {
        matches!(self, Self::Pacifist | Self::Generic)
    }
}

/// Innate likes (Tu 1996, section 6.1). Both or neither of a pair means indifference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Habits {
    /// Likes brightness.
    pub bright: bool,
    /// Likes darkness.
    pub dark: bool,
    /// Likes cold water.
    pub cold: bool,
    /// Likes warm water.
    pub warm: bool,
    /// Likes company of its kind.
    pub school: bool,
    /// Female rather than male.
    pub female: bool,
}

/// Names and meanings of the habits as switches.
const SWITCHES: [(&str, &str); 6] = [
    ("likes_bright", "Whether it likes brightness; with darkness too: indifferent."),
    ("likes_dark", "Whether it likes darkness; with brightness too: indifferent."),
    ("likes_cold", "Whether it likes cold water; with warm water too: indifferent."),
    ("likes_warm", "Whether it likes warm water; with cold water too: indifferent."),
    ("likes_company", "Whether it likes the company of its kind."),
    ("female", "Whether it is female."),
];

impl Habits {
    /// The habits as parameters: 0 without, 1 with.
    pub fn descriptions() -> impl Iterator<Item = Parameter> {
        SWITCHES.into_iter().map(|(name, meaning)| Parameter {
            name: name.to_owned(),
            unit: String::from("1"),
            minimum: 0.0,
            maximum: 1.0,
            default: 0.0,
            meaning: meaning.to_owned(),
            source: String::from("Tu 1996, 6.1"),
        })
    }

    /// 1 with the habit of this name, 0 without.
    pub fn get(&self, name: &str) -> Option<f64> {
        let mut habits = *self;
        habits.switch(name).map(|habit| f64::from(u8::from(*habit)))
    }

    /// Gives it the habit of this name from 0.5 on, takes it away below.
    pub fn set(&mut self, name: &str, value: f64) -> Result<()> {
        let Some(habit) = self.switch(name) else {
            let known = SWITCHES.map(|(name, _)| name.to_owned()).to_vec();
            return Err(Error::Unknown { kind: "habit", name: name.to_owned(), known });
        };
        if !(0.0..=1.0).contains(&value) {
            return Err(Error::value(name, value, "0 to 1"));
        }
        *habit = value >= 0.5;
        Ok(())
    }

    fn switch(&mut self, name: &str) -> Option<&mut bool> {
        let number = SWITCHES.iter().position(|(known, _)| *known == name)?;
        let Self { bright, dark, cold, warm, school, female } = self;
        [bright, dark, cold, warm, school, female].into_iter().nth(number)
    }
}

/// What another animal is to a fish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// It eats such as me.
    Enemy,
    /// I eat it.
    Food,
    /// One of my kind.
    Kin,
    /// None of my business.
    Other,
}

/// Role, habits and acquaintances of a fish.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Nature {
    /// How it lives.
    pub role: Role,
    /// What it likes.
    pub habits: Habits,
    /// Its own species.
    pub species: Arc<str>,
    /// Species that it flees from.
    pub enemies: Vec<Arc<str>>,
    /// Species that it eats.
    pub food: Vec<Arc<str>>,
    /// Species behind which it schools, beside its own.
    pub leaders: Vec<Arc<str>>,
}

impl Nature {
    /// What an animal of this species is to it.
    pub fn relation(&self, species: &Arc<str>) -> Relation {
        let among =
            |list: &[Arc<str>]| list.iter().any(|one| Arc::ptr_eq(one, species) || one == species);
        if among(&self.enemies) {
            Relation::Enemy
        } else if among(&self.food) {
            Relation::Food
        } else if self.species == *species {
            Relation::Kin
        } else {
            Relation::Other
        }
    }

    /// Whether it schools behind such an animal.
    pub fn follows(&self, species: &Arc<str>) -> bool {
        self.leaders.iter().any(|one| one == species)
    }

    /// Its sex.
    pub fn sex(&self) -> Sex {
        if self.habits.female { Sex::Female } else { Sex::Male }
    }

    /// Whether it might mate with this animal: one of the other sex that is neither enemy nor food.
    pub fn might_mate(&self, other: &Sighting) -> bool {
        let sexes = (self.sex(), other.display.sex);
        matches!(sexes, (Sex::Female, Sex::Male) | (Sex::Male, Sex::Female))
            && matches!(self.relation(&other.species), Relation::Kin | Relation::Other)
    }
}
