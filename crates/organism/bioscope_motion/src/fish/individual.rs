use bioscope_core::Vec3;
use bioscope_dynamics::spring_body::fish::{MUSCLES, NODES};
use bioscope_dynamics::spring_body::{
    Body, Dispatch, Integrator, Lanes, Real, Triple, Workspace, signed_volume,
};
use serde::{Deserialize, Serialize};

use super::frame::Frame;
use super::model::{FishDesign, FishModel};
use super::motor::{Effort, Feeling, Motor};

/// Most bodies that one number speaks for.
const WIDEST: usize = Lanes::LANES;

/// What a fish is beside its nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Individual {
    /// Metres.
    pub length: f64,
    /// Where the origin of its nodes lies, metres.
    pub origin: [f64; 3],
    /// Its motor controllers.
    pub motor: Motor,
    /// Contraction of the muscles from outside, in place of the controllers'.
    pub activation: Option<[f32; MUSCLES]>,
    /// Velocity of the water at its place, body lengths per time unit.
    pub flow: [f64; 3],
    /// Work of the muscles, in units of the body.
    pub work: f64,
    /// How often it was put back into shape after it had come apart.
    pub repairs: u32,
}

/// As many bodies as one number speaks for, side by side.
#[derive(Clone, Debug)]
pub(super) struct Group<R> {
    pub body: Body<R>,
    pub members: Vec<Individual>,
}

/// Memory of a thread.
pub(super) struct Desk<R> {
    work: Workspace<R>,
    flow: Vec<Triple<R>>,
    push: Vec<Triple<R>>,
}

impl<R: Dispatch> Desk<R> {
    pub fn new(model: &FishModel) -> Self {
        let zero = [R::splat(0.0); 3];
        let work = Workspace::new(&model.mechanics.anatomy);
        Self { work, flow: vec![zero; NODES], push: vec![zero; NODES] }
    }

    /// Lets neither water nor fins push anybody.
    pub fn still(&mut self) {
        let zero = [R::splat(0.0); 3];
        self.flow.fill(zero);
        self.push.fill(zero);
    }
}

impl<R: Dispatch> Group<R> {
    pub fn new(model: &FishModel) -> Self {
        Self { body: Body::at_rest(&model.mechanics.anatomy), members: Vec::new() }
    }

    /// Place of a node relative to the origin, body lengths.
    pub fn node(&self, lane: usize, node: usize) -> [f64; 3] {
        self.body.position[node].map(|axis| axis.lane(lane))
    }

    pub fn frame(&self, lane: usize) -> Frame {
        Frame::of(|node| self.node(lane, node).map(|axis| axis as f32).into())
    }

    /// The frames of all members, of which the sums are made side by side.
    fn frames(&self) -> [Frame; WIDEST] {
        let add = |a: Triple<R>, b: Triple<R>| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let sub = |a: Triple<R>, b: Triple<R>| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let (ahead, rise) = Frame::axes(|node| self.body.position[node], add, sub);
        let of = |axes: &Triple<R>, lane: usize| axes.map(|axis| axis.lane(lane) as f32).into();
        std::array::from_fn(|lane| {
            let lane = lane.min(R::LANES - 1);
            Frame::along(of(&ahead, lane), of(&rise, lane))
        })
    }

    /// Mean over the mass: of the places, or of the velocities.
    pub fn mean(&self, model: &FishModel, lane: usize, of: &[Triple<R>]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (value, mass) in of.iter().zip(&model.mechanics.anatomy.masses) {
            for axis in 0..3 {
                sum[axis] += mass * value[axis].lane(lane);
            }
        }
        sum
    }

    /// The same for all members: of each axis one value per lane.
    fn means(&self, model: &FishModel, of: &[Triple<R>]) -> [[f64; WIDEST]; 3] {
        let mut sums = [[0.0; WIDEST]; 3];
        for (value, mass) in of.iter().zip(&model.mechanics.anatomy.masses) {
            for axis in 0..3 {
                for (lane, sum) in sums[axis].iter_mut().enumerate().take(R::LANES) {
                    *sum += mass * value[axis].lane(lane);
                }
            }
        }
        sums
    }

    /// Sets a body down at rest: its center of mass at the origin, turned as `rotation` says.
    pub fn put(&mut self, model: &FishModel, lane: usize, rotation: bioscope_core::Quat) {
        let center = Vec3::new(0.0, 0.0, -model.center() as f32);
        for (node, rest) in model.mechanics.anatomy.nodes.iter().enumerate() {
            let rest = Vec3::from_array(rest.map(|axis| axis as f32));
            let place = rotation * (rest - center);
            for axis in 0..3 {
                self.body.position[node][axis].set_lane(lane, f64::from(place[axis]));
                self.body.velocity[node][axis].set_lane(lane, 0.0);
            }
        }
        for muscle in &mut self.body.contraction {
            muscle.set_lane(lane, 0.0);
        }
    }

    /// Advances all members by `steps` steps of `dt` time units.
    pub fn advance(&mut self, model: &FishModel, steps: usize, dt: f64, desk: &mut Desk<R>) {
        // Only the semi-implicit scheme ever fails.
        let may_fail = model.mechanics.integrator == Integrator::SemiImplicit;
        let before = may_fail.then(|| self.body.clone());
        for (lane, member) in self.members.iter().enumerate() {
            for node in &mut desk.flow {
                for (axis, flow) in node.iter_mut().zip(member.flow) {
                    axis.set_lane(lane, flow);
                }
            }
        }
        for _ in 0..steps {
            if self.step(model, dt, desk).is_err() {
                // The semi-implicit scheme does not say which of the bodies collapsed: all are put back.
                if let Some(before) = before {
                    self.body = before;
                }
                for lane in 0..self.members.len() {
                    self.repair(model, lane);
                }
                return;
            }
        }
        let centers = self.means(model, &self.body.position);
        let volume = model.mechanics.anatomy.volume();
        for lane in 0..self.members.len() {
            if self.is_whole(model, lane, volume) {
                self.center(lane, centers.map(|axis| axis[lane]));
            } else {
                self.repair(model, lane);
            }
        }
    }

    fn step(
        &mut self,
        model: &FishModel,
        dt: f64,
        desk: &mut Desk<R>,
    ) -> bioscope_core::Result<()> {
        let mut wanted = [R::splat(0.0); MUSCLES];
        let frames = self.frames();
        let velocities = self.means(model, &self.body.velocity);
        for (lane, member) in self.members.iter_mut().enumerate() {
            let velocity = velocities.map(|axis| axis[lane]);
            let Effort { contraction, fins } = drive(member, model, (frames[lane], velocity), dt);
            for (muscle, value) in wanted.iter_mut().zip(contraction) {
                muscle.set_lane(lane, f64::from(value));
            }
            push_fins(model, fins, &mut desk.push, lane);
        }
        /// Greatest change of a muscle's normalized length in a published step of 0.055.
        const QUICKEST: f64 = 0.075 / 0.055;
        let change = R::splat(QUICKEST * dt);
        let work = model.mechanics.contract(&mut self.body, &wanted, change);
        for (lane, member) in self.members.iter_mut().enumerate() {
            member.work += work.lane(lane);
        }
        R::step(&model.mechanics, &mut self.body, &desk.flow, &desk.push, dt, &mut desk.work)
    }

    /// Keeps the origin at the center of mass, so that numbers stay small.
    fn center(&mut self, lane: usize, center: [f64; 3]) {
        for node in &mut self.body.position {
            for (axis, by) in node.iter_mut().zip(center) {
                axis.set_lane(lane, axis.lane(lane) - by);
            }
        }
        let member = &mut self.members[lane];
        for (axis, by) in member.origin.iter_mut().zip(center) {
            *axis += member.length * by;
        }
    }

    /// Whether a body still has its shape, whose volume at rest is `rest`.
    fn is_whole(&self, model: &FishModel, lane: usize, rest: f64) -> bool {
        let nodes: [[f64; 3]; NODES] = std::array::from_fn(|node| self.node(lane, node));
        let volume = signed_volume(&model.mechanics.anatomy.faces, &nodes);
        let near = nodes.iter().flatten().all(|axis| axis.abs() < 100.0);
        let share = volume / rest;
        near && (0.1..10.0).contains(&share)
    }

    /// Puts a body that came apart back into its shape, at rest where it was.
    fn repair(&mut self, model: &FishModel, lane: usize) {
        let rotation = self.frame(lane).rotation();
        let rotation = if rotation.is_finite() { rotation } else { bioscope_core::Quat::IDENTITY };
        self.put(model, lane, rotation);
        self.members[lane].repairs += 1;
    }
}

/// What the controllers of a fish of this frame do that moves with this velocity.
fn drive(
    member: &mut Individual,
    model: &FishModel,
    (frame, velocity): (Frame, [f64; 3]),
    dt: f64,
) -> Effort {
    let through = [0, 1, 2].map(|axis| (velocity[axis] - member.flow[axis]) as f32);
    let feeling = Feeling { frame, velocity: through.into() };
    let mut effort = member.motor.advance(&model.design, &feeling, dt as f32);
    if let Some(activation) = member.activation {
        effort.contraction = activation;
    }
    effort
}

/// Puts the forces of the left and the right pectoral fin on the first three rings, so that they act at the fins'
/// distance from the axis. Like the skin they push the harder the thicker the fluid.
fn push_fins<R: Dispatch>(model: &FishModel, fins: [Vec3; 2], push: &mut [Triple<R>], lane: usize) {
    let FishDesign { fins: settings, shape, medium, .. } = &model.design;
    for ring in 0..3 {
        let wide = shape.half_widths[ring];
        let outward = settings.arm.max(wide) / wide;
        for corner in 0..4 {
            let (near, far) = (fins[corner / 2], fins[1 - corner / 2]);
            for axis in 0..3 {
                let (near, far) = (f64::from(near[axis]), f64::from(far[axis]));
                let force = near * (1.0 + outward) + far * (1.0 - outward);
                let value = 0.25 * medium.thickness * settings.weights[ring] * force;
                push[4 * ring + 1 + corner][axis].set_lane(lane, value);
            }
        }
    }
}
