use std::collections::BTreeMap;

use bioscope_core::{Id, Vec3};
use bioscope_crowds::Threat;
use bioscope_geometry::{Batch, Scene};

/// Mesh lengths kept before the cache is emptied.
const KNOWN_MESHES: usize = 1024;
/// Places along a threat's body, as shares of its length ahead of its middle.
const ALONG: [f32; 3] = [0.35, 0.0, -0.3];

/// Finds what a school must flee from in the scene.
#[derive(Debug, Default)]
pub(super) struct Lookout {
    /// Length of each mesh by its key: no state, only what need not be computed twice.
    lengths: BTreeMap<u64, f32>,
    /// Head, middle and tail of each threat.
    pub threats: Vec<Threat>,
    /// Whose each of `threats` is.
    pub owners: Vec<Id>,
}

impl Lookout {
    /// Looks for animals that move, are at least `least_length` metres long and touch the box
    /// between two corners.
    pub fn scan(
        &mut self,
        scene: &Scene,
        species: &str,
        least_length: f32,
        (low, high): (Vec3, Vec3),
    ) {
        self.threats.clear();
        self.owners.clear();
        for batch in &scene.batches {
            let moves = batch.velocities.len() == batch.ids.len() && !batch.ids.is_empty();
            if !(batch.alive && moves) || &*batch.species == species {
                continue;
            }
            let mesh_length = self.length(batch);
            for (instance, transform) in batch.transforms.iter().enumerate() {
                let length = mesh_length * transform.scale;
                let nearest = transform.position.clamp(low, high);
                let touches = nearest.distance(transform.position) <= 0.5 * length;
                if length < least_length || !touches {
                    continue;
                }
                let ahead = transform.rotation() * Vec3::Z * length;
                for share in ALONG {
                    let position = transform.position + ahead * share;
                    self.threats.push(Threat { position, velocity: batch.velocities[instance] });
                    self.owners.push(batch.ids[instance]);
                }
            }
        }
    }

    /// The threat nearest to a place.
    pub fn nearest(&self, place: Vec3) -> Option<(Id, f32)> {
        let distances = self.threats.iter().map(|threat| threat.position.distance(place));
        let nearest = self.owners.iter().copied().zip(distances);
        nearest.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn length(&mut self, batch: &Batch) -> f32 {
        if self.lengths.len() > KNOWN_MESHES {
            self.lengths.clear();
        }
        *self.lengths.entry(batch.mesh.key.number()).or_insert_with(|| {
            let (low, high) = batch.mesh.bounds();
            (high.z - low.z).max(0.0)
        })
    }
}
