use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use bioscope_core::math::TAU;
use bioscope_core::{
    Intention, Parameter, Parameters, Quat, Random, Result, Value, Vec3, math, state,
};
use bioscope_dynamics::Influence;
use bioscope_dynamics::spring_body::fish::NODES;
use bioscope_geometry::Transform;

use super::MusclePhysics;
use crate::Body;
use crate::fish::{Command, FishModel, Swimmers, pose_from_nodes, wrapped};
use crate::undulation::{Spine, SwimState};

/// Wish to turn, radians, below which there is none.
const STRAIGHT: f32 = 1e-4;

/// Wish to turn, radians, from which either side will do.
const BEHIND: f32 = 1.8;

/// Deviation below which the course that it has is held, radians: it cannot tell it from the swing of its beat.
const HELD: f32 = 0.06;

/// Steepest way that is swum, radians; to what lies steeper it goes in turns.
const STEEPEST: f32 = 0.9;

/// Level share of a way from which it is turned to in full: one straight up or down lies to neither side.
const LEVEL: f32 = 0.8;

/// Share of its own climb that a fish gives up, so that one that only looks ahead comes back to level.
const LEVELING: f32 = 0.3;

/// A fish that swims by its muscles; see the [module](super).
#[derive(Clone, Debug)]
pub struct MuscleSwimmer {
    preset: String,
    physics: MusclePhysics,
    fish: Swimmers<f32>,
    spine: Arc<Spine>,
    /// Rowing fins and the mouth, which none of the simulated muscles moves.
    swim: SwimState,
    /// Where it is and how it moves, worked out of its nodes when asked for first.
    motion: OnceLock<Motion>,
}

/// Where a fish is and how it moves over ground.
#[derive(Clone, Copy, Debug)]
struct Motion {
    placement: Transform,
    velocity: Vec3,
    /// Metres.
    length: f32,
}

impl MuscleSwimmer {
    /// A fish of the form of this spine and the body of a preset (`calibrated` or `published`), at rest at the
    /// origin, looking along +Z.
    ///
    /// # Errors
    /// For unknown presets.
    pub fn new(spine: Arc<Spine>, preset: &str) -> Result<Self> {
        let cruise = f64::from(spine.gait().cruise);
        let mut fish = Swimmers::new(FishModel::named(preset)?, cruise)?;
        fish.add([0.0; 3], Quat::IDENTITY, f64::from(spine.length()))?;
        let (physics, swim) = (MusclePhysics::default(), SwimState::default());
        Ok(Self { preset: preset.to_owned(), physics, fish, spine, swim, motion: OnceLock::new() })
    }

    /// A calibrated fish that goes on from these places of its nodes (metres), with this rotation and this velocity (m/s) of its
    /// trunk, `phase` (0 to 1) after the beginning of a beat.
    ///
    /// # Errors
    /// For places and lengths (metres) that are not finite.
    pub fn going_on(
        spine: Arc<Spine>,
        length: f32,
        nodes: &[Vec3; NODES],
        (rotation, velocity): (Quat, Vec3),
        phase: f32,
    ) -> Result<Self> {
        let mut body = Self::new(spine, "calibrated")?;
        let model = body.fish.model().clone();
        let cruise = f64::from(body.spine.gait().cruise);
        let mut fish = Swimmers::new(model.clone(), cruise)?;
        fish.add(nodes[5].to_array().map(f64::from), rotation.normalize(), f64::from(length))?;
        fish.set_nodes(0, &nodes.map(|node| node.to_array().map(f64::from)));
        fish.kick(0, velocity);
        let speed = velocity.length() / length * fish.time_unit() as f32;
        fish.motor_mut(0).beat_at(&model.design, speed, phase);
        *body.fish_mut() = fish;
        Ok(body)
    }

    /// Share of the present beat that is over, 0 to 1.
    pub fn phase(&self) -> f32 {
        self.fish.motor(0).phase
    }

    /// Direction in which it goes on when the beat that swings its trunk is taken away: a unit vector.
    pub fn heading(&self) -> Vec3 {
        let yaw = self.fish.motor(0).heading();
        let ahead = self.motion().placement.rotation() * Vec3::Z;
        let level = math::sqrt(ahead.x * ahead.x + ahead.z * ahead.z);
        Vec3::new(level * math::sin(yaw), ahead.y, level * math::cos(yaw)).normalize_or(ahead)
    }

    /// Its nodes in its placement, body lengths.
    pub fn local_nodes(&self) -> [Vec3; NODES] {
        self.fish.local_nodes(0)
    }

    /// The fish that [`save`](Body::save) stored.
    ///
    /// # Errors
    /// For damaged bytes.
    pub fn restore(spine: Arc<Spine>, bytes: &[u8]) -> Result<Self> {
        let (preset, physics, fish, swim): (String, MusclePhysics, Vec<u8>, SwimState) =
            state::from_bytes("muscle_swimmer", bytes)?;
        for one in physics.descriptions() {
            one.check(physics.get(&one.name).unwrap_or(f64::NAN))?;
        }
        let fish = Swimmers::restore_one(physics.model(&preset)?, &fish)?;
        Ok(Self { preset, physics, fish, spine, swim, motion: OnceLock::new() })
    }

    /// Takes up what the mind intends and what acts on it; the next [`advance`](Self::advance_together) does it.
    ///
    /// # Errors
    /// For intentions that are not finite.
    pub fn obey(&mut self, intention: &Intention, influence: &Influence, dt: f32) -> Result<()> {
        let length = self.motion().length;
        let speed = intention.speed * length;
        let (steer, climb) = self.course(intention);
        self.fish.command(
            0,
            Command {
                speed: speed.max(0.0),
                steer,
                climb,
                brake: intention.brake,
                backward: (-speed).max(0.0),
            },
        )?;
        self.fish.set_flow(0, influence.flow);
        if influence.force != Vec3::ZERO {
            self.fish_mut().kick(0, influence.force * dt);
        }
        let speed = self.motion().velocity.length() / length;
        let brakes = intention.brake > 0.5 || intention.speed < 0.0;
        self.swim.row(speed, self.fish.motor(0).bend, brakes, dt);
        self.swim.gape(intention.mouth, dt);
        Ok(())
    }

    /// Change of heading, if there is to be any, and climb, radians. The mind speaks of directions as its swaying trunk
    /// has them, the controllers hold those of the world.
    fn course(&self, intention: &Intention) -> (Option<f32>, f32) {
        let rotation = self.motion().placement.rotation();
        let yaw = |way: Vec3| math::atan2(way.x, way.z);
        let pitch = |way: Vec3| math::atan2(way.y, math::sqrt(way.x * way.x + way.z * way.z));
        let (way, ahead) = (rotation * intention.heading, rotation * Vec3::Z);
        let climb = pitch(way).clamp(-STEEPEST, STEEPEST) - LEVELING * pitch(ahead);
        let motor = self.fish.motor(0);
        if intention.turn().abs() > STRAIGHT {
            let turn = wrapped(yaw(way) - yaw(ahead) + motor.sway());
            let turn = turn * (math::sqrt(way.x * way.x + way.z * way.z) / LEVEL).min(1.0);
            // To what is behind it turns on over the side that it has begun with.
            let other_way = turn.abs() > BEHIND && turn * motor.bend < 0.0;
            let turn = if other_way { turn - TAU.copysign(turn) } else { turn };
            if turn.abs() > HELD {
                return (Some(turn), climb);
            }
        }
        // Straight on: the course that it has then is held from then on.
        let went_straight = motor.command.steer.is_none_or(|steer| steer == 0.0);
        (if went_straight { None } else { Some(0.0) }, climb)
    }

    /// Changes the velocity of each node by what `change` gives for its place, in metres and metres per second.
    pub fn draw(&mut self, change: impl Fn(Vec3) -> Vec3) {
        self.fish_mut().draw(0, change);
    }

    /// Advances all by `dt` seconds; they have been told what to do.
    pub fn advance_together(bodies: &mut [&mut Self], dt: f32) {
        let mut fishes: Vec<_> = bodies.iter_mut().map(|body| body.fish_mut()).collect();
        Swimmers::advance_together(&mut fishes, f64::from(dt));
    }

    /// The fish, to be moved.
    fn fish_mut(&mut self) -> &mut Swimmers<f32> {
        self.motion.take();
        &mut self.fish
    }

    fn motion(&self) -> &Motion {
        self.motion.get_or_init(|| Motion {
            placement: self.fish.placement(0),
            velocity: self.fish.velocity(0),
            length: self.fish.length(0) as f32,
        })
    }

    /// Size relative to that of the spine.
    fn scale(&self) -> f32 {
        self.motion().length / self.spine.length()
    }

    /// Puts one of this length in its place, at rest.
    fn replace(&mut self, position: Vec3, rotation: Quat, length: f64) {
        let Ok(mut fish) =
            Swimmers::new(self.fish.model().clone(), f64::from(self.spine.gait().cruise))
        else {
            return;
        };
        let place = position.to_array().map(f64::from);
        if fish.add(place, rotation, length).is_ok() {
            *self.fish_mut() = fish;
        }
    }
}

impl Body for MuscleSwimmer {
    fn kind(&self) -> &str {
        "muscle_swimmer"
    }

    fn advance(&mut self, intention: &Intention, influence: &Influence, dt: f32) -> Result<()> {
        self.obey(intention, influence, dt)?;
        self.fish_mut().advance(f64::from(dt));
        Ok(())
    }

    fn muscles(&mut self) -> Option<&mut MuscleSwimmer> {
        Some(self)
    }

    fn placement(&self) -> Transform {
        let placement = self.motion().placement;
        Transform::new(placement.position, placement.rotation(), self.scale())
    }

    fn put(&mut self, position: Vec3, heading: Vec3) {
        let yaw = math::atan2(heading.x, heading.z);
        let half = 0.5 * yaw;
        let rotation = Quat::from_xyzw(0.0, math::sin(half), 0.0, math::cos(half)).normalize();
        self.replace(position, rotation, self.fish.length(0));
    }

    fn vary(&mut self, variation: f32, random: &mut Random) {
        let length = self.fish.length(0) * f64::from(1.0 + random.range(-variation, variation));
        let phase = random.uniform();
        let placement = self.placement();
        self.replace(placement.position, placement.rotation(), length);
        self.fish.motor_mut(0).phase = phase;
    }

    fn shift(&mut self, offset: Vec3) {
        if offset == Vec3::ZERO {
            return;
        }
        self.fish_mut().shift(0, offset);
        // What it ran into takes the part of its motion that went into it.
        let out = offset.normalize_or_zero();
        let into = self.fish.velocity(0).dot(out).min(0.0);
        self.fish_mut().kick(0, -out * into);
    }

    fn velocity(&self) -> Vec3 {
        self.motion().velocity
    }

    fn length(&self) -> f32 {
        self.motion().length
    }

    fn joint_count(&self) -> usize {
        self.spine.joint_count()
    }

    fn pose(&self, out: &mut [Transform]) {
        let motor = self.fish.motor(0);
        let swim = SwimState {
            fan: motor.fins.beat,
            fanning: motor.fins.spread,
            bend: [0.5 * motor.bend; 2],
            ..self.swim
        };
        let shape = &self.fish.model().design.shape;
        pose_from_nodes(&self.spine, shape, &self.fish.local_nodes(0), &swim, out);
    }

    fn energy_spent(&self) -> f32 {
        let mass = self.fish.model().mass(self.fish.length(0));
        (self.fish.work(0) / mass) as f32
    }

    fn values(&self) -> BTreeMap<String, Value> {
        let motor = self.fish.motor(0);
        let beat = f64::from(motor.frequency) / self.fish.time_unit();
        BTreeMap::from([
            (String::from("speed_m_per_s"), self.velocity().length().into()),
            (String::from("tail_beat_hz"), beat.into()),
            (String::from("bend"), motor.bend.into()),
            (String::from("energy_j"), self.fish.energy(0).into()),
        ])
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(self)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(self)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(&(&self.preset, &self.physics, self.fish.save_one()?, self.swim)))
    }
}

/// Those of its physics; a change takes effect in the next step.
impl Parameters for MuscleSwimmer {
    fn descriptions(&self) -> Vec<Parameter> {
        self.physics.descriptions()
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.physics.get(name)
    }

    fn set(&mut self, name: &str, value: f64) -> Result<()> {
        let mut physics = self.physics.clone();
        physics.set(name, value)?;
        let model = physics.model(&self.preset)?;
        self.fish_mut().set_model(model);
        self.physics = physics;
        Ok(())
    }
}
