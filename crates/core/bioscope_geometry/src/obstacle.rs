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
