//! Polygons, predefined surfaces and balls.

use bioscope_core::{Vec2, Vec3, math};

use super::{
    Binding, Builder, Vertex,
    axes::{Line, Node, perpendicular},
};
use crate::interpretation::{Anchor, Ball, Polygon, Surface};

/// Control points of the leaf that every `~x` stands for, as a bicubic Bézier patch: left, ahead
/// and up of the turtle, one row per step ahead; of length 1 and about a third as wide.
const LEAF: [[[f32; 3]; 4]; 4] = [
    [[0.02, 0.0, 0.0], [0.01, 0.0, 0.0], [-0.01, 0.0, 0.0], [-0.02, 0.0, 0.0]],
    [[0.30, 0.30, 0.10], [0.10, 0.33, 0.02], [-0.10, 0.33, 0.02], [-0.30, 0.30, 0.10]],
    [[0.24, 0.72, 0.14], [0.08, 0.75, 0.08], [-0.08, 0.75, 0.08], [-0.24, 0.72, 0.14]],
    [[0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
];
/// Quads of a leaf across and along.
const LEAF_QUADS: (u32, u32) = (2, 5);
/// Corners of a polygon that are cut off one by one; larger ones are taken as convex.
const EAR_LIMIT: usize = 100;

impl Builder<'_> {
    fn binding(&self, anchor: Option<Anchor>) -> Binding {
        match anchor {
            Some(anchor) => Binding { axis: Some(anchor.axis), path: self.layout.path(anchor) },
            None => Binding { axis: None, path: 0.0 },
        }
    }

    pub(super) fn polygon(&mut self, polygon: &Polygon) {
        let corners = &polygon.corners;
        let binding = self.binding(polygon.anchor);
        let normal = polygon_normal(corners);
        let across = perpendicular(corners[1] - corners[0], normal);
        let over = normal.cross(across);
        let flat: Vec<Vec2> =
            corners.iter().map(|corner| Vec2::new(corner.dot(across), corner.dot(over))).collect();
        let low = flat.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let size = (flat.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max) - low)
            .max_element()
            .max(1e-6);
        let first = self.mesh.positions.len() as u32;
        for (&position, &point) in corners.iter().zip(&flat) {
            let uv = ((point - low) / size).to_array();
            let way = position.distance(corners[0]);
            let binding = Binding { path: binding.path + way, ..binding };
            self.vertex(Vertex { position, normal, uv, color: polygon.color, binding });
        }
        let triangles = triangulate(&flat).into_iter();
        self.mesh.triangles.extend(triangles.map(|corners| corners.map(|corner| corner + first)));
    }

    pub(super) fn surface(&mut self, surface: &Surface) {
        let binding = self.binding(surface.anchor);
        let (vertex, triangle) = (self.mesh.positions.len(), self.mesh.triangles.len());
        let (across, along) = LEAF_QUADS;
        for row in 0..=along {
            for column in 0..=across {
                let (u, v) = (column as f32 / across as f32, row as f32 / along as f32);
                let local = bezier(&LEAF, u, v) * surface.scale;
                let frame = &surface.frame;
                let way = frame.left * local.x + frame.heading * local.y + frame.up * local.z;
                self.vertex(Vertex {
                    position: surface.position + way,
                    normal: Vec3::ZERO,
                    uv: [u, v],
                    color: surface.color,
                    binding: Binding { path: binding.path + local.y.abs(), ..binding },
                });
            }
        }
        for row in 0..along {
            for column in 0..across {
                let a = vertex as u32 + row * (across + 1) + column;
                let b = a + across + 1;
                self.mesh.triangles.push([a, b, a + 1]);
                // The tip of the leaf is one point.
                if row + 1 < along {
                    self.mesh.triangles.push([a + 1, b, b + 1]);
                }
            }
        }
        self.smooth_normals(vertex, triangle);
    }

    pub(super) fn ball(&mut self, ball: &Ball) {
        const RINGS: u32 = 5;
        let left = ball.axis.any_orthonormal_vector();
        let node = |ring: u32| {
            // From just above the lower pole to just below the upper one.
            let angle = math::PI * (ring as f32 + 0.35) / (RINGS as f32 - 0.3);
            let (height, radius) =
                (-math::cos(angle) * ball.radius, math::sin(angle) * ball.radius);
            Node {
                position: ball.center + ball.axis * height,
                radius: radius.abs(),
                color: ball.color,
                left,
                arc: 0.0,
                tangent: ball.axis,
            }
        };
        if ball.radius > 0.0 {
            let binding = self.binding(ball.anchor);
            let line = Line::new((0..RINGS).map(node).collect(), binding);
            self.tube(&line, self.options.sides.clamp(5, 12), true);
        }
    }
}

/// Mean normal of a polygon, by Newell's sum over its edges.
fn polygon_normal(corners: &[Vec3]) -> Vec3 {
    let next = corners.iter().cycle().skip(1);
    let sum: Vec3 =
        corners.iter().zip(next).map(|(a, b)| (*a - corners[0]).cross(*b - corners[0])).sum();
    sum.normalize_or(Vec3::Y).normalize_or(Vec3::Y)
}

/// Cuts a simple polygon (counterclockwise) into triangles, ear by ear.
fn triangulate(points: &[Vec2]) -> Vec<[u32; 3]> {
    let mut left: Vec<u32> = (0..points.len() as u32).collect();
    let mut triangles = Vec::with_capacity(points.len());
    let at = |index: u32| points[index as usize];
    while left.len() > 3 && left.len() <= EAR_LIMIT {
        let count = left.len();
        let corner = |middle: usize| {
            [left[(middle + count - 1) % count], left[middle], left[(middle + 1) % count]]
        };
        let is_ear = |&middle: &usize| {
            let [a, b, c] = corner(middle);
            turn(at(a), at(b), at(c)) > 0.0
                && left.iter().all(|&other| {
                    [a, b, c].contains(&other) || !is_inside(at(other), [at(a), at(b), at(c)])
                })
        };
        let Some(ear) = (0..count).find(is_ear) else { break };
        triangles.push(corner(ear));
        left.remove(ear);
    }
    // What is left is a triangle, or no simple polygon: a fan does for it.
    triangles.extend((2..left.len()).map(|corner| [left[0], left[corner - 1], left[corner]]));
    triangles
}

/// Twice the area of a triangle, positive if counterclockwise.
fn turn(a: Vec2, b: Vec2, c: Vec2) -> f32 {
    (b - a).perp_dot(c - a)
}

fn is_inside(point: Vec2, [a, b, c]: [Vec2; 3]) -> bool {
    turn(a, b, point) >= 0.0 && turn(b, c, point) >= 0.0 && turn(c, a, point) >= 0.0
}

fn bezier(points: &[[[f32; 3]; 4]; 4], u: f32, v: f32) -> Vec3 {
    let weights = |t: f32| {
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    };
    let (across, along) = (weights(u), weights(v));
    let mut sum = Vec3::ZERO;
    for (row, weight) in points.iter().zip(along) {
        for (point, other) in row.iter().zip(across) {
            sum += Vec3::from_array(*point) * (weight * other);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_concave_polygon_keeps_its_area() {
        let arrow = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 0.5), (0.0, 2.0)].map(Vec2::from);
        let triangles = triangulate(&arrow);
        let areas = triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|corner| arrow[corner as usize]);
            turn(a, b, c) / 2.0
        });
        let areas: Vec<f32> = areas.collect();
        assert!(areas.iter().all(|&area| area >= 0.0), "{areas:?}");
        assert!((areas.iter().sum::<f32>() - 2.5).abs() < 1e-6);
    }
}
