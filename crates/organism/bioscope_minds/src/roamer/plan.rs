//! What the roamer is up to, and for how long: the part that lasts from tick to tick.

use bioscope_core::{Percepts, Random, math};
use serde::{Deserialize, Serialize};

use super::RoamerParameters;
use super::wishes::School;

/// What it is up to when nothing more urgent interferes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Activity {
    /// Swims on along its wandering course.
    Cruise,
    /// Follows a school with its eyes and body.
    Inspect,
    /// Charges at it.
    Dash,
}

/// An activity, when it ends, and the rhythm of swimming.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// What it does, or is about to do.
    pub activity: Activity,
    /// World time at which it ends, seconds.
    until: f64,
    /// World time up to which it hesitates, seconds.
    hesitates_until: f64,
    /// Whether it glides rather than strokes.
    pub gliding: bool,
    /// World time at which burst or glide ends, seconds.
    stroke_until: f64,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            activity: Activity::Cruise,
            until: 0.0,
            hesitates_until: 0.0,
            gliding: false,
            stroke_until: 0.0,
        }
    }
}

impl Plan {
    /// Whether it pauses, not yet decided, at this time.
    pub fn hesitates(&self, time: f64) -> bool {
        time < self.hesitates_until
    }

    /// Lets time pass: ends what is over, and takes up what invites.
    pub fn advance(
        &mut self,
        percepts: &Percepts,
        school: Option<&School>,
        parameters: &RoamerParameters,
        random: &mut Random,
    ) {
        if percepts.time >= self.stroke_until {
            self.gliding = !self.gliding;
            self.stroke_until = percepts.time + around(parameters.stroke, random);
        }
        let over = percepts.time >= self.until;
        match (self.activity, school) {
            (Activity::Cruise, Some(_)) if over => {
                let rate = parameters.curiosity / 60.0;
                if random.uniform() < 1.0 - math::exp(-rate * percepts.dt) {
                    let pause = around(parameters.hesitation, random);
                    self.take_up(Activity::Inspect, parameters.inspection, pause, percepts, random);
                }
            }
            (Activity::Inspect, Some(_)) if over && random.uniform() < parameters.boldness => {
                self.take_up(Activity::Dash, 1.0, 0.0, percepts, random);
            }
            (Activity::Inspect | Activity::Dash, _) if over || school.is_none() => {
                let pause = around(parameters.hesitation, random);
                // A while without new ideas, about as long as an inspection.
                self.take_up(Activity::Cruise, parameters.inspection, pause, percepts, random);
            }
            _ => {}
        }
    }

    fn take_up(
        &mut self,
        activity: Activity,
        mean_duration: f32,
        pause: f64,
        percepts: &Percepts,
        random: &mut Random,
    ) {
        self.activity = activity;
        self.hesitates_until = percepts.time + pause;
        self.until = self.hesitates_until + around(mean_duration, random);
    }
}

/// A duration in seconds between half and one and a half times the mean.
fn around(mean: f32, random: &mut Random) -> f64 {
    f64::from(mean * random.range(0.5, 1.5))
}
