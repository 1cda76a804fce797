use bioscope_core::{Quat, Vec3};
use bioscope_geometry as geometry;
use pyo3::prelude::*;

/// See `bioscope.Camera`.
#[pyclass(frozen, module = "bioscope._engine")]
#[derive(Clone, Copy)]
pub struct Camera {
    pub camera: geometry::Camera,
}

#[pymethods]
impl Camera {
    #[new]
    #[pyo3(signature = (position, rotation, field_of_view, fisheye=false, near=0.02, far=200.0))]
    fn new(
        position: [f32; 3],
        rotation: [f32; 4],
        field_of_view: f32,
        fisheye: bool,
        near: f32,
        far: f32,
    ) -> Self {
        let projection = if fisheye {
            geometry::Projection::Fisheye { field_of_view }
        } else {
            geometry::Projection::Perspective { field_of_view }
        };
        let rotation = Quat::from_array(rotation).normalize();
        let position = Vec3::from_array(position);
        Self { camera: geometry::Camera { position, rotation, projection, near, far } }
    }

    #[staticmethod]
    fn looking_at(position: [f32; 3], target: [f32; 3], field_of_view: f32) -> Self {
        let (position, target) = (Vec3::from_array(position), Vec3::from_array(target));
        Self { camera: geometry::Camera::looking_at(position, target, field_of_view) }
    }

    #[getter]
    fn position(&self) -> [f32; 3] {
        self.camera.position.to_array()
    }

    /// Unit quaternion x, y, z, w.
    #[getter]
    fn rotation(&self) -> [f32; 4] {
        self.camera.rotation.to_array()
    }

    /// Radians: vertical for perspective, the whole cone for a fish-eye.
    #[getter]
    fn field_of_view(&self) -> f32 {
        match self.camera.projection {
            geometry::Projection::Perspective { field_of_view }
            | geometry::Projection::Fisheye { field_of_view } => field_of_view,
        }
    }

    #[getter]
    fn fisheye(&self) -> bool {
        matches!(self.camera.projection, geometry::Projection::Fisheye { .. })
    }

    #[getter]
    fn near(&self) -> f32 {
        self.camera.near
    }

    #[getter]
    fn far(&self) -> f32 {
        self.camera.far
    }
}
