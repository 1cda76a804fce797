//! How one plant answers the flow.

use bioscope_core::{Quat, Vec2, Vec3, math};
use bioscope_geometry::Transform;
use serde::{Deserialize, Serialize};

use super::PlantsParameters;
use super::shapes::Bend;

/// Links of the chain of springs from the base to the tip.
const LINKS: usize = 3;
/// Time in seconds in which flutter follows the speed of the flow.
const FLUTTER_LAG: f32 = 0.4;
/// Time in seconds in which a plant gives way to what pushes it.
const PARTING_TIME: f32 = 0.1;
/// Flutters per second of a plant of 1 m.
const FLUTTER_RATE: f32 = 1.9;

/// The bending of one plant: a chain of damped springs. The first follows the drag of the flow, each
/// other one the spring below it, so that the tip comes late.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sway {
    links: [Link; LINKS],
    /// Speed of the flow as flutter feels it, metres per second.
    speed: f32,
}

/// One spring: lean towards x and z, 1 being all the plant can lean, and its rate per second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Link {
    lean: Vec2,
    rate: Vec2,
}

impl Sway {
    /// Goes on by `dt` seconds in a steady flow (metres per second); `length` is the plant's, metres.
    pub(crate) fn advance(&mut self, flow: Vec3, length: f32, dt: f32, p: &PlantsParameters) {
        let level = Vec2::new(flow.x, flow.z);
        let speed = math::sqrt(level.length_squared());
        // Drag grows with the square of the speed, but a plant that lies down offers less of itself.
        let drag = level / math::sqrt(speed * speed + 1.25 * p.yielding * p.yielding);
        let pace = math::TAU / (p.period * math::sqrt(length.max(0.01)));
        let mut target = drag;
        for (number, link) in self.links.iter_mut().enumerate() {
            let pace = pace * (1.5 - 0.25 * number as f32);
            link.advance(target, pace, p.damping, dt);
            target = link.lean;
        }
        self.speed += (speed - self.speed) * math::relaxation(dt, FLUTTER_LAG);
    }

    /// Is pushed aside by something that passes: leans at least this far that way (1 being all it can lean, towards x and z).
    pub(crate) fn part(&mut self, aside: Vec2, dt: f32) {
        let amount = aside.length();
        if amount < 1e-6 {
            return;
        }
        let way = aside / amount;
        let share = math::relaxation(dt, PARTING_TIME);
        for link in &mut self.links {
            link.lean += way * ((amount.min(1.0) - link.lean.dot(way)).max(0.0) * share);
        }
    }

    /// Lean at a height (0 base, 1 tip), 1 being a quarter turn at full flexibility.
    fn lean(&self, height: f32) -> Vec2 {
        let place = height.clamp(0.0, 1.0) * (LINKS - 1) as f32;
        let below = (place as usize).min(LINKS - 2);
        let lean = self.links[below].lean.lerp(self.links[below + 1].lean, place - below as f32);
        lean * (height * (0.55 + 0.45 * height))
    }

    /// Lean of the tip, radians.
    pub(crate) fn tip(&self, p: &PlantsParameters) -> Vec2 {
        self.lean(1.0) * (p.flexibility * 0.5 * math::PI)
    }
}

impl Link {
    /// The exact motion of a damped spring towards a target that stands still for `dt` seconds.
    fn advance(&mut self, target: Vec2, pace: f32, damping: f32, dt: f32) {
        let away = self.lean - target;
        let fade = damping * pace;
        let square = 1.0 - damping * damping;
        let (cosine, sine) = if square > 1e-4 {
            let swing = pace * math::sqrt(square);
            (math::cos(swing * dt), math::sin(swing * dt) / swing)
        } else if square < -1e-4 {
            let creep = pace * math::sqrt(-square);
            // Beyond this the exponentials below would overflow where their product is nothing.
            let reach = (creep * dt).min(40.0);
            let (grow, shrink) = (math::exp(reach), math::exp(-reach));
            (0.5 * (grow + shrink), 0.5 * (grow - shrink) / creep)
        } else {
            (1.0, dt)
        };
        let decay = math::exp(-(fade * dt).min(80.0));
        let lean = away * (cosine + fade * sine) + self.rate * sine;
        let rate = self.rate * (cosine - fade * sine) - away * (pace * pace * sine);
        self.lean = target + lean * decay;
        self.rate = rate * decay;
    }
}

/// What the poses of one plant depend on beside its sway.
pub(crate) struct Stance {
    /// Direction in which the plant was planted, radians about the vertical.
    pub yaw: f32,
    /// Its own place in the rhythm, radians.
    pub phase: f32,
    /// Its longest way from root to tip, metres.
    pub length: f32,
    /// World time, seconds.
    pub time: f64,
}

impl Sway {
    /// Writes the pose of every joint, in mesh space.
    pub(crate) fn pose(
        &self,
        joints: &[Bend],
        stance: &Stance,
        p: &PlantsParameters,
        poses: &mut [Transform],
    ) {
        let bend = p.flexibility * 0.5 * math::PI;
        let (sine, cosine) = (math::sin(stance.yaw), math::cos(stance.yaw));
        let rate = FLUTTER_RATE / math::sqrt(stance.length.max(0.05));
        // No two plants flutter at quite the same rate.
        let rate = f64::from(rate * (1.0 + 0.12 * math::sin(stance.phase * 3.0)));
        let beat = (stance.time * rate).fract() as f32 * math::TAU + stance.phase;
        let (first, second) = (math::sin(beat), math::cos(beat));
        let third = math::sin(beat * 2.0 + 1.0);
        let strength = p.flutter * self.speed / (self.speed + p.yielding);
        for (number, joint) in joints.iter().enumerate() {
            let height = joint.flexibility;
            let lean = self.lean(height) * bend;
            // From the world's x and z to the plant's own.
            let own = Vec2::new(lean.x * cosine - lean.y * sine, lean.x * sine + lean.y * cosine);
            let [a, b] = joint.phase;
            let quiver = strength * height * height;
            let shiver = Vec3::new(first * a + second * b, 0.6 * third * b, first * b - second * a);
            let turn = quaternion(Vec3::new(own.y, 0.0, -own.x) + shiver * quiver);
            let position = match joint.parent {
                Some(parent) => poses[parent].position + poses[parent].rotation() * joint.offset,
                None => joint.offset,
            };
            poses[number] = Transform::new(position, turn, 1.0);
        }
    }
}

/// The rotation about a vector by its length in radians, by series that serve up to half a turn.
fn quaternion(turn: Vec3) -> Quat {
    let square = 0.25 * turn.length_squared();
    let sine = 0.5 * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)));
    let cosine = 1.0 - 0.5 * square * (1.0 - square / 12.0 * (1.0 - square / 30.0));
    Quat::from_xyzw(turn.x * sine, turn.y * sine, turn.z * sine, cosine).normalize()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn stays_bounded_at_any_dt_and_flow_and_returns_to_rest(
            dt in 1e-4f32..10.0,
            length in 0.01f32..20.0,
            damping in 0.05f32..2.0,
            flows in prop::collection::vec((-60f32..60.0, -60f32..60.0), 1..40),
        ) {
            let parameters = PlantsParameters { damping, ..PlantsParameters::default() };
            let mut sway = Sway::default();
            for (x, z) in flows {
                sway.advance(Vec3::new(x, 3.0, z), length, dt, &parameters);
                // Three springs in a row that are hardly damped may swing far beyond their target.
                let most = if damping > 0.5 { 2.5 } else { 80.0 };
                prop_assert!(sway.lean(1.0).length() < most, "{:?}", sway);
            }
            let long = 400.0 * math::sqrt(length) / damping.min(1.0);
            for _ in 0..(long / dt).min(1e5) as usize + 50 {
                sway.advance(Vec3::ZERO, length, dt, &parameters);
            }
            prop_assert!(sway.lean(1.0).length() < 1e-2, "{:?}", sway);
        }
    }

    #[test]
    fn one_long_step_is_many_short_ones() {
        let parameters = PlantsParameters::default();
        let flow = Vec3::new(0.3, 0.0, -0.1);
        let (mut once, mut often) = (Link::default(), Link::default());
        let target = Vec2::new(flow.x, flow.z);
        once.advance(target, 3.0, parameters.damping, 0.8);
        (0..80).for_each(|_| often.advance(target, 3.0, parameters.damping, 0.01));
        assert!((once.lean - often.lean).length() < 1e-4, "{once:?} {often:?}");
    }

    #[test]
    fn the_series_agree_with_the_rotation() {
        for angle in [0.0f32, 0.3, 1.0, 2.0, 2.8] {
            let axis = Vec3::new(0.6, 0.0, -0.8);
            let exact = Quat::from_axis_angle(axis, angle);
            assert!(quaternion(axis * angle).dot(exact) > 1.0 - 1e-5, "{angle}");
        }
    }

    #[test]
    fn the_tip_leans_later_and_wider_than_the_middle() {
        let parameters = PlantsParameters::default();
        let mut sway = Sway::default();
        let mut crossings = [0.0; 2];
        for step in 0..400 {
            sway.advance(Vec3::X * 0.5, 1.0, 0.01, &parameters);
            for (crossing, height) in crossings.iter_mut().zip([0.4, 1.0]) {
                let lean = sway.lean(height).x;
                let rest = Vec2::X * 0.5 / math::sqrt(0.25 + 1.25 * 0.09);
                let half = 0.5 * rest.x * height * (0.55 + 0.45 * height);
                if *crossing == 0.0 && lean > half {
                    *crossing = step as f32 * 0.01;
                }
            }
        }
        assert!(crossings[1] > crossings[0] + 0.1, "{crossings:?}");
        assert!(sway.lean(1.0).x > 2.0 * sway.lean(0.4).x);
    }
}
