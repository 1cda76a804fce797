//! How passing animals push plants aside (Tu, "Artificial Animals for Computer Animation", 1996, section 7.1.2).

use bioscope_core::{Vec2, Vec3};
use bioscope_geometry::Scene;

/// How far the water that an animal pushes aside reaches from its middle, body lengths (choice).
const REACH: f32 = 0.6;

/// Animals that move, sorted so that those near a plant are found soon.
pub(super) struct Passers {
    /// Place, reach and velocity.
    sorted: Vec<(Vec3, f32, Vec3)>,
    widest: f32,
}

/// The stem of a plant as a straight line.
pub(super) struct Stem {
    pub root: Vec3,
    /// Metres.
    pub height: f32,
    /// Lean of the tip towards x and z, radians.
    pub lean: Vec2,
    /// Greatest lean, radians.
    pub bend: f32,
}

impl Passers {
    /// All living things of the scene that move.
    pub fn new(scene: &Scene) -> Self {
        let mut sorted = Vec::new();
        for batch in &scene.batches {
            if !batch.alive || batch.velocities.is_empty() || batch.transforms.is_empty() {
                continue;
            }
            let (low, high) = batch.mesh.bounds();
            let reach = REACH * (high - low).max_element().max(0.0);
            for (transform, &velocity) in batch.transforms.iter().zip(&batch.velocities) {
                sorted.push((transform.position, reach * transform.scale, velocity));
            }
        }
        sorted.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
        let widest = sorted.iter().fold(0.0f32, |widest, one| widest.max(one.1));
        Self { sorted, widest }
    }

    /// How far they push a plant aside towards x and z, 1 being all it can lean.
    pub fn aside(&self, stem: &Stem) -> Vec2 {
        let Stem { root, height, .. } = *stem;
        let reach = self.widest + height;
        let first = self.sorted.partition_point(|one| one.0.x < root.x - reach);
        let near = self.sorted[first..].iter().take_while(|one| one.0.x <= root.x + reach);
        let all: Vec2 = near.map(|&(place, reach, way)| stem.aside(place, reach, way)).sum();
        all.clamp_length_max(1.0)
    }
}

impl Stem {
    fn aside(&self, place: Vec3, reach: f32, velocity: Vec3) -> Vec2 {
        let up = (place.y - self.root.y) / self.height.max(1e-3);
        if !(0.0..=1.0 + reach / self.height.max(1e-3)).contains(&up) {
            return Vec2::ZERO;
        }
        let share = up.clamp(0.1, 1.0);
        let stem = Vec2::new(self.root.x, self.root.z) + self.lean * (share * self.height);
        let off = stem - Vec2::new(place.x, place.z);
        let distance = off.length();
        if distance >= reach {
            return Vec2::ZERO;
        }
        // Who meets it in the middle pushes it to one side.
        let across = Vec2::new(velocity.z, -velocity.x).try_normalize().unwrap_or(Vec2::X);
        let way = if distance > 1e-3 * reach { off / distance } else { across };
        let wanted = (reach - distance) / (share * self.height.max(1e-3));
        way * (wanted / self.bend.max(1e-3)).min(1.0)
    }
}
