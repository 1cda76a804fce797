//! Cylinders and ribbons along the axes.

use bioscope_core::{Vec2, Vec3, math};

use super::{Binding, Builder, Layout, MOST_SIDES, Vertex};
use crate::{Interpretation, interpretation::Contour};

/// How far the edge of a ruffled ribbon is bent up and down, in half widths.
const RUFFLE: f32 = 0.45;
/// By what angle the ruffle advances from node to node: no whole part of a turn, so it does not repeat.
const RUFFLE_ADVANCE: f32 = 2.4;

/// One node of an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub position: Vec3,
    pub radius: f32,
    pub color: i32,
    /// Left of the turtle there.
    pub left: Vec3,
    /// Distance from the base of the axis.
    pub arc: f32,
    /// Unit vector along the axis.
    pub tangent: Vec3,
}

/// The nodes of one axis.
#[derive(Default)]
pub(super) struct Line {
    pub nodes: Vec<Node>,
    axis: Option<u32>,
    base: f32,
}

impl Line {
    /// Takes over the nodes of an axis; if it `merges`, without those on straight pieces between others.
    pub fn read(&mut self, drawn: &Interpretation, layout: &Layout, axis: u32, merges: bool) {
        let (start, end) = (layout.starts[axis as usize], layout.starts[axis as usize + 1]);
        self.axis = Some(axis);
        self.base = layout.bases[axis as usize];
        self.nodes.clear();
        for index in start..end {
            let segment = &drawn.segments[layout.list[index] as usize];
            let node = Node {
                position: segment.end,
                radius: segment.end_radius,
                color: segment.color,
                left: segment.left,
                arc: layout.arcs[index],
                tangent: Vec3::ZERO,
            };
            if index == start {
                self.nodes.push(Node {
                    position: segment.start,
                    radius: segment.start_radius,
                    color: segment.start_color,
                    arc: 0.0,
                    ..node
                });
            } else if merges && self.is_straight_to(&node) {
                self.nodes.pop();
            }
            self.nodes.push(node);
        }
        self.direct();
    }

    /// Whether the last node lies so evenly between the one before it and `next` that nobody misses it.
    fn is_straight_to(&self, next: &Node) -> bool {
        let [.., before, last] = &self.nodes[..] else { return false };
        if before.color != last.color || last.color != next.color {
            return false;
        }
        let (arriving, leaving) = (last.position - before.position, next.position - last.position);
        let (a, b) = (arriving.length(), leaving.length());
        let aligned = arriving.dot(leaving) >= a * b * (1.0 - 1e-7);
        let radius = before.radius + (next.radius - before.radius) * (a / (a + b).max(1e-30));
        aligned && (radius - last.radius).abs() <= 1e-4 * last.radius
    }

    /// A line of these nodes at one place of the plant.
    pub fn new(nodes: Vec<Node>, binding: Binding) -> Self {
        let mut line = Self { nodes, axis: binding.axis, base: binding.path };
        line.direct();
        line
    }

    /// Finds the tangents: at each node the mean of the directions before and after it.
    fn direct(&mut self) {
        let (mut before, mut arriving) = (Vec3::Y, Vec3::ZERO);
        for index in 0..self.nodes.len() {
            let leaving = self.nodes.get(index + 1).map_or(Vec3::ZERO, |next| {
                (next.position - self.nodes[index].position).normalize_or_zero()
            });
            // Where the axis turns back on itself the mean is nothing but rounding.
            let mean = arriving + leaving;
            let mean = if mean.length_squared() < 0.04 { arriving } else { mean };
            before = mean.normalize_or(before);
            self.nodes[index].tangent = before;
            arriving = leaving;
        }
    }

    fn binding(&self, node: &Node) -> Binding {
        Binding { axis: self.axis, path: self.base + node.arc }
    }

    /// Change of the radius per length at a node.
    fn slope(&self, index: usize) -> f32 {
        const STEEPEST: f32 = 1e4;
        let before = &self.nodes[index.saturating_sub(1)];
        let after = &self.nodes[(index + 1).min(self.nodes.len() - 1)];
        let change = after.radius - before.radius;
        let way = before.position.distance(after.position);
        if change == 0.0 || way <= 0.0 { 0.0 } else { (change / way).clamp(-STEEPEST, STEEPEST) }
    }

    /// Length of texture once around its base.
    fn girth(&self) -> f32 {
        (math::TAU * self.nodes[0].radius).max(1e-4)
    }
}

/// How a ring lies: across it, over it, and how its radius changes.
#[derive(Clone, Copy)]
struct Ring {
    across: Vec3,
    over: Vec3,
    slope: f32,
    girth: f32,
    sides: u32,
}

impl Builder<'_> {
    /// Adds an axis; `sides` 0 leaves its sides to its radius.
    pub(super) fn axis(&mut self, line: &Line, contour: Contour, sides: u16) {
        if line.nodes.len() < 2 {
            return;
        }
        let thickest = || line.nodes.iter().map(|node| node.radius).fold(0.0, f32::max);
        let own = |builder: &Self| match sides {
            0 => builder.sides_of(thickest()),
            sides => u32::from(sides).clamp(3, MOST_SIDES),
        };
        match contour {
            Contour::Round => self.tube(line, own(self), line.base == 0.0),
            Contour::Ribbon => self.ribbon(line, 0.0),
            Contour::Ruffle => self.ribbon(line, RUFFLE),
            Contour::Profile(number) => {
                let sides = if sides == 0 { self.options.sides } else { own(self) };
                self.profile(line, number, sides.clamp(3, MOST_SIDES));
            }
        }
    }

    /// Adds a generalized cylinder with a rounded tip and, if asked for, a closed base. Where the
    /// axis turns back on itself (`F(1)F(-1)`, for a hollow tube) its surface is the inner one.
    pub(super) fn tube(&mut self, line: &Line, sides: u32, closed: bool) {
        self.prepare_circle(sides);
        let first = &line.nodes[0];
        let across = perpendicular(first.left, first.tangent);
        let over = first.tangent.cross(across);
        let mut ring = Ring { across, over, slope: 0.0, girth: line.girth(), sides };
        let mut below = None;
        for (index, node) in line.nodes.iter().enumerate() {
            ring.across = perpendicular(ring.across, node.tangent);
            let over = node.tangent.cross(ring.across);
            ring.over = if over.dot(ring.over) < 0.0 { -over } else { over };
            ring.slope = line.slope(index);
            let above = self.ring(line, node, &ring);
            match below {
                Some(below) => self.band(below, above, sides),
                None if closed => self.close(line, node, above, -1.0, sides),
                None => {}
            }
            below = Some(above);
        }
        let (Some(below), Some(tip)) = (below, line.nodes.last()) else { return };
        let swelling = tip.radius * 0.6;
        let position = tip.position + tip.tangent * swelling;
        let (radius, arc) = (tip.radius * 0.7, tip.arc + swelling);
        if sides > 4 && self.has_domes && tip.radius > 0.3 * first.radius {
            let dome = Node { position, radius, arc, ..*tip };
            let upper = self.ring(line, &dome, &Ring { slope: -1.2, ..ring });
            self.band(below, upper, sides);
            self.close(line, &dome, upper, 0.5, sides);
        } else {
            self.close(line, tip, below, 0.8, sides);
        }
    }

    /// Adds a ring of vertices; the number of its first. The seam has two vertices at one place.
    fn ring(&mut self, line: &Line, node: &Node, ring: &Ring) -> u32 {
        let Ring { across, over, slope, girth, sides } = *ring;
        let circle = &self.circles[sides as usize];
        let mesh = &mut self.mesh;
        let first = mesh.positions.len() as u32;
        let (wide, high) = (across * node.radius, over * node.radius);
        let place = |&[cosine, sine]: &[f32; 2]| node.position + wide * cosine + high * sine;
        mesh.positions.extend(circle.iter().map(place));
        // Across, over and the tangent are perpendicular, so one length does for all normals.
        let facing = node.tangent.cross(across).dot(over).signum();
        let scale = facing / (1.0 + slope * slope).sqrt();
        let (wide, high, ahead) = (across * scale, over * scale, node.tangent * (-slope * scale));
        let normal = |&[cosine, sine]: &[f32; 2]| ahead + wide * cosine + high * sine;
        mesh.normals.extend(circle.iter().map(normal));
        let (share, v) = (1.0 / sides as f32, node.arc / girth);
        mesh.uvs.extend((0..=sides).map(|side| [side as f32 * share, v]));
        let count = sides as usize + 1;
        let color = self.options.palette.color(node.color);
        mesh.colors.extend(std::iter::repeat_n(color, count));
        if self.bends {
            self.bindings.extend(std::iter::repeat_n(line.binding(node), count));
        }
        first
    }

    /// Joins two rings.
    fn band(&mut self, below: u32, above: u32, sides: u32) {
        let corners = |index: u32| {
            let (a, b) = (below + index / 2, above + index / 2);
            if index.is_multiple_of(2) { [a, a + 1, b] } else { [a + 1, b + 1, b] }
        };
        self.mesh.triangles.extend((0..2 * sides).map(corners));
    }

    /// Closes a ring by a point `height` radii ahead of it (behind it if negative).
    fn close(&mut self, line: &Line, node: &Node, ring: u32, height: f32, sides: u32) {
        let reach = if height < 0.0 { 0.0 } else { height * node.radius };
        let point = self.vertex(Vertex {
            position: node.position + node.tangent * reach,
            normal: node.tangent * height.signum(),
            uv: [0.5, node.arc],
            color: node.color,
            binding: line.binding(node),
        });
        for side in 0..sides {
            let (a, b) = (ring + side, ring + side + 1);
            self.mesh.triangles.push(if height < 0.0 { [b, a, point] } else { [a, b, point] });
        }
    }

    /// Adds an axis whose cross-section is a contour, x of which is the turtle's down and y its right.
    fn profile(&mut self, line: &Line, number: i32, sides: u32) {
        let Some(shape) = self.drawn.shapes.contours.get(&number) else { return };
        let vertices = self.contours.entry((number, sides)).or_insert_with(|| shape.sampled(sides));
        let (vertices, girth) = (vertices.clone(), line.girth());
        let start = self.mesh.triangles.len();
        let mut below: Option<u32> = None;
        for (index, node) in line.nodes.iter().enumerate() {
            let left = perpendicular(node.left, node.tangent);
            let up = node.tangent.cross(left);
            let slope = line.slope(index);
            let first = self.mesh.positions.len() as u32;
            for vertex in &vertices {
                let out = |at: Vec2| -up * at.x - left * at.y;
                let place = out(vertex.point) + node.tangent * vertex.ahead;
                let normal = out(vertex.normal) - node.tangent * slope;
                self.vertex(Vertex {
                    position: node.position + place * node.radius,
                    normal: normal.normalize_or(node.tangent),
                    uv: [vertex.way, node.arc / girth],
                    color: node.color,
                    binding: line.binding(node),
                });
            }
            if let Some(below) = below {
                self.band(below, first, sides);
            }
            below = Some(first);
        }
        self.face_outward(start);
        if shape.closed
            && let (Some(last), Some(tip)) = (below, line.nodes.last())
        {
            let (start, count) = (self.mesh.triangles.len(), vertices.len() as u32);
            self.close(line, tip, last, 0.01, count - 1);
            self.face_outward(start);
        }
    }

    /// Turns all triangles from `start` on over if those that stand for them face against their normals.
    fn face_outward(&mut self, start: usize) {
        let mesh = &mut self.mesh;
        let facing = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|index| mesh.positions[index as usize]);
            let normals: Vec3 = corners.iter().map(|&index| mesh.normals[index as usize]).sum();
            (b - a).cross(c - a).dot(normals)
        };
        let sum: f32 = mesh.triangles[start..].iter().take(400).map(facing).sum();
        if sum < 0.0 {
            mesh.triangles[start..].iter_mut().for_each(|corners| corners.swap(1, 2));
        }
    }

    /// Adds a flat blade whose edges are bent by `ruffle` half widths.
    fn ribbon(&mut self, line: &Line, ruffle: f32) {
        let (vertex, triangle) = (self.mesh.positions.len(), self.mesh.triangles.len());
        let widest = line.nodes.iter().map(|node| node.radius).fold(0.0, f32::max).max(1e-4);
        let phase = line.axis.unwrap_or(0) as f32 * 1.7;
        let mut below: Option<(u32, u32)> = None;
        let last = line.nodes.len() - 1;
        for (index, node) in line.nodes.iter().enumerate() {
            let left = perpendicular(node.left, node.tangent);
            let up = node.tangent.cross(left);
            let wave = index as f32 * RUFFLE_ADVANCE + phase;
            // Three vertices across a ruffled blade, two across a flat one, one at a sharp tip.
            let columns = match ruffle {
                _ if node.radius < 1e-6 && index == last => 1,
                0.0 => 2,
                _ => 3,
            };
            let first = self.mesh.positions.len() as u32;
            for column in 0..columns {
                let side = if columns == 1 {
                    0.0
                } else {
                    2.0 * column as f32 / (columns - 1) as f32 - 1.0
                };
                let lift = ruffle * side.abs() * math::sin(wave + side * 0.9);
                self.vertex(Vertex {
                    position: node.position + (left * side + up * lift) * node.radius,
                    normal: Vec3::ZERO,
                    uv: [0.5 + side / 2.0, node.arc / (2.0 * widest)],
                    color: node.color,
                    binding: line.binding(node),
                });
            }
            if let Some(below) = below {
                self.strip(below, (first, columns));
            }
            below = Some((first, columns));
        }
        self.smooth_normals(vertex, triangle);
    }

    /// Joins two rows of a blade, each given by its first vertex and their number.
    fn strip(&mut self, below: (u32, u32), above: (u32, u32)) {
        for column in 0..below.1 - 1 {
            let (a, b) = (below.0 + column, above.0 + column);
            if above.1 == 1 {
                self.mesh.triangles.push([a, a + 1, above.0]);
            } else {
                self.mesh.triangles.push([a, a + 1, b]);
                self.mesh.triangles.push([a + 1, b + 1, b]);
            }
        }
    }
}

/// The unit vector nearest to `vector` that is perpendicular to the unit vector `axis`.
pub(super) fn perpendicular(vector: Vec3, axis: Vec3) -> Vec3 {
    let rest = vector - axis * axis.dot(vector);
    let Some(unit) = rest.try_normalize() else { return axis.any_orthonormal_vector() };
    if rest.length_squared() > 0.01 * vector.length_squared() {
        return unit;
    }
    // What little was left of the vector has few digits.
    (unit - axis * axis.dot(unit)).try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector())
}
