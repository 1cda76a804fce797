use std::sync::Arc;

use bioscope_core::Mark;
use bioscope_geometry as geometry;
use numpy::ndarray::ShapeBuilder;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, Array1, Array2, Array3, Floats};
use crate::material::Material;
use crate::mesh::Mesh;

/// See `bioscope.Scene`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Scene {
    pub scene: Arc<geometry::Scene>,
}

#[pymethods]
impl Scene {
    #[getter]
    fn tick(&self) -> u64 {
        self.scene.tick
    }

    #[getter]
    fn time(&self) -> f64 {
        self.scene.time
    }

    #[getter]
    fn batches(&self) -> Vec<Batch> {
        let batches = 0..self.scene.batches.len();
        batches.map(|index| Batch { scene: self.scene.clone(), index }).collect()
    }

    #[getter]
    fn points(&self) -> Vec<Points> {
        let points = 0..self.scene.points.len();
        points.map(|index| Points { scene: self.scene.clone(), index }).collect()
    }

    #[getter]
    fn sun<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sun = PyDict::new(py);
        sun.set_item("direction", self.scene.sun.direction.to_array())?;
        sun.set_item("color", self.scene.sun.color)?;
        Ok(sun)
    }

    #[getter]
    fn sky<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sky = PyDict::new(py);
        sky.set_item("zenith", self.scene.sky.zenith)?;
        sky.set_item("horizon", self.scene.sky.horizon)?;
        sky.set_item("nadir", self.scene.sky.nadir)?;
        Ok(sky)
    }

    #[getter]
    fn medium<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let medium = &self.scene.medium;
        let dict = PyDict::new(py);
        dict.set_item("surface", medium.surface)?;
        dict.set_item("absorption", medium.absorption)?;
        dict.set_item("scattering", medium.scattering)?;
        dict.set_item("glow", medium.glow)?;
        dict.set_item("caustics", medium.caustics)?;
        dict.set_item("caustic_scale", medium.caustic_scale)?;
        dict.set_item("shafts", medium.shafts)?;
        Ok(dict)
    }

    #[getter]
    fn annotations<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.scene.annotations.iter().map(|one| annotation(py, one)).collect()
    }
}

fn annotation<'py>(
    py: Python<'py>,
    one: &bioscope_core::Annotation,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("subject", one.subject)?;
    dict.set_item("role", one.role.as_ref())?;
    match &one.mark {
        Mark::Line { from, to } => {
            let line: Vec<f32> = from.to_array().into_iter().chain(to.to_array()).collect();
            dict.set_item("line", line)?;
        }
        Mark::Sphere { center, radius } => {
            dict.set_item("center", center.to_array())?;
            dict.set_item("radius", radius)?;
        }
        Mark::Label { position, text } => {
            dict.set_item("position", position.to_array())?;
            dict.set_item("text", text)?;
        }
    }
    Ok(dict)
}

/// See `bioscope.Batch`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Batch {
    scene: Arc<geometry::Scene>,
    index: usize,
}

impl Batch {
    fn get(&self) -> &geometry::Batch {
        &self.scene.batches[self.index]
    }
}

#[pymethods]
impl Batch {
    #[getter]
    fn name(&self) -> &str {
        &self.get().name
    }

    #[getter]
    fn species(&self) -> &str {
        &self.get().species
    }

    #[getter]
    fn alive(&self) -> bool {
        self.get().alive
    }

    #[getter]
    fn mesh(&self) -> Mesh {
        Mesh { mesh: self.get().mesh.clone() }
    }

    #[getter]
    fn material(&self) -> Material {
        Material { material: self.get().material.clone() }
    }

    #[getter]
    fn ids<'py>(slf: &Bound<'py, Self>) -> PyResult<Array1<'py, u32>> {
        let ids = &slf.get().get().ids;
        arrays::view(slf.as_any(), ids, [ids.len()])
    }

    #[getter]
    fn transforms<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        columns(slf, &slf.get().get().transforms, 0, 8)
    }

    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        columns(slf, &slf.get().get().transforms, 0, 3)
    }

    #[getter]
    fn rotations<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        columns(slf, &slf.get().get().transforms, 4, 4)
    }

    #[getter]
    fn scales<'py>(slf: &Bound<'py, Self>) -> PyResult<Array1<'py, f32>> {
        let transforms = &slf.get().get().transforms;
        if transforms.is_empty() {
            return arrays::view(slf.as_any(), &[], [0]);
        }
        let numbers = numbers(transforms);
        let from = numbers.get(3..).unwrap_or_default();
        arrays::view(slf.as_any(), from, [transforms.len()].strides([8]))
    }

    #[getter]
    fn velocities<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        let velocities = &slf.get().get().velocities;
        let numbers = velocities.as_flattened_floats();
        arrays::view(slf.as_any(), numbers, [velocities.len(), 3])
    }

    #[getter]
    fn tints<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        let tints = &slf.get().get().tints;
        arrays::view(slf.as_any(), tints.as_flattened(), [tints.len(), 3])
    }

    #[getter]
    fn poses<'py>(slf: &Bound<'py, Self>) -> PyResult<Array3<'py, f32>> {
        let batch = slf.get().get();
        let (count, joints) = (batch.ids.len(), batch.joint_count());
        let shape = if joints == 0 { [0, 0, 8] } else { [count, joints, 8] };
        arrays::view(slf.as_any(), numbers(&batch.poses), shape)
    }
}

fn columns<'py>(
    owner: &Bound<'py, Batch>,
    transforms: &[geometry::Transform],
    first: usize,
    width: usize,
) -> PyResult<Array2<'py, f32>> {
    if transforms.is_empty() {
        return arrays::view(owner.as_any(), &[], [0, width]);
    }
    let from = numbers(transforms).get(first..).unwrap_or_default();
    arrays::view(owner.as_any(), from, [transforms.len(), width].strides([8, 1]))
}

fn numbers(transforms: &[geometry::Transform]) -> &[f32] {
    bytemuck::cast_slice(transforms)
}

/// See `bioscope.Points`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Points {
    scene: Arc<geometry::Scene>,
    index: usize,
}

impl Points {
    fn get(&self) -> &geometry::Points {
        &self.scene.points[self.index]
    }
}

#[pymethods]
impl Points {
    #[getter]
    fn name(&self) -> &str {
        &self.get().name
    }

    #[getter]
    fn species(&self) -> &str {
        &self.get().species
    }

    #[getter]
    fn color(&self) -> [f32; 3] {
        self.get().color
    }

    #[getter]
    fn opacity(&self) -> f32 {
        self.get().opacity
    }

    #[getter]
    fn glassy(&self) -> bool {
        self.get().glassy
    }

    #[getter]
    fn ids<'py>(slf: &Bound<'py, Self>) -> PyResult<Array1<'py, u32>> {
        let ids = &slf.get().get().ids;
        arrays::view(slf.as_any(), ids, [ids.len()])
    }

    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> PyResult<Array2<'py, f32>> {
        let positions = &slf.get().get().positions;
        arrays::view(slf.as_any(), positions.as_flattened_floats(), [positions.len(), 3])
    }

    #[getter]
    fn radii<'py>(slf: &Bound<'py, Self>) -> PyResult<Array1<'py, f32>> {
        let radii = &slf.get().get().radii;
        arrays::view(slf.as_any(), radii, [radii.len()])
    }
}
