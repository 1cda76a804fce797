//! How a stand is published: the wood of each plant, and all leaves of one form together.

use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Event, Quat, Vec3, math};
use bioscope_geometry::{Batch, Material, Mesh, Points, Transform};
use bioscope_world::Publication;
use rayon::prelude::*;

use super::Stand;
use super::growing::News;
use super::look::{Form, Look};
use super::model::Model;
use super::plant::Plant;
use crate::names::free_name;
use crate::plants::Stance;

/// Radius of a seed as it is shown, metres.
const SEED: f32 = 0.035;
/// Length of a fallen leaf, metres.
const LEAF: f32 = 0.16;

/// Meshes and materials that the plants of a stand share.
#[derive(Default)]
pub(super) struct Shared {
    pub wood: Arc<Material>,
    pub leaves: Arc<Material>,
    pub forms: BTreeMap<Form, Arc<Mesh>>,
    pub litter: Arc<Mesh>,
}

/// One plant as it is now.
struct Posed<'a> {
    plant: &'a Plant,
    look: &'a Look,
    body: Transform,
    poses: Vec<Transform>,
}

impl Stand {
    /// Makes sure that there is a mesh of every form of leaves.
    pub(super) fn share(&mut self) {
        let Model { turtle, meshing, .. } = &self.models.list[0];
        for look in self.looks.iter().flatten() {
            for leaf in &look.leaves {
                let mesh = || Arc::new(leaf.form.mesh(&turtle.shapes, &meshing.palette));
                self.shared.forms.entry(leaf.form).or_insert_with(mesh);
            }
        }
    }

    pub(super) fn show(&self, publication: &mut Publication) {
        let time = publication.moment.time;
        let sway = self.state.options.parameters.sway();
        let bends = sway.flexibility > 0.0 && !self.state.options.lying;
        let space = self.state.space;
        let looks = self.state.plants.par_iter().zip(&self.looks);
        let posed: Vec<Posed> = looks
            .filter_map(|(plant, look)| Some((plant, look.as_ref()?)))
            .map(|(plant, look)| {
                let body = space.of_plant(plant.position, plant.yaw);
                let mut poses = Vec::new();
                if bends {
                    poses.resize(look.joints.len(), Transform::IDENTITY);
                    let length = look.length * body.scale;
                    let stance = Stance { yaw: plant.yaw, phase: plant.phase, length, time };
                    plant.sway.pose(&look.joints, &stance, &sway, &mut poses);
                }
                Posed { plant, look, body, poses }
            })
            .collect();
        let species: Arc<str> = Arc::from(self.state.options.species.as_str());
        for one in posed.iter().filter(|one| !one.look.mesh.triangles.is_empty()) {
            let name = format!("{species}/{}", one.plant.id);
            let wood = self.shared.wood.clone();
            let mut batch = Batch::new(name, species.clone(), one.look.mesh.clone(), wood);
            batch.alive = true;
            batch.ids = vec![one.plant.id];
            batch.transforms = vec![one.body];
            batch.tints = vec![one.plant.tint];
            batch.poses.clone_from(&one.poses);
            publication.scene.batches.push(batch);
        }
        self.show_leaves(&posed, &species, publication);
        self.show_falling(&species, publication);
        self.show_surroundings(publication);
        self.tell(publication);
    }

    fn show_leaves(&self, posed: &[Posed], species: &Arc<str>, publication: &mut Publication) {
        let placed: Vec<Vec<Transform>> =
            posed.par_iter().map(|one| one.look.leaves(&one.body, &one.poses)).collect();
        let mut counts: BTreeMap<Form, usize> = BTreeMap::new();
        for one in posed {
            one.look.runs().for_each(|(form, run)| *counts.entry(form).or_default() += run.len());
        }
        let mut batches: BTreeMap<Form, Batch> = BTreeMap::new();
        for (form, count) in counts {
            let Form { name, color, texture, proportions: [width, thickness] } = form;
            let name = format!("{species}/{name}{color}.{texture}.{width}.{thickness}");
            let name = free_name(&publication.scene, &name);
            let mesh = self.shared.forms.get(&form).cloned().unwrap_or_default();
            let mut batch = Batch::new(name, species.clone(), mesh, self.shared.leaves.clone());
            batch.ids.reserve(count);
            batch.transforms.reserve(count);
            batch.tints.reserve(count);
            batches.insert(form, batch);
        }
        for (one, places) in posed.iter().zip(placed) {
            for (form, run) in one.look.runs() {
                let Some(batch) = batches.get_mut(&form) else { continue };
                batch.ids.resize(batch.ids.len() + run.len(), one.plant.id);
                batch.tints.resize(batch.tints.len() + run.len(), one.plant.tint);
                batch.transforms.extend_from_slice(&places[run]);
            }
        }
        publication.scene.batches.extend(batches.into_values().map(|mut batch| {
            batch.alive = true;
            batch
        }));
    }

    fn show_falling(&self, species: &Arc<str>, publication: &mut Publication) {
        let now = publication.moment.time;
        let name = free_name(&publication.scene, &format!("{species}/litter"));
        let material = self.shared.leaves.clone();
        let mut litter = Batch::new(name, species.clone(), self.shared.litter.clone(), material);
        let name = free_name(&publication.scene, &format!("{species}/seeds"));
        let mut seeds = Points {
            name,
            species: species.clone(),
            ids: Vec::new(),
            positions: Vec::new(),
            radii: Vec::new(),
            color: [0.21, 0.11, 0.04],
            opacity: 1.0,
            glassy: false,
        };
        for one in &self.state.falling {
            let place = one.place(now);
            if one.is_seed {
                seeds.ids.push(one.id);
                seeds.positions.push(place + Vec3::Y * SEED);
                seeds.radii.push(SEED);
                continue;
            }
            let age = (now - one.begun).min(f64::from(one.duration)) as f32;
            let turn = one.id as f32 * 2.4;
            // It lies flat in the end.
            let tilt =
                0.5 * math::PI + 0.7 * math::sin(age * 3.1 + turn) * (1.0 - age / one.duration);
            let rotation = Quat::from_rotation_y(turn + age) * Quat::from_rotation_x(tilt);
            let size = LEAF * one.presence(now);
            litter.ids.push(one.id);
            litter.transforms.push(Transform::new(place + Vec3::Y * 0.02, rotation, size));
            let shade = 0.7 + 0.6 * math::sin(turn).abs();
            litter.tints.push([0.7 * shade, 0.3 * shade, 0.07 * shade]);
        }
        if !litter.ids.is_empty() {
            publication.scene.batches.push(litter);
        }
        if !seeds.ids.is_empty() {
            publication.scene.points.push(seeds);
        }
    }

    fn tell(&self, publication: &mut Publication) {
        let moment = publication.moment;
        for news in &self.state.news {
            let (kind, subject, object, modules) = match *news {
                News::Germinated { who } => ("germinated", who, None, None),
                News::Pruned { who, modules } => ("pruned", who, None, Some(modules)),
                News::Eaten { who, into } => (crate::bites::EATEN, who, Some(into), None),
                News::Died { who } => ("died", who, None, None),
            };
            let data = modules.map(|count| (String::from("modules"), f64::from(count).into()));
            publication.events.push(Event {
                tick: moment.tick,
                time: moment.time,
                kind: kind.into(),
                subject,
                object,
                data: data.into_iter().collect(),
            });
        }
    }
}
