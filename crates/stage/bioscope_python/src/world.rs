use std::sync::{Mutex, PoisonError};
use std::thread::{self, ThreadId};

use bioscope_core::{Error, Result, Vec3};
use bioscope_geometry::{Obstacle, Terrain};
use bioscope_world::Registry;
use numpy::{PyArrayMethods, PyReadonlyArray2};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::camera::Camera;
use crate::error::to_python;
use crate::field::{Field, PythonField};
use crate::mind::Classes;
use crate::population::{PythonPopulation, Resident};
use crate::scene::Scene;
use crate::{values, view};

/// How many ticks are made between two looks for Ctrl-C.
const TICKS_PER_SIGNAL_CHECK: u64 = 8;

/// See `bioscope.World`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct World {
    world: Mutex<bioscope_world::World>,
    /// Thread inside a call, to refuse re-entry from a callback instead of waiting for ever.
    busy: Mutex<Option<ThreadId>>,
}

impl World {
    fn new_of(world: bioscope_world::World) -> Self {
        Self { world: Mutex::new(world), busy: Mutex::new(None) }
    }

    /// Runs `body` on the engine's world with the interpreter lock released.
    pub fn with<T: Send>(
        &self,
        py: Python<'_>,
        body: impl FnOnce(&mut bioscope_world::World) -> Result<T> + Send,
    ) -> PyResult<T> {
        let me = thread::current().id();
        let busy = || self.busy.lock().unwrap_or_else(PoisonError::into_inner);
        if *busy() == Some(me) {
            let expected = "use of what the verb is given; the world is in the middle of a tick";
            return Err(to_python(Error::value("world", "in use", expected)));
        }
        let outcome = py.detach(|| {
            let mut world = self.world.lock().unwrap_or_else(PoisonError::into_inner);
            *busy() = Some(me);
            let outcome = body(&mut world);
            *busy() = None;
            outcome
        });
        outcome.map_err(to_python)
    }
}

/// Everything that saved worlds may hold, user's classes among them.
fn registry(kinds: Vec<String>, fields: Vec<String>, minds: Classes) -> Registry {
    let mut registry = bioscope_populations::registry();
    bioscope_populations::add_animals(&mut registry, crate::mind::parts(minds));
    bioscope_populations::add_stands(&mut registry, crate::environments::revived);
    for kind in kinds {
        let name = kind.clone();
        registry.add_population(&kind, move |bytes| {
            Ok(Box::new(PythonPopulation::rebuild(&name, bytes)?))
        });
    }
    for kind in fields {
        let name = kind.clone();
        registry.add_field(&kind, move |bytes| Ok(Box::new(PythonField::rebuild(&name, bytes)?)));
    }
    registry
}

#[pymethods]
impl World {
    #[new]
    fn new(seed: u64, dt: f64) -> PyResult<Self> {
        bioscope_world::World::new(seed, dt).map(Self::new_of).map_err(to_python)
    }

    #[staticmethod]
    fn restore(
        py: Python<'_>,
        data: &[u8],
        populations: Vec<String>,
        fields: Vec<String>,
        minds: Classes,
    ) -> PyResult<Self> {
        let registry = registry(populations, fields, minds);
        let world = py.detach(|| bioscope_world::World::restore(data, &registry));
        world.map(Self::new_of).map_err(to_python)
    }

    #[getter]
    fn seed(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |world| Ok(world.seed()))
    }

    #[getter]
    fn dt(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |world| Ok(world.dt()))
    }

    #[getter]
    fn tick(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |world| Ok(world.tick_count()))
    }

    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |world| Ok(world.time()))
    }

    #[getter]
    fn get_title(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |world| Ok(world.title.clone()))
    }

    #[setter]
    fn set_title(&self, py: Python<'_>, title: String) -> PyResult<()> {
        self.with(py, |world| {
            world.title = title;
            Ok(())
        })
    }

    #[getter]
    fn scene(&self, py: Python<'_>) -> PyResult<Scene> {
        self.with(py, |world| Ok(Scene { scene: world.scene().clone() }))
    }

    #[getter]
    fn sounds<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let sounds = self.with(py, |world| Ok(world.sounds().to_vec()))?;
        sounds.iter().map(|sound| view::sound(py, sound)).collect()
    }

    /// Names, kinds and counts of the populations.
    #[getter]
    fn populations(&self, py: Python<'_>) -> PyResult<Vec<(String, String, usize)>> {
        self.with(py, |world| {
            let populations = world.populations().iter();
            Ok(populations
                .map(|one| {
                    let population = &one.population;
                    (one.name.clone(), population.kind().to_owned(), population.count())
                })
                .collect())
        })
    }

    /// Makes ticks; stops for Ctrl-C between two of them.
    fn step(&self, py: Python<'_>, ticks: u64) -> PyResult<()> {
        for done in 0..ticks {
            if done % TICKS_PER_SIGNAL_CHECK == 0 {
                py.check_signals()?;
            }
            self.with(py, bioscope_world::World::tick)?;
        }
        Ok(())
    }

    fn state_hash(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |world| world.state_hash())
    }

    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.with(py, |world| world.save())?;
        Ok(PyBytes::new(py, &bytes))
    }

    fn return_to(&self, py: Python<'_>, data: &[u8]) -> PyResult<()> {
        self.with(py, |world| world.return_to(data))
    }

    #[pyo3(signature = (resident, name=None))]
    fn add(
        &self,
        py: Python<'_>,
        resident: &Bound<'_, Resident>,
        name: Option<&str>,
    ) -> PyResult<String> {
        let population = resident.get().take().map_err(to_python)?;
        self.with(py, |world| world.add(population, name))
    }

    #[pyo3(signature = (population, kind, name=None))]
    fn add_python(
        &self,
        py: Python<'_>,
        population: Py<PyAny>,
        kind: String,
        name: Option<&str>,
    ) -> PyResult<String> {
        let population = PythonPopulation::new(population, kind)?;
        self.with(py, |world| world.add(Box::new(population), name))
    }

    #[pyo3(signature = (field, name=None))]
    fn add_field(
        &self,
        py: Python<'_>,
        field: &Bound<'_, Field>,
        name: Option<&str>,
    ) -> PyResult<String> {
        let field = field.get().take().map_err(to_python)?;
        self.with(py, |world| world.add_field(field, name))
    }

    #[pyo3(signature = (field, kind, name=None))]
    fn add_python_field(
        &self,
        py: Python<'_>,
        field: Py<PyAny>,
        kind: String,
        name: Option<&str>,
    ) -> PyResult<String> {
        let field = PythonField::new(field, kind);
        self.with(py, |world| world.add_field(Box::new(field), name))
    }

    /// Fills everything below this height with clear sea water.
    fn fill_with_water(&self, py: Python<'_>, surface: f32) -> PyResult<()> {
        if !surface.is_finite() {
            return Err(to_python(Error::value("surface", surface, "a height in metres")));
        }
        self.with(py, |world| {
            world.environment.fill_with_water(surface);
            Ok(())
        })
    }

    /// Lays a heightfield: `heights` (rows along z, columns along x).
    fn lay_terrain(
        &self,
        py: Python<'_>,
        heights: PyReadonlyArray2<'_, f32>,
        origin: [f32; 2],
        spacing: f32,
    ) -> PyResult<()> {
        let columns = heights.as_array().shape()[1];
        let heights = heights
            .to_vec()
            .map_err(|error| to_python(Error::value("heights", error, "a contiguous array")))?;
        let terrain = Terrain::new(origin, spacing, columns, heights).map_err(to_python)?;
        self.with(py, |world| {
            world.environment.terrain = Some(terrain.into());
            Ok(())
        })
    }

    /// Puts up an invisible cylinder that stands in the way and hides what is behind it.
    fn add_cylinder(
        &self,
        py: Python<'_>,
        base: [f32; 3],
        top: [f32; 3],
        radius: f32,
    ) -> PyResult<()> {
        let (base, top) = (Vec3::from_array(base), Vec3::from_array(top));
        let sound = base.is_finite() && top.is_finite() && base != top;
        if !(sound && radius.is_finite() && radius > 0.0) {
            let found = format!("from {base} to {top}, radius {radius}");
            let expected = "two different finite points and a radius above 0, metres";
            return Err(to_python(Error::value("cylinder", found, expected)));
        }
        self.with(py, |world| {
            world.environment.obstacles.edit().push(Obstacle::Cylinder { base, top, radius });
            Ok(())
        })
    }

    /// Heights (rows along z, columns along x), origin and spacing of the terrain; none without.
    #[getter]
    fn terrain<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(terrain) = self.with(py, |world| Ok(world.environment.terrain.clone()))? else {
            return Ok(None);
        };
        let heights = numpy::PyArray1::from_slice(py, &terrain.heights);
        let heights = heights.reshape([terrain.rows(), terrain.columns])?;
        (heights, terrain.origin, terrain.spacing).into_bound_py_any(py).map(Some)
    }

    /// Every parameter as (owner, name, unit, minimum, maximum, default, meaning, source, value).
    #[allow(clippy::type_complexity)] // A row of a table.
    fn parameters(
        &self,
        py: Python<'_>,
    ) -> PyResult<Vec<(String, String, String, f64, f64, f64, String, String, f64)>> {
        self.with(py, |world| {
            let owners = world.parameters().into_iter();
            let rows = owners.flat_map(|(owner, parameters)| {
                parameters.into_iter().map(move |(one, value)| {
                    let range = (one.minimum, one.maximum, one.default);
                    (
                        owner.clone(),
                        one.name,
                        one.unit,
                        range.0,
                        range.1,
                        range.2,
                        one.meaning,
                        one.source,
                        value,
                    )
                })
            });
            Ok(rows.collect())
        })
    }

    fn set(&self, py: Python<'_>, owner: &str, name: &str, value: f64) -> PyResult<()> {
        self.with(py, |world| world.set(owner, name, value))
    }

    /// Tells a population something: `order` is a JSON text of one of the orders.
    fn order(&self, py: Python<'_>, population: &str, order: &str) -> PyResult<()> {
        let order = serde_json::from_str(order)
            .map_err(|error| to_python(Error::format("order", error.to_string())))?;
        self.with(py, |world| world.order(population, &order))
    }

    /// What is known of one individual: population, species, behavior, values, traits, percepts, eye.
    fn inspect<'py>(&self, py: Python<'py>, id: u32) -> PyResult<Option<Bound<'py, PyDict>>> {
        let found = self.with(py, |world| {
            Ok(world.inspect(id).map(|(population, one)| (population.to_owned(), one)))
        })?;
        let Some((population, inspection)) = found else { return Ok(None) };
        let dict = PyDict::new(py);
        dict.set_item("id", id)?;
        dict.set_item("population", population)?;
        dict.set_item("species", inspection.species)?;
        dict.set_item("behavior", inspection.behavior)?;
        dict.set_item("values", values::dict(py, &inspection.values)?)?;
        dict.set_item("traits", inspection.traits)?;
        dict.set_item("percepts", values::dict(py, &inspection.percepts)?)?;
        let eye = inspection.eye.map(|camera| Bound::new(py, Camera { camera })).transpose()?;
        dict.set_item("eye", eye)?;
        Ok(Some(dict))
    }

    /// One value of every individual of a population; none where there is no such value.
    fn values<'py>(
        &self,
        py: Python<'py>,
        population: &str,
        name: &str,
    ) -> PyResult<Option<Vec<Bound<'py, PyAny>>>> {
        let found = self.with(py, |world| Ok(world.values(population, name)))?;
        found.map(|all| all.iter().map(|one| values::to_python(py, one)).collect()).transpose()
    }

    fn statistics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let statistics = self.with(py, |world| Ok(world.statistics()))?;
        let dict = PyDict::new(py);
        for (name, value) in statistics {
            dict.set_item(name, value)?;
        }
        Ok(dict)
    }

    /// Events from the `first`-th on, as tuples.
    fn events<'py>(&self, py: Python<'py>, first: usize) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let events =
            self.with(py, |world| Ok(world.events().get(first..).unwrap_or_default().to_vec()))?;
        events.iter().map(|event| values::event(py, event)).collect()
    }

    /// Takes all events out.
    fn drain_events<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let events = self.with(py, |world| Ok(world.drain_events()))?;
        events.iter().map(|event| values::event(py, event)).collect()
    }

    /// Begins to record changes from outside.
    fn record(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, bioscope_world::World::record)
    }

    /// The run since `record` as bytes; none if it was not called.
    fn recording<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let recording = self.with(py, |world| Ok(world.recording()))?;
        Ok(recording.map(|one| PyBytes::new(py, &bioscope_core::state::to_bytes(&one))))
    }

    /// Repeats a recorded run to its end.
    #[staticmethod]
    fn replay(
        py: Python<'_>,
        data: &[u8],
        populations: Vec<String>,
        fields: Vec<String>,
        minds: Classes,
    ) -> PyResult<Self> {
        let registry = registry(populations, fields, minds);
        let world = py.detach(|| {
            let recording = bioscope_core::state::from_bytes("recording", data)?;
            bioscope_world::World::replay(&recording, &registry, |_| {})
        });
        world.map(Self::new_of).map_err(to_python)
    }
}
