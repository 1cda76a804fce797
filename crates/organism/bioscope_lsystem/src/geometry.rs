//! From what the turtle has drawn to a triangle mesh that can bend.
//!
//! Round axes become generalized cylinders: rings in frames carried along the axis without
//! twist, one ring per node, so that neighboring segments share their vertices and leave no
//! crack; the tips are rounded and the base of a branch is open inside its parent. Texture
//! coordinates run around (u) and along the axis (v, in circumferences).

mod axes;
mod layout;
mod palette;
mod patches;
mod skeleton;

use bioscope_core::{Result, Vec3};
use bioscope_geometry::Mesh;

pub use palette::Palette;
pub use skeleton::{PlantShape, SkeletonOptions};

use crate::Interpretation;
use axes::Line;
use layout::Layout;

/// How a mesh is made.
#[derive(Clone, Debug)]
pub struct MeshOptions {
    /// How many sides the thickest axis has, at least 3; thinner ones have fewer.
    pub sides: u32,
    /// Colors that the turtle's color numbers mean.
    pub palette: Palette,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self { sides: 8, palette: Palette::default() }
    }
}

impl Interpretation {
    /// The plant as one mesh with vertex colors, rigid.
    pub fn mesh(&self, options: &MeshOptions) -> Mesh {
        Builder::build(self, options).mesh
    }

    /// The plant as one mesh with joints along its main axes.
    pub fn shape(&self, mesh: &MeshOptions, skeleton: &SkeletonOptions) -> Result<PlantShape> {
        skeleton::shape(self, mesh, skeleton)
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

/// A mesh that is being made, with the binding of each vertex.
struct Builder<'a> {
    mesh: Mesh,
    bindings: Vec<Binding>,
    layout: Layout,
    options: &'a MeshOptions,
    /// Radius of the thickest round axis.
    thickest: f32,
}

impl<'a> Builder<'a> {
    fn build(interpretation: &Interpretation, options: &'a MeshOptions) -> Self {
        let radii = interpretation.segments.iter().map(|segment| segment.start_radius);
        let mut builder = Self {
            mesh: Mesh::default(),
            bindings: Vec::new(),
            layout: Layout::new(interpretation),
            options,
            thickest: radii.fold(0.0, f32::max),
        };
        let mut line = Line::default();
        for number in 0..interpretation.axes.len() as u32 {
            line.read(interpretation, &builder.layout, number);
            builder.axis(&line, interpretation.axes[number as usize].contour);
        }
        for polygon in &interpretation.polygons {
            builder.polygon(polygon);
        }
        for surface in &interpretation.surfaces {
            builder.surface(surface);
        }
        for ball in &interpretation.balls {
            builder.ball(ball);
        }
        builder
    }

    /// Adds a vertex; its number.
    fn vertex(&mut self, vertex: Vertex) -> u32 {
        self.mesh.positions.push(vertex.position);
        self.mesh.normals.push(vertex.normal);
        self.mesh.uvs.push(vertex.uv);
        self.mesh.colors.push(self.options.palette.color(vertex.color));
        self.bindings.push(vertex.binding);
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
