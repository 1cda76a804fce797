use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Error, Event, Id, Parameter, Parameters, Result, SoundEvent, Value};
use bioscope_dynamics::Field;
use bioscope_geometry::{Rig, Scene};

use crate::{
    Change, Common, Environment, Growth, Input, Inspection, Moment, Order, Population, Recording,
    View,
};

/// One world: time, environment and everything that lives in it.
///
/// All parts are open to the reader; change parameters through [`set`](Self::set), so that the
/// change is recorded.
pub struct World {
    pub(crate) seed: u64,
    pub(crate) dt: f64,
    pub(crate) tick: u64,
    /// A tick and its world time in seconds: from there on ticks have had their present length.
    pub(crate) epoch: (u64, f64),
    /// Terrain, medium, light, fields.
    pub environment: Environment,
    pub(crate) populations: Vec<Resident>,
    /// Points of view the world offers, the first being the main one.
    pub rigs: Vec<Rig>,
    /// The film this world suggests: names of rigs and seconds to stay with each.
    pub shots: Vec<(String, f32)>,
    /// What the world is called.
    pub title: String,
    pub(crate) next_id: Id,
    pub(crate) scene: Arc<Scene>,
    pub(crate) sounds: Vec<SoundEvent>,
    /// What happened in the last tick.
    pub(crate) latest: Vec<Event>,
    /// What has happened since the start, or since an observer took it.
    pub(crate) events: Vec<Event>,
    recorder: Option<Recorder>,
    common: Common,
}

/// A population under its name in the world.
pub struct Resident {
    /// Unique name in the world.
    pub name: String,
    /// The population.
    pub population: Box<dyn Population>,
}

struct Recorder {
    start: Vec<u8>,
    inputs: Vec<Input>,
}

/// Owner name of the environment's parameters.
const ENVIRONMENT: &str = "environment";
/// Owner name of the world's own parameter.
const WORLD: &str = "world";

/// The length of a tick as a parameter.
fn time_step() -> Parameter {
    Parameter {
        name: String::from("time_step"),
        unit: String::from("s"),
        minimum: 1e-4,
        maximum: 10.0,
        default: 1.0 / 60.0,
        meaning: String::from("Length of a tick; shorter ones follow motion more exactly."),
        source: String::from("choice"),
    }
}

impl World {
    /// An empty world; `dt` is the length of a tick in seconds.
    pub fn new(seed: u64, dt: f64) -> Result<Self> {
        if !(dt.is_finite() && dt > 0.0 && dt <= 10.0) {
            return Err(Error::value("dt", dt, "seconds per tick, above 0 and up to 10"));
        }
        Ok(Self {
            seed,
            dt,
            tick: 0,
            epoch: (0, 0.0),
            environment: Environment::default(),
            populations: Vec::new(),
            rigs: Vec::new(),
            shots: Vec::new(),
            title: String::from("world"),
            next_id: 1,
            scene: Arc::default(),
            sounds: Vec::new(),
            latest: Vec::new(),
            events: Vec::new(),
            recorder: None,
            common: Common::default(),
        })
    }

    /// Seed of all randomness in this world.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Seconds per tick.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Ticks made so far.
    pub fn tick_count(&self) -> u64 {
        self.tick
    }

    /// World time in seconds.
    pub fn time(&self) -> f64 {
        self.time_at(self.tick)
    }

    /// World time of a tick, if ticks keep their present length.
    fn time_at(&self, tick: u64) -> f64 {
        let (since, time) = self.epoch;
        time + (tick as f64 - since as f64) * self.dt
    }

    /// What the last tick published.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// What sounded in the last tick.
    pub fn sounds(&self) -> &[SoundEvent] {
        &self.sounds
    }

    /// What has happened since the world was made, restored or last drained.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Takes the events out, for observers that store them elsewhere.
    pub fn drain_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// The populations in the order of their verbs.
    pub fn populations(&self) -> &[Resident] {
        &self.populations
    }

    /// Lets a population live here, under `name` or one made from its own default name; returns the
    /// name.
    pub fn add(
        &mut self,
        mut population: Box<dyn Population>,
        name: Option<&str>,
    ) -> Result<String> {
        let name = self.free_name(name, &population.default_name())?;
        let kind = population.kind().to_owned();
        let state = if self.recorder.is_some() { population.save()? } else { Vec::new() };
        let moment = self.moment(self.tick);
        let mut growth = Growth {
            moment,
            scene: &self.scene,
            events: &self.latest,
            environment: &mut self.environment,
            next_id: &mut self.next_id,
        };
        population.settle(&mut growth)?;
        self.populations.push(Resident { name: name.clone(), population });
        self.note(Change::Add { name: name.clone(), kind, state });
        self.publish()?;
        Ok(name)
    }

    /// Adds something that acts at a distance, under `name` or its kind; returns the name.
    pub fn add_field(&mut self, field: Box<dyn Field>, name: Option<&str>) -> Result<String> {
        let name = self.free_name(name, field.kind())?;
        self.environment.fields.push((name.clone(), field));
        Ok(name)
    }

    fn free_name(&self, wanted: Option<&str>, default: &str) -> Result<String> {
        let taken = |name: &str| self.owner(name).is_ok() || self.has(name);
        if let Some(name) = wanted {
            if taken(name) || name.is_empty() {
                return Err(Error::value("name", name, "a name that nothing else has"));
            }
            return Ok(name.to_owned());
        }
        let numbered = (2..).map(|number| format!("{default}-{number}"));
        let mut names = std::iter::once(default.to_owned()).chain(numbered);
        Ok(names.find(|name| !taken(name)).expect("names are endless"))
    }

    fn has(&self, name: &str) -> bool {
        self.populations.iter().any(|one| one.name == name)
            || self.environment.fields.iter().any(|(field, _)| field == name)
    }

    pub(crate) fn moment(&self, tick: u64) -> Moment {
        Moment { seed: self.seed, tick, time: self.time_at(tick), dt: self.dt as f32 }
    }

    pub(crate) fn view(&self, moment: Moment) -> View<'_> {
        View {
            moment,
            scene: &self.scene,
            sounds: &self.sounds,
            events: &self.latest,
            environment: &self.environment,
            common: &self.common,
        }
    }

    /// Everything that has parameters, by name, with descriptions and current values.
    pub fn parameters(&self) -> BTreeMap<String, Vec<(Parameter, f64)>> {
        let with_values = |parameters: &dyn Parameters| {
            let descriptions = parameters.descriptions().into_iter();
            descriptions
                .filter_map(|one| parameters.get(&one.name).map(|value| (one, value)))
                .collect::<Vec<_>>()
        };
        let mut all =
            BTreeMap::from([(ENVIRONMENT.to_owned(), with_values(&self.environment.parameters))]);
        all.insert(WORLD.to_owned(), vec![(time_step(), self.dt)]);
        for (name, field) in &self.environment.fields {
            all.extend(field.parameters().map(|one| (name.clone(), with_values(one))));
        }
        for resident in &self.populations {
            let parameters = resident.population.parameters();
            all.extend(parameters.map(|one| (resident.name.clone(), with_values(one))));
        }
        all
    }

    fn owner(&self, name: &str) -> Result<()> {
        let known: Vec<String> = self.parameters().into_keys().collect();
        if known.iter().any(|one| one == name) {
            Ok(())
        } else {
            Err(Error::Unknown { kind: "owner of parameters", name: name.to_owned(), known })
        }
    }

    /// Sets a parameter of a population, a field, the `environment` or the `world` between two ticks.
    pub fn set(&mut self, owner: &str, name: &str, value: f64) -> Result<()> {
        self.owner(owner)?;
        if owner == WORLD {
            self.set_own(name, value)?;
        }
        let fields = self.environment.fields.iter_mut();
        let populations = self.populations.iter_mut();
        let parameters = if owner == ENVIRONMENT {
            Some(&mut self.environment.parameters as &mut dyn Parameters)
        } else {
            let mut found = fields
                .filter(|(field, _)| field == owner)
                .filter_map(|(_, field)| field.parameters_mut())
                .chain(
                    populations
                        .filter(|one| one.name == owner)
                        .filter_map(|one| one.population.parameters_mut()),
                );
            found.next()
        };
        if let Some(parameters) = parameters {
            parameters.set(name, value)?;
        }
        self.note(Change::Set { owner: owner.to_owned(), name: name.to_owned(), value });
        self.publish_again()
    }

    fn set_own(&mut self, name: &str, value: f64) -> Result<()> {
        let known = time_step();
        if name != known.name {
            let (name, known) = (name.to_owned(), vec![known.name]);
            return Err(Error::Unknown { kind: "parameter", name, known });
        }
        known.check(value)?;
        self.epoch = (self.tick, self.time());
        self.dt = value;
        Ok(())
    }

    /// Tells a population something between two ticks.
    pub fn order(&mut self, population: &str, order: &Order) -> Result<()> {
        order.check()?;
        let moment = self.moment(self.tick);
        let known = || self.populations.iter().map(|one| one.name.clone()).collect();
        let Some(index) = self.populations.iter().position(|one| one.name == population) else {
            let (name, known) = (population.to_owned(), known());
            return Err(Error::Unknown { kind: "population", name, known });
        };
        let mut growth = Growth {
            moment,
            scene: &self.scene,
            events: &self.latest,
            environment: &mut self.environment,
            next_id: &mut self.next_id,
        };
        self.populations[index].population.obey(order, &mut growth)?;
        self.note(Change::Order { population: population.to_owned(), order: order.clone() });
        self.publish_again()
    }

    /// Keeps a change from outside, if changes are recorded.
    fn note(&mut self, change: Change) {
        if let Some(recorder) = &mut self.recorder {
            recorder.inputs.push(Input { tick: self.tick, change });
        }
    }

    /// Inner life of one individual, with the name of its population.
    pub fn inspect(&self, individual: Id) -> Option<(&str, Inspection)> {
        self.populations
            .iter()
            .find_map(|one| Some((one.name.as_str(), one.population.inspect(individual)?)))
    }

    /// One value of the inner life of every individual of a population; none if there is no such population
    /// or value.
    pub fn values(&self, population: &str, name: &str) -> Option<Vec<Value>> {
        let found = self.populations.iter().find(|one| one.name == population)?;
        found.population.values(name)
    }

    /// Figures of all populations for charts, as `population.figure`.
    pub fn statistics(&self) -> BTreeMap<String, f64> {
        let figures = self.populations.iter().flat_map(|one| {
            let figures = one.population.statistics().into_iter();
            figures.map(|(figure, value)| (format!("{}.{figure}", one.name), value))
        });
        figures.collect()
    }

    /// Begins to record: from now on every change from outside is kept.
    pub fn record(&mut self) -> Result<()> {
        self.recorder = Some(Recorder { start: self.save()?, inputs: Vec::new() });
        Ok(())
    }

    /// The run since [`record`](Self::record); none if it was not called.
    pub fn recording(&self) -> Option<Recording> {
        let recorder = self.recorder.as_ref()?;
        Some(Recording {
            start: recorder.start.clone(),
            inputs: recorder.inputs.clone(),
            end: self.tick,
        })
    }
}
