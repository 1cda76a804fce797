use std::f32::consts::PI;

use bioscope_core::{Id, math};

use super::{Chase, Command, chase};
use crate::attention::{Candidate, Morsel, Preferences, Situation, choose};
use crate::nature::{Role, Temper};

/// Deviation swum through without a turn: at 5 body lengths and farther, at 1 and nearer (choice).
const TOLERANCE: (f32, f32) = (PI / 5.0, PI / 18.0);
/// How much farther than the distance of sucking the mouth begins to open.
const ANTICIPATION: f32 = 2.0;

/// The food to go for: `1 − d/O_r` for morsels, `1/(1 + C/V_r)` for a predator's prey (Tu 1996, 5.4 and
/// 6.5.1; the latter form is a choice), `current` being what it goes for now.
pub fn choose_food<'a>(
    situation: &Situation<'a>,
    preferences: &Preferences,
    current: Id,
    (role, temper): (Role, &Temper),
) -> Option<Morsel<'a>> {
    let length = situation.length;
    let mut candidates: Vec<Candidate> = situation
        .food
        .iter()
        .map(|morsel| {
            let cost = morsel.cost / length;
            let desirability = match role {
                Role::Predator => 1.0 / (1.0 + cost / temper.sight_range),
                _ => (1.0 - cost / temper.smell_range).max(0.0),
            };
            let Morsel { sighting, .. } = morsel;
            Candidate { id: sighting.id, position: sighting.position, desirability, cost }
        })
        .collect();
    let weights = (temper.preference_weight, temper.persistence);
    let chosen = choose(&mut candidates, preferences, current, weights)?;
    situation.food.iter().copied().find(|one| one.sighting.id == chosen.id)
}

/// The routine eating-food: chases until the mouth is near, then sucks it in (Tu 1996, 6.4.3).
pub fn eat(morsel: &Morsel, situation: &Situation, temper: &Temper) -> Command {
    let length = situation.length;
    let distance = morsel.distance / length;
    let share = ((distance - 1.0) / 4.0).clamp(0.0, 1.0);
    let target = morsel.sighting.position - situation.mouth();
    let goal = Chase {
        target,
        velocity: situation.through_water(morsel.sighting.velocity),
        tolerance: math::mix(TOLERANCE.1, TOLERANCE.0, share),
        lead: temper.lead,
        stop: 0.0,
    };
    let mut command = chase(&goal, length, situation.own_speed(), temper);
    let near = distance / temper.suck_distance;
    command.mouth = (ANTICIPATION - near).clamp(0.0, 1.0);
    if near < 1.0 {
        command.speed = command.speed.min(temper.cruise_speed);
    }
    command
}
