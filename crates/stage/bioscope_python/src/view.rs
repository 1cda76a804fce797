use std::sync::Arc;

use bioscope_core::{Purpose, SoundEvent};
use bioscope_geometry as geometry;
use bioscope_world::{Environment, Moment};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, ToPyArray};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{self, Array1, Array2};
use crate::error::to_python;
use crate::scene::Scene;

/// See `bioscope.WorldView`: what a population written in Python may read.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct View {
    moment: Moment,
    scene: Arc<geometry::Scene>,
    sounds: Vec<SoundEvent>,
    environment: Environment,
}

impl View {
    pub fn new(view: &bioscope_world::View) -> Self {
        Self {
            moment: view.moment,
            scene: view.scene.clone(),
            sounds: view.sounds.to_vec(),
            environment: view.environment.clone(),
        }
    }
}

#[pymethods]
impl View {
    #[getter]
    fn tick(&self) -> u64 {
        self.moment.tick
    }

    #[getter]
    fn time(&self) -> f64 {
        self.moment.time
    }

    #[getter]
    fn dt(&self) -> f32 {
        self.moment.dt
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.moment.seed
    }

    #[getter]
    fn scene(&self) -> Scene {
        Scene { scene: self.scene.clone() }
    }

    #[getter]
    fn sounds<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.sounds.iter().map(|one| sound(py, one)).collect()
    }

    /// Height of the water surface in metres; none without water.
    #[getter]
    fn surface(&self) -> Option<f32> {
        self.environment.medium.surface
    }

    /// Velocity of the medium (n, 3) at points (n, 3).
    fn flow<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f32>,
    ) -> PyResult<Array2<'py, f32>> {
        let points = arrays::vectors("points", &points).map_err(to_python)?;
        let influence = self.environment.influence(&points, self.moment.time).map_err(to_python)?;
        let rows: Vec<_> = influence.iter().map(|one| one.flow.to_array().to_vec()).collect();
        if rows.is_empty() {
            return Ok(PyArray2::zeros(py, [0, 3], false));
        }
        Ok(PyArray2::from_vec2(py, &rows)?)
    }

    /// Height of the ground (n,) below points (n, 3); minus infinity without terrain.
    fn ground<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f32>,
    ) -> PyResult<Array1<'py, f32>> {
        let points = arrays::vectors("points", &points).map_err(to_python)?;
        let terrain = self.environment.terrain.as_deref();
        let height = |point: &bioscope_core::Vec3| {
            terrain.map_or(f32::NEG_INFINITY, |terrain| terrain.height(point.x, point.z))
        };
        Ok(PyArray1::from_iter(py, points.iter().map(height)))
    }

    /// Numbers (n, count) uniform in [0, 1) of these individuals in this tick for this purpose.
    #[pyo3(signature = (ids, purpose, count=1))]
    fn random<'py>(
        &self,
        py: Python<'py>,
        ids: PyReadonlyArray1<'py, u32>,
        purpose: &str,
        count: usize,
    ) -> Array2<'py, f32> {
        let ids = ids.as_array();
        let purpose = Purpose::new(purpose);
        let numbers = numpy::ndarray::Array2::from_shape_vec(
            (ids.len(), count),
            ids.iter()
                .flat_map(|&id| {
                    let mut random = self.moment.random(id, purpose);
                    (0..count).map(move |_| random.uniform())
                })
                .collect(),
        );
        numbers.expect("one row of count numbers per id").to_pyarray(py)
    }
}

/// A sound event as a dict.
pub fn sound<'py>(py: Python<'py>, sound: &SoundEvent) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("source", sound.source)?;
    dict.set_item("kind", &*sound.kind)?;
    dict.set_item("time", sound.time)?;
    dict.set_item("duration", sound.duration)?;
    dict.set_item("position", sound.position.to_array())?;
    dict.set_item("velocity", sound.velocity.to_array())?;
    dict.set_item("amplitude", sound.amplitude)?;
    dict.set_item("pitch", sound.pitch)?;
    Ok(dict)
}
