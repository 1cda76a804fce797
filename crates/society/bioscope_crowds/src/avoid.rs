//! Passing obstacles: steer-to-avoid, and the force field it is compared with.
//!
//! Source: Reynolds, "Flocks, herds, and schools", SIGGRAPH 1987, section on environmental
//! obstacles. Only what lies straight ahead counts, so flight along a wall is not disturbed.

use bioscope_core::{Impact, Vec3};
use bioscope_geometry::Obstacle;

/// A body on its course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Where it is, metres.
    pub position: Vec3,
    /// Where it is going, unit length.
    pub heading: Vec3,
    /// How far it looks ahead, metres.
    pub reach: f32,
    /// Length of the body, metres: by so much the aim lies outside the obstacle.
    pub length: f32,
    /// Distance that its middle must keep from surfaces, metres.
    pub clearance: f32,
}

/// How far to look ahead at this speed (m/s) with this greatest acceleration (m/s²): three times
/// the tightest turn radius v² / a, at least five body lengths (metres).
pub fn look_ahead(speed: f32, thrust: f32, length: f32) -> f32 {
    (3.0 * speed * speed / thrust).max(5.0 * length)
}

/// Where the course meets the obstacle, if it does: the distance, and the point beside the
/// silhouette to steer for, both from the body, along the world's axes.
pub fn impact(course: &Course, obstacle: &Obstacle) -> Option<Impact> {
    // Who is already nearer than the clearance may fly on along the surface.
    let outside = obstacle.distance(course.position) > course.clearance;
    let solid = if outside { obstacle.inflated(course.clearance) } else { *obstacle };
    let distance = solid.hit(course.position, course.heading, course.reach)?;
    let aim = solid.beside(course.position, course.heading, distance, course.length);
    Some(Impact { distance, aim: aim - course.position })
}

/// Obstacles with their bounds, so that most are dismissed at the cost of one comparison.
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    solids: Vec<Obstacle>,
    /// Middle and radius of a ball around each; an infinite radius for planes.
    bounds: Vec<(Vec3, f32)>,
}

impl Obstacles {
    /// These obstacles.
    pub fn new(solids: &[Obstacle]) -> Self {
        Self { solids: solids.to_vec(), bounds: solids.iter().map(bounds).collect() }
    }

    /// Puts into `found` which of them may lie within `radius` metres of `center`; clears it first.
    pub fn near(&self, center: Vec3, radius: f32, found: &mut Vec<u32>) {
        found.clear();
        for (index, &(middle, size)) in self.bounds.iter().enumerate() {
            if middle.distance_squared(center) <= (size + radius) * (size + radius) {
                found.push(index as u32);
            }
        }
    }

    /// The first impact on the course with any of the obstacles of these indices.
    pub fn first_impact(&self, course: &Course, among: &[u32]) -> Option<Impact> {
        let impacts = among.iter().filter_map(|&index| {
            let (middle, size) = self.bounds[index as usize];
            let way = middle - course.position;
            let ahead = way.dot(course.heading).clamp(0.0, course.reach);
            let off = way - course.heading * ahead;
            let wide = size + course.clearance;
            let may_hit = off.length_squared() <= wide * wide;
            if may_hit { impact(course, &self.solids[index as usize]) } else { None }
        });
        impacts.min_by(|a, b| a.distance.total_cmp(&b.distance))
    }
}

fn bounds(obstacle: &Obstacle) -> (Vec3, f32) {
    match *obstacle {
        Obstacle::Sphere { center, radius } => (center, radius),
        Obstacle::Cylinder { base, top, radius } => {
            (0.5 * (base + top), (0.25 * base.distance_squared(top) + radius * radius).sqrt())
        }
        Obstacle::Box { low, high } => (0.5 * (low + high), 0.5 * low.distance(high)),
        Obstacle::Plane { point, .. } => (point, f32::INFINITY),
    }
}

/// The request of a repelling field: straight away from the surface, 1 on it and falling linearly
/// to 0 at `range` metres. Kept for comparison: it cannot turn a body that comes head-on, and it
/// disturbs flight along a wall.
pub fn force_field(obstacle: &Obstacle, position: Vec3, range: f32) -> Vec3 {
    let strength = (1.0 - obstacle.distance(position) / range).clamp(0.0, 1.0);
    let step = 1e-3 * range;
    let slope = |axis: Vec3| {
        obstacle.distance(position + axis * step) - obstacle.distance(position - axis * step)
    };
    let outward = Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).normalize_or_zero();
    outward * strength
}
