//! Polygons, predefined surfaces and balls.

use bioscope_core::{Vec2, Vec3, math};

use super::{
    Binding, Builder, Vertex,
    axes::{Line, Node, perpendicular},
};
use crate::Tessellation;
use crate::interpretation::{Anchor, Ball, Basis, Disc, Patch, Polygon, Surface};

/// Control points of the leaf that every `~x` stands for, as a bicubic Bézier patch: left, ahead
/// and up of the turtle, one row per step ahead; of length 1 and about a third as wide.
const LEAF: [[[f32; 3]; 4]; 4] = [
    [[0.02, 0.0, 0.0], [0.01, 0.0, 0.0], [-0.01, 0.0, 0.0], [-0.02, 0.0, 0.0]],
    [[0.30, 0.30, 0.10], [0.10, 0.33, 0.02], [-0.10, 0.33, 0.02], [-0.30, 0.30, 0.10]],
    [[0.24, 0.72, 0.14], [0.08, 0.75, 0.08], [-0.08, 0.75, 0.08], [-0.24, 0.72, 0.14]],
    [[0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
];
/// Quads of a leaf along and across.
const LEAF_QUADS: [u32; 2] = [5, 2];
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
        let drawn = self.drawn;
        let shape = drawn.shapes.surfaces.get(&surface.name);
        let leaf = std::mem::take(&mut self.leaf);
        let mesh = shape.map_or(&leaf, |shape| &shape.mesh);
        let Surface { frame, scale, .. } = surface;
        let turned = |v: Vec3| frame.left * v.x + frame.heading * v.y + frame.up * v.z;
        let inverse = Vec3::new(scale.y * scale.z, scale.z * scale.x, scale.x * scale.y);
        let first = self.mesh.positions.len() as u32;
        for ((&place, &normal), &uv) in mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs) {
            let local = place * *scale;
            self.vertex(Vertex {
                position: surface.position + turned(local),
                normal: turned(normal * inverse).normalize_or(frame.up).normalize_or(frame.up),
                uv,
                color: surface.color,
                binding: Binding { path: binding.path + local.y.abs(), ..binding },
            });
        }
        let mirrored = scale.x * scale.y * scale.z < 0.0;
        self.mesh.triangles.extend(mesh.triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|corner| corner + first);
            if mirrored { [a, c, b] } else { [a, b, c] }
        }));
        self.leaf = leaf;
    }

    pub(super) fn patch(&mut self, patch: &Patch) {
        let binding = self.binding(patch.anchor);
        let mut mesh = Tessellation::default();
        mesh.add_patch(&patch.points, patch.basis, patch.quads);
        let first = self.mesh.positions.len() as u32;
        for ((&position, &normal), &uv) in mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs) {
            self.vertex(Vertex { position, normal, uv, color: patch.color, binding });
        }
        let moved = mesh.triangles.iter().map(|corners| corners.map(|corner| corner + first));
        self.mesh.triangles.extend(moved);
    }

    pub(super) fn disc(&mut self, disc: &Disc) {
        const SIDES: u32 = 24;
        if disc.radius <= 0.0 {
            return;
        }
        self.prepare_circle(SIDES);
        let binding = self.binding(disc.anchor);
        let across = disc.normal.any_orthonormal_vector();
        let over = disc.normal.cross(across);
        let inner = disc.rim.map_or(0.0, |rim| (disc.radius - rim).max(0.0));
        let first = self.mesh.positions.len() as u32;
        for side in 0..=SIDES as usize {
            let [cosine, sine] = self.circles[SIDES as usize][side];
            for radius in [inner, disc.radius] {
                let out = (across * cosine + over * sine) * radius;
                let share = 0.5 * radius / disc.radius;
                self.vertex(Vertex {
                    position: disc.center + out,
                    normal: disc.normal,
                    uv: [0.5 + share * cosine, 0.5 + share * sine],
                    color: disc.color,
                    binding,
                });
            }
        }
        for side in 0..SIDES {
            let a = first + 2 * side;
            self.mesh.triangles.push([a, a + 1, a + 3]);
            if inner > 0.0 {
                self.mesh.triangles.push([a, a + 3, a + 2]);
            }
        }
    }

    /// A ball of so many rings from pole to pole, and at least as many sides.
    pub(super) fn ball(&mut self, ball: &Ball, rings: u32) {
        let left = ball.axis.any_orthonormal_vector();
        let node = |ring: u32| {
            // From just above the lower pole to just below the upper one, which the tube rounds off.
            let angle = math::PI * (ring as f32 + 0.05) / (rings as f32 - 0.9);
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
            let line = Line::new((0..rings).map(node).collect(), binding);
            self.tube(
                &line,
                self.options.sides.clamp(2 * rings - 5, (3 * rings - 3).min(16)),
                true,
            );
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

/// The leaf that every `~x` without a file stands for.
pub(super) fn leaf() -> Tessellation {
    let mut mesh = Tessellation::default();
    mesh.add_patch(&LEAF.map(|row| row.map(Vec3::from_array)), Basis::Bezier, LEAF_QUADS);
    mesh
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
