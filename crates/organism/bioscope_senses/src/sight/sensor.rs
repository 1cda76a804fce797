use std::collections::BTreeMap;

use bioscope_core::{Parameters, Percepts, Result, Sighting, Vec3, math, parameters, state};
use bioscope_geometry::{Batch, Camera, Medium, Transform};
use serde::{Deserialize, Serialize};

use crate::eye::{eye_camera, eye_position};
use crate::{Sense, Surroundings};

/// −ln of the least contrast that is seen, 2 percent (Koschmieder 1924).
const HAZE: f32 = 3.912;
/// Mesh sizes kept before the cache is emptied.
const KNOWN_MESHES: usize = 4096;

parameters! {
    /// How well an animal sees.
    pub struct SightParameters {
        /// Distance up to which it sees in clear air.
        range: f32 = 30.0, "m", 0.0..=1000.0, "choice";
        /// Whole angle in which it sees, centered on the direction it looks in.
        field_of_view: f32 = 300.0, "deg", 1.0..=360.0, "Tu and Terzopoulos 1994";
        /// Least angle under which a thing is noticed.
        acuity: f32 = 0.25, "deg", 0.0..=30.0, "choice";
        /// How many things it attends to at once, the nearest first.
        attention: f32 = 24.0, "1", 0.0..=1000.0, "choice";
    }
}

/// Sight of living things; see the [module](self) for what is seen.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Sight {
    parameters: SightParameters,
    /// Size of each mesh by its key: no state, only what need not be computed twice.
    #[serde(skip)]
    sizes: BTreeMap<u64, f32>,
}

/// Something within range and field of view.
struct Candidate {
    distance: f32,
    batch: usize,
    instance: usize,
    size: f32,
}

impl Sight {
    /// Sight this good.
    pub fn new(parameters: SightParameters) -> Self {
        Self { parameters, sizes: BTreeMap::new() }
    }

    /// Greatest extent of a batch's mesh at scale 1, metres.
    fn size(&mut self, batch: &Batch) -> f32 {
        if self.sizes.len() > KNOWN_MESHES {
            self.sizes.clear();
        }
        *self.sizes.entry(batch.mesh.key.number()).or_insert_with(|| {
            let (low, high) = batch.mesh.bounds();
            (high - low).max_element().max(0.0)
        })
    }

    /// Everything within range and field of view, nearest first.
    fn candidates(&mut self, surroundings: &Surroundings, eye: Vec3) -> Vec<Candidate> {
        let range = self.parameters.range.min(visibility(surroundings.medium));
        let half_angle = (0.5 * self.parameters.field_of_view).min(180.0).to_radians();
        let least_cosine = math::cos(half_angle);
        let least_size = 2.0 * math::tan(0.5 * self.parameters.acuity.to_radians());
        let heading = surroundings.heading();
        let mut candidates = Vec::new();
        for (index, batch) in surroundings.scene.batches.iter().enumerate() {
            if !batch.alive {
                continue;
            }
            let mesh_size = self.size(batch);
            for (instance, transform) in batch.transforms.iter().enumerate() {
                let offset = transform.position - eye;
                let distance = offset.length();
                let size = mesh_size * transform.scale;
                let seen = distance <= range
                    && size >= least_size * distance
                    && offset.dot(heading) >= least_cosine * distance
                    && batch.ids[instance] != surroundings.id;
                if seen {
                    candidates.push(Candidate { distance, batch: index, instance, size });
                }
            }
        }
        candidates.sort_by(|a, b| {
            let order = a.distance.total_cmp(&b.distance);
            order.then(a.batch.cmp(&b.batch)).then(a.instance.cmp(&b.instance))
        });
        candidates
    }
}

/// Distance in metres at which haze leaves too little contrast to see, in the clearest color.
fn visibility(medium: &Medium) -> f32 {
    let channels = medium.absorption.iter().zip(&medium.scattering);
    let least = channels.map(|(absorbed, scattered)| absorbed + scattered);
    HAZE / least.fold(f32::INFINITY, f32::min).max(1e-6)
}

/// Whether obstacles or ground lie between the eye and a thing of this size (metres).
fn hidden(surroundings: &Surroundings, eye: Vec3, target: Vec3, size: f32) -> bool {
    // A thing that grows out of a rock is seen by the side that it turns to the eye, and an eye
    // that has pressed itself into a rock's rough stand-in is not blind.
    let way = target - eye;
    let length = way.length();
    let near = eye + way * (1.0 - (0.5 * size / length.max(1e-6)).min(1.0));
    let solid = surroundings.obstacles.iter();
    let behind_solid = solid.filter(|one| one.distance(eye) > 0.0).any(|one| one.hides(eye, near));
    behind_solid
        || surroundings.terrain.is_some_and(|terrain| {
            const SAMPLES: u16 = 16;
            let lift = 0.5 * size;
            (1..SAMPLES).any(|step| {
                let point = eye.lerp(near, f32::from(step) / f32::from(SAMPLES));
                point.y + lift < terrain.height(point.x, point.z)
            })
        })
}

impl Sense for Sight {
    fn kind(&self) -> &str {
        "sight"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        let placement = Transform::new(surroundings.position, surroundings.attitude, 1.0);
        let eye = eye_position(&placement, surroundings.body_length);
        let attention = self.parameters.attention as usize;
        let batches = &surroundings.scene.batches;
        let candidates = self.candidates(surroundings, eye);
        let visible = candidates.iter().filter(|one| {
            let target = batches[one.batch].transforms[one.instance].position;
            !hidden(surroundings, eye, target, one.size)
        });
        percepts.seen = visible
            .take(attention)
            .map(|one| {
                let batch = &batches[one.batch];
                let velocity = batch.velocities.get(one.instance).copied().unwrap_or_default();
                Sighting {
                    id: batch.ids[one.instance],
                    species: batch.species.clone(),
                    position: surroundings.own_point(batch.transforms[one.instance].position),
                    velocity: surroundings.own_vector(velocity),
                    size: one.size,
                }
            })
            .collect();
        Ok(())
    }

    fn eye(&self, placement: &Transform, body_length: f32) -> Option<Camera> {
        Some(eye_camera(placement, body_length, self.parameters.field_of_view.to_radians()))
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.parameters)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.parameters)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}
