use bioscope_core::Vec3;
use bioscope_geometry::{Obstacle, Terrain};

/// Everything around a flock that it may react to: the world as of the last tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surroundings<'a> {
    /// World time in seconds; by it slow whims are timed.
    pub time: f64,
    /// Solids to steer round.
    pub obstacles: &'a [Obstacle],
    /// What to flee from.
    pub threats: &'a [Threat],
    /// Ground to stay above.
    pub terrain: Option<&'a Terrain>,
    /// Height of a ceiling to stay below, such as the water's surface, metres.
    pub surface: Option<f32>,
    /// Where to migrate.
    pub goal: Option<Goal>,
    /// Where to stay.
    pub home: Option<Home>,
    /// Velocity of the medium at each individual, metres per second, in the order of the flock;
    /// empty for a medium at rest.
    pub flow: &'a [Vec3],
}

/// Something to flee from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threat {
    /// Where it is, metres.
    pub position: Vec3,
    /// How it moves, metres per second.
    pub velocity: Vec3,
}

/// Where all migrate; may change from tick to tick, as a script wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Towards this point, metres.
    Point(Vec3),
    /// In this direction, any length but zero.
    Direction(Vec3),
}

/// A ball to which all return when they have left it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Home {
    /// Its middle, metres.
    pub center: Vec3,
    /// Its radius, metres.
    pub radius: f32,
}
