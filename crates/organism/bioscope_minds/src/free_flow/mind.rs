use std::collections::BTreeMap;

use bioscope_core::{
    Annotation, Id, Intention, NOTHING, Parameters, Percepts, Random, Result, Value, Vec3, state,
};
use serde::{Deserialize, Serialize};

use super::hierarchy::Ballot;
use crate::Mind;
use crate::attention::{Behavior, Focus, Preferences, Situation, Threat};
use crate::character::{Character, Deed};
use crate::nature::{Nature, Role, Temper};
use crate::routines::Command;

/// Say of going straight on, that keeps choices from flickering.
const INERTIA: f32 = 0.12;
/// Say of the whim of wandering.
const WHIM: f32 = 0.2;
/// Say of the wish for company, by habit.
const COMPANY: f32 = 0.35;

/// A mind in which all subsystems have their say down to the motor level; see the [module](super).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FreeFlow {
    character: Character,
}

impl FreeFlow {
    /// A mind of this nature and temper.
    pub fn new(nature: Nature, temper: Temper) -> Self {
        Self { character: Character::new(nature, temper) }
    }

    /// The mind that [`save`](Mind::save) wrote.
    pub fn restore(bytes: &[u8]) -> Result<Self> {
        let mind: Self = state::from_bytes("free_flow", bytes)?;
        mind.character.check()?;
        Ok(mind)
    }
}

/// Danger: what is near and in the way, and predators.
fn safety(
    ballot: &mut Ballot,
    character: &Character,
    situation: &Situation,
    threat: Option<&Threat>,
) {
    let length = situation.length;
    let near = 2.0 * length;
    for &point in &situation.percepts.solids {
        let closeness = (1.0 - point.length() / near).max(0.0);
        ballot.say(Behavior::Avoid, point, -1.2 * closeness, 3);
    }
    if let Some(impact) = situation.percepts.ahead {
        let closeness = (1.0 - impact.distance / (3.0 * length)).max(0.0);
        ballot.say(Behavior::Avoid, Vec3::Z, -1.5 * closeness, 3);
        ballot.say(Behavior::Avoid, impact.aim, closeness, 4);
    }
    if let Some(Threat::Animal(one)) = threat {
        let closeness = (1.0 - one.position.length() / near).max(0.0);
        ballot.say(Behavior::Avoid, one.position, -closeness, 2);
        ballot.say(Behavior::Avoid, -one.position, 0.5 * closeness, 1);
    }
    if character.nature.role.flees() {
        for (enemy, fear) in &situation.enemies {
            ballot.say(Behavior::Escape, enemy.position, -fear, 1);
            ballot.say(Behavior::Escape, -enemy.position, 1.2 * fear, 1);
        }
        if situation.enemies.is_empty() && character.drives.fear > character.temper.fear_threshold {
            // What is feared and not seen is behind.
            ballot.say(Behavior::Escape, Vec3::Z, 1.2 * character.drives.fear, 1);
        }
    }
}

/// Needs: food by nearness, company by course and gaps.
fn needs(ballot: &mut Ballot, character: &Character, situation: &Situation) {
    let (temper, drives) = (&character.temper, &character.drives);
    if drives.hunger > temper.drive_threshold {
        for morsel in situation.food.iter().take(8) {
            let near = 1.0 - morsel.cost / (temper.smell_range * situation.length);
            let place = morsel.sighting.position - situation.mouth();
            ballot.say(Behavior::Eat, place, drives.hunger * near.max(0.05) * near.max(0.05), 4);
        }
    }
    let Nature { role, habits, .. } = &character.nature;
    if role.flees() && habits.school {
        let strength = COMPANY + 0.3 * drives.fear;
        let leader = situation.leader.iter();
        for one in situation.school.iter().take(7).chain(leader) {
            let gap = (one.position.length() / situation.length - temper.spacing).clamp(-1.0, 2.0);
            let course = one.heading * strength;
            ballot.say(Behavior::School, course, 0.5 * strength, 2);
            ballot.say(Behavior::School, one.position * gap, 0.3 * strength * gap.abs(), 2);
        }
    }
}

impl FreeFlow {
    /// Everybody's say; the partner of a courtship comes with it, and what the ritual asks for.
    fn vote(
        &mut self,
        situation: &Situation,
        threat: Option<&Threat>,
        random: &mut Random,
    ) -> (Ballot, Option<Deed>) {
        let mut ballot = Ballot::default();
        let character = &mut self.character;
        safety(&mut ballot, character, situation, threat);
        needs(&mut ballot, character, situation);
        ballot.say(Behavior::Wander, Vec3::Z, INERTIA, 2);
        let none = Preferences::default();
        let focus = |behavior: Behavior| Focus { behavior, target: NOTHING, threat: None };
        let uncomfortable = situation.discomfort(&character.nature, &character.temper) > 0.0
            && character.nature.role != Role::Predator;
        let idle = if uncomfortable { Behavior::Leave } else { Behavior::Wander };
        let whim = character.perform(situation, &focus(idle), &none, random);
        ballot.say(idle, whim.command.heading(), WHIM * if uncomfortable { 2.0 } else { 1.0 }, 2);
        let libido = character.drives.libido;
        let courts = character.nature.role.courts() && libido > character.temper.drive_threshold;
        let ritual = courts.then(|| {
            let deed = character.perform(situation, &focus(Behavior::Mate), &none, random);
            ballot.say(Behavior::Mate, deed.command.heading(), libido, 4);
            deed
        });
        (ballot, ritual)
    }

    /// Speed for a direction, from what said most for it, in body lengths per second.
    fn pace(&self, system: Behavior, direction: Vec3, situation: &Situation) -> f32 {
        let temper = &self.character.temper;
        let blocked =
            situation.percepts.ahead.is_some_and(|impact| impact.distance < 1.5 * situation.length);
        let slow = if blocked || direction.z < 0.3 { 0.6 } else { 1.0 };
        let speed = match system {
            Behavior::Escape => temper.full_speed,
            Behavior::Eat => 1.5 * temper.cruise_speed,
            Behavior::School => {
                let velocities = situation.school.iter().map(|one| one.velocity.length());
                let mean = velocities.sum::<f32>() / situation.school.len().max(1) as f32;
                (mean / situation.length).clamp(0.5 * temper.cruise_speed, temper.full_speed)
            }
            _ => temper.cruise_speed,
        };
        speed * slow
    }
}

impl Mind for FreeFlow {
    fn name(&self) -> &str {
        "free_flow"
    }

    fn decide(
        &mut self,
        percepts: &Percepts,
        random: &mut Random,
        annotations: &mut Vec<Annotation>,
    ) -> Result<Intention> {
        let situation = self.character.perceive(percepts, random);
        let threat = self.character.threat(&situation);
        let (ballot, ritual) = self.vote(&situation, threat.as_ref(), random);
        let (direction, _, system) = ballot.winner();
        let nearest = situation.food.iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut command = Command::toward(direction, self.pace(system, direction, &situation));
        let mut target: Id = NOTHING;
        match (system, ritual, nearest) {
            (Behavior::Mate, Some(deed), _) => (command, target) = (deed.command, deed.target),
            (Behavior::Eat, _, Some(morsel)) => {
                target = morsel.sighting.id;
                let near =
                    morsel.distance / (self.character.temper.suck_distance * situation.length);
                command.mouth = (2.0 - near).clamp(0.0, 1.0);
            }
            (Behavior::Escape, _, _) => {
                target = situation.worst_enemy().map_or(NOTHING, |(enemy, _)| enemy.id);
            }
            _ => {}
        }
        let deed = Deed { behavior: system, command, target };
        Ok(self.character.intention(&deed, &situation, annotations))
    }

    fn values(&self) -> BTreeMap<String, Value> {
        self.character.values()
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.character)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.character)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}
