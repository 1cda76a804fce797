use std::sync::Arc;

use bioscope_core::{Error, Result, Vec3, parameters};
use bioscope_crowds::FlockParameters;

use crate::fish::FishSpecies;

/// Most fishes of one school.
const LARGEST_COUNT: usize = 200_000;

parameters! {
    /// How a school lives, beside how its flock flies.
    pub struct SchoolParameters {
        /// Radius of the home range.
        home_radius: f32 = 5.0, "m", 0.1..=1000.0, "choice";
        /// Speed at which the goal that draws the school on wanders, as a share of cruise speed.
        goal_pace: f32 = 0.6, "1", 0.0..=4.0, "choice";
        /// How much faster a burst and how much slower a glide is than steady swimming.
        burst: f32 = 0.3, "1", 0.0..=0.9, "choice";
        /// Mean time from one burst to the next.
        burst_period: f32 = 1.6, "s", 0.1..=30.0, "choice";
        /// How many times longer than a fish of the school an animal must be to be fled from.
        threat_ratio: f32 = 4.0, "1", 1.0..=100.0, "choice";
        /// 1 to replay motion captured from the muscle-driven fish, 0 to undulate by the gait of the species.
        replayed: f32 = 0.0, "1", 0.0..=1.0, "choice";
        /// With replay: how many, those nearest to the observer, are driven by their muscles.
        driven: f32 = 0.0, "1", 0.0..=1000.0, "choice";
        /// Place of the observer, east.
        observer_x: f32 = 0.0, "m", -100_000.0..=100_000.0, "choice";
        /// Place of the observer, up.
        observer_y: f32 = 0.0, "m", -100_000.0..=100_000.0, "choice";
        /// Place of the observer, south.
        observer_z: f32 = 0.0, "m", -100_000.0..=100_000.0, "choice";
        /// Number of fishes whose heading and wish are shown.
        annotated: f32 = 3.0, "1", 0.0..=100.0, "choice";
    }
}

/// What a school consists of and where it lives.
#[derive(Clone, Debug)]
pub struct FishSchoolOptions {
    /// What the fishes are.
    pub species: Arc<FishSpecies>,
    /// How many.
    pub count: usize,
    /// Middle of the ellipsoid in which they begin, metres.
    pub center: Vec3,
    /// Its half axes, metres.
    pub half: Vec3,
    /// Middle of the home range, metres; none for `center`.
    pub home: Option<Vec3>,
    /// How the school flies.
    pub flock: FlockParameters,
    /// How it lives.
    pub parameters: SchoolParameters,
}

impl FishSchoolOptions {
    /// A school of `count` of this species, as densely as such fishes like to swim, that begins and
    /// has its home round `center` (metres).
    pub fn new(species: Arc<FishSpecies>, count: usize, center: Vec3) -> Self {
        let flock = schooling(&species);
        // About one and a half body lengths from one to the next, flatter than wide.
        let spacing = 1.5 * species.length;
        let radius = spacing * (count.max(1) as f32 * 0.24).cbrt();
        let half = Vec3::new(1.3, 0.6, 1.3) * radius;
        let parameters = SchoolParameters::default();
        Self { species, count, center, half, home: None, flock, parameters }
    }

    pub(super) fn check(&self) -> Result<()> {
        if self.count > LARGEST_COUNT {
            return Err(Error::value("count", self.count, format!("up to {LARGEST_COUNT}")));
        }
        for (name, value) in [("center", self.center), ("home", self.home.unwrap_or_default())] {
            if !value.is_finite() {
                return Err(Error::value(name, value, "a finite point in metres"));
            }
        }
        if !(self.half.is_finite() && self.half.min_element() >= 0.0) {
            return Err(Error::value("half", self.half, "three half axes in metres"));
        }
        self.flock.check()
    }
}

/// How fishes of a species school: closer together, more level and leaning less than birds, at
/// the speeds of their kind.
fn schooling(species: &FishSpecies) -> FlockParameters {
    let (cruise, burst) = (species.swimming.cruise, species.swimming.burst);
    FlockParameters {
        body_length: species.length,
        radius: 5.0,
        separation: 0.09,
        matching: 3.0,
        centering: 2.5,
        goal_strength: 0.25,
        home_strength: 0.6,
        wander_strength: 0.3,
        maximum_speed: burst,
        minimum_speed: 0.25 * cruise,
        cruise_speed: cruise,
        damping: 1.2,
        leveling: 0.8,
        maximum_acceleration: 5.0 * cruise,
        bank: 0.4,
        clearance: 1.0,
        ground_clearance: 3.0,
        flight_distance: 12.0,
        alarm_time: 1.2,
        ..FlockParameters::default()
    }
}
