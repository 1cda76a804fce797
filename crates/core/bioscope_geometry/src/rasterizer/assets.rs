//! What is worked out once per mesh or texture and kept as long as scenes show it.

use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::Vec3;

use super::prepare::{Options, Prepared};
use super::texture::Mipmap;
use crate::mesh::tiles::Tile;
use crate::{Mesh, Scene};

/// Meshes above this many triangles that come without levels are cut into tiles.
const LARGE: usize = 8192;

/// Triangles of the finest tiles of a large mesh.
const TILE: usize = 1024;

/// Makes scenes ready for looking at; remembers what it worked out for their meshes and textures.
///
/// What it remembers never changes a picture, only how soon it is there.
///
/// ```
/// use bioscope_core::Vec3;
/// use bioscope_geometry::{Camera, Scene, rasterizer::{Options, Rasterizer}};
/// let mut rasterizer = Rasterizer::default();
/// let prepared = rasterizer.prepare(&Scene::default(), &Options::eye());
/// let camera = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 1.0);
/// assert_eq!(prepared.look(&camera, 64, 64).identity, vec![0; 64 * 64]);
/// ```
#[derive(Debug, Default)]
pub struct Rasterizer {
    shapes: BTreeMap<u64, Arc<Shape>>,
    pictures: BTreeMap<u64, Arc<Mipmap>>,
}

impl Rasterizer {
    /// A scene ready for any number of looks. Meshes and textures that it no longer shows are forgotten.
    pub fn prepare(&mut self, scene: &Scene, options: &Options) -> Prepared {
        let mut shapes = BTreeMap::new();
        let mut pictures = BTreeMap::new();
        for batch in &scene.batches {
            let key = batch.mesh.key.number();
            let known =
                || self.shapes.remove(&key).unwrap_or_else(|| Arc::new(Shape::new(&batch.mesh)));
            shapes.entry(key).or_insert_with(known);
            if let Some(texture) = &batch.material.texture {
                let key = texture.key.number();
                let known =
                    || self.pictures.remove(&key).unwrap_or_else(|| Arc::new(Mipmap::new(texture)));
                pictures.entry(key).or_insert_with(known);
            }
        }
        (self.shapes, self.pictures) = (shapes, pictures);
        Prepared::new(scene, options, &self.shapes, &self.pictures)
    }
}

/// A mesh as the rasterizer draws it: one part, or the tiles of a large mesh.
#[derive(Debug)]
pub(crate) struct Shape {
    pub parts: Vec<Part>,
}

/// A piece of a mesh with its own bounds and levels.
#[derive(Debug)]
pub(crate) struct Part {
    pub center: Vec3,
    pub radius: f32,
    /// Coarser towards the end, each with the size in pixels from which downward it serves.
    pub levels: Vec<(f32, Arc<Mesh>)>,
    /// Ball round the vertices that each joint moves: joint, center, radius.
    pub joints: Vec<(usize, Vec3, f32)>,
    /// When a tile of a large mesh is shown.
    pub tile: Option<Reign>,
}

/// When a tile is shown: if its own error is small enough where it is, and its parent's is not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reign {
    pub own: Flaw,
    /// Of the coarser tile that would replace it.
    pub parent: Option<Flaw>,
}

/// How far a tile is from the true shape, metres, and the corners of the box round it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flaw {
    pub error: f32,
    corners: [Vec3; 2],
}

impl Flaw {
    /// Distance from a point to the box.
    pub fn distance(&self, point: Vec3) -> f32 {
        (point - point.clamp(self.corners[0], self.corners[1])).length()
    }
}

impl Shape {
    pub fn new(mesh: &Arc<Mesh>) -> Self {
        let mesh = sound(mesh);
        if mesh.triangles.len() > LARGE && mesh.levels.is_empty() && mesh.skin.is_none() {
            let tiles = mesh.tiles(TILE);
            return Self { parts: tiles.iter().map(|tile| Part::of(tile, &tiles)).collect() };
        }
        Self { parts: vec![Part::new(&mesh)] }
    }
}

impl Part {
    fn new(mesh: &Arc<Mesh>) -> Self {
        let (center, radius) = ball(&mesh.positions);
        let mut levels = vec![(f32::INFINITY, mesh.clone())];
        let same_joints = |level: &Mesh| match (&level.skin, &mesh.skin) {
            (Some(level), Some(mesh)) => level.joints.len() == mesh.joints.len(),
            (level, mesh) => level.is_none() && mesh.is_none(),
        };
        let coarser = mesh.levels.iter().map(|(size, level)| (*size, sound(level)));
        levels.extend(coarser.filter(|(_, level)| same_joints(level)));
        let (size, last) = &levels[levels.len() - 1];
        let sparse = mesh.sparse_levels(radius, (*size, last.triangles.len()));
        levels.extend(sparse.into_iter().map(|(size, level)| (size, Arc::new(level))));
        Self { center, radius, levels, joints: joint_balls(mesh), tile: None }
    }

    fn of(tile: &Tile, tiles: &[Tile]) -> Self {
        let flaw = |tile: &Tile| Flaw { error: tile.error, corners: tile.corners };
        let reign =
            Reign { own: flaw(tile), parent: tile.parent.map(|parent| flaw(&tiles[parent])) };
        let [low, high] = tile.corners;
        let (center, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
        let levels = vec![(f32::INFINITY, Arc::new(tile.mesh.clone()))];
        Self { center, radius, levels, joints: Vec::new(), tile: Some(reign) }
    }

    /// Number of the level for a projected diameter in pixels.
    pub fn level(&self, size: f32) -> usize {
        self.levels.iter().rposition(|&(from, _)| size <= from).unwrap_or(0)
    }
}

/// Center of the box round the points, and the radius of the ball round it.
fn ball(points: &[Vec3]) -> (Vec3, f32) {
    let around = |(low, high): (Vec3, Vec3), &point: &Vec3| (low.min(point), high.max(point));
    let (low, high) = points.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), around);
    if points.is_empty() {
        return (Vec3::ZERO, 0.0);
    }
    let center = (low + high) * 0.5;
    let square = points.iter().map(|&point| (point - center).length_squared()).fold(0.0, f32::max);
    (center, square.sqrt())
}

fn joint_balls(mesh: &Mesh) -> Vec<(usize, Vec3, f32)> {
    let Some(skin) = &mesh.skin else { return Vec::new() };
    let mut moved = vec![Vec::new(); skin.joints.len()];
    for ((&point, joints), weights) in mesh.positions.iter().zip(&skin.indices).zip(&skin.weights) {
        for (&joint, &weight) in joints.iter().zip(weights) {
            if weight > 0.0 {
                moved[joint as usize].push(point);
            }
        }
    }
    let used = moved.iter().enumerate().filter(|(_, points)| !points.is_empty());
    used.map(|(joint, points)| {
        let (center, radius) = ball(points);
        (joint, center, radius)
    })
    .collect()
}

/// The mesh itself if it is well formed, else a copy without what cannot be drawn.
fn sound(mesh: &Arc<Mesh>) -> Arc<Mesh> {
    let count = mesh.positions.len();
    let drawable = |triangle: &[u32; 3]| {
        triangle.iter().all(|&corner| {
            mesh.positions.get(corner as usize).is_some_and(|point| point.abs().max_element() < 1e9)
        })
    };
    let skin_fits = mesh.skin.as_ref().is_none_or(|skin| {
        let known =
            |joints: &[u8; 4]| joints.iter().all(|&joint| usize::from(joint) < skin.joints.len());
        skin.indices.len() == count && skin.weights.len() == count && skin.indices.iter().all(known)
    });
    let fits = |length: usize| length == 0 || length == count;
    let finite = mesh.positions.iter().all(|point| point.abs().max_element() < 1e9);
    let whole = finite
        && mesh.normals.len() == count
        && fits(mesh.uvs.len())
        && fits(mesh.colors.len())
        && skin_fits
        && mesh.triangles.iter().all(drawable);
    if whole {
        return mesh.clone();
    }
    let mut copy = Mesh::clone(mesh);
    copy.triangles.retain(drawable);
    for point in &mut copy.positions {
        *point = if point.abs().max_element() < 1e9 { *point } else { Vec3::ZERO };
    }
    if copy.normals.len() != count {
        copy.compute_normals();
    }
    if !fits(copy.uvs.len()) {
        copy.uvs.clear();
    }
    if !fits(copy.colors.len()) {
        copy.colors.clear();
    }
    if !skin_fits {
        copy.skin = None;
    }
    Arc::new(copy)
}
