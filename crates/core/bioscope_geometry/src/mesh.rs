//! Triangle meshes, with joints to bend them by.

use std::sync::Arc;

use bioscope_core::Vec3;

use crate::{Key, Transform};

mod iso_surface;
pub(crate) mod levels;
mod simplify;
mod sparse;
pub(crate) mod tiles;

pub use iso_surface::iso_surface;

/// A triangle mesh in its own space, shared by all its instances; never changed once published
/// (a deforming body publishes a new mesh).
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// By which observers recognize it.
    pub key: Key,
    /// Vertices, metres.
    pub positions: Vec<Vec3>,
    /// Unit normals, one per vertex.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one per vertex or none at all; v grows downward in the picture.
    pub uvs: Vec<[f32; 2]>,
    /// Linear vertex colours that multiply the material's, one per vertex or none at all.
    pub colors: Vec<[f32; 3]>,
    /// Three vertex numbers per triangle, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// How the mesh bends, if it does.
    pub skin: Option<Skin>,
    /// Coarser versions for the distance, finest first: use each from the given size on screen
    /// downward (projected diameter of the bounding sphere in pixels).
    pub levels: Vec<(f32, Arc<Mesh>)>,
}

/// Joints and the weights that bind vertices to them (linear blend skinning).
#[derive(Clone, Debug)]
pub struct Skin {
    /// The joints; parents come before their children.
    pub joints: Vec<Joint>,
    /// Per vertex four joint numbers.
    pub indices: Vec<[u8; 4]>,
    /// Per vertex the four weights of those joints, sum 1.
    pub weights: Vec<[f32; 4]>,
}

/// One joint at rest.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name in exported skeletons.
    pub name: String,
    /// Number of the parent joint, none for a root.
    pub parent: Option<u8>,
    /// Pose at rest, in mesh space (not relative to the parent).
    pub rest: Transform,
}

impl Mesh {
    /// Least and greatest corner of the axis-aligned box around all vertices.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        self.positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &point| {
            (low.min(point), high.max(point))
        })
    }

    /// Replaces the normals by the area-weighted mean of the adjacent triangles' normals.
    pub fn compute_normals(&mut self) {
        let mut normals = vec![Vec3::ZERO; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|index| self.positions[index as usize]);
            let area = (b - a).cross(c - a);
            for &index in triangle {
                normals[index as usize] += area;
            }
        }
        self.normals = normals.into_iter().map(|normal| normal.normalize_or(Vec3::Y)).collect();
    }

    /// Adds another mesh's triangles, moved by `transform`; keeps texture coordinates and colours
    /// only where both meshes have them. Skins are not merged.
    pub fn append(&mut self, other: &Mesh, transform: &Transform) {
        let first = self.positions.len() as u32;
        let empty = self.positions.is_empty();
        self.positions.extend(other.positions.iter().map(|&point| transform.point(point)));
        self.normals.extend(other.normals.iter().map(|&normal| transform.rotation() * normal));
        join(&mut self.uvs, &other.uvs, empty);
        join(&mut self.colors, &other.colors, empty);
        self.triangles.extend(other.triangles.iter().map(|one| one.map(|index| index + first)));
    }
}

fn join<T: Copy>(own: &mut Vec<T>, other: &[T], empty: bool) {
    if (own.is_empty() && !empty) || other.is_empty() {
        own.clear();
    } else {
        own.extend_from_slice(other);
    }
}
