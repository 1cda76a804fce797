use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Id, Parameters, Purpose, Result, Value, Vec3, state};
use bioscope_geometry::Material;
use bioscope_lsystem::{Environment, Palette};
use bioscope_world::{Growth, Inspection, Population, Publication, View};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::StandOptions;
use super::falling::Falling;
use super::field::Sight;
use super::growing::News;
use super::look::{Form, Look};
use super::model::{Models, environment, missing};
use super::plant::Plant;
use super::show::Shared;
use super::space::Space;

const PLACE: Purpose = Purpose::new("stand place");
/// Plants that one thread takes at a time.
const SHARE: usize = 16;

/// A stand of growing plants.
pub struct Stand {
    pub(super) state: State,
    pub(super) models: Models,
    /// After how many steps a plant is complete.
    pub(super) steps: u64,
    pub(super) environment: Option<Box<dyn Environment>>,
    /// What is seen of each plant; none where it has changed.
    pub(super) looks: Vec<Option<Look>>,
    pub(super) shared: Shared,
    /// What is seen of the surroundings.
    pub(super) sights: Vec<Sight>,
}

#[derive(Clone, Serialize, Deserialize)]
pub(super) struct State {
    pub options: StandOptions,
    pub space: Space,
    /// Steps of the stand, complete ones.
    pub step: u64,
    /// How much of the present step is done, 0 to 1.
    pub part: f64,
    /// How many plants have been rewritten in it.
    pub done: usize,
    /// In the order of their identities.
    pub plants: Vec<Plant>,
    pub falling: Vec<Falling>,
    /// What happened in the last tick.
    pub news: Vec<News>,
    /// Identity of what is seen of the surroundings.
    pub surroundings: Option<Id>,
}

impl Stand {
    /// A stand of these options. Texts and environment are read at once, so that errors in them are reported here.
    pub fn new(options: StandOptions) -> Result<Self> {
        let environment = environment(&options)?;
        Self::in_environment(options, environment)
    }

    /// A stand in this environment, whatever its texts ask for. One that is none of the engine's must be called
    /// `foreign` in the options.
    pub fn in_environment(
        options: StandOptions,
        environment: Option<Box<dyn Environment>>,
    ) -> Result<Self> {
        let space = Space { origin: Vec3::ZERO, size: options.size, lying: options.lying };
        let (plants, falling, news) = (Vec::new(), Vec::new(), Vec::new());
        let state = State {
            options,
            space,
            step: 0,
            part: 0.0,
            done: 0,
            plants,
            falling,
            news,
            surroundings: None,
        };
        Self::with(state, environment)
    }

    /// A stand in a state that `save` gave; `revive` brings an environment back that is none of the engine's.
    pub fn from_saved(
        bytes: &[u8],
        revive: impl FnOnce(&str) -> Result<Box<dyn Environment>>,
    ) -> Result<Self> {
        let (state, memory): (State, Vec<u8>) = state::from_bytes("stand", bytes)?;
        let mut own = match state.options.foreign() {
            Some(name) => Some(revive(name)?),
            None => environment(&state.options)?,
        };
        if let Some(environment) = own.as_mut().filter(|_| !memory.is_empty()) {
            environment.recall(&memory)?;
        }
        let mut stand = Self::with(state, own)?;
        stand.look_again()?;
        stand.look_around();
        stand.share();
        Ok(stand)
    }

    fn with(state: State, environment: Option<Box<dyn Environment>>) -> Result<Self> {
        state.options.check()?;
        let models = Models::read(&state.options)?;
        for plant in &state.plants {
            plant.progress.check(&models.of(plant.source).system)?;
        }
        let own = models.list[0].system.derivation_length();
        let steps = state.options.steps.unwrap_or(u64::from(own));
        let shared = shared(&state.options, &models);
        let looks = state.plants.iter().map(|_| None).collect();
        Ok(Self { state, models, steps, environment, looks, shared, sights: Vec::new() })
    }

    fn found(&self, individual: Id) -> Option<(&Plant, Option<&Look>)> {
        let plants = &self.state.plants;
        let number = plants.binary_search_by_key(&individual, |plant| plant.id).ok()?;
        Some((&plants[number], self.looks[number].as_ref()))
    }
}

fn shared(options: &StandOptions, models: &Models) -> Shared {
    let material = |name: &str, translucency: f32| {
        Arc::new(Material {
            name: format!("{} {name}", options.species),
            color: [1.0; 3],
            roughness: options.roughness,
            translucency,
            two_sided: true,
            ..Material::default()
        })
    };
    // Its tint gives litter its color.
    let form = Form { name: 'l', color: 0, texture: 0, proportions: [16, 2] };
    let white = Palette::new(vec![[1.0; 3]]);
    Shared {
        wood: material("wood", 0.0),
        leaves: material("leaves", options.translucency),
        forms: BTreeMap::new(),
        litter: Arc::new(form.mesh(&models.list[0].turtle.shapes, &white)),
    }
}

impl Population for Stand {
    fn kind(&self) -> &str {
        "stand"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        let options = &self.state.options;
        let places: Vec<Id> = growth.identities(options.count)?;
        let sites = options.habitat.sites(&places, &[options.room], growth, PLACE);
        let sites: Vec<Vec3> = sites.into_iter().map(|site| site.position).collect();
        let middle = sites.iter().sum::<Vec3>() / sites.len().max(1) as f32;
        self.state.space.origin = options.origin.map_or(middle, Vec3::from_array);
        let start = options.start;
        let sources: Vec<u32> = (0..sites.len() as u32).collect();
        self.plant(&sites, &sources, growth)?;
        self.exchange()?;
        self.go_on(start as f64, growth)?;
        self.state.news.clear();
        if !self.state.options.levels.is_empty() {
            self.state.surroundings = growth.identities(1)?.first().copied();
        }
        self.look_again()?;
        self.look_around();
        self.share();
        Ok(())
    }

    fn advance(&mut self, view: &View) -> Result<()> {
        let size = self.state.options.size;
        let plants = &self.state.plants;
        let height = |look: &Option<Look>| look.as_ref().map_or(0.0, |look| look.height) * size;
        let points = plants.iter().zip(&self.looks);
        let points: Vec<Vec3> =
            points.map(|(plant, look)| plant.position + Vec3::Y * (0.7 * height(look))).collect();
        let influences = view.environment.influence(&points, view.moment.time)?;
        let sway = self.state.options.parameters.sway();
        let plants = self.state.plants.par_iter_mut().with_min_len(SHARE);
        plants.zip(&self.looks).zip(&influences).for_each(|((plant, look), influence)| {
            let length = look.as_ref().map_or(1.0, |look| look.length) * size;
            plant.sway.advance(influence.flow, length, view.moment.dt, &sway);
        });
        Ok(())
    }

    fn grow(&mut self, growth: &mut Growth) -> Result<()> {
        self.state.news.clear();
        self.lose_branches(growth)?;
        self.clear_ground(growth.moment.time);
        let rate = self.state.options.parameters.rate;
        let step = self.state.step;
        self.go_on(f64::from(rate) * f64::from(growth.moment.dt), growth)?;
        self.look_again()?;
        if self.state.step != step {
            self.look_around();
        }
        self.share();
        Ok(())
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        self.show(publication);
        Ok(())
    }

    fn count(&self) -> usize {
        self.state.plants.len()
    }

    fn save(&self) -> Result<Vec<u8>> {
        let memory = self.environment.as_ref().map(|one| one.memory()).transpose()?;
        let memory = memory.unwrap_or_default();
        Ok(state::to_bytes(&(&self.state, memory)))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        let own = self.environment.take();
        // One that is none of the engine's goes on.
        *self = Self::from_saved(bytes, |name| own.ok_or_else(|| missing(name)))?;
        Ok(())
    }

    fn may_fail(&self) -> bool {
        self.state.options.foreign().is_some()
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.state.options.parameters)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.state.options.parameters)
    }

    fn inspect(&self, individual: Id) -> Option<Inspection> {
        let (plant, look) = self.found(individual)?;
        let look = look?;
        let lean = plant.sway.tip(&self.state.options.parameters.sway()).length().to_degrees();
        let values = [
            ("height_m", f64::from(look.height * self.state.options.size)),
            ("lean_deg", f64::from(lean)),
            ("steps", plant.progress.step() as f64),
            ("segments", look.segments as f64),
            ("leaves", look.leaves.len() as f64),
        ];
        let values = values.map(|(name, value)| (name.to_owned(), value.into())).into();
        let species = self.state.options.species.clone();
        Some(Inspection { species, values, ..Inspection::default() })
    }

    fn values(&self, name: &str) -> Option<Vec<Value>> {
        let size = self.state.options.size;
        let value = |(plant, look): (&Plant, &Option<Look>)| {
            let seen = |figure: fn(&Look) -> f32| f64::from(look.as_ref().map_or(0.0, figure));
            Some(match name {
                "height_m" => (seen(|look| look.height) * f64::from(size)).into(),
                "segments" => seen(|look| look.segments as f32).into(),
                "leaves" => seen(|look| look.leaves.len() as f32).into(),
                "steps" => (plant.progress.step() as f64).into(),
                "id" => f64::from(plant.id).into(),
                "position" => Value::Numbers(plant.position.to_array().map(f64::from).to_vec()),
                "string" => {
                    let system = &self.models.of(plant.source).system;
                    Value::Text(plant.progress.string(system).to_string())
                }
                _ => return None,
            })
        };
        self.state.plants.iter().zip(&self.looks).map(value).collect()
    }

    fn statistics(&self) -> BTreeMap<String, f64> {
        let looks = || self.looks.iter().flatten();
        let size = f64::from(self.state.options.size);
        let tallest = looks().map(|look| f64::from(look.height)).fold(0.0, f64::max);
        let sum = |figure: fn(&Look) -> usize| looks().map(figure).sum::<usize>() as f64;
        BTreeMap::from([
            (String::from("count"), self.count() as f64),
            (String::from("tallest_m"), tallest * size),
            (String::from("segments"), sum(|look| look.segments)),
            (String::from("leaves"), sum(|look| look.leaves.len())),
            (String::from("step"), self.state.step as f64),
        ])
    }

    fn default_name(&self) -> String {
        self.state.options.species.clone()
    }
}
