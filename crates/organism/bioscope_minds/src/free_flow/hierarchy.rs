use std::f32::consts::TAU;

use bioscope_core::{Vec3, math};

use crate::attention::Behavior;

/// Directions round the fish, and steps of climb.
const ROUND: usize = 12;
const CLIMBS: [f32; 3] = [-0.7, 0.0, 0.7];
/// How many directions there are to choose from.
pub const DIRECTIONS: usize = ROUND * CLIMBS.len();
/// Part of all weaker reasons of one sign that counts beside the strongest (choice).
const BESIDE: f32 = 0.3;
/// Subsystems that can have a say.
const SYSTEMS: usize = Behavior::ALL.len();

/// The motor level: what every subsystem says for and against each direction.
#[derive(Clone, Debug)]
pub struct Ballot {
    directions: [Vec3; DIRECTIONS],
    /// Strongest and sum of the reasons for, then against, per direction.
    reasons: [[(f32, f32); 2]; DIRECTIONS],
    /// What each subsystem says for each direction.
    voices: [[f32; SYSTEMS]; DIRECTIONS],
}

impl Default for Ballot {
    fn default() -> Self {
        let mut directions = [Vec3::Z; DIRECTIONS];
        for (index, direction) in directions.iter_mut().enumerate() {
            let angle = TAU * (index % ROUND) as f32 / ROUND as f32;
            let climb = CLIMBS[index / ROUND];
            let level = math::cos(climb);
            let ahead = Vec3::new(math::sin(angle), 0.0, math::cos(angle)) * level;
            *direction = ahead.with_y(math::sin(climb));
        }
        Self {
            directions,
            reasons: [[(0.0, 0.0); 2]; DIRECTIONS],
            voices: [[0.0; SYSTEMS]; DIRECTIONS],
        }
    }
}

impl Ballot {
    /// A subsystem's say for (`strength` > 0) or against directions towards a place of the own frame; the
    /// narrower the `focus` (a power of the cosine), the fewer directions it concerns.
    pub fn say(&mut self, system: Behavior, place: Vec3, strength: f32, focus: i32) {
        let toward = place.normalize_or_zero();
        let side = usize::from(strength < 0.0);
        for (index, direction) in self.directions.iter().enumerate() {
            let weight = strength.abs() * direction.dot(toward).max(0.0).powi(focus);
            let (strongest, sum) = &mut self.reasons[index][side];
            *strongest = strongest.max(weight);
            *sum += weight;
            self.voices[index][system as usize] += if side == 0 { weight } else { 0.0 };
        }
    }

    /// The best direction with its net preference and the subsystem that says most for it.
    pub fn winner(&self) -> (Vec3, f32, Behavior) {
        let net = |index: usize| {
            let count = |(strongest, sum): (f32, f32)| strongest + BESIDE * (sum - strongest);
            let [good, bad] = self.reasons[index];
            count(good) - count(bad)
        };
        let mut best = 0;
        for index in 1..DIRECTIONS {
            if net(index) > net(best) {
                best = index;
            }
        }
        let voices = &self.voices[best];
        let mut loudest = Behavior::Wander;
        for system in Behavior::ALL {
            if voices[system as usize] > voices[loudest as usize] {
                loudest = system;
            }
        }
        (self.refined(best, net), net(best), loudest)
    }

    /// The best direction, shifted towards its better neighbors so that courses are not bound to the raster.
    fn refined(&self, best: usize, net: impl Fn(usize) -> f32) -> Vec3 {
        let row = best / ROUND * ROUND;
        let beside = |step: usize| row + (best + step) % ROUND;
        let neighbors = [beside(1), beside(ROUND - 1)];
        let mut sum = self.directions[best];
        for one in neighbors {
            let worse = (net(best) - net(one)) / net(best).abs().max(1e-3);
            sum += self.directions[one] * (0.5 - worse).clamp(0.0, 0.5);
        }
        sum.normalize_or(self.directions[best])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_between_two_goods_beat_either_and_bad_ones_are_left() {
        let mut ballot = Ballot::default();
        ballot.say(Behavior::Eat, Vec3::new(1.0, 0.0, 1.0), 0.8, 2);
        ballot.say(Behavior::Mate, Vec3::new(-1.0, 0.0, 1.0), 0.8, 2);
        let (between, _, _) = ballot.winner();
        assert!(between.z > 0.7, "{between}");
        ballot.say(Behavior::Avoid, Vec3::new(1.0, 0.0, 1.0), -1.0, 2);
        let (clear, _, loudest) = ballot.winner();
        assert!(clear.x < -0.2, "{clear}");
        assert_eq!(loudest, Behavior::Mate);
    }

    #[test]
    fn weak_reasons_together_do_not_outweigh_a_strong_one() {
        let mut ballot = Ballot::default();
        for _ in 0..3 {
            ballot.say(Behavior::Wander, Vec3::X, 0.3, 4);
        }
        ballot.say(Behavior::Escape, Vec3::NEG_X, 0.8, 4);
        assert!(ballot.winner().0.x < -0.9);
    }
}
