use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{
    Error, Intention, NOTHING, Parameters, Quat, Random, Result, SoundEvent, Value, Vec3, math,
    parameters, state,
};
use bioscope_dynamics::Influence;
use bioscope_geometry::Transform;
use serde::{Deserialize, Serialize};

use crate::Body;
use crate::undulation::{Spine, Stroke, SwimState, spine_pose};

/// Time in which a turn is meant to be completed, seconds.
const TURN_TIME: f32 = 0.4;
/// Time constant with which the water takes a body along, seconds.
const CARRY_TIME: f32 = 0.3;
/// Time constant of the roll into a turn, seconds.
const ROLL_TIME: f32 = 0.3;
/// Steepest roll, radians.
const STEEPEST_ROLL: f32 = 0.6;
/// Standard gravity, m/s².
const GRAVITY: f32 = 9.81;
/// Share of the speed wanted at which a glide ends and at which a burst ends.
const BURST_AND_GLIDE: [f32; 2] = [0.9, 1.08];
/// Urgency from which nobody glides.
const PRESSING: f32 = 0.7;
/// Share of the full thrust from which a stroke of the tail is heard.
const AUDIBLE_THRUST: f32 = 0.6;

parameters! {
    /// What a swimmer can do.
    pub struct SwimmerParameters {
        /// Greatest speed through the water.
        top_speed: f32 = 4.0, "BL/s", 0.0..=30.0, "choice; 10 for a short sprint (Videler 1993)";
        /// Greatest thrust.
        acceleration: f32 = 5.0, "BL/s^2", 0.01..=200.0, "choice";
        /// Radius of the tightest turn.
        turn_radius: f32 = 0.45, "BL", 0.05..=20.0, "Domenici and Blake 1997: 0.1 to 0.5";
        /// Turn rate with the fins alone, when nearly still.
        pivot: f32 = 0.7, "rad/s", 0.0..=20.0, "choice";
        /// Greatest turn rate.
        turn_rate: f32 = 4.5, "rad/s", 0.01..=40.0, "choice";
        /// Time constant of a change of turn rate.
        agility: f32 = 0.18, "s", 0.0..=5.0, "choice";
        /// Steepest climb and descent.
        steepness: f32 = 50.0, "deg", 0.0..=85.0, "choice";
        /// Roll in a turn as a share of that of a bird, which must lift its weight.
        bank: f32 = 0.6, "1", -2.0..=2.0, "choice; a fish floats and need not bank";
        /// Slowing down while it glides, per body length.
        drag: f32 = 0.3, "1/BL", 0.0..=10.0, "choice";
        /// Slowing down with spread fins.
        brake: f32 = 1.5, "BL/s^2", 0.0..=50.0, "choice";
    }
}

/// A body that swims; see the [module](super) for the model.
#[derive(Clone, Debug)]
pub struct Swimmer {
    pub(super) spine: Arc<Spine>,
    pub(super) motion: Motion,
}

/// All of a swimmer but its anatomy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Motion {
    parameters: SwimmerParameters,
    /// Size relative to the spine's.
    scale: f32,
    position: Vec3,
    /// Heading about the vertical, from +Z towards +X, radians.
    yaw: f32,
    /// Climb, radians.
    pitch: f32,
    /// Lean to the left, radians.
    roll: f32,
    /// Speed through the water along the heading, metres per second.
    speed: f32,
    /// Turn to the left and lift of the head, radians per second.
    turn: [f32; 2],
    /// Velocity that water and forces have given it, metres per second.
    carried: Vec3,
    pub(super) swim: SwimState,
    /// Whether the tail drives (else it glides).
    driving: bool,
    /// Thrust as a share of the greatest.
    thrust: f32,
    /// Whether a strong stroke of the tail ended in the last step.
    stroke_ended: bool,
    /// Joules per kilogram.
    energy: f32,
}

impl Swimmer {
    /// A swimmer with this spine, `scale` times its size, at the origin, looking along +Z.
    pub fn new(spine: Arc<Spine>, scale: f32, parameters: SwimmerParameters) -> Result<Self> {
        if !(scale.is_finite() && scale > 0.0) {
            return Err(Error::value("scale", scale, "a positive number"));
        }
        let motion = Motion {
            parameters,
            scale,
            position: Vec3::ZERO,
            yaw: 0.0,
            pitch: 0.0,
            roll: 0.0,
            speed: 0.0,
            turn: [0.0; 2],
            carried: Vec3::ZERO,
            swim: SwimState::default(),
            driving: true,
            thrust: 0.0,
            stroke_ended: false,
            energy: 0.0,
        };
        Ok(Self { spine, motion })
    }

    /// The swimmer that [`save`](Body::save) wrote, with the anatomy of its species.
    pub fn restore(spine: Arc<Spine>, bytes: &[u8]) -> Result<Self> {
        let motion: Motion = state::from_bytes("swimmer", bytes)?;
        for parameter in motion.parameters.descriptions() {
            parameter.check(motion.parameters.get(&parameter.name).unwrap_or(f64::NAN))?;
        }
        if !(motion.position.is_finite() && motion.scale > 0.0 && motion.scale.is_finite()) {
            return Err(Error::format("swimmer", "its place or size is not a finite number"));
        }
        Ok(Self { spine, motion })
    }
}

impl Motion {
    fn attitude(&self) -> Quat {
        let yaw = Quat::from_rotation_y(self.yaw);
        yaw * Quat::from_rotation_x(-self.pitch) * Quat::from_rotation_z(-self.roll)
    }

    fn heading(&self) -> Vec3 {
        self.attitude() * Vec3::Z
    }

    /// Turns towards a direction in the world, unit length.
    fn steer(&mut self, wanted: Vec3, length: f32, urgency: f32, dt: f32) {
        let limits = &self.parameters;
        let tight = limits.pivot + self.speed / length / limits.turn_radius;
        let greatest = tight.min(limits.turn_rate) * math::mix(0.4, 1.0, urgency);
        let level = math::sqrt(wanted.x * wanted.x + wanted.z * wanted.z);
        let steepest = limits.steepness.to_radians();
        let climb = math::atan2(wanted.y, level).clamp(-steepest, steepest);
        // Straight up or down has no direction on the level: keep the present one.
        let bearing = if level > 0.05 { math::atan2(wanted.x, wanted.z) } else { self.yaw };
        let errors = [wrap(bearing - self.yaw), climb - self.pitch];
        let follow = math::relaxation(dt, limits.agility);
        for (rate, error) in self.turn.iter_mut().zip(errors) {
            let wanted = (error / TURN_TIME).clamp(-greatest, greatest);
            *rate += (wanted - *rate) * follow;
        }
        self.yaw = wrap(self.yaw + self.turn[0] * dt);
        self.pitch = (self.pitch + self.turn[1] * dt).clamp(-steepest, steepest);
        let full = math::atan2(self.speed * self.turn[0], GRAVITY);
        let lean = (limits.bank * full).clamp(-STEEPEST_ROLL, STEEPEST_ROLL);
        self.roll += (lean - self.roll) * math::relaxation(dt, ROLL_TIME);
    }

    /// Brings the speed towards the one wanted (m/s); returns the acceleration.
    fn drive(&mut self, wanted: f32, length: f32, urgency: f32, dt: f32) -> f32 {
        let limits = &self.parameters;
        let wanted = wanted.clamp(0.0, limits.top_speed * length);
        let band = BURST_AND_GLIDE.map(|share| share * wanted);
        if urgency >= PRESSING || self.speed < band[0] {
            self.driving = true;
        } else if self.speed > band[1] {
            self.driving = false;
        }
        let drag = limits.drag * self.speed * self.speed / length;
        let greatest = limits.acceleration * length * math::mix(0.35, 1.0, urgency);
        let burst = if urgency >= PRESSING { wanted } else { wanted * 1.12 };
        let needed = (burst - self.speed) / 0.35 + drag;
        let thrust = if self.driving && wanted > 0.0 { needed.clamp(0.0, greatest) } else { 0.0 };
        let too_fast = (self.speed - band[1]).max(0.0) / 0.5;
        let brake = too_fast.min(limits.brake * length * urgency.max(0.3));
        let before = self.speed;
        self.speed =
            (self.speed + (thrust - drag - brake) * dt).clamp(0.0, limits.top_speed * length);
        self.thrust = thrust / (limits.acceleration * length);
        self.energy += thrust * self.speed * dt;
        (self.speed - before) / dt
    }

    /// Lets the water take the body along.
    fn carry(&mut self, influence: &Influence, dt: f32) {
        self.carried += influence.force * dt;
        self.carried += (influence.flow - self.carried) * math::relaxation(dt, CARRY_TIME);
    }
}

/// The same angle between -π and π.
fn wrap(angle: f32) -> f32 {
    angle - math::TAU * (angle / math::TAU).round()
}

impl Body for Swimmer {
    fn kind(&self) -> &str {
        "swimmer"
    }

    fn advance(&mut self, intention: &Intention, influence: &Influence, dt: f32) -> Result<()> {
        let length = self.length();
        let motion = &mut self.motion;
        let urgency =
            if intention.urgency.is_finite() { intention.urgency.clamp(0.0, 1.0) } else { 0.0 };
        let own = intention.heading.try_normalize().unwrap_or(Vec3::Z);
        let speed = if intention.speed.is_finite() { intention.speed * length } else { 0.0 };
        motion.steer(motion.attitude() * own, length, urgency, dt);
        let acceleration = motion.drive(speed, length, urgency, dt);
        motion.carry(influence, dt);
        motion.position += (motion.heading() * motion.speed + motion.carried) * dt;

        let side = math::sin(motion.swim.phase) > 0.0;
        let stroke = Stroke {
            speed: motion.speed / length,
            acceleration: acceleration / length,
            turn: motion.turn[0],
            lift: motion.turn[1],
            brake: if intention.speed < 0.0 { 1.0 } else { intention.brake },
        };
        motion.swim.advance(self.spine.gait(), &stroke, dt);
        motion.swim.gape(intention.mouth, dt);
        let half_beat = side != (math::sin(motion.swim.phase) > 0.0);
        motion.stroke_ended = half_beat && motion.thrust > AUDIBLE_THRUST;
        Ok(())
    }

    fn placement(&self) -> Transform {
        Transform::new(self.motion.position, self.motion.attitude(), self.motion.scale)
    }

    fn put(&mut self, position: Vec3, heading: Vec3) {
        let motion = &mut self.motion;
        motion.position = position;
        motion.yaw = math::atan2(heading.x, heading.z);
        let level = math::sqrt(heading.x * heading.x + heading.z * heading.z);
        let steepest = motion.parameters.steepness.to_radians();
        motion.pitch = math::atan2(heading.y, level).clamp(-steepest, steepest);
        (motion.roll, motion.speed, motion.turn) = (0.0, 0.0, [0.0; 2]);
        motion.carried = Vec3::ZERO;
    }

    fn vary(&mut self, variation: f32, random: &mut Random) {
        let motion = &mut self.motion;
        motion.scale *= 1.0 + random.range(-variation, variation).clamp(-0.9, 0.9);
        motion.swim.phase = random.range(0.0, math::TAU);
        motion.swim.mood = random.range(0.0, math::TAU);
        motion.swim.fan = random.range(0.0, math::TAU);
    }

    fn shift(&mut self, offset: Vec3) {
        self.motion.position += offset;
    }

    fn velocity(&self) -> Vec3 {
        self.motion.heading() * self.motion.speed + self.motion.carried
    }

    fn length(&self) -> f32 {
        self.spine.length() * self.motion.scale
    }

    fn joint_count(&self) -> usize {
        self.spine.joint_count()
    }

    fn pose(&self, out: &mut [Transform]) {
        spine_pose(&self.spine, &self.motion.swim, out);
    }

    fn sounds(&self, out: &mut Vec<SoundEvent>) {
        if self.motion.stroke_ended {
            let loudness = self.motion.thrust * self.length();
            out.push(SoundEvent {
                source: NOTHING,
                kind: Cow::Borrowed("swish"),
                time: 0.0,
                duration: 0.0,
                position: self.motion.position,
                velocity: self.velocity(),
                amplitude: (0.25 * loudness).min(0.5),
                pitch: 0.0,
            });
        }
    }

    fn energy_spent(&self) -> f32 {
        self.motion.energy
    }

    fn values(&self) -> BTreeMap<String, Value> {
        let motion = &self.motion;
        let length = self.length();
        let gait = self.spine.gait();
        BTreeMap::from([
            ("speed_m_per_s".into(), self.velocity().length().into()),
            ("speed_body_lengths_per_s".into(), (motion.speed / length).into()),
            ("turn_rad_per_s".into(), motion.turn[0].into()),
            ("climb_rad".into(), motion.pitch.into()),
            ("roll_rad".into(), motion.roll.into()),
            ("thrust".into(), motion.thrust.into()),
            ("tail_beat_hz".into(), gait.tail_beat(motion.speed / length).into()),
            ("tail_amplitude".into(), motion.swim.amplitude.into()),
            ("gliding".into(), (!motion.driving).into()),
            ("energy_spent_j_per_kg".into(), motion.energy.into()),
        ])
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.motion.parameters)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.motion.parameters)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(&self.motion))
    }
}
