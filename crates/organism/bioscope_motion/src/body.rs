use std::collections::BTreeMap;

use bioscope_core::{Intention, Parameters, Random, Result, SoundEvent, Value, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::Transform;

use crate::MuscleSwimmer;

/// One animal's body: moves as its mind wants and its nature permits.
pub trait Body: Send + Sync {
    /// Word under which saved worlds find the constructor: `swimmer`.
    fn kind(&self) -> &str;

    /// Moves and grows by `dt` seconds as the mind intends, under what acts at its place.
    fn advance(&mut self, intention: &Intention, influence: &Influence, dt: f32) -> Result<()>;

    /// The same body if muscles drive it, so that many are advanced side by side with
    /// [`MuscleSwimmer::advance_together`].
    fn muscles(&mut self) -> Option<&mut MuscleSwimmer> {
        None
    }

    /// Where it is, how it is turned (+Z ahead, +X left, +Y up) and how its mesh is scaled.
    fn placement(&self) -> Transform;

    /// Sets it down at a place in metres, looking along `heading`, at rest.
    fn put(&mut self, position: Vec3, heading: Vec3);

    /// Makes it differ from its kin, once, before it lives: by up to `variation` of its size, and in
    /// the phase of its motion.
    fn vary(&mut self, _variation: f32, _random: &mut Random) {}

    /// Moves it by this many metres out of something that it has run into.
    fn shift(&mut self, offset: Vec3);

    /// Velocity over ground, metres per second.
    fn velocity(&self) -> Vec3;

    /// Length in metres.
    fn length(&self) -> f32;

    /// How many joints it poses; none if it is rigid.
    fn joint_count(&self) -> usize {
        0
    }

    /// Writes the poses of its joints in mesh space; `out` has [`joint_count`](Self::joint_count)
    /// entries.
    fn pose(&self, _out: &mut [Transform]) {}

    /// Adds the noises it made in the last step; whoever runs it fills in source and time.
    fn sounds(&self, _out: &mut Vec<SoundEvent>) {}

    /// Energy spent since it came to be, in joules per kilogram of body.
    fn energy_spent(&self) -> f32 {
        0.0
    }

    /// Live values for the inspector, units in the names.
    fn values(&self) -> BTreeMap<String, Value> {
        BTreeMap::new()
    }

    /// Tunable numbers, if it has any.
    fn parameters(&self) -> Option<&dyn Parameters> {
        None
    }

    /// Tunable numbers for changing.
    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        None
    }

    /// Complete state, parameters included, as bytes.
    fn save(&self) -> Result<Vec<u8>>;
}
