//! How a school is published: its fishes as one batch, what some of them wish, what has happened.

use std::borrow::Cow;

use bioscope_core::{Annotation, Event, Id, Mark, NOTHING, Vec3};
use bioscope_geometry::{Batch, Transform};
use bioscope_motion::undulation::spine_pose;
use bioscope_world::Publication;
use rayon::prelude::*;

use super::FishSchool;
use super::fish::Fish;
use super::population::TASK;
use crate::bites::CAUGHT;
use crate::names::free_name;

impl FishSchool {
    pub(super) fn show(&self, publication: &mut Publication) {
        let name = free_name(&publication.scene, &self.options.species.name);
        publication.scene.batches.push(self.batch(name));
        self.annotate(&mut publication.scene.annotations);
        self.events(publication);
    }

    /// Writes the pose of a fish and returns where it is.
    fn pose(&self, index: usize, fish: &Fish, pose: &mut [Transform]) -> Transform {
        if !self.replays() {
            spine_pose(&self.spine, &fish.swim, pose);
            return self.placement(index);
        }
        let speed = self.flock.velocities()[index].length() / (self.body_length() * fish.scale);
        let who = (self.flock.ids()[index], fish, speed);
        self.bodies.pose(&self.spine, who, pose).unwrap_or_else(|| self.placement(index))
    }

    fn batch(&self, name: String) -> Batch {
        let species = &self.options.species;
        let mut batch = Batch::new(
            name,
            species.name.as_str(),
            self.form.mesh.clone(),
            self.form.material.clone(),
        );
        batch.alive = true;
        batch.ids = self.flock.ids().to_vec();
        batch.velocities = self.fishes.iter().map(|fish| fish.motion).collect();
        batch.tints = self.fishes.iter().map(|fish| fish.tint).collect();
        let joints = self.form.spine.joint_count();
        batch.poses = vec![Transform::IDENTITY; joints * self.fishes.len()];
        batch.transforms = vec![Transform::IDENTITY; self.fishes.len()];
        let bodies = batch.poses.par_chunks_mut(joints).zip(&mut batch.transforms);
        bodies.zip(&self.fishes).enumerate().with_min_len(TASK).for_each(
            |(index, ((pose, placement), fish))| {
                *placement = self.pose(index, fish, pose);
            },
        );
        batch
    }

    fn annotate(&self, annotations: &mut Vec<Annotation>) {
        let reach = 3.0 * self.body_length();
        for (index, wish) in self.wishes.iter().enumerate().take(self.fishes.len()) {
            let from = self.flock.positions()[index];
            let mut show = |role: &'static str, to: Vec3| {
                let subject = self.flock.ids()[index];
                let mark = Mark::Line { from, to };
                annotations.push(Annotation { subject, role: role.into(), mark });
            };
            show("heading", from + self.flock.headings()[index] * reach);
            show(self.fishes[index].mode.name(), from + *wish * reach);
        }
    }

    fn events(&self, publication: &mut Publication) {
        let moment = publication.moment;
        publication.events.extend(self.caught.iter().map(|gone| gone.event(CAUGHT, &moment)));
        let mut happen =
            |kind: &'static str, subject: Id, object: Option<Id>, groups: Option<usize>| {
                let data = groups.map(|groups| (String::from("groups"), (groups as f64).into()));
                publication.events.push(Event {
                    tick: moment.tick,
                    time: moment.time,
                    kind: Cow::Borrowed(kind),
                    subject,
                    object,
                    data: data.into_iter().collect(),
                });
            };
        for (fish, &id) in self.fishes.iter().zip(self.flock.ids()) {
            if fish.startled_by != NOTHING {
                happen("startled", id, Some(fish.startled_by), None);
            }
        }
        if let (Some(before), Some(&first)) = (self.regrouped_from, self.flock.ids().first()) {
            let kind = if self.groups > before { "split" } else { "rejoined" };
            happen(kind, first, None, Some(self.groups));
        }
    }
}
