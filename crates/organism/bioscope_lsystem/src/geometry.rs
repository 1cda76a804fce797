//! From what the turtle has drawn to a triangle mesh that can bend.
//!
//! Round axes become generalized cylinders: rings in frames carried along the axis without
//! twist, one ring per node, so that neighboring segments share their vertices and leave no
//! crack; the tips are rounded and the base of a branch is open inside its parent. Axes with a
//! contour keep to the turtle's left. Texture coordinates run around (u) and along the axis (v, in circumferences).

mod axes;
mod layout;
mod palette;
mod patches;
mod skeleton;

use std::collections::BTreeMap;

use bioscope_core::{Result, Vec3, math};
use bioscope_geometry::Mesh;

pub use palette::Palette;
pub use skeleton::{Held, PlantShape, SkeletonOptions};

use crate::interpretation::Contour;
use crate::{Interpretation, Tessellation, files::ContourVertex};
use axes::Line;
use layout::Layout;

/// How a mesh is made.
#[derive(Clone, Debug)]
pub struct MeshOptions {
    /// How many sides the thickest axis has, at least 3; thinner ones have fewer, and in plants of
    /// very many segments all have.
    pub sides: u32,
    /// Colors that the turtle's color numbers mean.
    pub palette: Palette,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self { sides: 8, palette: Palette::default() }
    }
}

/// Most sides of an axis.
const MOST_SIDES: u32 = 64;
/// Plants of more segments have axes of fewer sides and with pointed tips: nobody sees theirs closely.
const DETAILED: usize = 200_000;
/// Plants of more balls have coarser ones.
const FEW_BALLS: usize = 500;

impl Interpretation {
    /// The plant as one mesh with vertex colors, rigid.
    pub fn mesh(&self, options: &MeshOptions) -> Mesh {
        Builder::build(self, options, None, false).mesh
    }

    /// The parts of the plant that have this texture (0 is none) as one mesh.
    pub fn mesh_of_texture(&self, options: &MeshOptions, texture: u16) -> Mesh {
        Builder::build(self, options, Some(texture), false).mesh
    }

    /// The plant as one mesh with joints along its main axes.
    pub fn shape(&self, mesh: &MeshOptions, skeleton: &SkeletonOptions) -> Result<PlantShape> {
        skeleton::shape(self, mesh, skeleton)
    }

    /// Likewise, but with the predefined surfaces (leaves) apart, so that they can be drawn as instances.
    pub fn shape_and_leaves(
        self,
        mesh: &MeshOptions,
        skeleton: &SkeletonOptions,
    ) -> Result<(PlantShape, Vec<Held>)> {
        skeleton::shape_and_leaves(self, mesh, skeleton)
    }
}

/// Where a vertex is on the plant.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Binding {
    /// Its axis; none for what stands on no axis.
    axis: Option<u32>,
    /// Way from the root to it along the axes, metres.
    path: f32,
}

/// A mesh that is being made, with the binding of each vertex if it is to bend.
struct Builder<'a> {
    mesh: Mesh,
    bends: bool,
    bindings: Vec<Binding>,
    layout: Layout,
    drawn: &'a Interpretation,
    options: &'a MeshOptions,
    /// Radius of the thickest round axis.
    thickest: f32,
    /// Sides of the thickest round axis.
    most_sides: u32,
    /// Whether tips are round.
    has_domes: bool,
    /// Cosines and sines around a circle, by the number of sides; the first comes again at the end.
    circles: Vec<Vec<[f32; 2]>>,
    /// Contours by number and sides.
    contours: BTreeMap<(i32, u32), Vec<ContourVertex>>,
    /// The surface of those that have no file.
    leaf: Tessellation,
}

impl<'a> Builder<'a> {
    fn build(
        drawn: &'a Interpretation,
        options: &'a MeshOptions,
        texture: Option<u16>,
        bends: bool,
    ) -> Self {
        let radii = drawn.segments.iter().map(|segment| segment.start_radius);
        let crowd = drawn.segments.len() as f32 / DETAILED as f32;
        let most_sides = options.sides.clamp(3, MOST_SIDES) as f32 / crowd.max(1.0).powf(0.4);
        let mut builder = Self {
            mesh: Mesh::default(),
            bends,
            bindings: Vec::new(),
            layout: Layout::new(drawn),
            drawn,
            options,
            thickest: radii.fold(0.0, f32::max),
            most_sides: (most_sides.ceil() as u32).max(3),
            has_domes: drawn.segments.len() <= DETAILED,
            circles: vec![Vec::new(); MOST_SIDES as usize + 1],
            contours: BTreeMap::new(),
            leaf: patches::leaf(),
        };
        let wanted = |own: u16| texture.is_none_or(|texture| texture == own);
        builder.reserve();
        let mut line = Line::default();
        for (number, axis) in drawn.axes.iter().enumerate() {
            if wanted(axis.texture) {
                // What bends needs a ring at every node.
                let merges = !bends && axis.contour == Contour::Round;
                line.read(drawn, &builder.layout, number as u32, merges);
                builder.axis(&line, axis.contour, axis.sides);
            }
        }
        drawn
            .polygons
            .iter()
            .filter(|one| wanted(one.texture))
            .for_each(|one| builder.polygon(one));
        for surface in &drawn.surfaces {
            let shape = drawn.shapes.surfaces.get(&surface.name);
            let own = shape.and_then(|shape| shape.texture).unwrap_or(surface.texture);
            if wanted(own) {
                builder.surface(surface);
            }
        }
        drawn.patches.iter().filter(|one| wanted(one.texture)).for_each(|one| builder.patch(one));
        if wanted(0) {
            let rings = if drawn.balls.len() <= FEW_BALLS { 9 } else { 5 };
            drawn.balls.iter().for_each(|ball| builder.ball(ball, rings));
            drawn.discs.iter().for_each(|disc| builder.disc(disc));
        }
        builder
    }

    /// Makes room for the axes, most of which have few sides.
    fn reserve(&mut self) {
        let (mut vertices, mut triangles) = (0, 0);
        for (number, axis) in self.drawn.axes.iter().enumerate() {
            let last = self.layout.starts[number];
            let radius = self
                .layout
                .list
                .get(last)
                .map_or(0.0, |&segment| self.drawn.segments[segment as usize].start_radius);
            let sides = self.sides_of(radius) as usize;
            vertices += (axis.segments as usize + 2) * (sides + 1) + 2;
            triangles += (axis.segments as usize + 2) * 2 * sides;
        }
        self.mesh.positions.reserve(vertices);
        self.mesh.normals.reserve(vertices);
        self.mesh.uvs.reserve(vertices);
        self.mesh.colors.reserve(vertices);
        self.mesh.triangles.reserve(triangles);
        if self.bends {
            self.bindings.reserve(vertices);
        }
    }

    /// Sides of an axis of this radius.
    fn sides_of(&self, radius: f32) -> u32 {
        let share = if self.thickest > 0.0 { radius / self.thickest } else { 1.0 };
        let sides = (self.most_sides as f32 * share.clamp(0.0, 1.0).sqrt()).ceil();
        (sides as u32).clamp(3, self.most_sides)
    }

    /// Makes sure that there is a circle of so many sides.
    fn prepare_circle(&mut self, sides: u32) {
        let circle = &mut self.circles[sides as usize];
        if circle.is_empty() {
            // The seam must meet itself to the last bit.
            circle.extend((0..=sides).map(|side| {
                let angle = math::TAU * (side % sides) as f32 / sides as f32;
                [math::cos(angle), math::sin(angle)]
            }));
        }
    }

    /// Adds a vertex; its number.
    fn vertex(&mut self, vertex: Vertex) -> u32 {
        self.mesh.positions.push(vertex.position);
        self.mesh.normals.push(vertex.normal);
        self.mesh.uvs.push(vertex.uv);
        self.mesh.colors.push(self.options.palette.color(vertex.color));
        if self.bends {
            self.bindings.push(vertex.binding);
        }
        self.mesh.positions.len() as u32 - 1
    }

    /// Replaces the normals of the vertices from `vertex` on by those of the triangles from
    /// `triangle` on, smoothed.
    fn smooth_normals(&mut self, vertex: usize, triangle: usize) {
        let mesh = &mut self.mesh;
        for corners in &mesh.triangles[triangle..] {
            let [a, b, c] = corners.map(|index| mesh.positions[index as usize]);
            let area = (b - a).cross(c - a);
            for &index in corners {
                mesh.normals[index as usize] += area;
            }
        }
        for normal in &mut mesh.normals[vertex..] {
            // Twice, for the sum over very small triangles has few digits.
            *normal = normal.normalize_or(Vec3::Y).normalize_or(Vec3::Y);
        }
    }
}

struct Vertex {
    position: Vec3,
    normal: Vec3,
    uv: [f32; 2],
    color: i32,
    binding: Binding,
}
