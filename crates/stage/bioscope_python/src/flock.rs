use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use bioscope_core::{Error, Parameters, Vec3};
use bioscope_crowds::{FlockParameters, Goal, Home, Region, Surroundings, statistics};
use bioscope_geometry::Obstacle;
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{Array1, Array2, Floats};
use crate::error::to_python;

type Floats3 = [f32; 3];

/// See `bioscope.crowds.Flock`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Flock {
    state: Mutex<State>,
}

struct State {
    flock: bioscope_crowds::Flock,
    obstacles: Vec<Obstacle>,
    goal: Option<Goal>,
    home: Option<Home>,
    time: f64,
}

#[pymethods]
impl Flock {
    /// `half` are half axes of an ellipsoid, or half sides of a box.
    #[new]
    #[pyo3(signature = (count, half, seed, parameters, boxed=false))]
    fn new(
        count: u32,
        half: Floats3,
        seed: u64,
        parameters: BTreeMap<String, f64>,
        boxed: bool,
    ) -> PyResult<Self> {
        let mut flock = FlockParameters::default();
        for (name, value) in parameters {
            flock.set(&name, value).map_err(to_python)?;
        }
        let (center, half) = (Vec3::ZERO, Vec3::from_array(half));
        let region =
            if boxed { Region::Box { center, half } } else { Region::Ellipsoid { center, half } };
        let flock = bioscope_crowds::Flock::scattered(1..=count, region, seed, flock);
        let flock = flock.map_err(to_python)?;
        let state = State { flock, obstacles: Vec::new(), goal: None, home: None, time: 0.0 };
        Ok(Self { state: Mutex::new(state) })
    }

    fn add_sphere(&self, center: Floats3, radius: f32) {
        let center = Vec3::from_array(center);
        self.lock().obstacles.push(Obstacle::Sphere { center, radius });
    }

    fn add_cylinder(&self, base: Floats3, top: Floats3, radius: f32) {
        let (base, top) = (Vec3::from_array(base), Vec3::from_array(top));
        self.lock().obstacles.push(Obstacle::Cylinder { base, top, radius });
    }

    fn add_box(&self, low: Floats3, high: Floats3) {
        let (low, high) = (Vec3::from_array(low), Vec3::from_array(high));
        self.lock().obstacles.push(Obstacle::Box { low, high });
    }

    fn add_plane(&self, point: Floats3, normal: Floats3) -> PyResult<()> {
        let (point, normal) = (Vec3::from_array(point), Vec3::from_array(normal));
        let Some(normal) = normal.try_normalize() else {
            return Err(to_python(Error::value("normal", normal, "a direction")));
        };
        self.lock().obstacles.push(Obstacle::Plane { point, normal });
        Ok(())
    }

    fn migrate_to(&self, point: Option<Floats3>) {
        self.lock().goal = point.map(|point| Goal::Point(Vec3::from_array(point)));
    }

    fn stay_within(&self, center: Floats3, radius: f32) {
        self.lock().home = Some(Home { center: Vec3::from_array(center), radius });
    }

    fn set(&self, name: &str, value: f64) -> PyResult<()> {
        self.lock().flock.parameters.set(name, value).map_err(to_python)
    }

    /// Updates all members `ticks` times by `dt` seconds.
    fn step(&self, py: Python<'_>, dt: f32, ticks: u32) -> PyResult<()> {
        let outcome = py.detach(|| {
            let mut state = self.lock();
            let State { flock, obstacles, goal, home, time } = &mut *state;
            for _ in 0..ticks {
                let (goal, home) = (*goal, *home);
                let around =
                    Surroundings { time: *time, obstacles, goal, home, ..Surroundings::default() };
                flock.update(dt, &around)?;
                *time += f64::from(dt);
            }
            Ok(())
        });
        outcome.map_err(to_python)
    }

    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f32>> {
        rows(py, self.lock().flock.positions())
    }

    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f32>> {
        rows(py, self.lock().flock.velocities())
    }

    #[getter]
    fn headings<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f32>> {
        rows(py, self.lock().flock.headings())
    }

    #[getter]
    fn ups<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f32>> {
        rows(py, self.lock().flock.ups())
    }

    /// Length of the mean heading, 0 (all ways) to 1 (one way).
    fn polarization(&self) -> f32 {
        statistics::polarization(self.lock().flock.velocities())
    }

    /// Distance of each to its nearest neighbor within `reach` metres.
    fn nearest<'py>(&self, py: Python<'py>, reach: f32) -> Array1<'py, f32> {
        let state = self.lock();
        statistics::nearest_neighbor_distances(state.flock.positions(), reach).into_pyarray(py)
    }

    /// Number of groups whose members are linked by less than `link` metres.
    fn flockettes(&self, link: f32) -> usize {
        statistics::flockette_count(self.lock().flock.positions(), link)
    }
}

impl Flock {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn rows<'py>(py: Python<'py>, vectors: &[Vec3]) -> PyResult<Array2<'py, f32>> {
    vectors.as_flattened_floats().to_vec().into_pyarray(py).reshape([vectors.len(), 3])
}
