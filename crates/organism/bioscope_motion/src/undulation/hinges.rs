//! Parts of a body that turn at hinges: paired fins and the lower jaw.

use bioscope_core::{Quat, Vec3, math};
use bioscope_geometry::Transform;

use super::{GREATEST_BEND, Spine, SwimState, half_tangent};

/// Least reach of a fin that rows, as a share of its swing.
const LEAST_REACH: f32 = 0.4;

/// What turns at a hinge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// A paired fin that flaps about the axis.
    Flap,
    /// A paired fin that rows: it runs round on a cone, one stroke a turn (after Tu, "Artificial Animals for
    /// Computer Animation", appendix B; there the fin also spins about itself).
    Oar {
        /// Unit axis, across both the first one and the fin.
        across: Vec3,
    },
    /// The lower jaw.
    Jaw,
}

/// Where a part turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hinge {
    /// Middle of the part's base in mesh space, metres.
    pub position: Vec3,
    /// Unit axis about which a positive angle spreads a fin from the body or opens the mouth.
    pub axis: Vec3,
    /// +1 for a left fin, −1 for a right one, 0 in the middle.
    pub side: f32,
    /// Greatest angle in radians.
    pub swing: f32,
    /// What turns.
    pub part: Part,
}

impl Hinge {
    /// Name of its joint, being the hinge of this number.
    pub(super) fn name(&self, number: usize) -> String {
        match self.part {
            Part::Jaw => String::from("jaw"),
            _ => format!("fin_{number}_{}", if self.side > 0.0 { "left" } else { "right" }),
        }
    }

    fn rotation(&self, swim: &SwimState) -> Quat {
        let turn = |axis: Vec3, angle: f32| axis * half_tangent(angle);
        let half = match self.part {
            Part::Flap => {
                let beat = math::sin(swim.fan + if self.side > 0.0 { 0.0 } else { 2.6 });
                let inside = (swim.bend[0] * self.side).max(0.0) / GREATEST_BEND;
                let share = swim.fanning * (0.35 + 0.65 * beat) + 0.8 * inside;
                turn(self.axis, self.swing * share.clamp(-0.5, 1.0))
            }
            Part::Oar { across } => {
                let phase = swim.oars[usize::from(self.side < 0.0)];
                let reach = 0.5 * self.swing * swim.fanning.max(LEAST_REACH);
                let round = self.axis * (1.0 - math::cos(phase)) + across * math::sin(phase);
                turn(round, reach)
            }
            Part::Jaw => turn(self.axis, self.swing * swim.mouth),
        };
        Quat::from_xyzw(half.x, half.y, half.z, 1.0).normalize()
    }
}

/// Writes the poses of the hinged parts, which go with the links that carry them: those must be posed already.
pub(crate) fn pose_hinges(spine: &Spine, swim: &SwimState, out: &mut [Transform]) {
    for (number, hinge) in spine.hinges.iter().enumerate() {
        let carrier = spine.carrier(hinge);
        let rest = Vec3::new(0.0, 0.0, spine.along(spine.cuts[carrier]));
        let pose = out[carrier];
        let rotation = pose.rotation() * hinge.rotation(swim);
        out[spine.link_count() + number] =
            Transform::new(pose.point(hinge.position - rest), rotation, 1.0);
    }
}
