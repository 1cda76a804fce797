//! What each member wants: requests by priority, and their allocation.

use bioscope_core::{Id, Purpose, Random, Vec3, math};
use bioscope_minds::arbitration::{prioritized, request};
use bioscope_minds::steering::{Moving, seek};
use rayon::prelude::*;

use super::{Flock, Percept};
use crate::columns::moving;
use crate::{Goal, Home, Surroundings};

const WANDER: Purpose = Purpose::new("flock wander");

/// Names of the requests in the order of their priority.
const BEHAVIORS: [&str; 9] =
    ["avoid", "keep level", "flee", "return", "separate", "match", "gather", "migrate", "wander"];

/// Acceleration wanted and why.
#[derive(Clone, Copy, Debug, Default)]
pub struct Decision {
    /// In units of the greatest acceleration, at most 1 long.
    pub acceleration: Vec3,
    /// Alarm felt, 0 to 1.
    pub alarm: f32,
    /// Index of the request that was granted most.
    pub winner: Option<u8>,
}

impl Flock {
    /// Lets all members decide on an acceleration from what they noticed. Without a
    /// [`sense`](Self::sense) since the last change of membership there is nothing to decide.
    pub fn decide(&mut self, surroundings: &Surroundings) {
        let mut scratch = std::mem::take(&mut self.scratch);
        let mut decisions = std::mem::take(&mut scratch.decisions);
        let flock = &*self;
        scratch
            .percepts
            .par_iter()
            .enumerate()
            .with_min_len(256)
            .map(|(slot, percept)| {
                let [position, velocity] = moving(&scratch.rows[slot]);
                let index = scratch.grid.order()[slot] as usize;
                let requests =
                    flock.requests(index, Moving { position, velocity }, percept, surroundings);
                let allocation = prioritized(&requests, 1.0);
                let winner = allocation.winner.map(|winner| winner as u8);
                Decision { acceleration: allocation.acceleration, alarm: percept.alarm, winner }
            })
            .collect_into_vec(&mut decisions);
        scratch.decisions = decisions;
        self.scratch = scratch;
    }

    /// What a member does mostly, by its last decision: `avoid`, `keep level`, `flee`, `return`,
    /// `separate`, `match`, `gather`, `migrate`, `wander`, or `glide` if it wants nothing.
    pub fn behavior(&self, index: usize) -> &'static str {
        let winner = self.decision(index).winner;
        winner.map_or("glide", |winner| BEHAVIORS[winner as usize])
    }

    /// Acceleration that a member decided on, in units of its greatest, at most 1 long.
    pub fn request(&self, index: usize) -> Vec3 {
        self.decision(index).acceleration
    }

    pub(super) fn decision(&self, index: usize) -> Decision {
        let slot = self.scratch.grid.slots().get(index);
        let decision = slot.and_then(|&slot| self.scratch.decisions.get(slot as usize));
        decision.copied().unwrap_or_default()
    }

    #[inline]
    fn requests(
        &self,
        index: usize,
        mover: Moving,
        percept: &Percept,
        surroundings: &Surroundings,
    ) -> [Vec3; 9] {
        let parameters = &self.parameters;
        let wish = |wish: Vec3, strength: f32| wish.clamp_length_max(1.0) * strength;
        let separation = parameters.separation * percept.crowding;
        let matching = percept.motion * (parameters.matching / parameters.top_speed());
        let centering = percept.middle * (parameters.centering / parameters.radius_metres());
        [
            percept.obstacle,
            percept.bounds,
            percept.flight,
            // Before the wishes of flocking, which use up the budget at the edge of a flock.
            surroundings.home.map_or(Vec3::ZERO, |home| self.homing(mover, home)),
            wish(separation, parameters.separation_strength),
            wish(matching, parameters.matching_strength),
            wish(centering, parameters.centering_strength),
            surroundings.goal.map_or(Vec3::ZERO, |goal| self.migration(mover, goal)),
            self.whim(self.members.ids[index], surroundings.time),
        ]
    }

    fn migration(&self, mover: Moving, goal: Goal) -> Vec3 {
        let target = match goal {
            Goal::Point(point) => point,
            Goal::Direction(direction) => mover.position + direction,
        };
        let speed = self.parameters.cruise_speed * self.parameters.body_length;
        let wish = seek(mover, target, speed);
        request(wish, self.parameters.thrust(), self.parameters.goal_strength)
    }

    /// Inward, the harder the farther outside, up to a quarter of the radius beyond.
    fn homing(&self, mover: Moving, home: Home) -> Vec3 {
        let way = home.center - mover.position;
        let outside = (way.length() - home.radius) / (0.25 * home.radius);
        if outside <= 0.0 {
            return Vec3::ZERO;
        }
        let wish = seek(mover, home.center, self.parameters.top_speed());
        request(wish, self.parameters.thrust(), self.parameters.home_strength * outside.min(1.0))
    }

    /// A direction of its own that changes smoothly, at other moments than that of others.
    fn whim(&self, id: Id, time: f64) -> Vec3 {
        let strength = self.parameters.wander_strength;
        if strength == 0.0 {
            return Vec3::ZERO;
        }
        let phase = f64::from(Random::new(self.seed, id, 0, WANDER).uniform());
        let age = (time / f64::from(self.parameters.wander_period) + phase).max(0.0);
        let epoch = age as u64;
        let toward = |epoch| Random::new(self.seed, id, epoch + 1, WANDER).direction();
        let share = math::smoothstep(0.0, 1.0, age.fract() as f32);
        toward(epoch).lerp(toward(epoch + 1), share) * strength
    }
}
