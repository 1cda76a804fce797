use bioscope_core::{Id, NOTHING};
use serde::{Deserialize, Serialize};

use super::{Preferences, Situation, Threat};
use crate::drives::Drives;
use crate::nature::Relation;

/// What a fish can intend; one at a time (Tu 1996, section 6.3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Behavior {
    /// To avoid a collision.
    Avoid,
    /// To escape from a predator.
    Escape,
    /// To keep with its school.
    School,
    /// To feed.
    Eat,
    /// To court and spawn.
    Mate,
    /// To leave an uncomfortable place.
    Leave,
    /// To go on.
    #[default]
    Wander,
}

impl Behavior {
    /// All of them, in order of rank.
    pub const ALL: [Self; 7] =
        [Self::Avoid, Self::Escape, Self::School, Self::Eat, Self::Mate, Self::Leave, Self::Wander];

    /// Its name: one word, lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avoid => "avoid",
            Self::Escape => "escape",
            Self::School => "school",
            Self::Eat => "eat",
            Self::Mate => "mate",
            Self::Leave => "leave",
            Self::Wander => "wander",
        }
    }
}

/// Strengths of the desires relative to that of the current intention, each 0 to 1 (Tu 1996, 5.4).
///
/// Repaired: ratios above 1 are cut off, as preferences are defined up to 1 only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strengths {
    /// Of the desire to avoid, `τ^a`.
    pub avoid: f32,
    /// Of the desire to escape, `τ^f`.
    pub escape: f32,
    /// Of the desire to eat, `τ^e`.
    pub eat: f32,
    /// Of the desire to mate, `τ^m`.
    pub mate: f32,
}

impl Strengths {
    /// The strengths beside this intention.
    pub fn beside(behavior: Behavior, drives: &Drives) -> Self {
        let own = match behavior {
            Behavior::Escape => drives.fear,
            Behavior::Eat => drives.hunger,
            Behavior::Mate => drives.libido,
            _ => 1.0,
        };
        let relative = |drive: f32| (drive / own.max(1e-6)).clamp(0.0, 1.0);
        Self {
            avoid: 1.0,
            escape: relative(drives.fear),
            eat: relative(drives.hunger),
            mate: relative(drives.libido),
        }
    }
}

/// Food and solids that are taken into account, the nearest first.
const CONSIDERED: usize = 6;
/// Distance in body lengths within which solids and others count as obstacles.
const OBSTRUCTING: f32 = 1.5;

/// On what attention rests.
#[derive(Clone, Copy, Debug)]
pub struct Focus<'a, 'b> {
    /// The current intention.
    pub behavior: Behavior,
    /// Its target; [`NOTHING`] if it has none.
    pub target: Id,
    /// What threatens to collide.
    pub threat: Option<&'b Threat<'a>>,
}

/// Preferences for motor skills from all that is relevant beside the focus of attention: towards food and
/// mates, away from predators and obstacles. What the intention itself is after (all food while eating,
/// all mates while mating) is no reason beside it.
pub fn preferences(situation: &Situation, strengths: &Strengths, focus: &Focus) -> Preferences {
    let mut preferences = Preferences::default();
    let mut add = |place, strength: f32| {
        if strength != 0.0 {
            preferences.add_at(place, strength);
        }
    };
    let beside = |id: Id| id != focus.target || focus.target == NOTHING;
    if focus.behavior != Behavior::Eat {
        for morsel in situation.food.iter().filter(|one| beside(one.sighting.id)).take(CONSIDERED) {
            add(morsel.sighting.position, strengths.eat);
        }
    }
    if focus.behavior != Behavior::Mate {
        for mate in situation.mates.iter().filter(|one| beside(one.id)) {
            add(mate.position, strengths.mate);
        }
    }
    for (enemy, _) in situation.enemies.iter().filter(|(one, _)| beside(one.id)) {
        add(enemy.position, -strengths.escape);
    }
    let near = OBSTRUCTING * situation.length;
    // The solid that is being avoided is the one ahead; all others count.
    let solid = matches!(focus.threat, Some(Threat::Solid(_)));
    for &point in situation.percepts.solids.iter().take(CONSIDERED) {
        let ahead = super::azimuth(point).abs() < std::f32::consts::FRAC_PI_6;
        if point.length_squared() < near * near && !(solid && ahead) {
            add(point, -strengths.avoid);
        }
    }
    for (relation, other) in situation.others() {
        let in_the_way = other.position.length_squared() < near * near;
        let counts = in_the_way && matches!(relation, Relation::Kin | Relation::Other);
        if counts && beside(other.id) && other.size > 0.2 * situation.length {
            add(other.position, -strengths.avoid);
        }
    }
    preferences
}
