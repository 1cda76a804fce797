use std::f32::consts::PI;

use bioscope_core::{Quat, Vec3};
use bioscope_geometry::{Camera, Projection, Transform};

/// Distance of the eye ahead of the centre, in body lengths: before the snout, so that an animal
/// sees its own flanks but not the inside of its head.
const AHEAD: f32 = 0.44;
/// Nothing nearer than this is seen, in body lengths.
const NEAR: f32 = 0.05;
/// Nothing farther than this is seen, metres.
const FAR: f32 = 120.0;

/// Where the eye of an animal of `body_length` metres is.
pub(crate) fn eye_position(placement: &Transform, body_length: f32) -> Vec3 {
    placement.position + placement.rotation() * Vec3::Z * (AHEAD * body_length)
}

/// The fish-eye view of an animal of `body_length` metres that is at `placement` and sees
/// `field_of_view` radians (up to 300 degrees). Its scale is ignored.
pub fn eye_camera(placement: &Transform, body_length: f32, field_of_view: f32) -> Camera {
    Camera {
        position: eye_position(placement, body_length),
        // Bodies look along +Z, cameras along -Z.
        rotation: placement.rotation() * Quat::from_rotation_y(PI),
        projection: Projection::Fisheye { field_of_view: field_of_view.min(300f32.to_radians()) },
        near: NEAR * body_length,
        far: FAR,
    }
}
