use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Error, Id, Parameters, Purpose, Quat, Random, Result, Vec3, math, state};
use bioscope_geometry::{Batch, Transform};
use bioscope_world::{Growth, Inspection, Order, Population, Publication, View, no_such_order};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::parting::{Passers, Stem};
use super::shapes::{Shape, Shapes};
use super::sway::{Stance, Sway};
use super::{PlantsOptions, PlantsParameters};
use crate::names::free_name;
use crate::placement::Site;

const PLACE: Purpose = Purpose::new("plant place");
const LOOK: Purpose = Purpose::new("plant look");
/// Plants that one thread takes at a time.
const SHARE: usize = 64;

/// A stand of plants.
pub struct Plants {
    state: State,
    shapes: Shapes,
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    options: PlantsOptions,
    seed: u64,
    plants: Vec<Plant>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
struct Plant {
    id: Id,
    variant: u32,
    position: Vec3,
    size: f32,
    yaw: f32,
    phase: f32,
    tint: [f32; 3],
    sway: Sway,
}

impl Plants {
    /// Plants of these options. The text is read at once, so that errors in it are reported here;
    /// the shapes grow when the population is added to a world, whose seed they depend on.
    pub fn new(options: PlantsOptions) -> Result<Self> {
        options.check()?;
        bioscope_lsystem::LSystem::parse(&options.source, &options.file_name)?;
        let state = State { options, seed: 0, plants: Vec::new() };
        Ok(Self { state, shapes: Shapes::default() })
    }

    /// Plants in a state that `save` gave.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state = read(bytes)?;
        let shapes = Shapes::grow(&state.options, state.seed)?;
        Ok(Self { state, shapes })
    }

    /// Lean of each plant's tip towards x and z, radians.
    pub fn leans(&self) -> impl Iterator<Item = [f32; 2]> + '_ {
        let parameters = &self.state.options.parameters;
        self.state.plants.iter().map(|one| one.sway.tip(parameters).to_array())
    }

    fn shape(&self, plant: &Plant) -> Option<&Shape> {
        self.shapes.variants.get(plant.variant as usize)
    }
}

impl Plants {
    /// Roots newcomers in the habitat, or lets the youngest go.
    fn number(&mut self, count: usize, growth: &mut Growth) -> Result<()> {
        let options = PlantsOptions { count, ..self.state.options.clone() };
        options.check()?;
        let missing = count.saturating_sub(self.state.plants.len());
        self.state.plants.truncate(count);
        let ids = growth.identities(missing)?;
        let sites = options.habitat.sites(&ids, &[options.room], growth, PLACE);
        let root = |(id, site)| Plant::root(id, site, &options, growth.moment.random(id, LOOK));
        self.state.plants.extend(ids.into_iter().zip(sites).map(root));
        Ok(())
    }
}

fn read(bytes: &[u8]) -> Result<State> {
    let state: State = state::from_bytes("plants", bytes)?;
    state.options.check()?;
    if state.plants.iter().any(|one| one.variant >= state.options.variants) {
        return Err(Error::format("plants", "a plant of a shape that there is not"));
    }
    Ok(state)
}

impl Plant {
    fn root(id: Id, site: Site, options: &PlantsOptions, mut random: Random) -> Self {
        let [small, large] = options.size;
        let size = math::mix(small, large, random.uniform());
        let bright = 1.0 + options.variety * random.range(-0.6, 0.6);
        let tint = [0, 1, 2].map(|_| bright * (1.0 + options.variety * random.range(-0.35, 0.35)));
        Self {
            id,
            variant: random.below(options.variants),
            position: site.position - Vec3::Y * (0.01 * size),
            size,
            yaw: random.range(0.0, math::TAU),
            phase: random.range(0.0, math::TAU),
            tint,
            sway: Sway::default(),
        }
    }

    fn write_poses(
        &self,
        shape: &Shape,
        parameters: &PlantsParameters,
        time: f64,
        poses: &mut [Transform],
    ) {
        let length = shape.length * self.size;
        let stance = Stance { yaw: self.yaw, phase: self.phase, length, time };
        self.sway.pose(&shape.joints, &stance, parameters, poses);
    }
}

impl Population for Plants {
    fn kind(&self) -> &str {
        "plants"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        let options = &self.state.options;
        self.shapes = Shapes::grow(options, growth.moment.seed)?;
        let ids = growth.identities(options.count)?;
        let sites = options.habitat.sites(&ids, &[options.room], growth, PLACE);
        let root = |(id, site)| Plant::root(id, site, options, growth.moment.random(id, LOOK));
        self.state.plants = ids.into_iter().zip(sites).map(root).collect();
        self.state.seed = growth.moment.seed;
        Ok(())
    }

    fn obey(&mut self, order: &Order, growth: &mut Growth) -> Result<()> {
        match *order {
            Order::Number(count) => self.number(count, growth),
            Order::Place { id, position, scale } => {
                let plant = self.state.plants.iter_mut().find(|one| one.id == id);
                let expected = || Error::value("id", id, "a plant of this population");
                let plant = plant.ok_or_else(expected)?;
                plant.position = position;
                plant.size *= scale;
                Ok(())
            }
            _ => Err(no_such_order(self.kind(), order)),
        }
    }

    fn advance(&mut self, view: &View) -> Result<()> {
        let shapes = &self.shapes.variants;
        let points: Vec<Vec3> = self
            .state
            .plants
            .iter()
            .map(|plant| {
                let height = shapes.get(plant.variant as usize).map_or(0.0, |shape| shape.height);
                plant.position + Vec3::Y * (0.6 * height * plant.size)
            })
            .collect();
        let influences = view.environment.influence(&points, view.moment.time)?;
        let passers = Passers::new(view.scene);
        let State { options, plants, .. } = &mut self.state;
        let parameters = &options.parameters;
        let bend = parameters.flexibility * 0.5 * math::PI;
        let answers = plants.par_iter_mut().with_min_len(SHARE).zip(&influences);
        answers.for_each(|(plant, influence)| {
            let shape = shapes.get(plant.variant as usize);
            let (length, height) = shape.map_or((1.0, 1.0), |shape| (shape.length, shape.height));
            let dt = view.moment.dt;
            plant.sway.advance(influence.flow, length * plant.size, dt, parameters);
            let (root, height) = (plant.position, height * plant.size);
            let stem = Stem { root, height, lean: plant.sway.tip(parameters), bend };
            plant.sway.part(passers.aside(&stem) * parameters.parting, dt);
        });
        Ok(())
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        let State { options, plants, .. } = &self.state;
        let species: Arc<str> = Arc::from(options.species.as_str());
        let time = publication.moment.time;
        for (number, shape) in self.shapes.variants.iter().enumerate() {
            let name = free_name(&publication.scene, &format!("{species}/{number}"));
            let material = self.shapes.material.clone();
            let mut batch = Batch::new(name, species.clone(), shape.mesh.clone(), material);
            batch.alive = true;
            let own: Vec<&Plant> =
                plants.iter().filter(|one| one.variant as usize == number).collect();
            batch.ids = own.iter().map(|one| one.id).collect();
            batch.tints = own.iter().map(|one| one.tint).collect();
            let place = |one: &&Plant| {
                Transform::new(one.position, Quat::from_rotation_y(one.yaw), one.size)
            };
            batch.transforms = own.iter().map(place).collect();
            let joints = shape.joints.len();
            if joints > 0 {
                batch.poses = vec![Transform::IDENTITY; joints * own.len()];
                let poses = batch.poses.par_chunks_mut(joints).with_min_len(SHARE);
                poses.zip(&own).for_each(|(poses, plant)| {
                    plant.write_poses(shape, &options.parameters, time, poses);
                });
            }
            publication.scene.batches.push(batch);
        }
        Ok(())
    }

    fn count(&self) -> usize {
        self.state.plants.len()
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(&self.state))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        let state = read(bytes)?;
        let shaping = |state: &State| {
            // How plants answer the flow does not change their shapes.
            let parameters = PlantsParameters::default();
            (PlantsOptions { parameters, ..state.options.clone() }, state.seed)
        };
        if shaping(&state) != shaping(&self.state) {
            self.shapes = Shapes::grow(&state.options, state.seed)?;
        }
        self.state = state;
        Ok(())
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.state.options.parameters)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.state.options.parameters)
    }

    fn inspect(&self, individual: Id) -> Option<Inspection> {
        let plant = self.state.plants.iter().find(|one| one.id == individual)?;
        let lean = plant.sway.tip(&self.state.options.parameters).length().to_degrees();
        let height = self.shape(plant).map_or(0.0, |shape| shape.height) * plant.size;
        let values = BTreeMap::from([
            (String::from("height_m"), height.into()),
            (String::from("lean_deg"), lean.into()),
        ]);
        let species = self.state.options.species.clone();
        Some(Inspection { species, values, ..Inspection::default() })
    }

    fn default_name(&self) -> String {
        self.state.options.species.clone()
    }
}
