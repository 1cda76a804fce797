//! What stands between an eye and the things it looks for.

use bioscope_core::Vec3;
use bioscope_geometry::{Obstacle, Terrain};

use crate::Surroundings;

/// Solids that an animal notices round it, the nearest first.
const NOTICED: usize = 6;
/// Share of half its length at which parts of a thing lie before and behind its middle, in the order in
/// which they are looked for: middle, shoulders, root of the tail, snout, tip of the tail.
const PARTS: [f32; 5] = [0.0, 0.6, -0.6, 0.96, -0.96];

/// The solids and the ground that may hide something within some distance of an eye.
pub(super) struct Cover<'a> {
    eye: Vec3,
    /// Solids within that distance, with their distance from the eye.
    solids: Vec<(f32, &'a Obstacle)>,
    terrain: Option<&'a Terrain>,
    /// Height that the ground does not rise above within that distance, metres.
    summit: f32,
}

impl<'a> Cover<'a> {
    /// All that may hide something within `reach` metres of the eye.
    pub fn new(surroundings: &Surroundings<'a>, eye: Vec3, reach: f32) -> Self {
        let within = surroundings.obstacles.within(eye - reach, eye + reach);
        let mut solids = Vec::with_capacity(within.len());
        let distances = within.map(|one| (one.distance(eye), one));
        solids.extend(distances.filter(|&(distance, _)| distance <= reach));
        let terrain = surroundings.terrain;
        let summit = terrain.map_or(f32::NEG_INFINITY, |terrain| {
            terrain.bound([eye.x - reach, eye.z - reach], [eye.x + reach, eye.z + reach])
        });
        Self { eye, solids, terrain, summit }
    }

    /// Points of the nearest solids that are nearest to the eye, in the world.
    pub fn nearest_points(mut self) -> impl Iterator<Item = Vec3> {
        self.solids.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = self.solids.into_iter().take(NOTICED);
        near.map(move |(distance, solid)| self.eye - solid.outward(self.eye) * distance)
    }

    /// Whether all of a thing of this size (metres) is hidden, whose length lies along `axis` (a unit
    /// vector, zero for things without length).
    pub fn hides(&self, center: Vec3, axis: Vec3, size: f32) -> bool {
        let parts = if axis == Vec3::ZERO { &PARTS[..1] } else { &PARTS[..] };
        parts.iter().all(|share| self.hides_point(center + axis * (0.5 * size * share), size))
    }

    fn hides_point(&self, target: Vec3, size: f32) -> bool {
        // A thing that grows out of a rock is seen by the side that it turns to the eye, and an eye
        // that has pressed itself into a rock's rough stand-in is not blind.
        let way = target - self.eye;
        let length = way.length();
        let near = self.eye + way * (1.0 - (0.5 * size / length.max(1e-6)).min(1.0));
        let mut solids = self.solids.iter();
        solids.any(|&(distance, one)| {
            distance > 0.0 && distance < length && one.hides(self.eye, near)
        }) || self.terrain.is_some_and(|terrain| self.below(terrain, near, 0.5 * size))
    }

    /// Whether the ground rises over the way to a point.
    fn below(&self, terrain: &Terrain, near: Vec3, lift: f32) -> bool {
        const MOST_SAMPLES: f32 = 16.0;
        let (low, high) = (self.eye.min(near), self.eye.max(near));
        if low.y + lift >= self.summit
            || low.y + lift >= terrain.bound([low.x, low.z], [high.x, high.z])
        {
            return false;
        }
        let samples = (self.eye.distance(near) / terrain.spacing * 2.0).clamp(2.0, MOST_SAMPLES);
        let samples = samples as u16;
        (1..samples).any(|step| {
            let point = self.eye.lerp(near, f32::from(step) / f32::from(samples));
            point.y + lift < terrain.height(point.x, point.z)
        })
    }
}
