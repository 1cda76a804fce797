//! What the three minds of fishes share: nature, temper, drives and the routines' own state.

use std::borrow::Cow;
use std::collections::BTreeMap;

use bioscope_core::{
    Act, Annotation, Display, Id, Intention, Mark, NOTHING, Parameter, Parameters, Percepts,
    Random, Result, Value, Vec3,
};
use serde::{Deserialize, Serialize};

use crate::attention::{
    Behavior, Focus, Preferences, Region, Situation, Strengths, Threat, preferences,
};
use crate::drives::Drives;
use crate::nature::{Habits, Nature, Temper};
use crate::routines::{Avoidance, Command, Courtship, Escape, Wandering, choose_food, eat, school};

/// Nature, temper, drives and skills of a fish.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Character {
    pub nature: Nature,
    pub temper: Temper,
    pub drives: Drives,
    pub courtship: Courtship,
    avoidance: Avoidance,
    wandering: Wandering,
    escape: Escape,
    /// Whether it swims in formation, so that its sensitivity region shrinks.
    formation: bool,
}

/// Its temper, and its habits as switches (from 0.5 on).
impl Parameters for Character {
    fn descriptions(&self) -> Vec<Parameter> {
        let mut all = self.temper.descriptions();
        all.extend(Habits::descriptions());
        all
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.temper.get(name).or_else(|| self.nature.habits.get(name))
    }

    fn set(&mut self, name: &str, value: f64) -> Result<()> {
        if self.nature.habits.get(name).is_some() {
            return self.nature.habits.set(name, value);
        }
        self.temper.set(name, value)
    }
}

/// What a fish does in one tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deed {
    pub behavior: Behavior,
    pub command: Command,
    pub target: Id,
}

impl Character {
    pub fn new(nature: Nature, temper: Temper) -> Self {
        Self { nature, temper, ..Self::default() }
    }

    /// Refuses a temper outside its ranges, as damaged files may hold.
    pub fn check(&self) -> Result<()> {
        let all = self.temper.descriptions();
        all.iter().try_for_each(|one| {
            one.check(self.temper.get(&one.name).unwrap_or(f64::NAN)).map(|_| ())
        })
    }

    /// Sorts what is noticed and lets it move the drives.
    pub fn perceive<'a>(&mut self, percepts: &'a Percepts, random: &mut Random) -> Situation<'a> {
        let situation = Situation::new(percepts, &self.nature, &self.temper);
        self.drives.advance(&situation.stirring(), &self.temper, random);
        situation
    }

    /// What threatens to collide, as its sensitivity region has it now.
    pub fn threat<'a>(&self, situation: &Situation<'a>) -> Option<Threat<'a>> {
        let factor = if self.formation { 0.5 } else { 1.0 };
        let region = Region::new(&self.temper, factor, self.courtship.partner);
        Threat::worst(situation, &region, &self.temper)
    }

    /// The preferences beside this focus of attention, for behaviors that heed them.
    pub fn preferences(&self, situation: &Situation, focus: &Focus) -> Preferences {
        if matches!(focus.behavior, Behavior::School | Behavior::Leave | Behavior::Wander) {
            return Preferences::default();
        }
        let strengths = Strengths::beside(focus.behavior, &self.drives);
        preferences(situation, &strengths, focus)
    }

    /// Does what serves a behavior; attention rests on `focus`.
    pub fn perform(
        &mut self,
        situation: &Situation,
        focus: &Focus,
        preferences: &Preferences,
        random: &mut Random,
    ) -> Deed {
        let behavior = focus.behavior;
        if behavior != Behavior::Avoid {
            self.avoidance.rest();
        }
        if behavior != Behavior::Escape {
            self.escape.rest();
        }
        let done = match behavior {
            Behavior::Avoid => focus.threat.map(|threat| {
                let command =
                    self.avoidance.command(threat, situation, preferences, &self.temper, random);
                let target = if let Threat::Animal(one) = threat { one.id } else { NOTHING };
                (command, target)
            }),
            Behavior::Escape => Some(match situation.worst_enemy() {
                Some((enemy, _)) => {
                    let command = self.escape.command(enemy, situation, preferences, &self.temper);
                    (command, enemy.id)
                }
                None => (Command::ahead(self.temper.full_speed), NOTHING),
            }),
            Behavior::School => {
                let leader = situation.leader.map_or(NOTHING, |leader| leader.id);
                school(situation, &self.temper).map(|command| (command, leader))
            }
            Behavior::Eat => {
                let choice = (self.nature.role, &self.temper);
                choose_food(situation, preferences, focus.target, choice)
                    .map(|morsel| (eat(&morsel, situation, &self.temper), morsel.sighting.id))
            }
            Behavior::Mate => {
                let (nature, temper) = (&self.nature, &self.temper);
                let (command, spawned) =
                    self.courtship.advance(situation, nature, temper, preferences);
                if spawned {
                    self.drives.mated();
                }
                command.map(|command| (command, self.courtship.partner))
            }
            Behavior::Leave | Behavior::Wander => None,
        };
        let nearest = situation.school.first().map(|one| one.position.length());
        self.formation = behavior == Behavior::School
            && nearest.is_some_and(|distance| distance < 1.5 * situation.length);
        let (command, target) = match done {
            Some(done) => {
                self.wandering.rest();
                done
            }
            // Nothing to be done about it here: looks for it.
            None => (self.wander(behavior, situation, random), NOTHING),
        };
        Deed { behavior, command, target }
    }

    fn wander(
        &mut self,
        behavior: Behavior,
        situation: &Situation,
        random: &mut Random,
    ) -> Command {
        if behavior == Behavior::Leave {
            let discomfort = situation.discomfort(&self.nature, &self.temper);
            self.wandering.leave(discomfort, situation, &self.temper, random)
        } else {
            self.wandering.wander(situation, &self.temper, random)
        }
    }

    /// The deed as an intention, with its display and annotations.
    pub fn intention(
        &self,
        deed: &Deed,
        situation: &Situation,
        annotations: &mut Vec<Annotation>,
    ) -> Intention {
        let found = situation.find(deed.target).filter(|_| deed.target != NOTHING);
        let mut note = |role: &'static str, to: Vec3| {
            let mark = Mark::Line { from: Vec3::ZERO, to };
            annotations.push(Annotation { subject: NOTHING, role: role.into(), mark });
        };
        let command = &deed.command;
        note("heading", command.heading() * situation.length);
        if let Some(one) = found {
            note(if deed.behavior == Behavior::Avoid { "avoid" } else { "target" }, one.position);
        }
        Intention {
            behavior: Cow::Borrowed(deed.behavior.name()),
            gaze: found.map(|one| one.position),
            target: found.map(|one| one.id),
            display: self.display(deed, situation.percepts.time),
            ..command.intention(self.temper.full_speed)
        }
    }

    fn display(&self, deed: &Deed, time: f64) -> Display {
        // A courtship that is interrupted for a moment still shows.
        let courts = deed.behavior == Behavior::Mate || self.courtship.lasts(time);
        let act = match self.courtship.act(time, courts) {
            Act::Other => match deed.behavior {
                Behavior::School => Act::Schooling,
                Behavior::Escape => Act::Fleeing,
                Behavior::Eat => Act::Feeding,
                _ => Act::Other,
            },
            act => act,
        };
        let partner = if courts { self.courtship.partner } else { NOTHING };
        Display { sex: self.nature.sex(), act, partner }
    }

    /// Inner life for inspectors.
    pub fn values(&self) -> BTreeMap<String, Value> {
        let Drives { hunger, libido, fear, eaten, .. } = self.drives;
        BTreeMap::from([
            (String::from("hunger"), hunger.into()),
            (String::from("libido"), libido.into()),
            (String::from("fear"), fear.into()),
            (String::from("eaten"), eaten.into()),
            (
                String::from("courtship"),
                format!("{:?}", self.courtship.stage).to_lowercase().as_str().into(),
            ),
        ])
    }
}
