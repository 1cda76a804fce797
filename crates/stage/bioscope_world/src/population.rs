use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Error, Event, Id, Parameters, Purpose, Random, Result, SoundEvent, Value};
use bioscope_geometry::{Camera, Scene};

use crate::{Common, Environment, Order, Publication};

/// The one contract that the tick knows: a batch of individuals that implements the five verbs.
///
/// In every tick each verb is called on every population before the next verb begins, in the order
/// in which the populations were added. `sense` and `decide` see only the scene, sounds and fields
/// that the previous tick published. A verb that fails ends the tick and leaves the world at the
/// last complete one. Verbs do nothing unless written: scenery only publishes.
pub trait Population: Send {
    /// Word under which saved worlds find the constructor: `plants`, `fish_school`.
    fn kind(&self) -> &str;

    /// Takes its place in a world: asks for identities, puts individuals where the ground is.
    /// Called once, when it is added; not after a restore.
    fn settle(&mut self, growth: &mut Growth) -> Result<()>;

    /// Notices what there is to notice.
    fn sense(&mut self, _view: &View) -> Result<()> {
        Ok(())
    }

    /// Turns percepts into intentions and motor commands.
    fn decide(&mut self, _view: &View) -> Result<()> {
        Ok(())
    }

    /// Moves the bodies by one tick.
    fn advance(&mut self, _view: &View) -> Result<()> {
        Ok(())
    }

    /// Births, deaths, rewriting, exchange with the environment.
    fn grow(&mut self, _growth: &mut Growth) -> Result<()> {
        Ok(())
    }

    /// Shows itself: a pure function of the state, so that it can be repeated after a restore.
    fn publish(&self, publication: &mut Publication) -> Result<()>;

    /// How many individuals there are.
    fn count(&self) -> usize;

    /// Complete state as bytes; equal states give equal bytes.
    fn save(&self) -> Result<Vec<u8>>;

    /// Goes back to a state that [`save`](Self::save) gave.
    fn restore(&mut self, bytes: &[u8]) -> Result<()>;

    /// Tunable numbers, if it has any.
    fn parameters(&self) -> Option<&dyn Parameters> {
        None
    }

    /// Tunable numbers for changing.
    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        None
    }

    /// Obeys an order from outside, between two ticks. One that is refused changes nothing.
    fn obey(&mut self, order: &Order, _growth: &mut Growth) -> Result<()> {
        Err(no_such_order(self.kind(), order))
    }

    /// Inner life of one individual; none if it is not of this population.
    fn inspect(&self, _individual: Id) -> Option<Inspection> {
        None
    }

    /// One value of the inner life of every individual, in the order of its identities; none if they have
    /// nothing of this name.
    fn values(&self, _name: &str) -> Option<Vec<Value>> {
        None
    }

    /// Figures for charts, by name (with the unit in the name where there is one).
    fn statistics(&self) -> BTreeMap<String, f64> {
        BTreeMap::from([(String::from("count"), self.count() as f64)])
    }

    /// Whether a verb may fail for reasons of its own (code of the user's), so that the tick must be
    /// undoable.
    fn may_fail(&self) -> bool {
        false
    }

    /// Name it is given if the user gives none.
    fn default_name(&self) -> String {
        self.kind().to_owned()
    }
}

/// The refusal of an order that makes no sense for a population of this kind.
pub fn no_such_order(kind: &str, order: &Order) -> Error {
    Error::value("order", format!("{order:?}"), format!("an order that {kind} can obey"))
}

/// The present moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Seed of the world.
    pub seed: u64,
    /// Number of the tick that is being made; the first is 1.
    pub tick: u64,
    /// World time at its end, in seconds.
    pub time: f64,
    /// Length of the tick in seconds.
    pub dt: f32,
}

impl Moment {
    /// Random numbers of one individual in this tick.
    pub fn random(&self, individual: Id, purpose: Purpose) -> Random {
        Random::new(self.seed, individual, self.tick, purpose)
    }
}

/// What the populations may read while they sense, decide and move: the past.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// Now.
    pub moment: Moment,
    /// What the previous tick published.
    pub scene: &'a Arc<Scene>,
    /// What sounded in the previous tick.
    pub sounds: &'a [SoundEvent],
    /// What happened in the previous tick.
    pub events: &'a [Event],
    /// Terrain, water, light, fields.
    pub environment: &'a Environment,
    /// What populations work out together.
    pub common: &'a Common,
}

/// What the populations may do while they grow, one after the other.
pub struct Growth<'a> {
    /// Now.
    pub moment: Moment,
    /// What the previous tick published.
    pub scene: &'a Arc<Scene>,
    /// What happened in the previous tick: who was bitten, what was shed.
    pub events: &'a [Event],
    /// Terrain, water, light, fields.
    pub environment: &'a mut Environment,
    pub(crate) next_id: &'a mut Id,
}

impl Growth<'_> {
    /// `count` identities that nothing else in this world has or ever had.
    pub fn identities(&mut self, count: usize) -> Result<Vec<Id>> {
        let available = (Id::MAX - *self.next_id) as usize;
        if count > available {
            return Err(Error::Limit {
                what: format!("{count} more individuals"),
                limit: format!("{} in the life of a world", Id::MAX),
            });
        }
        let first = *self.next_id;
        *self.next_id += count as Id;
        Ok((first..*self.next_id).collect())
    }
}

/// What can be known of one individual.
#[derive(Clone, Debug, Default)]
pub struct Inspection {
    /// Its species.
    pub species: String,
    /// The behavior it follows now, if it has any.
    pub behavior: Option<String>,
    /// Live values of its body and mind, units in the names.
    pub values: BTreeMap<String, Value>,
    /// Its own values of the population's parameters, where individuals may differ in them.
    pub traits: BTreeMap<String, f64>,
    /// What it notices.
    pub percepts: BTreeMap<String, Value>,
    /// Through which it sees, if it sees.
    pub eye: Option<Camera>,
}
