use bioscope_core::{Purpose, Random, Vec3};
use bioscope_world::{Environment, Moment};
use serde::{Deserialize, Serialize};

use crate::animals::way_out;

const GOAL: Purpose = Purpose::new("goal of a school");
/// Room kept round a goal, metres.
const ROOM: f32 = 0.6;

/// The goal that draws a school on: it wanders from place to place in the home range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Course {
    /// Where the goal is, metres.
    pub goal: Vec3,
    /// Where it goes, metres.
    next: Vec3,
}

impl Course {
    /// A goal that begins here.
    pub fn starting(place: Vec3) -> Self {
        Self { goal: place, next: place }
    }

    /// Moves the goal by `way` metres within `radius` metres of `home`; where it arrives it chooses a new place.
    pub fn advance(
        &mut self,
        way: f32,
        (home, radius): (Vec3, f32),
        environment: &Environment,
        moment: &Moment,
    ) {
        let left = self.next - self.goal;
        if left.length() > way {
            self.goal += left.normalize() * way;
            return;
        }
        self.goal = self.next;
        // Belongs to nobody in particular: two schools of one place differ in where they are.
        let key = self.goal.x.to_bits() ^ self.goal.z.to_bits().rotate_left(16);
        let mut random = Random::new(moment.seed, key, moment.tick, GOAL);
        let mut draw = || home + random.in_ball() * Vec3::new(0.8, 0.5, 0.8) * radius;
        let far = |place: &Vec3| place.distance(self.goal) > 0.6 * radius;
        let drawn = (0..8).map(|_| draw()).find(far).unwrap_or(home);
        self.next = drawn + way_out(drawn, ROOM, environment);
    }
}
