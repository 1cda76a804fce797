use std::sync::Arc;

use bioscope_core::{
    Act, Annotation, Display, Error, Id, Intention, NOTHING, Percepts, Purpose, Quat, Result, Vec3,
};
use bioscope_dynamics::Influence;
use bioscope_minds::Mind;
use bioscope_motion::Body;
use bioscope_senses::{Outlook, Sense, Surroundings};
use bioscope_world::{Environment, Moment, Steering, View};
use serde::{Deserialize, Serialize};

use super::Look;

const DECISION: Purpose = Purpose::new("mind of an animal");

/// Behaviors whose beginning is worth an event, and the event's kind.
const NOTEWORTHY: [(&str, &str); 5] = [
    ("dash", "dashed"),
    ("turn home", "turned home"),
    ("inspect", "inspected"),
    ("escape", "escaped"),
    ("school", "schooled"),
];
/// Stages of courtship that are worth an event, and the event's kind.
const COURTSHIP: [(Act, &str); 4] = [
    (Act::Courting, "courted"),
    (Act::Circling, "circled"),
    (Act::Nuzzling, "mated"),
    (Act::Spawned, "spawned"),
];
/// Seconds in which the same is not reported twice of one animal.
const QUIET: f64 = 3.0;

/// The parts of one animal.
pub struct Animal {
    /// What it notices with, asked in this order.
    pub senses: Vec<Box<dyn Sense>>,
    /// What it decides with.
    pub mind: Box<dyn Mind>,
    /// What it moves with.
    pub body: Box<dyn Body>,
    /// What it looks like.
    pub look: Arc<Look>,
    /// Whether a part of it may fail for reasons of its own (code of the user's).
    pub may_fail: bool,
}

/// One animal in a world.
pub(super) struct Individual {
    pub id: Id,
    pub parts: Animal,
    pub record: Record,
}

/// What is known of an individual beside its parts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    /// Place it calls home, metres.
    pub home: Vec3,
    /// Linear color that multiplies its look's.
    pub tint: [f32; 3],
    /// What it noticed last.
    pub percepts: Percepts,
    /// What it wants.
    pub intention: Intention,
    /// What its mind shows, in its own frame.
    pub annotations: Vec<Annotation>,
    /// When each of [`NOTEWORTHY`] was reported last, world time in seconds.
    reported: [Option<f64>; NOTEWORTHY.len()],
    /// Which of them is reported in this tick.
    news: Option<usize>,
    /// The hook on which it hangs.
    pub hook: Option<Id>,
    /// Whom it bites in this tick.
    pub bite: Option<Id>,
    /// What it has shown of a courtship so far, so that each stage is reported once.
    shown: Act,
    /// Stage of a courtship that is reported in this tick.
    stage: Option<usize>,
    /// Whom it has courted last.
    partner: Id,
    /// What somebody commands in place of its mind, which goes on feeling.
    pub steering: Option<Steering>,
    /// World time of its last decision, seconds; none before the first.
    decided: Option<f64>,
    /// How it lay in the world when the intention's heading was last expressed in its own frame.
    faced: Quat,
    /// What it has swallowed since its last decision.
    fed: u32,
}

impl Individual {
    /// Whether it decides in this tick, if it takes `reaction` seconds from one decision to the next. Not all of a population
    /// decide in the same tick.
    fn is_due(&self, moment: &Moment, reaction: f32) -> bool {
        let ticks = (reaction / moment.dt).round().max(1.0) as u64;
        self.record.decided.is_none() || (moment.tick + u64::from(self.id)).is_multiple_of(ticks)
    }

    pub fn sense(
        &mut self,
        view: &View,
        outlook: &Outlook,
        (influence, fed, reaction): (Influence, u32, f32),
    ) -> Result<()> {
        self.record.fed += fed;
        if !self.is_due(&view.moment, reaction) {
            return Ok(());
        }
        let environment = view.environment;
        let placement = self.parts.body.placement();
        let medium = environment.medium();
        let surroundings = Surroundings {
            id: self.id,
            position: placement.position,
            attitude: placement.rotation(),
            velocity: self.parts.body.velocity(),
            body_length: self.parts.body.length(),
            home: self.record.home,
            outlook,
            sounds: view.sounds,
            influence,
            obstacles: &environment.obstacles,
            terrain: environment.terrain.as_deref(),
            medium: &medium,
            sun: environment.sun(),
            temperature: environment.parameters.temperature,
            time: view.moment.time,
            dt: self.record.decided.map_or(view.moment.dt, |last| (view.moment.time - last) as f32),
        };
        let percepts = &mut self.record.percepts;
        surroundings.begin(percepts);
        percepts.fed = std::mem::take(&mut self.record.fed);
        let mut senses = self.parts.senses.iter_mut();
        senses.try_for_each(|sense| sense.sense(&surroundings, percepts))
    }

    pub fn decide(&mut self, moment: &Moment, reaction: f32) -> Result<()> {
        let is_due = self.is_due(moment, reaction);
        let record = &mut self.record;
        if record.hook.is_some() {
            record.annotations.clear();
            (record.bite, record.news, record.stage) = (None, None, None);
            record.intention = super::hooked::struggle(record, moment.time);
            return Ok(());
        }
        if !is_due {
            // It goes on in the same direction, however it turns meanwhile.
            let attitude = self.parts.body.placement().rotation();
            record.intention.heading = attitude.inverse() * record.faced * record.intention.heading;
            record.faced = attitude;
            (record.bite, record.news, record.stage) = (None, None, None);
            return Ok(());
        }
        let mut random = moment.random(self.id, DECISION);
        record.decided = Some(moment.time);
        record.faced = record.percepts.attitude;
        record.annotations.clear();
        let mind = &mut self.parts.mind;
        let mut intention = mind.decide(&record.percepts, &mut random, &mut record.annotations)?;
        if let Some(steering) = &record.steering {
            let mouthful = super::feeding::mouthful(&record.percepts);
            intention = super::orders::commanded(steering, &intention, mouthful);
            record.annotations.clear();
        }
        let changed = intention.behavior != record.intention.behavior;
        record.intention = intention;
        // What it bit in the tick before is still seen, but on its way down.
        let swallowed = record.bite;
        record.bite = super::feeding::bite(record).filter(|&one| Some(one) != swallowed);
        record.court();
        record.news = if changed { record.report(moment.time) } else { None };
        Ok(())
    }

    /// Moves the body as intended; one of muscles is only told, and moved together with others.
    pub fn drive(&mut self, influence: &Influence, dt: f32) -> Result<()> {
        let (body, intention) = (&mut self.parts.body, &self.record.intention);
        match body.muscles() {
            Some(muscles) => muscles.obey(intention, influence, dt),
            None => body.advance(intention, influence, dt),
        }
    }

    /// Gets out of what it has run into.
    pub fn arrive(&mut self, environment: &Environment) -> Result<()> {
        let body = &mut self.parts.body;
        let reach = 0.25 * body.length();
        let position = body.placement().position;
        if self.record.hook.is_none() {
            body.shift(super::contact::way_out(position, reach, environment));
        }
        let placement = body.placement();
        let sound = placement.position.is_finite()
            && placement.rotation().is_finite()
            && body.velocity().is_finite();
        if sound {
            return Ok(());
        }
        let name = format!("placement of animal {} ({})", self.id, body.kind());
        Err(Error::value(name, format!("{placement:?}"), "finite numbers"))
    }
}

impl Record {
    /// Which noteworthy behavior has just begun, unless it was reported a moment ago.
    fn report(&mut self, time: f64) -> Option<usize> {
        let behavior = &self.intention.behavior;
        let index = NOTEWORTHY.iter().position(|(word, _)| word == behavior)?;
        if self.reported[index].is_some_and(|last| time - last < QUIET) {
            return None;
        }
        self.reported[index] = Some(time);
        Some(index)
    }

    /// Takes note of the stage that a courtship has reached.
    fn court(&mut self) {
        let Display { act, partner, .. } = self.intention.display;
        let act = if partner == NOTHING && act != Act::Spawned { Act::Other } else { act };
        if partner != NOTHING {
            self.partner = partner;
        }
        let reached = COURTSHIP.iter().position(|(one, _)| *one == act);
        self.stage = reached.filter(|_| act != self.shown);
        self.shown = act;
    }

    /// Kinds of this tick's events and whom they concern.
    pub fn events(&self) -> impl Iterator<Item = (&'static str, Option<Id>)> {
        let target = self.intention.target.filter(|&target| target != NOTHING);
        let news = self.news.map(|index| (NOTEWORTHY[index].1, target));
        let partner = Some(self.partner).filter(|&partner| partner != NOTHING);
        let stage = self.stage.map(|index| (COURTSHIP[index].1, partner));
        news.into_iter().chain(stage)
    }
}
