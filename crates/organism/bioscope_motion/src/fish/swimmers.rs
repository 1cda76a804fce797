use std::sync::Arc;

use bioscope_core::{Error, Quat, Result, Vec3};
use bioscope_dynamics::spring_body::fish::{MUSCLES, NODES};
use bioscope_dynamics::spring_body::{Dispatch, Lanes};
use bioscope_geometry::Transform;
use rayon::prelude::*;

use super::individual::{Desk, Group, Individual};
use super::model::FishModel;
use super::motor::{Command, Motor};
use crate::undulation::ORIGIN;

/// Many muscle-driven fishes of one kind and of any sizes, advanced together: eight side by side, groups of eight in
/// parallel. Each fish moves alike whatever its place among the others and however many threads there are.
#[derive(Clone, Debug)]
pub struct Swimmers<R = Lanes> {
    pub(super) model: Arc<FishModel>,
    /// Seconds in a time unit.
    pub(super) time_unit: f64,
    pub(super) groups: Vec<Group<R>>,
    pub(super) count: usize,
}

impl<R: Dispatch> Swimmers<R> {
    /// None yet, of a kind that cruises at `cruise` body lengths per second: the calibrated cruise of the model is
    /// given that pace, which keeps stride length and Strouhal number.
    ///
    /// # Errors
    /// For a pace that is not positive.
    pub fn new(model: Arc<FishModel>, cruise: f64) -> Result<Self> {
        if !(1e-3..=1e3).contains(&cruise) {
            let expected = "0.001 to 1,000 body lengths per second";
            return Err(Error::value("cruising speed", cruise, expected));
        }
        let time_unit = model.design.swim.cruise / cruise;
        Ok(Self { model, time_unit, groups: Vec::new(), count: 0 })
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// What they are made of.
    pub fn model(&self) -> &Arc<FishModel> {
        &self.model
    }

    /// Gives them other tissue and water: a model with the same tables of motor controllers.
    pub(crate) fn set_model(&mut self, model: Arc<FishModel>) {
        self.model = model;
    }

    /// Seconds in a time unit of the model.
    pub fn time_unit(&self) -> f64 {
        self.time_unit
    }

    /// Seconds of the step for which the tables hold.
    pub fn natural_step(&self) -> f64 {
        self.model.design.step * self.time_unit
    }

    /// Adds a fish of this length in metres, at rest; returns its index.
    ///
    /// # Errors
    /// For lengths, places and rotations that are not finite, and lengths outside 1 mm to 100 m.
    pub fn add(&mut self, position: [f64; 3], rotation: Quat, length: f64) -> Result<usize> {
        if !(1e-3..=100.0).contains(&length) {
            return Err(Error::value("length of a fish", length, "0.001 to 100 metres"));
        }
        if !position.iter().all(|axis| axis.abs() < 1e9) || !rotation.is_normalized() {
            let found = format!("{position:?}, {rotation}");
            return Err(Error::value("place of a fish", found, "finite numbers"));
        }
        if self.count == self.groups.len() * R::LANES {
            self.groups.push(Group::new(&self.model));
        }
        let lane = self.count % R::LANES;
        let group = self.groups.last_mut().ok_or_else(|| Error::value("groups", 0, "one"))?;
        group.members.push(Individual {
            length,
            origin: position,
            motor: Motor::default(),
            activation: None,
            flow: [0.0; 3],
            work: 0.0,
            repairs: 0,
        });
        group.put(&self.model, lane, rotation);
        let heading = group.frame(lane).yaw();
        group.members[lane].motor.face(heading);
        self.count += 1;
        Ok(self.count - 1)
    }

    /// Removes a fish; the last takes its index.
    pub fn swap_remove(&mut self, index: usize) {
        let last = self.count - 1;
        let (to, from) = (index / R::LANES, last / R::LANES);
        let (lane, other) = (index % R::LANES, last % R::LANES);
        let moved = self.groups[from].body.clone();
        let body = &mut self.groups[to].body;
        let columns = |body: &mut bioscope_dynamics::spring_body::Body<R>| {
            for (mine, theirs) in
                [(&mut body.position, &moved.position), (&mut body.velocity, &moved.velocity)]
            {
                for (mine, theirs) in mine.iter_mut().flatten().zip(theirs.iter().flatten()) {
                    mine.set_lane(lane, theirs.lane(other));
                }
            }
            for (mine, theirs) in body.contraction.iter_mut().zip(&moved.contraction) {
                mine.set_lane(lane, theirs.lane(other));
            }
        };
        columns(body);
        // The last group holds the last fish, so it is never empty here.
        if let Some(member) = self.groups[from].members.pop()
            && index != last
        {
            self.groups[to].members[lane] = member;
        }
        if self.groups[from].members.is_empty() {
            self.groups.pop();
        }
        self.count = last;
    }

    /// Advances all by `dt` seconds, in equal steps of about the natural one.
    pub fn advance(&mut self, dt: f64) {
        self.advance_in(dt, self.steps(dt).0);
    }

    /// How many equal steps make `dt` seconds, and their length in time units: none more than a twentieth longer than the natural
    /// one, so that a tick that is hardly longer than a number of steps does not cost one more.
    pub(super) fn steps(&self, dt: f64) -> (usize, f64) {
        let steps = (dt / self.natural_step() / 1.05 - 1e-6).ceil().max(1.0);
        (steps as usize, dt / self.time_unit / steps)
    }

    /// Advances all by `dt` seconds in this number of steps.
    pub fn advance_in(&mut self, dt: f64, steps: usize) {
        let step = dt / self.time_unit / steps as f64;
        let model = &self.model;
        self.groups.par_iter_mut().for_each_init(
            || Desk::new(model),
            |desk, group| group.advance(model, steps, step, desk),
        );
    }

    fn group(&self, index: usize) -> (&Group<R>, usize) {
        (&self.groups[index / R::LANES], index % R::LANES)
    }

    fn individual(&self, index: usize) -> &Individual {
        &self.groups[index / R::LANES].members[index % R::LANES]
    }

    fn individual_mut(&mut self, index: usize) -> &mut Individual {
        &mut self.groups[index / R::LANES].members[index % R::LANES]
    }

    /// Tells a fish what to do, in metres, seconds and radians.
    ///
    /// # Errors
    /// For numbers that are not finite.
    pub fn command(&mut self, index: usize, command: Command) -> Result<()> {
        let command = command.checked()?;
        let scale = self.time_unit as f32 / self.individual(index).length as f32;
        self.individual_mut(index).motor.obey(Command {
            speed: command.speed * scale,
            backward: command.backward * scale,
            ..command
        });
        Ok(())
    }

    /// The motor controllers of a fish; lengths in body lengths, times in time units.
    pub fn motor(&self, index: usize) -> &Motor {
        &self.individual(index).motor
    }

    /// The motor controllers of a fish, for changing.
    pub fn motor_mut(&mut self, index: usize) -> &mut Motor {
        &mut self.individual_mut(index).motor
    }

    /// Begins a turn by this angle in radians, positive to the left.
    pub fn turn(&mut self, index: usize, angle: f32) {
        let model = Arc::clone(&self.model);
        self.individual_mut(index).motor.begin_turn(&model.design, angle);
    }

    /// Gives the contraction of the muscles, 0 to 1, in place of the motor controllers'; none gives it back to them.
    pub fn activate(&mut self, index: usize, activation: Option<[f32; MUSCLES]>) {
        self.individual_mut(index).activation = activation;
    }

    /// Present contraction of the muscles, 0 to 1.
    pub fn contraction(&self, index: usize) -> [f64; MUSCLES] {
        let (group, lane) = self.group(index);
        std::array::from_fn(|muscle| group.body.contraction[muscle].lane(lane))
    }

    /// Sets the velocity of the water at a fish, metres per second.
    pub fn set_flow(&mut self, index: usize, flow: Vec3) {
        let scale = self.time_unit / self.individual(index).length;
        self.individual_mut(index).flow = flow.to_array().map(|axis| f64::from(axis) * scale);
    }

    /// Moves a fish by this many metres.
    pub fn shift(&mut self, index: usize, offset: Vec3) {
        for (axis, by) in self.individual_mut(index).origin.iter_mut().zip(offset.to_array()) {
            *axis += f64::from(by);
        }
    }

    /// Changes the velocity of a whole fish by this many metres per second.
    pub fn kick(&mut self, index: usize, change: Vec3) {
        self.draw(index, |_| change);
    }

    /// Changes the velocity of each node by what `change` gives for its place, in metres and metres per second.
    pub fn draw(&mut self, index: usize, change: impl Fn(Vec3) -> Vec3) {
        let lane = index % R::LANES;
        let Group { body, members } = &mut self.groups[index / R::LANES];
        let Individual { length, origin, .. } = &members[lane];
        let scale = self.time_unit / length;
        for (velocity, position) in body.velocity.iter_mut().zip(&body.position) {
            let place = [0, 1, 2].map(|axis| origin[axis] + length * position[axis].lane(lane));
            let change = change(place.map(|axis| axis as f32).into());
            for axis in 0..3 {
                let value = velocity[axis].lane(lane) + f64::from(change[axis]) * scale;
                velocity[axis].set_lane(lane, value);
            }
        }
    }

    /// Puts the nodes of a fish at these places in metres, at rest.
    pub fn set_nodes(&mut self, index: usize, nodes: &[[f64; 3]; NODES]) {
        let lane = index % R::LANES;
        let group = &mut self.groups[index / R::LANES];
        let Individual { length, origin, .. } = &group.members[lane];
        for (node, place) in nodes.iter().enumerate() {
            for axis in 0..3 {
                let value = (place[axis] - origin[axis]) / length;
                group.body.position[node][axis].set_lane(lane, value);
                group.body.velocity[node][axis].set_lane(lane, 0.0);
            }
        }
    }

    /// Length of a fish, metres.
    pub fn length(&self, index: usize) -> f64 {
        self.individual(index).length
    }

    /// Places of its nodes in metres, the snout first, the tips of the tail last.
    pub fn nodes(&self, index: usize) -> [[f64; 3]; NODES] {
        let (group, lane) = self.group(index);
        let Individual { length, origin, .. } = &group.members[lane];
        std::array::from_fn(|node| {
            let place = group.node(lane, node);
            [0, 1, 2].map(|axis| origin[axis] + length * place[axis])
        })
    }

    /// Velocities of its nodes, metres per second.
    pub fn node_velocities(&self, index: usize) -> [[f64; 3]; NODES] {
        let (group, lane) = self.group(index);
        let scale = group.members[lane].length / self.time_unit;
        std::array::from_fn(|node| group.body.velocity[node].map(|axis| axis.lane(lane) * scale))
    }

    /// Center of mass, metres.
    pub fn center(&self, index: usize) -> [f64; 3] {
        let (group, lane) = self.group(index);
        let Individual { length, origin, .. } = &group.members[lane];
        let mean = group.mean(&self.model, lane, &group.body.position);
        [0, 1, 2].map(|axis| origin[axis] + length * mean[axis])
    }

    /// Velocity of the center of mass over ground, metres per second.
    pub fn velocity(&self, index: usize) -> Vec3 {
        let (group, lane) = self.group(index);
        let scale = group.members[lane].length / self.time_unit;
        let mean = group.mean(&self.model, lane, &group.body.velocity);
        mean.map(|axis| (axis * scale) as f32).into()
    }

    /// Where its mesh goes: the origin of the form, which lies [`ORIGIN`] from the snout, and the frame of its trunk.
    pub fn placement(&self, index: usize) -> Transform {
        let (group, lane) = self.group(index);
        let rotation = group.frame(lane).rotation();
        let length = group.members[lane].length;
        let ahead = ((self.model.center() - f64::from(ORIGIN)) * length) as f32;
        let center: Vec3 = self.center(index).map(|axis| axis as f32).into();
        Transform::new(center + rotation * Vec3::new(0.0, 0.0, ahead), rotation, 1.0)
    }

    /// Its nodes in its [`placement`](Self::placement), in body lengths: at rest those of the anatomy moved by
    /// [`ORIGIN`].
    pub fn local_nodes(&self, index: usize) -> [Vec3; NODES] {
        let (group, lane) = self.group(index);
        let back = group.frame(lane).rotation().inverse();
        let mean: Vec3 =
            group.mean(&self.model, lane, &group.body.position).map(|axis| axis as f32).into();
        let ahead = Vec3::new(0.0, 0.0, ORIGIN - self.model.center() as f32);
        std::array::from_fn(|node| {
            let place: Vec3 = group.node(lane, node).map(|axis| axis as f32).into();
            back * (place - mean) + ahead
        })
    }

    /// Kinetic and elastic energy, joules.
    pub fn energy(&self, index: usize) -> f64 {
        let (group, lane) = self.group(index);
        self.joule(index) * self.model.mechanics.energy(&group.body).lane(lane)
    }

    /// Work that the muscles have done, joules.
    pub fn work(&self, index: usize) -> f64 {
        self.joule(index) * self.individual(index).work
    }

    /// Joules in the model's unit of energy.
    fn joule(&self, index: usize) -> f64 {
        let length = self.individual(index).length;
        self.model.mass(length) * (length / self.time_unit).powi(2)
    }

    /// How often a fish had to be put back into shape after it had come apart.
    pub fn repairs(&self, index: usize) -> u32 {
        self.individual(index).repairs
    }
}
