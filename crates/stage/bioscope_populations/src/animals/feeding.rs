//! How animals bite, swallow and are caught.
//!
//! An animal whose mouth is open, by its intention, draws in what floats before it (see [`suction`](crate::suction)). It bites
//! what its attention rests on as soon as that has got into contact with the mouth, or else other food that has. See
//! [`bites`](crate::bites) for how the bitten answers.

use std::borrow::Cow;
use std::collections::BTreeMap;

use bioscope_core::{Event, Id, NOTHING, Percepts, Sighting, SoundEvent, Vec3};
use bioscope_geometry::Mouth;
use bioscope_motion::Body;
use bioscope_world::Moment;

use super::individual::{Individual, Record};
use crate::bites::{BITTEN, CAUGHT, EATEN, Gone, bitten};
use crate::suction::MOUTHFUL;

/// How far the mouth lies ahead of the middle, body lengths.
pub(super) const MOUTH: f32 = 0.48;
/// Distance from the mouth within which a thing is in contact with it, body lengths.
const CONTACT: f32 = 0.1;
/// Opening from which it bites.
const OPEN: f32 = 0.5;

/// How many things each has swallowed in the last tick.
pub(super) fn meals(events: &[Event]) -> BTreeMap<Id, u32> {
    let mut meals = BTreeMap::new();
    for event in events.iter().filter(|one| one.kind == EATEN || one.kind == CAUGHT) {
        if let Some(eater) = event.object {
            *meals.entry(eater).or_insert(0) += 1;
        }
    }
    meals
}

/// Whom an animal bites by its intention: what is in contact with its open mouth, its target before other food.
pub(super) fn bite(record: &Record) -> Option<Id> {
    let (percepts, intention) = (&record.percepts, &record.intention);
    let target = intention.target.filter(|&target| target != NOTHING && intention.mouth >= OPEN)?;
    let length = percepts.body_length;
    let goes_in = |one: &&Sighting| {
        let distance = one.position.distance(Vec3::Z * (MOUTH * length)) - 0.5 * one.size;
        distance <= CONTACT * length && one.size <= MOUTHFUL * length
    };
    let mut noticed = percepts.smelled.iter().chain(&percepts.seen);
    let morsel = noticed.find(|one| one.id == target).filter(goes_in);
    morsel.or_else(|| percepts.smelled.iter().find(goes_in)).map(|one| one.id)
}

/// The mouth of an animal that holds it open.
pub(super) fn open_mouth(id: Id, record: &Record, body: &dyn Body) -> Option<Mouth> {
    let gape = record.intention.mouth.min(1.0);
    if gape < OPEN || record.hook.is_some() {
        return None;
    }
    let (placement, body_length) = (body.placement(), body.length());
    let ahead = placement.rotation() * Vec3::Z;
    let position = placement.position + ahead * (MOUTH * body_length);
    Some(Mouth { owner: id, position, ahead, body_length, gape })
}

/// The food that it notices nearest to its mouth.
pub(super) fn mouthful(percepts: &Percepts) -> Option<Id> {
    let mouth = Vec3::Z * (MOUTH * percepts.body_length);
    let distance = |place: Vec3| place.distance_squared(mouth);
    let food = percepts.smelled.iter();
    food.min_by(|a, b| distance(a.position).total_cmp(&distance(b.position))).map(|one| one.id)
}

/// The event of a bite.
pub(super) fn bitten_by(biter: Id, prey: Id, moment: &Moment) -> Event {
    Event {
        tick: moment.tick,
        time: moment.time,
        kind: Cow::Borrowed(BITTEN),
        subject: prey,
        object: Some(biter),
        data: BTreeMap::new(),
    }
}

/// The noise of jaws that closed on something in the last tick: deeper and louder the larger they are (choice).
pub(super) fn bite_sound(record: &Record, body: &dyn Body) -> Option<SoundEvent> {
    if record.percepts.fed == 0 {
        return None;
    }
    let (length, placement) = (body.length(), body.placement());
    Some(SoundEvent {
        source: NOTHING,
        kind: Cow::Borrowed("bite"),
        time: 0.0,
        duration: 0.12,
        position: placement.position + placement.rotation() * Vec3::Z * (MOUTH * length),
        velocity: body.velocity(),
        amplitude: (0.3 * length).min(0.3),
        pitch: 350.0 / length.clamp(0.1, 3.0),
    })
}

/// Takes those away who were bitten in the last tick.
pub(super) fn be_caught(individuals: &mut Vec<Individual>, events: &[Event]) -> Vec<Gone> {
    let biters = bitten(events);
    if biters.is_empty() {
        return Vec::new();
    }
    let mut caught = Vec::new();
    individuals.retain(|one| {
        let biter = biters.get(&one.id);
        caught.extend(biter.map(|&into| Gone {
            who: one.id,
            into,
            species: one.parts.look.species.clone(),
        }));
        biter.is_none()
    });
    caught
}
