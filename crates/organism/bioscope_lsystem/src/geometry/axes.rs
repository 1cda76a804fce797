//! Cylinders and ribbons along the axes.

use bioscope_core::{Vec3, math};

use super::{Binding, Builder, Layout, Vertex};
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
    /// Takes over the nodes of an axis.
    pub fn read(&mut self, interpretation: &Interpretation, layout: &Layout, axis: u32) {
        let (start, end) = (layout.starts[axis as usize], layout.starts[axis as usize + 1]);
        self.axis = Some(axis);
        self.base = layout.bases[axis as usize];
        self.nodes.clear();
        for index in start..end {
            let segment = &interpretation.segments[layout.list[index] as usize];
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
            }
            self.nodes.push(node);
        }
        self.direct();
    }

    /// A line of these nodes at one place of the plant.
    pub fn new(nodes: Vec<Node>, binding: Binding) -> Self {
        let mut line = Self { nodes, axis: binding.axis, base: binding.path };
        line.direct();
        line
    }

    /// Finds the tangents: at each node the mean of the directions before and after it.
    fn direct(&mut self) {
        let positions: Vec<Vec3> = self.nodes.iter().map(|node| node.position).collect();
        let direction = |a: usize, b: usize| (positions[b] - positions[a]).normalize_or_zero();
        let last = positions.len().saturating_sub(1);
        let mut before = Vec3::Y;
        for (index, node) in self.nodes.iter_mut().enumerate() {
            let arriving = if index > 0 { direction(index - 1, index) } else { Vec3::ZERO };
            let leaving = if index < last { direction(index, index + 1) } else { Vec3::ZERO };
            // Where the axis turns back on itself the mean is nothing but rounding.
            let mean = arriving + leaving;
            let mean = if mean.length_squared() < 0.04 { arriving } else { mean };
            node.tangent = mean.normalize_or(before);
            before = node.tangent;
        }
    }

    fn binding(&self, node: &Node) -> Binding {
        Binding { axis: self.axis, path: self.base + node.arc }
    }

    /// Change of the radius per length at a node.
    fn slope(&self, index: usize) -> f32 {
        let before = &self.nodes[index.saturating_sub(1)];
        let after = &self.nodes[(index + 1).min(self.nodes.len() - 1)];
        let way = before.position.distance(after.position);
        if way > 0.0 { (after.radius - before.radius) / way } else { 0.0 }
    }
}

impl Builder<'_> {
    /// Adds an axis.
    pub(super) fn axis(&mut self, line: &Line, contour: Contour) {
        if line.nodes.len() < 2 {
            return;
        }
        match contour {
            Contour::Round => self.tube(line, self.sides(line), line.base == 0.0),
            Contour::Ribbon => self.ribbon(line, 0.0),
            Contour::Ruffle => self.ribbon(line, RUFFLE),
        }
    }

    fn sides(&self, line: &Line) -> u32 {
        let radius = line.nodes.iter().map(|node| node.radius).fold(0.0, f32::max);
        let share = if self.thickest > 0.0 { radius / self.thickest } else { 1.0 };
        let sides = (self.options.sides as f32 * math::sqrt(share.clamp(0.0, 1.0))).ceil();
        (sides as u32).clamp(3, self.options.sides.max(3))
    }

    /// Adds a generalized cylinder with a rounded tip and, if asked for, a closed base. Where the
    /// axis turns back on itself (`F(1)F(-1)`, for a hollow tube) its surface is the inner one.
    pub(super) fn tube(&mut self, line: &Line, sides: u32, closed: bool) {
        let first = &line.nodes[0];
        let girth = (math::TAU * first.radius).max(1e-4);
        let mut across = perpendicular(first.left, first.tangent);
        let mut over = first.tangent.cross(across);
        let mut below = None;
        for (index, node) in line.nodes.iter().enumerate() {
            across = perpendicular(across, node.tangent);
            let side = if node.tangent.cross(across).dot(over) < 0.0 { -1.0 } else { 1.0 };
            over = node.tangent.cross(across) * side;
            let slope = line.slope(index);
            let ring = self.ring(line, node, [across, over], slope, girth, sides);
            match below {
                Some(below) => self.band(below, ring, sides),
                None if closed => self.close(line, node, ring, -1.0, sides),
                None => {}
            }
            below = Some(ring);
        }
        let (Some(ring), Some(tip)) = (below, line.nodes.last()) else { return };
        let swelling = tip.radius * 0.6;
        let position = tip.position + tip.tangent * swelling;
        let (radius, arc) = (tip.radius * 0.7, tip.arc + swelling);
        if sides > 4 && tip.radius > 0.3 * first.radius {
            let dome = Node { position, radius, arc, ..*tip };
            let upper = self.ring(line, &dome, [across, over], -1.2, girth, sides);
            self.band(ring, upper, sides);
            self.close(line, &dome, upper, 0.5, sides);
        } else {
            self.close(line, tip, ring, 0.8, sides);
        }
    }

    /// Adds a ring of vertices; the number of its first. The seam has two vertices at one place.
    fn ring(
        &mut self,
        line: &Line,
        node: &Node,
        [across, over]: [Vec3; 2],
        slope: f32,
        girth: f32,
        sides: u32,
    ) -> u32 {
        let facing = node.tangent.cross(across).dot(over).signum();
        let first = self.mesh.positions.len() as u32;
        for side in 0..=sides {
            // The seam must meet itself to the last bit.
            let angle = math::TAU * (side % sides) as f32 / sides as f32;
            let outward = across * math::cos(angle) + over * math::sin(angle);
            self.vertex(Vertex {
                position: node.position + outward * node.radius,
                normal: (outward - node.tangent * slope).normalize_or(outward) * facing,
                uv: [side as f32 / sides as f32, node.arc / girth],
                color: node.color,
                binding: line.binding(node),
            });
        }
        first
    }

    /// Joins two rings.
    fn band(&mut self, below: u32, above: u32, sides: u32) {
        for side in 0..sides {
            let (a, b) = (below + side, above + side);
            self.mesh.triangles.push([a, a + 1, b]);
            self.mesh.triangles.push([a + 1, b + 1, b]);
        }
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
    rest.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector())
}
