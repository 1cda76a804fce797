//! An animal on a hook: it struggles, and goes where the hook goes.

use std::borrow::Cow;
use std::collections::BTreeMap;

use bioscope_core::{Event, Id, Intention, Vec3, math};
use bioscope_geometry::{Scene, Transform};
use bioscope_motion::Body;

use super::feeding::MOUTH;
use super::individual::{Individual, Record};
use crate::bites::HOOKED;

/// How often it throws itself round, per second (choice).
const THROWS: f64 = 1.6;

/// Takes note of those who were hooked in the last tick.
pub(super) fn hook(individuals: &mut [Individual], events: &[Event]) {
    for event in events.iter().filter(|one| one.kind == HOOKED) {
        let caught = individuals.iter_mut().find(|one| one.id == event.subject);
        if let Some(caught) = caught {
            caught.record.hook = event.object;
        }
    }
}

/// Where the hooks are, at the end of this tick, on which some of them hang.
pub(super) fn places(individuals: &[Individual], scene: &Scene, dt: f32) -> BTreeMap<Id, Vec3> {
    let hooks = individuals.iter().filter_map(|one| one.record.hook);
    hooks.filter_map(|hook| Some((hook, place(hook, scene, dt)?))).collect()
}

/// The scene shows where a hook was: it has moved on since.
fn place(id: Id, scene: &Scene, dt: f32) -> Option<Vec3> {
    scene.batches.iter().find_map(|batch| {
        let index = batch.ids.iter().position(|&one| one == id)?;
        let velocity = batch.velocities.get(index).copied().unwrap_or_default();
        batch.transforms.get(index).map(|one| one.position + velocity * dt)
    })
}

/// What it does: beats upward with all its strength and throws itself from side to side.
pub(super) fn struggle(record: &Record, time: f64) -> Intention {
    let up = record.percepts.attitude.inverse() * Vec3::Y;
    let side = math::sin(((time * THROWS).fract() as f32) * math::TAU);
    Intention {
        behavior: Cow::Borrowed("struggle"),
        heading: (Vec3::Z * 0.5 + up + Vec3::X * (0.8 * side)).normalize_or(Vec3::Z),
        speed: 3.0,
        urgency: 1.0,
        mouth: 0.4,
        ..Intention::default()
    }
}

impl Individual {
    /// Hangs by the mouth at this point.
    pub(super) fn hang(&mut self, hook: Vec3) {
        let body = &mut self.parts.body;
        let mouth = mouth(body.as_ref());
        body.shift(hook - mouth);
    }
}

/// Where the mouth of a body is that may be bent.
fn mouth(body: &dyn Body) -> Vec3 {
    let placement = body.placement();
    let mut poses = vec![Transform::IDENTITY; body.joint_count()];
    body.pose(&mut poses);
    // The first joint of a spine is at its snout.
    match poses.first() {
        Some(snout) => placement.point(snout.position),
        None => placement.position + placement.rotation() * Vec3::Z * (MOUTH * body.length()),
    }
}
