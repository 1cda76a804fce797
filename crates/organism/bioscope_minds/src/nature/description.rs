use std::sync::Arc;

use bioscope_core::{Sex, Sighting};
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
