use std::sync::Arc;

use bioscope_core::{Error, Event, Id, Purpose, Random, Result, Vec3, math, parameters, state};
use bioscope_geometry::Points;
use bioscope_world::{
    Environment, Growth, Moment, Order, Population, Publication, View, no_such_order,
};
use serde::{Deserialize, Serialize};

use crate::bites::{EATEN, Gone, bitten};
use crate::kept::{parameters_in, saved_as_state};
use crate::names::free_name;
use crate::suction::Mouths;

const BIRTH: Purpose = Purpose::new("plankton birth");
const SWIM: Purpose = Purpose::new("plankton swim");
const ENTRY: Purpose = Purpose::new("plankton entry");
/// Most drifters of one population.
const LARGEST_COUNT: usize = 1_000_000;
/// Places on the faces of the box at which the inflow is looked at in each tick.
const ENTRIES: usize = 64;
/// Time in seconds after which a drifter's own motion has changed its direction.
const SWIM_MEMORY: f32 = 1.5;
/// Time in seconds in which the water stops one that a mouth has drawn: a small thing has hardly any way on it (choice).
const STOPPING: f32 = 0.1;
/// Distance in metres that is kept from the ground and from the surface.
const CLEARANCE: f32 = 0.02;

parameters! {
    /// How plankton drifts.
    pub struct PlanktonParameters {
        /// Share of the current's speed that it takes on.
        drift: f32 = 1.0, "1", 0.0..=2.0, "choice";
        /// Speed of its own slow, aimless motion.
        swimming: f32 = 0.012, "m/s", 0.0..=0.5, "copepods: a few lengths of 1 to 2 mm a second";
    }
}

/// Where how much plankton lives, and how it looks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PlanktonOptions {
    /// Its species in the scene.
    pub species: Arc<str>,
    /// How many.
    pub count: usize,
    /// Least corner of the box of water it lives in, metres.
    pub low: Vec3,
    /// Greatest corner, metres.
    pub high: Vec3,
    /// Least and greatest radius, metres.
    pub radius: [f32; 2],
    /// Linear color.
    pub color: [f32; 3],
    /// 0 (invisible) to 1 (solid).
    pub opacity: f32,
    /// How it drifts.
    pub parameters: PlanktonParameters,
}

impl Default for PlanktonOptions {
    fn default() -> Self {
        Self {
            species: "plankton".into(),
            count: 1800,
            low: Vec3::new(-9.0, -9.0, -8.0),
            high: Vec3::new(9.0, -0.2, 10.0),
            radius: [0.0012, 0.0042],
            color: [0.72, 0.74, 0.6],
            opacity: 0.55,
            parameters: PlanktonParameters::default(),
        }
    }
}

/// Motes of life that the water carries.
pub struct Plankton {
    state: State,
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    options: PlanktonOptions,
    drifters: Vec<Drifter>,
    /// Those that were eaten in this tick.
    eaten: Vec<Gone>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
struct Drifter {
    id: Id,
    position: Vec3,
    /// Own motion through the water, metres per second.
    swimming: Vec3,
    /// Motion through the water that open mouths have given it, metres per second.
    drawn: Vec3,
    radius: f32,
    /// Whether it has left the box, or was eaten, in this tick.
    gone: bool,
}

impl Plankton {
    /// Plankton of these options; refuses boxes and sizes that make no sense.
    pub fn new(options: PlanktonOptions) -> Result<Self> {
        check(&options)?;
        Ok(Self { state: State { options, drifters: Vec::new(), eaten: Vec::new() } })
    }

    /// Plankton in a state that `save` gave.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state: State = state::from_bytes("plankton", bytes)?;
        check(&state.options)?;
        Ok(Self { state })
    }

    /// Where each drifter is, metres.
    pub fn positions(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.state.drifters.iter().map(|one| one.position)
    }

    /// Lets newcomers come to live anywhere in the box.
    fn settle_more(&mut self, count: usize, growth: &mut Growth) -> Result<()> {
        let options = &self.state.options;
        let size = options.high - options.low;
        for id in growth.identities(count)? {
            let mut random = growth.moment.random(id, BIRTH);
            let place = |random: &mut Random| {
                let share = Vec3::new(random.uniform(), random.uniform(), random.uniform());
                options.low + size * share
            };
            // A place below the ground is drawn again, so that the water above is not crowded.
            let free = |point: &Vec3| in_water(*point, growth.environment) == *point;
            let mut draws = (0..16).map(|_| place(&mut random));
            let point = draws.find(free).unwrap_or(options.low + 0.5 * size);
            let position = in_water(point, growth.environment);
            self.state.drifters.push(Drifter::born(id, position, options, &mut random));
        }
        Ok(())
    }

    /// Lets go of those that were bitten.
    fn be_eaten(&mut self, events: &[Event]) {
        let biters = bitten(events);
        self.state.eaten.clear();
        if biters.is_empty() {
            return;
        }
        for drifter in &mut self.state.drifters {
            if let Some(&into) = biters.get(&drifter.id) {
                drifter.gone = true;
                self.state.eaten.push(Gone {
                    who: drifter.id,
                    into,
                    species: self.state.options.species.clone(),
                });
            }
        }
    }

    /// Replaces those that have left by newcomers where the water flows in.
    fn enter(&mut self, growth: &mut Growth) -> Result<()> {
        let leavers = self.state.drifters.iter().filter(|one| one.gone).count();
        if leavers == 0 {
            return Ok(());
        }
        let ids = growth.identities(leavers)?;
        let entries = self.entries(growth.environment, growth.moment)?;
        let options = &self.state.options;
        let gone = self.state.drifters.iter_mut().filter(|one| one.gone);
        for (drifter, id) in gone.zip(ids) {
            let mut random = growth.moment.random(id, BIRTH);
            let place = entries.choose(random.uniform());
            let inward = place.velocity * (growth.moment.dt * random.uniform());
            let position = (place.position + inward).clamp(options.low, options.high);
            let position = in_water(position, growth.environment);
            *drifter = Drifter::born(id, position, options, &mut random);
        }
        Ok(())
    }

    /// Random places on the faces of the box, each with the flux of drifters through it.
    fn entries(&self, environment: &Environment, moment: Moment) -> Result<Entries> {
        let PlanktonOptions { low, high, parameters, .. } = &self.state.options;
        let mut random = moment.random(0, ENTRY);
        let faces = (0..ENTRIES).map(|_| on_face(*low, *high, &mut random)).collect::<Vec<_>>();
        let points = faces.iter().map(|&(point, _)| point).collect::<Vec<_>>();
        let flows = environment.influence(&points, moment.time)?;
        let mut entries = Entries { places: Vec::with_capacity(ENTRIES), total: 0.0 };
        for (&(position, inward), influence) in faces.iter().zip(&flows) {
            let velocity = influence.flow * parameters.drift;
            // A quarter of the mean speed of an aimless motion passes through a face each way.
            let flux = velocity.dot(inward).max(0.0) + 0.25 * parameters.swimming + 1e-6;
            let free = environment.terrain.as_ref().is_none_or(|ground| {
                position.y > ground.height(position.x, position.z) + CLEARANCE
            });
            entries.total += if free { flux } else { flux * 1e-3 };
            entries.places.push(Entry { position, velocity, until: entries.total });
        }
        Ok(entries)
    }
}

/// Places of entry with their cumulated fluxes.
struct Entries {
    places: Vec<Entry>,
    total: f32,
}

struct Entry {
    position: Vec3,
    velocity: Vec3,
    until: f32,
}

impl Entries {
    fn choose(&self, share: f32) -> &Entry {
        let wanted = share * self.total;
        let index = self.places.partition_point(|one| one.until <= wanted);
        &self.places[index.min(self.places.len() - 1)]
    }
}

/// A point uniform on the faces of a box, with the normal that points inward.
fn on_face(low: Vec3, high: Vec3, random: &mut Random) -> (Vec3, Vec3) {
    let size = high - low;
    let areas = [size.y * size.z, size.z * size.x, size.x * size.y];
    let mut choice = random.uniform() * (areas[0] + areas[1] + areas[2]);
    let mut axis = 0;
    while axis < 2 && choice >= areas[axis] {
        choice -= areas[axis];
        axis += 1;
    }
    let share = Vec3::new(random.uniform(), random.uniform(), random.uniform());
    let mut point = low + size * share;
    let mut inward = Vec3::ZERO;
    let at_low = random.uniform() < 0.5;
    point[axis] = if at_low { low[axis] } else { high[axis] };
    inward[axis] = if at_low { 1.0 } else { -1.0 };
    (point, inward)
}

impl Drifter {
    fn born(id: Id, position: Vec3, options: &PlanktonOptions, random: &mut Random) -> Self {
        let [small, large] = options.radius;
        // Small ones are many: the square of a uniform number leans to the lower end.
        let share = random.uniform();
        let radius = math::mix(small, large, share * share);
        let swimming = random.in_ball() * options.parameters.swimming;
        Self { id, position, swimming, drawn: Vec3::ZERO, radius, gone: false }
    }

    fn advance(&mut self, flow: Vec3, parameters: &PlanktonParameters, moment: Moment) {
        let mut random = moment.random(self.id, SWIM);
        let kick = Vec3::new(random.uniform(), random.uniform(), random.uniform()) * 2.0 - 1.0;
        let forget = (moment.dt / SWIM_MEMORY).min(1.0);
        let strength = math::sqrt(3.0 * forget * (2.0 - forget));
        self.swimming =
            self.swimming * (1.0 - forget) + kick * (strength * 0.58 * parameters.swimming);
        self.drawn *= 1.0 - math::relaxation(moment.dt, STOPPING);
        self.position += (flow * parameters.drift + self.swimming + self.drawn) * moment.dt;
    }
}

/// The nearest place in the water: above the ground, below the surface.
fn in_water(mut position: Vec3, environment: &Environment) -> Vec3 {
    if let Some(surface) = environment.medium.surface {
        position.y = position.y.min(surface - CLEARANCE);
    }
    if let Some(ground) = &environment.terrain {
        position.y = position.y.max(ground.height(position.x, position.z) + CLEARANCE);
    }
    position
}

fn check(options: &PlanktonOptions) -> Result<()> {
    let size = options.high - options.low;
    if !(size.is_finite() && size.min_element() > 0.0 && options.low.is_finite()) {
        let found = format!("{} to {}", options.low, options.high);
        return Err(Error::value("low and high", found, "two corners of a box in metres"));
    }
    if options.count > LARGEST_COUNT {
        return Err(Error::value("count", options.count, format!("up to {LARGEST_COUNT}")));
    }
    let [small, large] = options.radius;
    if !(small > 0.0 && small <= large && large <= 10.0) {
        let found = format!("[{small}, {large}]");
        return Err(Error::value("radius", found, "least and greatest radius in metres"));
    }
    Ok(())
}

impl Population for Plankton {
    fn kind(&self) -> &str {
        "plankton"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        self.state.drifters.clear();
        self.settle_more(self.state.options.count, growth)
    }

    fn obey(&mut self, order: &Order, growth: &mut Growth) -> Result<()> {
        let Order::Number(count) = *order else { return Err(no_such_order(self.kind(), order)) };
        check(&PlanktonOptions { count, ..self.state.options.clone() })?;
        let missing = count.saturating_sub(self.count());
        self.settle_more(missing, growth)?;
        self.state.drifters.truncate(count);
        Ok(())
    }

    fn advance(&mut self, view: &View) -> Result<()> {
        let State { options, drifters, .. } = &mut self.state;
        let points = drifters.iter().map(|one| one.position).collect::<Vec<_>>();
        let influences = view.environment.influence(&points, view.moment.time)?;
        let mouths = Mouths::new(&view.scene.mouths);
        for (drifter, influence) in drifters.iter_mut().zip(&influences) {
            let pull = mouths.pull(drifter.id, drifter.position, 2.0 * drifter.radius);
            drifter.drawn += pull * view.moment.dt;
            drifter.advance(influence.flow, &options.parameters, view.moment);
            let inside = drifter.position.clamp(options.low, options.high) == drifter.position;
            drifter.gone = !inside;
            drifter.position = in_water(drifter.position, view.environment);
        }
        Ok(())
    }

    fn grow(&mut self, growth: &mut Growth) -> Result<()> {
        self.be_eaten(growth.events);
        self.enter(growth)
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        let State { options, drifters, eaten } = &self.state;
        publication.scene.points.push(Points {
            name: free_name(&publication.scene, &options.species),
            species: options.species.clone(),
            ids: drifters.iter().map(|one| one.id).collect(),
            positions: drifters.iter().map(|one| one.position).collect(),
            radii: drifters.iter().map(|one| one.radius).collect(),
            color: options.color,
            opacity: options.opacity,
            glassy: false,
        });
        let moment = publication.moment;
        publication.events.extend(eaten.iter().map(|gone| gone.event(EATEN, &moment)));
        Ok(())
    }

    fn count(&self) -> usize {
        self.state.drifters.len()
    }

    saved_as_state!();

    parameters_in!(state.options.parameters);

    fn default_name(&self) -> String {
        self.state.options.species.to_string()
    }
}
