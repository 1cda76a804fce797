use serde::{Deserialize, Serialize};

use crate::{Id, NOTHING};

/// What an animal shows of its state to whoever sees it: by posture, color and manner of moving.
///
/// Published beside the animal's placement and seen by eyes, so that minds may court, follow and
/// school without reading each other's thoughts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Display {
    /// Its sex, where it shows.
    pub sex: Sex,
    /// What it is visibly doing.
    pub act: Act,
    /// To whom; [`NOTHING`] for nobody in particular.
    pub partner: Id,
}

impl Display {
    /// Shows nothing.
    pub const NONE: Self = Self { sex: Sex::Unknown, act: Act::Other, partner: NOTHING };
}

impl Default for Display {
    fn default() -> Self {
        Self::NONE
    }
}

/// Sex as far as it shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sex {
    /// It does not show.
    #[default]
    Unknown,
    /// A female.
    Female,
    /// A male.
    Male,
}

/// What an animal is visibly doing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Act {
    /// Nothing in particular.
    #[default]
    Other,
    /// Swims with a school.
    Schooling,
    /// Hunts or feeds.
    Feeding,
    /// Flees.
    Fleeing,
    /// Wants to mate (and, if it has chosen a partner, displays before it).
    Courting,
    /// The pair circles, each after the other's tail.
    Circling,
    /// Ascends to spawn.
    Ascending,
    /// Hovers, or nuzzles its hovering partner.
    Nuzzling,
    /// Has just spawned.
    Spawned,
}

impl Act {
    /// All acts, in order.
    pub const ALL: [Self; 9] = [
        Self::Other,
        Self::Schooling,
        Self::Feeding,
        Self::Fleeing,
        Self::Courting,
        Self::Circling,
        Self::Ascending,
        Self::Nuzzling,
        Self::Spawned,
    ];

    /// Its name: one word, lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Other => "other",
            Self::Schooling => "schooling",
            Self::Feeding => "feeding",
            Self::Fleeing => "fleeing",
            Self::Courting => "courting",
            Self::Circling => "circling",
            Self::Ascending => "ascending",
            Self::Nuzzling => "nuzzling",
            Self::Spawned => "spawned",
        }
    }

    /// Whether it belongs to mating.
    pub fn mating(self) -> bool {
        self >= Self::Courting
    }
}
