use bioscope_core::{Mat3, Quat, Vec3};
use serde::{Deserialize, Serialize};

/// How directions become places in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Projection {
    /// Straight lines stay straight.
    Perspective {
        /// Vertical angle of view in radians, below π.
        field_of_view: f32,
    },
    /// Distance from the picture's centre is proportional to the angle from the axis; the circle
    /// that touches the picture's shorter side is the edge of the view.
    Fisheye {
        /// Whole angle of view in radians, up to 300 degrees.
        field_of_view: f32,
    },
}

/// A point of view: looks along its own −Z with +Y up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Where it is, metres.
    pub position: Vec3,
    /// How it is turned.
    pub rotation: Quat,
    /// How it projects.
    pub projection: Projection,
    /// Nothing nearer is seen, metres.
    pub near: f32,
    /// Nothing farther is seen, metres.
    pub far: f32,
}

impl Camera {
    /// A perspective camera that looks from `position` at `target`; `field_of_view` is the vertical
    /// angle in radians.
    pub fn looking_at(position: Vec3, target: Vec3, field_of_view: f32) -> Self {
        Self {
            position,
            rotation: facing(target - position),
            projection: Projection::Perspective { field_of_view },
            near: 0.02,
            far: 200.0,
        }
    }

    /// Unit vector of the view axis.
    pub fn forward(&self) -> Vec3 {
        self.rotation * Vec3::NEG_Z
    }
}

/// Rotation of a camera that looks along `direction` with world up as up as can be.
pub(crate) fn facing(direction: Vec3) -> Quat {
    let back = -direction.normalize_or(Vec3::NEG_Z);
    let right = Vec3::Y.cross(back).normalize_or(Vec3::X);
    Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back))
}
