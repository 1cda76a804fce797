use std::collections::BTreeMap;
use std::sync::{Mutex, OnceLock, PoisonError};

use bioscope_core::Vec3;
use bioscope_geometry::rasterizer::{Options, Prepared, Rasterizer};
use bioscope_geometry::{Mesh, Scene};

use super::cells::{Cells, Kind, Thing};

/// Meshes whose extent is remembered before the memory is emptied.
const KNOWN_MESHES: usize = 4096;

/// What need not be worked out anew in every tick; changes no percept, only how soon it is there.
#[derive(Debug, Default)]
pub struct Memory {
    rasterizer: Mutex<Rasterizer>,
    /// Greatest extent of each mesh at scale 1 by its key, metres.
    extents: Mutex<BTreeMap<u64, f32>>,
}

impl Memory {
    /// Greatest extent of a mesh at scale 1, metres.
    fn extent(&self, mesh: &Mesh) -> f32 {
        let mut extents = self.extents.lock().unwrap_or_else(PoisonError::into_inner);
        if extents.len() > KNOWN_MESHES {
            extents.clear();
        }
        *extents.entry(mesh.key.number()).or_insert_with(|| {
            let (low, high) = mesh.bounds();
            (high - low).max_element().max(0.0)
        })
    }
}

/// What the senses of all animals share in one tick; see the [module](self).
#[derive(Debug)]
pub struct Outlook<'a> {
    scene: &'a Scene,
    memory: &'a Memory,
    cells: Cells,
    prepared: OnceLock<Prepared>,
}

impl<'a> Outlook<'a> {
    /// The outlook on this scene.
    pub fn new(scene: &'a Scene, memory: &'a Memory) -> Self {
        let cells = Cells::new(things(scene, memory));
        Self { scene, memory, cells, prepared: OnceLock::new() }
    }

    /// What can be seen.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Calls `visit` for every living thing and point that may lie within reach of `center` (metres), in
    /// a fixed order. `reach` says how far a thing of a size is of interest, both in metres; it must not
    /// fall with size. Some things that lie farther are visited too.
    pub fn near(&self, center: Vec3, reach: impl Fn(f32) -> f32, visit: impl FnMut(&Thing)) {
        self.cells.near(center, reach, visit);
    }

    /// The scene made ready for looking at: by the first who looks, for all.
    pub fn prepared(&self) -> &Prepared {
        self.prepared.get_or_init(|| {
            // A panic while preparing leaves at worst forgotten meshes.
            let rasterizer = self.memory.rasterizer.lock();
            rasterizer.unwrap_or_else(PoisonError::into_inner).prepare(self.scene, &Options::eye())
        })
    }
}

/// Everything alive and every point of a scene.
fn things(scene: &Scene, memory: &Memory) -> Vec<Thing> {
    let mut things = Vec::new();
    for (group, batch) in scene.batches.iter().enumerate().filter(|(_, batch)| batch.alive) {
        let mesh_size = memory.extent(&batch.mesh);
        for (member, (transform, &id)) in batch.transforms.iter().zip(&batch.ids).enumerate() {
            things.push(Thing {
                position: transform.position,
                size: mesh_size * transform.scale,
                id,
                kind: Kind::Instance,
                group: group as u32,
                member: member as u32,
            });
        }
    }
    for (group, points) in scene.points.iter().enumerate() {
        let all = points.positions.iter().zip(&points.radii).zip(&points.ids);
        for (member, ((&position, radius), &id)) in all.enumerate() {
            things.push(Thing {
                position,
                size: 2.0 * radius,
                id,
                kind: Kind::Point,
                group: group as u32,
                member: member as u32,
            });
        }
    }
    things
}
