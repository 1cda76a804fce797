use bioscope_core::Vec3;
use glam::DVec3;

use super::axes::{Angle, Axes};
use super::{Movement, TurtleOptions};
use crate::interpretation::{Anchor, Contour};

/// Most numbered tropisms.
pub(super) const MOVEMENTS: usize = 8;

/// What brackets remember.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub position: DVec3,
    pub axes: Axes,
    pub width: f32,
    pub color: i32,
    pub scale: f32,
    pub contour: Contour,
    pub texture: u16,
    /// Sides of cross-sections; 0 leaves them to the mesh.
    pub sides: u16,
    /// How many brackets are open.
    pub depth: u32,
    /// The axis that the next segment continues.
    pub axis: Option<u32>,
    /// Where the next axis begins on another.
    pub anchor: Option<Anchor>,
    /// Width and color with which the next axis begins, if not with those of its first segment.
    pub beginning: Option<(f32, i32)>,
    pub tropism: DVec3,
    pub susceptibility: f64,
    pub elasticity: [f32; MOVEMENTS],
    /// Heading and up at the last stroke, for `@Tp`.
    pub before: (DVec3, DVec3),
    /// How strongly axes of control points leave (1) and reach (0) a point along its heading.
    pub tangents: [f32; 2],
    /// Slopes of the radius (along the axis, of the radius) reaching (0) and leaving (1) a point.
    pub radius_tangents: [[f32; 2]; 2],
    /// Whether those grow with the distance between points.
    pub scaled_radius_tangents: bool,
}

impl State {
    pub fn new(options: &TurtleOptions) -> Self {
        let mut elasticity = [0.0; MOVEMENTS];
        for (own, movement) in elasticity.iter_mut().zip(&options.movements) {
            *own = movement.elasticity;
        }
        let is_usual = (options.heading, options.up) == (Vec3::Y, Vec3::Z);
        let axes = match is_usual {
            true => Axes::START,
            false => Axes::looking(options.heading.as_dvec3(), options.up.as_dvec3()),
        };
        Self {
            position: options.position.as_dvec3(),
            axes,
            width: options.width,
            color: options.color,
            scale: options.scale,
            contour: Contour::Round,
            texture: 0,
            sides: 0,
            depth: 0,
            axis: None,
            anchor: None,
            beginning: None,
            tropism: options.tropism.as_dvec3(),
            susceptibility: f64::from(options.susceptibility),
            elasticity,
            before: (axes.heading, axes.up),
            tangents: [1.2; 2],
            radius_tangents: [[0.0; 2]; 2],
            scaled_radius_tangents: false,
        }
    }

    /// Turns the heading towards the tropism, by `susceptibility` radians times the sine of the
    /// angle between (*The Algorithmic Beauty of Plants*, section 2.3.4).
    pub fn bend(&mut self) {
        let torque = self.axes.heading.cross(self.tropism);
        let heading = self.axes.heading + torque.cross(self.axes.heading) * self.susceptibility;
        let heading = heading.normalize_or(self.axes.heading);
        let left = self.axes.left - heading * heading.dot(self.axes.left);
        let left = left.normalize_or(heading.any_orthonormal_vector());
        self.axes = Axes { heading, left, up: heading.cross(left) };
    }

    /// The same as cpfg does it: by the parts of the tropism along up and left, one after the other.
    pub fn bend_as_cpfg(&mut self) {
        let along = |axis: DVec3, state: &Self| {
            let sine = (state.susceptibility * state.tropism.dot(axis)).clamp(-1.0, 1.0);
            Angle { sine, cosine: (1.0 - sine * sine).sqrt() }
        };
        let pitch = along(-self.axes.up, self);
        self.axes.pitch(pitch);
        let turn = along(self.axes.left, self);
        self.axes.turn(turn);
    }

    /// Gives way to the numbered tropisms and torques, before a stroke.
    ///
    /// The headings that the tropisms seek (each at its angle from its direction) are summed; the
    /// heading turns towards the sum by as many radians as their cross product is long, at most
    /// one. Then up turns about the heading in the same way towards the sum of the torques.
    pub fn give_way(&mut self, movements: &[Movement]) {
        let heading = self.axes.heading;
        let (mut sought, mut torque) = (DVec3::ZERO, DVec3::ZERO);
        for (movement, &elasticity) in movements.iter().zip(&self.elasticity) {
            let direction = movement.direction.as_dvec3();
            let elasticity = f64::from(elasticity);
            if movement.twists {
                torque += direction * elasticity;
                continue;
            }
            let angle = f64::from(movement.angle).to_radians();
            let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
            sought += direction * (elasticity * cosine);
            if sine != 0.0 {
                let across = heading.cross(direction).try_normalize().unwrap_or(self.axes.left);
                sought += direction.cross(across) * (elasticity * sine);
            }
        }
        let pull = heading.cross(sought);
        if pull.length() > 1e-6 {
            let turned = turned_about(heading, pull);
            let (from, up) = self.before;
            self.axes.carry(turned, from, up);
        }
        let across = self.axes.heading.cross(torque.normalize_or_zero());
        if across.length_squared() > 1e-8 {
            let up = -self.axes.up;
            let wanted = across.cross(self.axes.heading) * torque.length();
            let up = turned_about(up, up.cross(wanted));
            self.axes = Axes::looking(self.axes.heading, -up);
            self.before = (self.axes.heading, self.axes.up);
        }
    }
}

/// `vector` turned about `pull` by as many radians as that is long, at most one.
fn turned_about(vector: DVec3, pull: DVec3) -> DVec3 {
    let length = pull.length();
    if length < 1e-7 {
        return vector;
    }
    let axis = pull / length;
    let angle = length.min(1.0);
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    vector * cosine + axis.cross(vector) * sine + axis * (axis.dot(vector) * (1.0 - cosine))
}
