use bioscope_core::{Mat3, Quat, Vec3};
use bioscope_dynamics::spring_body::fish::{CENTER_LINE, NODES};
use bioscope_geometry::Transform;

use crate::undulation::Spine;

/// Points of the center line.
const POINTS: usize = CENTER_LINE.len();

/// The center line of a fish: a smooth curve from snout to tail with a direction upward.
pub(super) struct CenterLine {
    /// Shares of the length at rest, rising from 0 to 1.
    shares: [f32; POINTS],
    points: [Vec3; POINTS],
    ups: [Vec3; POINTS],
}

impl CenterLine {
    /// The line of these nodes; `shares` are those of its points at rest.
    pub fn new(nodes: &[Vec3; NODES], shares: [f32; POINTS]) -> Self {
        let points = CENTER_LINE
            .map(|ring| ring.iter().map(|&node| nodes[node]).sum::<Vec3>() / ring.len() as f32);
        // Rings count left top, left bottom, right bottom, right top; the tail top, bottom.
        let ups = std::array::from_fn(|at| {
            let ring = CENTER_LINE[at.max(1)];
            let rise = match ring {
                [a, b, c, d] => nodes[*a] + nodes[*d] - nodes[*b] - nodes[*c],
                [top, bottom] => nodes[*top] - nodes[*bottom],
                _ => Vec3::Y,
            };
            rise.normalize_or(Vec3::Y)
        });
        Self { shares, points, ups }
    }

    /// The piece that a share of the length lies on, and how far along.
    fn piece(&self, share: f32) -> (usize, f32) {
        let piece = self.shares[1..POINTS - 1].partition_point(|&one| one <= share);
        let (start, end) = (self.shares[piece], self.shares[piece + 1]);
        (piece, ((share - start) / (end - start)).clamp(0.0, 1.0))
    }

    /// The point this share of the length from the snout: cubic pieces whose slopes at the joints are those
    /// of the parabola through three points.
    pub fn point(&self, share: f32) -> Vec3 {
        let (piece, at) = self.piece(share);
        let width = self.shares[piece + 1] - self.shares[piece];
        let [start, end] = [piece, piece + 1].map(|joint| self.slope(joint) * width);
        let (before, after) = (self.points[piece], self.points[piece + 1]);
        let rest = 1.0 - at;
        before * ((1.0 + 2.0 * at) * rest * rest)
            + start * (at * rest * rest)
            + after * (at * at * (3.0 - 2.0 * at))
            - end * (at * at * rest)
    }

    fn slope(&self, joint: usize) -> Vec3 {
        let slope = |piece: usize| {
            (self.points[piece + 1] - self.points[piece])
                / (self.shares[piece + 1] - self.shares[piece])
        };
        if joint == 0 {
            return slope(0);
        }
        if joint == POINTS - 1 {
            return slope(POINTS - 2);
        }
        let [before, after] = [joint - 1, joint].map(|one| self.shares[one + 1] - self.shares[one]);
        (slope(joint - 1) * after + slope(joint) * before) / (before + after)
    }

    fn up(&self, share: f32) -> Vec3 {
        let (piece, at) = self.piece(share);
        self.ups[piece].lerp(self.ups[piece + 1], at)
    }

    /// Writes the poses of a spine's links, in mesh space.
    pub fn pose(&self, spine: &Spine, out: &mut [Transform]) {
        let cuts = spine.cuts();
        let mut fore = self.point(cuts[0]);
        for (link, pose) in out[..spine.link_count()].iter_mut().enumerate() {
            let hind = self.point(cuts[link + 1]);
            let rotation = frame(fore - hind, self.up(0.5 * (cuts[link] + cuts[link + 1])));
            *pose = Transform::new(fore * spine.length(), rotation, 1.0);
            fore = hind;
        }
    }
}

/// The rotation that turns +Z ahead and +Y as near to `up` as can be.
fn frame(ahead: Vec3, up: Vec3) -> Quat {
    let ahead = ahead.normalize_or(Vec3::Z);
    let left = up.cross(ahead).normalize_or(Vec3::X);
    Quat::from_mat3(&Mat3::from_cols(left, ahead.cross(left), ahead)).normalize()
}
