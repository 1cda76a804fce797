use bioscope_core::{Id, NOTHING, Quat, Random, Vec3, math};
use bioscope_motion::undulation::{Gait, Stroke, SwimState};
use serde::{Deserialize, Serialize};

use crate::animals::tint;

/// Alarm from which a fish is fleeing.
const FLEEING: f32 = 0.35;
/// Alarm below which it is calm again.
const CALM: f32 = 0.1;
/// Seconds in which one fish is not reported startled twice.
const QUIET: f32 = 4.0;

/// What a fish does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Mode {
    /// Goes with the others.
    #[default]
    School,
    /// Steers round something.
    Avoid,
    /// Flees.
    Flee,
}

impl Mode {
    /// What a wish of this name, as the flock calls it, amounts to.
    pub fn of(behavior: &str, fleeing: bool) -> Self {
        match behavior {
            "avoid" | "keep level" => Self::Avoid,
            "flee" => Self::Flee,
            _ if fleeing => Self::Flee,
            _ => Self::School,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Self::School => "school",
            Self::Avoid => "avoid",
            Self::Flee => "flee",
        }
    }
}

/// What a fish is beside its place in the flock.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Fish {
    /// Size relative to the average of the species.
    pub scale: f32,
    /// Linear color that multiplies the species'.
    pub tint: [f32; 3],
    /// By which the school's cruise speed is multiplied.
    pub pace: f32,
    /// Where it is in its cycle of burst and glide, 0 to 1.
    pub rhythm: f32,
    /// Length of that cycle relative to the mean.
    pub tempo: f32,
    /// What its spine does.
    pub swim: SwimState,
    /// Share of its tail beat that is over, 0 to 1, if its motion is replayed.
    pub beat: f32,
    /// Velocity over ground, metres per second.
    pub motion: Vec3,
    pub mode: Mode,
    fleeing: bool,
    /// Seconds until it may be reported startled again.
    quiet: f32,
    /// Whom it was startled by in this tick; [`NOTHING`] if it was not.
    pub startled_by: Id,
}

/// How a fish moved in a tick.
pub(super) struct Step {
    /// Rotation before, and heading after.
    pub before: Quat,
    pub heading: Vec3,
    /// Speed through the water before and after, body lengths per second.
    pub speeds: [f32; 2],
    pub dt: f32,
}

impl Fish {
    /// A fish that differs from its kin by up to `variation` of its size.
    pub fn born(variation: f32, motion: Vec3, random: &mut Random) -> Self {
        let mut phase = || random.range(0.0, math::TAU);
        let swim =
            SwimState { phase: phase(), mood: phase(), fan: phase(), ..SwimState::default() };
        Self {
            scale: 1.0 + random.range(-variation, variation),
            tint: tint(0.1, random),
            pace: 1.0 + random.range(-0.1, 0.1),
            rhythm: random.uniform(),
            tempo: random.range(0.7, 1.4),
            beat: swim.phase / math::TAU,
            swim,
            motion,
            mode: Mode::School,
            fleeing: false,
            quiet: 0.0,
            startled_by: NOTHING,
        }
    }

    /// By which the school's cruise speed is multiplied now: a burst in the first part of the cycle, then a glide. Who
    /// flees does not glide.
    pub fn pace_now(&self, strength: f32) -> f32 {
        const BURST: f32 = 0.4;
        let rhythm = if self.fleeing {
            1.0
        } else if self.rhythm < BURST {
            1.0 + strength
        } else {
            1.0 - strength * BURST / (1.0 - BURST)
        };
        self.pace * rhythm
    }

    /// Lets its cycle go on; `period` is the mean length of one in seconds.
    pub fn beat(&mut self, dt: f32, period: f32) {
        self.rhythm = (self.rhythm + dt / (period * self.tempo)).fract();
    }

    /// Takes note of its alarm; `threat` is the nearest one.
    pub fn feel(&mut self, alarm: f32, behavior: &str, threat: Id, dt: f32) {
        let was = self.fleeing;
        self.fleeing = alarm > if was { CALM } else { FLEEING };
        self.quiet = (self.quiet - dt).max(0.0);
        self.startled_by = NOTHING;
        if self.fleeing && !was && self.quiet == 0.0 {
            self.startled_by = threat;
            self.quiet = QUIET;
        }
        self.mode = Mode::of(behavior, self.fleeing);
    }

    /// Bends and beats as its motion asks for.
    pub fn swim(&mut self, gait: Gait, step: &Step) {
        let own = step.before.inverse() * step.heading;
        let stroke = Stroke {
            speed: step.speeds[1],
            acceleration: (step.speeds[1] - step.speeds[0]) / step.dt,
            turn: math::atan2(own.x, own.z) / step.dt,
            lift: math::asin(own.y.clamp(-1.0, 1.0)) / step.dt,
            brake: 0.0,
        };
        self.swim.advance(gait, &stroke, step.dt);
    }
}
