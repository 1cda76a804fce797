use std::f32::consts::FRAC_PI_3;

use bioscope_core::{Random, Vec3, math};
use serde::{Deserialize, Serialize};

use super::Command;
use super::avoidance::homeward;
use crate::attention::Situation;
use crate::nature::Temper;

/// Deviation from its course that it does not mind, radians.
const TOLERANCE: f32 = 0.12;
/// Steepest whim, radians.
const STEEPEST: f32 = 0.25;
/// Time constant of the memory of how comfortable it was, seconds.
const COMFORT_TIME: f32 = 1.0;

/// The routines wandering and leaving (Tu 1996, 6.4.5): calm swimming with a random turn now and then.
///
/// Whims turn it by up to 60 degrees about every 40 steps (choice). While leaving it turns more, and
/// at once, as long as things get worse, and goes straight while they get better (choice), so that it climbs
/// the gradient of comfort without knowing it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wandering {
    /// Where it goes, unit vector in the world; zero where it has no course.
    course: Vec3,
    /// World time of the next whim, seconds.
    until: f64,
    /// How uncomfortable it was lately.
    discomfort: f32,
}

impl Wandering {
    /// Forgets its course.
    pub fn rest(&mut self) {
        self.course = Vec3::ZERO;
    }

    /// Wanders on.
    pub fn wander(
        &mut self,
        situation: &Situation,
        temper: &Temper,
        random: &mut Random,
    ) -> Command {
        let due = situation.percepts.time >= self.until;
        if self.course == Vec3::ZERO || due {
            let widest = temper.whim_turn.to_radians();
            self.take_course(random.range(-widest, widest), situation, temper, random);
        }
        self.follow(situation, temper)
    }

    /// Leaves a place at which it feels this uncomfortable.
    pub fn leave(
        &mut self,
        discomfort: f32,
        situation: &Situation,
        temper: &Temper,
        random: &mut Random,
    ) -> Command {
        let worse = discomfort - self.discomfort;
        self.discomfort += worse * math::relaxation(situation.percepts.dt, COMFORT_TIME);
        let due = situation.percepts.time >= self.until;
        if self.course == Vec3::ZERO {
            self.discomfort = discomfort;
            self.take_course(0.0, situation, temper, random);
        } else if worse > 1e-4 * discomfort && due {
            let side = if random.uniform() < 0.5 { 1.0 } else { -1.0 };
            let angle = side * random.range(FRAC_PI_3, 2.5 * FRAC_PI_3);
            self.take_course(angle, situation, temper, random);
        } else if due && homeward(situation, temper) != Vec3::ZERO {
            self.take_course(0.0, situation, temper, random);
        }
        self.follow(situation, temper)
    }

    fn take_course(
        &mut self,
        angle: f32,
        situation: &Situation,
        temper: &Temper,
        random: &mut Random,
    ) {
        let percepts = situation.percepts;
        let ahead = percepts.attitude * Vec3::Z;
        let bearing = math::atan2(ahead.x, ahead.z) + angle;
        let climb = random.range(-STEEPEST, STEEPEST);
        let level = math::cos(climb);
        let course =
            Vec3::new(math::sin(bearing) * level, math::sin(climb), math::cos(bearing) * level);
        // Whims far from home lead back.
        let home = percepts.attitude * homeward(situation, temper);
        self.course = (course + home * 1.5).normalize_or(course);
        let wait = temper.whim_time * random.range(0.5, 1.5);
        self.until = percepts.time + f64::from(wait);
    }

    fn follow(&self, situation: &Situation, temper: &Temper) -> Command {
        let own = situation.percepts.attitude.inverse() * self.course;
        let mut command = Command::toward(own, temper.cruise_speed);
        if command.turn.abs() < TOLERANCE {
            command.turn = 0.0;
        }
        command
    }
}
