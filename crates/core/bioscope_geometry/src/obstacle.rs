use bioscope_core::Vec3;
use serde::{Deserialize, Serialize};

/// A simple solid that moving things steer round; stands in for a rock's or wall's true shape.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Obstacle {
    /// A ball.
    Sphere {
        /// Its centre.
        center: Vec3,
        /// Its radius, metres.
        radius: f32,
    },
    /// A cylinder with flat ends.
    Cylinder {
        /// Middle of one end.
        base: Vec3,
        /// Middle of the other end.
        top: Vec3,
        /// Its radius, metres.
        radius: f32,
    },
    /// A box along the world's axes.
    Box {
        /// Least corner.
        low: Vec3,
        /// Greatest corner.
        high: Vec3,
    },
    /// A half space: everything behind the plane is solid.
    Plane {
        /// A point on it.
        point: Vec3,
        /// Unit normal towards the free side.
        normal: Vec3,
    },
}

impl Obstacle {
    /// The same solid, grown on all sides by `margin` metres.
    pub fn inflated(&self, margin: f32) -> Self {
        match *self {
            Self::Sphere { center, radius } => Self::Sphere { center, radius: radius + margin },
            Self::Cylinder { base, top, radius } => {
                let end = (top - base).normalize_or_zero() * margin;
                Self::Cylinder { base: base - end, top: top + end, radius: radius + margin }
            }
            Self::Box { low, high } => Self::Box { low: low - margin, high: high + margin },
            Self::Plane { point, normal } => Self::Plane { point: point + normal * margin, normal },
        }
    }

    /// Distance of a point from the surface in metres, negative inside.
    pub fn distance(&self, point: Vec3) -> f32 {
        match *self {
            Self::Sphere { center, radius } => point.distance(center) - radius,
            Self::Cylinder { base, top, radius } => {
                let (axis, height) = axis(base, top);
                let along = (point - base).dot(axis);
                let across = (point - base - axis * along).length() - radius;
                outside(Vec3::new(across, (along - 0.5 * height).abs() - 0.5 * height, f32::MIN))
            }
            Self::Box { low, high } => {
                outside((point - 0.5 * (low + high)).abs() - 0.5 * (high - low))
            }
            Self::Plane { point: on_plane, normal } => (point - on_plane).dot(normal),
        }
    }

    /// Unit vector away from the solid at a point near its surface.
    pub fn outward(&self, point: Vec3) -> Vec3 {
        const STEP: f32 = 1e-2;
        let slope =
            |axis: Vec3| self.distance(point + axis * STEP) - self.distance(point - axis * STEP);
        Vec3::new(slope(Vec3::X), slope(Vec3::Y), slope(Vec3::Z)).normalize_or(Vec3::Y)
    }

    /// Distance in metres at which a ray along the unit vector `direction` enters the solid, up to
    /// `reach`; zero if it begins inside.
    pub fn hit(&self, origin: Vec3, direction: Vec3, reach: f32) -> Option<f32> {
        let (enter, leave) = match *self {
            Self::Sphere { center, radius } => round(origin - center, direction, radius)?,
            Self::Cylinder { base, top, radius } => {
                let (axis, height) = axis(base, top);
                let (from, along) = ((origin - base).dot(axis), direction.dot(axis));
                let side = round(origin - base - axis * from, direction - axis * along, radius)?;
                overlap(side, slab(from, along, 0.0, height)?)?
            }
            Self::Box { low, high } => {
                let mut span = (f32::NEG_INFINITY, f32::INFINITY);
                for side in 0..3 {
                    let one = slab(origin[side], direction[side], low[side], high[side])?;
                    span = overlap(span, one)?;
                }
                span
            }
            Self::Plane { point, normal } => {
                slab((origin - point).dot(normal), direction.dot(normal), f32::NEG_INFINITY, 0.0)?
            }
        };
        (leave >= 0.0 && enter <= reach).then(|| enter.max(0.0))
    }

    /// The point to steer for in order to pass beside the solid when a ray along the unit vector
    /// `direction` hits it at `distance` metres: the point of its silhouette nearest to the ray,
    /// pushed out by `margin` metres (Reynolds, "Not bumping into things", 1988). A plane has no
    /// silhouette; there it is the point at which a course along the plane is farthest reached.
    pub fn beside(&self, origin: Vec3, direction: Vec3, distance: f32, margin: f32) -> Vec3 {
        let impact = origin + direction * distance;
        match *self {
            Self::Sphere { center, radius } => {
                center + sideways(impact - center, direction) * (radius + margin)
            }
            Self::Cylinder { base, top, radius } => {
                let (axis, height) = axis(base, top);
                let along = (impact - base).dot(axis).clamp(0.0, height);
                let middle = base + axis * along;
                let across = direction - axis * direction.dot(axis);
                let ahead = across.try_normalize().unwrap_or(direction);
                let off = impact - middle;
                let aside = sideways(off - axis * off.dot(axis), ahead);
                let aside = (aside - axis * aside.dot(axis)).try_normalize();
                middle + aside.unwrap_or_else(|| axis.any_orthonormal_vector()) * (radius + margin)
            }
            Self::Box { low, high } => {
                let edge = nearest_silhouette_point(low, high, origin, direction).unwrap_or(impact);
                edge + sideways(edge - 0.5 * (low + high), direction) * margin
            }
            Self::Plane { normal, .. } => {
                let along = direction - normal * direction.dot(normal);
                let along =
                    along.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
                impact + along * distance.max(margin) + normal * margin
            }
        }
    }

    /// Whether the straight line between two points passes through the solid.
    pub fn hides(&self, from: Vec3, to: Vec3) -> bool {
        let way = to - from;
        let length = way.length();
        length > 0.0 && self.hit(from, way / length, length).is_some()
    }
}

/// Unit axis and height of a cylinder; an upright axis if it has no height.
fn axis(base: Vec3, top: Vec3) -> (Vec3, f32) {
    let height = base.distance(top);
    (((top - base) / height).try_normalize().unwrap_or(Vec3::Y), height)
}

/// Distance from the corner region that `excess` (how far beyond each pair of faces) describes.
fn outside(excess: Vec3) -> f32 {
    excess.max(Vec3::ZERO).length() + excess.max_element().min(0.0)
}

/// Where a ray is within `radius` of the origin, as a span of distances.
fn round(from: Vec3, direction: Vec3, radius: f32) -> Option<(f32, f32)> {
    let a = direction.length_squared();
    if a < 1e-12 {
        return (from.length() <= radius).then_some((f32::NEG_INFINITY, f32::INFINITY));
    }
    let middle = -from.dot(direction) / a;
    // Measured from the nearest point, so that far origins do not cancel.
    let nearest = (from + direction * middle).length_squared();
    let half = (radius * radius - nearest) / a;
    (half >= 0.0).then(|| (middle - half.sqrt(), middle + half.sqrt()))
}

/// Where a coordinate that starts at `from` and changes by `rate` lies between two bounds.
fn slab(from: f32, rate: f32, low: f32, high: f32) -> Option<(f32, f32)> {
    if rate.abs() < 1e-12 {
        let within = low <= from && from <= high;
        return within.then_some((f32::NEG_INFINITY, f32::INFINITY));
    }
    let (a, b) = ((low - from) / rate, (high - from) / rate);
    Some((a.min(b), a.max(b)))
}

fn overlap(a: (f32, f32), b: (f32, f32)) -> Option<(f32, f32)> {
    let both = (a.0.max(b.0), a.1.min(b.1));
    (both.0 <= both.1).then_some(both)
}

/// Unit vector of the part of `offset` across `direction`; any one across it if there is none.
fn sideways(offset: Vec3, direction: Vec3) -> Vec3 {
    let across = offset - direction * offset.dot(direction);
    if across.length_squared() < 1e-10 {
        return Vec3::Y.cross(direction).try_normalize().unwrap_or(Vec3::X);
    }
    across.normalize()
}

/// The point of a box's outline, as seen from `origin`, nearest to the ray; none from inside.
fn nearest_silhouette_point(low: Vec3, high: Vec3, origin: Vec3, direction: Vec3) -> Option<Vec3> {
    let faces_viewer = |side: usize, upper: bool| {
        if upper { origin[side] > high[side] } else { origin[side] < low[side] }
    };
    let mut nearest: Option<(f32, Vec3)> = None;
    for along in 0..3 {
        let (one, two) = ((along + 1) % 3, (along + 2) % 3);
        for corner in 0..4 {
            let (upper_one, upper_two) = (corner & 1 == 1, corner & 2 == 2);
            // An edge is on the outline if just one of its two faces is turned to the viewer.
            if faces_viewer(one, upper_one) == faces_viewer(two, upper_two) {
                continue;
            }
            let mut start = low;
            start[one] = if upper_one { high[one] } else { low[one] };
            start[two] = if upper_two { high[two] } else { low[two] };
            let mut end = start;
            end[along] = high[along];
            let point = nearest_on_edge(start, end, origin, direction);
            let off = point - origin;
            let slant = off.normalize_or_zero().dot(direction);
            if nearest.is_none_or(|(best, _)| slant > best) {
                nearest = Some((slant, point));
            }
        }
    }
    nearest.map(|(_, point)| point)
}

/// The point between `start` and `end` that is nearest to a ray.
fn nearest_on_edge(start: Vec3, end: Vec3, origin: Vec3, direction: Vec3) -> Vec3 {
    let edge = end - start;
    let across = edge - direction * edge.dot(direction);
    let off = origin - start;
    let square = across.length_squared();
    let share = if square < 1e-12 { 0.0 } else { off.dot(across) / square };
    start + edge * share.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn solids() -> [Obstacle; 4] {
        [
            Obstacle::Sphere { center: Vec3::new(0.3, -0.2, 5.0), radius: 1.0 },
            Obstacle::Cylinder {
                base: Vec3::new(0.2, -3.0, 5.0),
                top: Vec3::new(0.4, 3.0, 5.5),
                radius: 0.8,
            },
            Obstacle::Box { low: Vec3::new(-1.2, -0.8, 4.0), high: Vec3::new(0.9, 1.1, 6.0) },
            Obstacle::Plane { point: Vec3::Z * 5.0, normal: Vec3::new(0.6, 0.0, -0.8) },
        ]
    }

    #[test]
    fn cylinders_end() {
        let cylinder = Obstacle::Cylinder { base: Vec3::ZERO, top: Vec3::Y * 2.0, radius: 1.0 };
        let level = |y: f32| cylinder.hides(Vec3::new(-5.0, y, 0.0), Vec3::new(5.0, y, 0.0));
        assert_eq!([-0.1, 0.1, 1.9, 2.1].map(level), [false, true, true, false]);
        assert!(cylinder.hides(Vec3::new(0.5, 3.0, 0.0), Vec3::new(0.5, -1.0, 0.0)), "down");
        assert!(!cylinder.hides(Vec3::new(-5.0, 1.0, 0.0), Vec3::new(-2.0, 1.0, 0.0)), "short");
        assert!(cylinder.hides(Vec3::new(-1.5, 2.6, 0.0), Vec3::new(0.5, 1.5, 0.0)), "the cap");
    }

    #[test]
    fn passing_beside_clears_the_solid() {
        for solid in solids() {
            let reach = solid.hit(Vec3::ZERO, Vec3::Z, 20.0).expect("lies ahead");
            let aim = solid.beside(Vec3::ZERO, Vec3::Z, reach, 0.5);
            assert!((solid.distance(aim) - 0.5).abs() < 0.3, "{solid:?} {aim}");
            assert!(!solid.hides(Vec3::ZERO, aim), "{solid:?} {aim}");
        }
    }

    proptest! {
        #[test]
        fn a_hit_lies_on_the_surface(
            x in -4f32..4.0, y in -4f32..4.0, z in -2f32..9.0, tilt in -0.5f32..0.5, turn in -0.5f32..0.5
        ) {
            let (origin, direction) = (Vec3::new(x, y, z), Vec3::new(turn, tilt, 1.0).normalize());
            for solid in solids() {
                match solid.hit(origin, direction, 30.0) {
                    Some(0.0) => prop_assert!(solid.distance(origin) <= 1e-4),
                    Some(way) => {
                        let off = solid.distance(origin + direction * way);
                        prop_assert!(off.abs() < 2e-3, "{:?}: {}", solid, off);
                        let on_surface = origin + direction * way;
                        let out = on_surface + solid.outward(on_surface) * 0.1;
                        prop_assert!(solid.distance(out) > 0.03, "{:?}: {}", solid, out);
                    }
                    None => for step in 0..60 {
                        let point = origin + direction * (step as f32 * 0.5);
                        prop_assert!(solid.distance(point) > -1e-3, "{:?} {}", solid, point);
                    }
                }
            }
        }

        #[test]
        fn growing_brings_the_surface_nearer(x in -4f32..4.0, y in -9f32..9.0, z in -2f32..9.0) {
            let point = Vec3::new(x, y, z);
            for solid in solids() {
                let (near, far) = (solid.inflated(0.3).distance(point), solid.distance(point));
                prop_assert!(near < far - 0.15, "{:?}: {} {}", solid, near, far);
            }
        }
    }
}
