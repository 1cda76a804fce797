use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use bioscope_geometry::rasterizer::{Options, Prepared, Rasterizer};
use bioscope_geometry::{Batch, Mesh, Scene};

use super::cells::Thing;
use super::register::Register;

/// Least edge of the cells in which points are looked up, metres: they are smelled from farther than their size tells (choice).
const LEAST_EDGE: f32 = 1.0;
/// Meshes whose extent is remembered before the memory is emptied.
const KNOWN_MESHES: usize = 4096;

/// What need not be worked out anew in every tick; changes no percept, only how soon it is there.
#[derive(Debug, Default)]
pub struct Memory {
    rasterizer: Mutex<Rasterizer>,
    /// Greatest extent of each mesh at scale 1 by its key, metres.
    extents: Mutex<BTreeMap<u64, f32>>,
    /// What was worked out last.
    survey: Mutex<Option<Arc<Survey>>>,
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
    survey: Arc<Survey>,
}

/// What was worked out of one scene.
#[derive(Debug)]
struct Survey {
    /// The scene, if more than one may ask for it.
    scene: Option<Arc<Scene>>,
    movers: Register,
    stays: Register,
    points: Register,
    prepared: OnceLock<Prepared>,
}

impl<'a> Outlook<'a> {
    /// The outlook on this scene.
    pub fn new(scene: &'a Scene, memory: &'a Memory) -> Self {
        let mut last = memory.survey.lock().unwrap_or_else(PoisonError::into_inner);
        let survey = Arc::new(Survey::of(scene, memory, last.as_deref()));
        *last = Some(survey.clone());
        Self { scene, memory, survey }
    }

    /// The outlook on this scene, which is worked out once for all who share the memory.
    pub fn shared(scene: &'a Arc<Scene>, memory: &'a Memory) -> Self {
        let mut last = memory.survey.lock().unwrap_or_else(PoisonError::into_inner);
        let is_same =
            |one: &&Arc<Survey>| one.scene.as_ref().is_some_and(|one| Arc::ptr_eq(one, scene));
        if let Some(survey) = last.as_ref().filter(is_same) {
            return Self { scene, memory, survey: survey.clone() };
        }
        let survey = Survey::of(scene, memory, last.as_deref());
        let survey = Arc::new(Survey { scene: Some(scene.clone()), ..survey });
        *last = Some(survey.clone());
        Self { scene, memory, survey }
    }

    /// What can be seen.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// All living things that move.
    pub fn movers(&self) -> &Register {
        &self.survey.movers
    }

    /// All living things that stay where they are.
    pub fn stays(&self) -> &Register {
        &self.survey.stays
    }

    /// All points.
    pub fn points(&self) -> &Register {
        &self.survey.points
    }

    /// The scene made ready for looking at: by the first who looks, for all.
    pub fn prepared(&self) -> &Prepared {
        self.survey.prepared.get_or_init(|| {
            // A panic while preparing leaves at worst forgotten meshes.
            let rasterizer = self.memory.rasterizer.lock();
            rasterizer.unwrap_or_else(PoisonError::into_inner).prepare(self.scene, &Options::eye())
        })
    }
}

impl Survey {
    fn of(scene: &Scene, memory: &Memory, last: Option<&Self>) -> Self {
        let (movers, stays, points) =
            (living(scene, memory, true), living(scene, memory, false), points(scene));
        let (movers, stays, points) = match last {
            Some(last) => (
                last.movers.followed_by(movers),
                last.stays.followed_by(stays),
                last.points.followed_by(points),
            ),
            None => (
                Register::new(movers, 0.0),
                Register::new(stays, 0.0),
                Register::new(points, LEAST_EDGE),
            ),
        };
        Self { scene: None, movers, stays, points, prepared: OnceLock::new() }
    }
}

/// Everything alive in a scene that moves, or that stays where it is.
fn living(scene: &Scene, memory: &Memory, moves: bool) -> Vec<Thing> {
    let mut things = Vec::new();
    let alike = |batch: &Batch| batch.alive && batch.velocities.is_empty() != moves;
    for (group, batch) in scene.batches.iter().enumerate().filter(|(_, batch)| alike(batch)) {
        let mesh_size = memory.extent(&batch.mesh);
        for (member, (transform, &id)) in batch.transforms.iter().zip(&batch.ids).enumerate() {
            things.push(Thing {
                position: transform.position,
                size: mesh_size * transform.scale,
                id,
                group: group as u32,
                member: member as u32,
            });
        }
    }
    things
}

/// Every point of a scene.
fn points(scene: &Scene) -> Vec<Thing> {
    let mut things = Vec::new();
    for (group, points) in scene.points.iter().enumerate() {
        let all = points.positions.iter().zip(&points.radii).zip(&points.ids);
        for (member, ((&position, radius), &id)) in all.enumerate() {
            let (group, member) = (group as u32, member as u32);
            things.push(Thing { position, size: 2.0 * radius, id, group, member });
        }
    }
    things
}
