use bioscope_core::{Error, Parameters, Result, parameters};

parameters! {
    /// How a flock flies. Lengths are in body lengths (BL), so one set fits any size; the
    /// defaults marked "checked" make one polarized flock from a random start (Reynolds,
    /// "Flocks, herds, and schools", SIGGRAPH 1987, names the parameters but not the values).
    pub struct FlockParameters {
        /// Length of one body.
        body_length: f32 = 1.0, "m", 0.001..=100.0, "choice";
        /// Distance within which others are neighbors.
        radius: f32 = 10.0, "BL", 0.5..=100.0, "checked";
        /// Falloff k of a neighbor's weight with distance d, max(d, 0.5 BL)^-k; -1 for springs.
        exponent: f32 = 2.0, "1", -1.0..=6.0, "checked (2 as in Reynolds 1987; 3 seen in fish)";
        /// Greatest number of neighbors heeded, the nearest first; 0 for all in the radius.
        maximum_neighbors: f32 = 0.0, "1", 0.0..=64.0, "choice (6 to 7 in starlings)";
        /// Gain of keeping apart.
        separation: f32 = 0.5, "1", 0.0..=20.0, "checked";
        /// Gain of matching the neighbors' velocity.
        matching: f32 = 4.0, "1", 0.0..=20.0, "checked";
        /// Gain of staying near the neighbors.
        centering: f32 = 3.0, "1", 0.0..=20.0, "checked";
        /// Strength of keeping apart.
        separation_strength: f32 = 1.0, "1", 0.0..=1.0, "checked";
        /// Strength of velocity matching.
        matching_strength: f32 = 0.7, "1", 0.0..=1.0, "checked";
        /// Strength of centering.
        centering_strength: f32 = 0.7, "1", 0.0..=1.0, "checked";
        /// Strength of migrating to the goal.
        goal_strength: f32 = 0.5, "1", 0.0..=1.0, "choice";
        /// Strength of returning home.
        home_strength: f32 = 0.5, "1", 0.0..=1.0, "choice";
        /// Strength of each one's own whims.
        wander_strength: f32 = 0.0, "1", 0.0..=1.0, "choice";
        /// Time from one whim to the next.
        wander_period: f32 = 1.5, "s", 0.1..=60.0, "choice";
        /// Speed nobody exceeds.
        maximum_speed: f32 = 8.0, "BL/s", 0.01..=100.0, "checked";
        /// Speed nobody falls below.
        minimum_speed: f32 = 0.0, "BL/s", 0.0..=100.0, "checked";
        /// Speed of calm flight.
        cruise_speed: f32 = 4.0, "BL/s", 0.0..=100.0, "checked";
        /// Spread of cruise speeds between individuals, as a share.
        speed_spread: f32 = 0.0, "1", 0.0..=0.5, "choice";
        /// Rate at which speed returns to cruise speed and sideslip dies out.
        damping: f32 = 0.3, "1/s", 0.0..=10.0, "checked";
        /// Rate at which climbing and diving die out.
        leveling: f32 = 0.0, "1/s", 0.0..=10.0, "choice";
        /// Greatest acceleration.
        maximum_acceleration: f32 = 8.0, "BL/s^2", 0.01..=1000.0, "checked";
        /// Gravity, as far as banking feels it.
        gravity: f32 = 9.81, "m/s^2", 0.0..=100.0, "standard gravity";
        /// How far one leans into a turn: 1 as physics has it, 0 not at all, -1 outwards.
        bank: f32 = 1.0, "1", -1.0..=1.0, "Reynolds 1987";
        /// Time in which one leans.
        bank_time: f32 = 0.3, "s", 0.0..=10.0, "choice";
        /// Distance kept from obstacles, ground and surface.
        clearance: f32 = 0.5, "BL", 0.0..=20.0, "choice (half a body)";
        /// Height kept above the ground, and depth below the surface, while there is time.
        ground_clearance: f32 = 2.0, "BL", 0.0..=100.0, "choice";
        /// Distance at which a threat begins to be felt.
        flight_distance: f32 = 12.0, "BL", 0.0..=1000.0, "choice";
        /// Time in which alarm dies out after the threat is gone.
        alarm_time: f32 = 1.5, "s", 0.01..=60.0, "choice";
    }
}

impl FlockParameters {
    /// Refuses values outside their ranges, and speeds that contradict each other.
    pub fn check(&self) -> Result<()> {
        for parameter in self.descriptions() {
            parameter.check(self.get(&parameter.name).unwrap_or(f64::NAN))?;
        }
        if self.minimum_speed > self.maximum_speed {
            let most = format!("at most maximum_speed = {}", self.maximum_speed);
            return Err(Error::value("minimum_speed", self.minimum_speed, most));
        }
        Ok(())
    }

    /// Radius in which others are neighbors, metres.
    pub fn radius_metres(&self) -> f32 {
        self.radius * self.body_length
    }

    /// Greatest speed, metres per second.
    pub(crate) fn top_speed(&self) -> f32 {
        self.maximum_speed * self.body_length
    }

    /// Greatest acceleration, metres per second squared.
    pub(crate) fn thrust(&self) -> f32 {
        self.maximum_acceleration * self.body_length
    }
}
