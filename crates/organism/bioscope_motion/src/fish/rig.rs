use bioscope_core::{Mat3, Quat, Vec3};
use bioscope_dynamics::spring_body::fish::{CENTER_LINE, FishShape, NODES};
use bioscope_geometry::Transform;

use crate::undulation::{Spine, SwimState, pose_hinges};

/// Bends a spine as the nodes of a body are bent: writes the poses of all joints in mesh space, links first, then
/// the hinged fins, which beat as `swim` says (its `fan`, `fanning` and `bend`). `nodes` are in the body's placement and in
/// body lengths ([`Swimmers::local_nodes`](super::Swimmers::local_nodes)).
pub fn pose_from_nodes(
    spine: &Spine,
    shape: &FishShape,
    nodes: &[Vec3; NODES],
    swim: &SwimState,
    out: &mut [Transform],
) {
    assert_eq!(out.len(), spine.joint_count(), "poses of a spine");
    let line = CenterLine::new(shape, nodes);
    let length = spine.length();
    for (link, pose) in out[..spine.link_count()].iter_mut().enumerate() {
        let [fore, hind] = [spine.cuts()[link], spine.cuts()[link + 1]];
        let (start, end) = (line.point(fore), line.point(hind));
        let ahead = (start - end).normalize_or(Vec3::Z);
        let up = line.up(0.5 * (fore + hind));
        let left = up.cross(ahead).normalize_or(Vec3::X);
        let rotation = Quat::from_mat3(&Mat3::from_cols(left, ahead.cross(left), ahead));
        *pose = Transform::new(start * length, rotation.normalize(), 1.0);
    }
    pose_hinges(spine, swim, out);
}

/// The middle of the body from snout to tail as a smooth curve.
struct CenterLine {
    places: [f32; 7],
    points: [Vec3; 7],
    ups: [Vec3; 7],
}

impl CenterLine {
    fn new(shape: &FishShape, nodes: &[Vec3; NODES]) -> Self {
        let [a, b, c, d, e] = shape.stations.map(|station| station as f32);
        let mean = |ring: usize| {
            let sum: Vec3 = CENTER_LINE[ring].iter().map(|&node| nodes[node]).sum();
            sum / CENTER_LINE[ring].len() as f32
        };
        let mut ups: [Vec3; 7] = std::array::from_fn(|ring| match ring {
            0 => Vec3::Y,
            6 => nodes[21] - nodes[22],
            ring => {
                let first = 4 * ring - 3;
                nodes[first] + nodes[first + 3] - nodes[first + 1] - nodes[first + 2]
            }
        });
        ups[0] = ups[1];
        let ups = ups.map(|up| up.normalize_or(Vec3::Y));
        Self { places: [0.0, a, b, c, d, e, 1.0], points: std::array::from_fn(mean), ups }
    }

    fn span(&self, at: f32) -> (usize, f32) {
        let span = self.places[1..6].iter().position(|&place| at < place).unwrap_or(5);
        let (from, to) = (self.places[span], self.places[span + 1]);
        (span, ((at - from) / (to - from)).clamp(0.0, 1.0))
    }

    /// Point at a share of the length: a cubic through the rings with slopes from their neighbors (Catmull and Rom).
    fn point(&self, at: f32) -> Vec3 {
        let (span, t) = self.span(at);
        let slope = |knot: usize| {
            let (a, b) = (knot.saturating_sub(1), (knot + 1).min(6));
            (self.points[b] - self.points[a]) / (self.places[b] - self.places[a])
        };
        let step = self.places[span + 1] - self.places[span];
        let (square, cube) = (t * t, t * t * t);
        self.points[span] * (2.0 * cube - 3.0 * square + 1.0)
            + slope(span) * (step * (cube - 2.0 * square + t))
            + self.points[span + 1] * (3.0 * square - 2.0 * cube)
            + slope(span + 1) * (step * (cube - square))
    }

    fn up(&self, at: f32) -> Vec3 {
        let (span, t) = self.span(at);
        self.ups[span].lerp(self.ups[span + 1], t).normalize_or(Vec3::Y)
    }
}
