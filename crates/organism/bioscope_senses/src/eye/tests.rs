use bioscope_core::{Quat, Vec3};
use bioscope_geometry::{Projection, Transform};
use proptest::prelude::*;

use super::eye_camera;

proptest! {
    #[test]
    fn the_eye_looks_where_the_body_looks(
        x in -1f32..1.0, y in -1f32..1.0, z in -1f32..1.0, angle in -3f32..3.0
    ) {
        let axis = Vec3::new(x, y, z);
        prop_assume!(axis.length() > 0.1);
        let attitude = Quat::from_axis_angle(axis.normalize(), angle);
        let camera = eye_camera(&Transform::new(Vec3::X, attitude, 3.0), 0.5, 9.0);
        prop_assert!((camera.forward() - attitude * Vec3::Z).length() < 1e-5);
        prop_assert!((camera.rotation * Vec3::Y - attitude * Vec3::Y).length() < 1e-5);
        prop_assert!((camera.position - Vec3::X - camera.forward() * 0.22).length() < 1e-5);
        let Projection::Fisheye { field_of_view } = camera.projection else { panic!("a fish-eye") };
        prop_assert!(field_of_view <= 300f32.to_radians());
    }
}
