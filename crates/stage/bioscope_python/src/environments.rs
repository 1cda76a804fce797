//! What surrounds plants: the environments of open L-systems.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use bioscope_core::{Error, Vec3};
use bioscope_lsystem::{self as lsystem, EnvironmentError, Reply, Request, Settings};
use numpy::{IntoPyArray, PyArray1, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays::{self, Floats};
use crate::error::{from_python, to_python};
use crate::lsystem::{LSystem, ModuleString};
use crate::mesh::Mesh;
use crate::turtle::ViewFile;

type Inner = Arc<Mutex<Box<dyn lsystem::Environment>>>;

/// See `bioscope.environments.Environment`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Environment {
    inner: Inner,
}

/// An environment that Python keeps while a derivation uses it.
struct Shared(Inner);

impl lsystem::Environment for Shared {
    fn exchange(
        &mut self,
        step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let mut inner = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        inner.exchange(step, requests, replies)
    }

    fn memory(&self) -> bioscope_core::Result<Vec<u8>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).memory()
    }

    fn amounts(&self) -> Option<lsystem::Amounts> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).amounts()
    }

    fn recall(&mut self, memory: &[u8]) -> bioscope_core::Result<()> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).recall(memory)
    }
}

/// Brings back an environment of a saved world: one written in Python by the class registered under its name.
pub fn revived(name: &str) -> bioscope_core::Result<Box<dyn lsystem::Environment>> {
    let build = |py: Python<'_>| -> PyResult<Py<PyAny>> {
        let module = py.import("bioscope.environments")?;
        module.call_method1("rebuild", (name,)).map(Bound::unbind)
    };
    let environment = Python::attach(build).map_err(|error| from_python(name, "restore", error))?;
    Ok(Box::new(Callback { environment }))
}

impl Environment {
    /// What a derivation takes over; the state stays with this object.
    pub fn shared(&self) -> Box<dyn lsystem::Environment> {
        Box::new(Shared(self.inner.clone()))
    }

    fn new(inner: Box<dyn lsystem::Environment>) -> Self {
        Self { inner: Arc::new(Mutex::new(inner)) }
    }
}

fn refused(error: EnvironmentError) -> PyErr {
    to_python(Error::format("environment", error.to_string()))
}

fn light_map(
    array: &PyReadonlyArray2<'_, f32>,
    low: [f32; 2],
    size: [f32; 2],
) -> lsystem::LightMap {
    let array = array.as_array();
    let [rows, columns] = [array.shape()[0], array.shape()[1]];
    let light =
        array.iter().map(|light| if light.is_finite() { light.clamp(0.0, 1.0) } else { 0.0 });
    lsystem::LightMap { low, size, cells: [columns, rows], light: light.collect() }
}

#[pymethods]
impl Environment {
    /// A built-in environment or field program by name; `map` is light (rows, columns), lowest row first.
    #[staticmethod]
    #[pyo3(signature = (name, settings, map=None, low=[-30.0, -30.0], size=[60.0, 60.0]))]
    fn built_in(
        name: &str,
        settings: Vec<(String, String)>,
        map: Option<PyReadonlyArray2<'_, f32>>,
        low: [f32; 2],
        size: [f32; 2],
    ) -> PyResult<Self> {
        let mut own = Settings::default();
        settings.into_iter().for_each(|(name, value)| own.set(&name, value));
        let map = map.map(|map| light_map(&map, low, size));
        Ok(Self::new(lsystem::built_in(name, &own, map).map_err(refused)?))
    }

    /// An environment by name and parameters, as a model asks for it.
    #[staticmethod]
    fn named(words: &str) -> PyResult<Self> {
        lsystem::DerivationOptions::environment_of(words).map(Self::new).map_err(refused)
    }

    /// Cells in x, y and z, lowest corner, width of a cell and amounts of what it keeps; none if it keeps nothing.
    #[allow(clippy::type_complexity)] // A tuple for Python.
    fn amounts<'py>(
        &self,
        py: Python<'py>,
    ) -> Option<([usize; 3], [f32; 3], f32, Bound<'py, PyArray1<f32>>)> {
        let amounts = self.inner.lock().unwrap_or_else(PoisonError::into_inner).amounts()?;
        let lsystem::Amounts { cells, low, cell, values } = amounts;
        Some((cells, low.to_array(), cell, values.into_pyarray(py)))
    }

    /// What an environment file (.e) describes.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let environment = py.detach(|| lsystem::read_environment(&path));
        Ok(Self::new(environment.map_err(to_python)?))
    }

    /// A program at the other end of a pipe.
    #[staticmethod]
    fn pipe(command: Vec<String>, seconds: f64) -> PyResult<Self> {
        let patience = Duration::try_from_secs_f64(seconds)
            .map_err(|_| to_python(Error::value("seconds", seconds, "a positive number")))?;
        let pipe = lsystem::Pipe::start(&command, patience).map_err(refused)?;
        Ok(Self::new(Box::new(pipe)))
    }

    /// A Python object with a method `exchange(step, messages)`.
    #[staticmethod]
    fn python(environment: Py<PyAny>) -> Self {
        Self::new(Box::new(Callback { environment }))
    }

    /// Asks once: parameters, places and headings of messages; the parameters after the answers.
    fn ask(
        &self,
        py: Python<'_>,
        parameters: Vec<Vec<f32>>,
        positions: PyReadonlyArray2<'_, f32>,
        headings: PyReadonlyArray2<'_, f32>,
        step: u64,
    ) -> PyResult<Vec<Vec<f32>>> {
        let positions = arrays::vectors("positions", &positions).map_err(to_python)?;
        let headings = arrays::vectors("headings", &headings).map_err(to_python)?;
        for (name, count) in [("positions", positions.len()), ("headings", headings.len())] {
            arrays::same_count(name, count, parameters.len()).map_err(to_python)?;
        }
        let mut answers = parameters.clone();
        let request = |module: usize| {
            let heading = headings[module].normalize_or(Vec3::Y);
            let left = Vec3::Z.cross(heading).normalize_or(Vec3::X);
            Request {
                module,
                id: module as u64,
                parameters: &parameters[module],
                position: positions[module],
                heading,
                left,
                up: heading.cross(left),
                width: 1.0,
                color: 1,
                following: None,
            }
        };
        let requests: Vec<Request> = (0..parameters.len()).map(request).collect();
        let mut replies: Vec<Reply> =
            answers.iter_mut().map(|answer| Reply { parameters: answer }).collect();
        let outcome = py.detach(|| {
            let mut inner = self.inner.lock().unwrap_or_else(PoisonError::into_inner);
            inner.exchange(step, &requests, &mut replies)
        });
        drop(replies);
        outcome.map_err(refused)?;
        Ok(answers)
    }
}

fn amounts(values: &PyReadonlyArray3<'_, f32>, low: [f32; 3], cell: f32) -> lsystem::Amounts {
    let array = values.as_array();
    let (layers, rows, columns) = array.dim();
    let values = array.iter().copied().collect();
    lsystem::Amounts { cells: [columns, rows, layers], low: low.into(), cell, values }
}

/// The surface on which a deep field (z, y, x) has this amount.
#[pyfunction]
pub fn amounts_surface(
    values: PyReadonlyArray3<'_, f32>,
    low: [f32; 3],
    cell: f32,
    amount: f32,
) -> Mesh {
    Mesh { mesh: Arc::new(amounts(&values, low, cell).surface(amount)) }
}

/// The first layer of a field (z, y, x), painted from black to blue, which is `most`.
#[pyfunction]
pub fn amounts_sheet(
    values: PyReadonlyArray3<'_, f32>,
    low: [f32; 3],
    cell: f32,
    most: f32,
) -> Mesh {
    Mesh { mesh: Arc::new(amounts(&values, low, cell).sheet(most)) }
}

/// Names of the environments that are built in.
#[pyfunction]
pub fn environment_names() -> Vec<&'static str> {
    lsystem::environment_names().to_vec()
}

/// Derives a string in an environment; the turtle walks as the view and the options say.
#[pyfunction]
#[pyo3(signature = (system, steps, seed, environment=None, view=None, options=None, threads=true))]
#[allow(clippy::too_many_arguments)] // Keywords of a Python call.
pub fn derive_in(
    py: Python<'_>,
    system: &Bound<'_, LSystem>,
    steps: u64,
    seed: u64,
    environment: Option<&Bound<'_, Environment>>,
    view: Option<&Bound<'_, ViewFile>>,
    options: Option<&Bound<'_, PyDict>>,
    threads: bool,
) -> PyResult<ModuleString> {
    let own = system.get().system.clone();
    let mut derivation = lsystem::DerivationOptions::of(&own).map_err(refused)?;
    (derivation.seed, derivation.threads) = (Some(seed), threads);
    if let Some(environment) = environment {
        derivation.environment = Some(environment.get().shared());
    }
    if let Some(view) = view {
        let view = &view.get().view;
        derivation.turtle = view.turtle.clone();
        derivation.functions = Some(Arc::new(lsystem::FunctionTable::new(view)));
    }
    if let Some(angle) = own.angle() {
        derivation.turtle.angle = angle;
    }
    for (name, value) in options.into_iter().flatten() {
        crate::turtle::set(&mut derivation.turtle, &name.extract::<String>()?, &value)?;
    }
    let string = py.detach(|| -> Result<_, lsystem::DerivationError> {
        let mut derivation = lsystem::Derivation::with_options(&own, derivation)?;
        for _ in 0..steps {
            derivation.advance()?;
        }
        derivation.finish()
    });
    let string = string.map_err(|error| to_python(error.into()))?;
    Ok(ModuleString::derived(string, own, seed))
}

/// The parameters of all messages, those that shorter ones lack not a number, and how many the longest has.
fn table(requests: &[Request]) -> (Vec<f32>, usize) {
    let widest = requests.iter().map(|one| one.parameters.len()).max().unwrap_or(0);
    let mut table = vec![f32::NAN; requests.len() * widest];
    for (row, request) in requests.iter().enumerate() {
        let own = request.parameters;
        table[row * widest..row * widest + own.len()].copy_from_slice(own);
    }
    (table, widest)
}

/// An environment written in Python.
struct Callback {
    environment: Py<PyAny>,
}

const FIELDS: [&str; 8] =
    ["parameters", "positions", "headings", "lefts", "ups", "widths", "modules", "following"];

impl Callback {
    /// What the environment is told: those of [`FIELDS`] that it names in its attribute `fields`, or all.
    fn messages<'py>(&self, py: Python<'py>, requests: &[Request]) -> PyResult<Bound<'py, PyDict>> {
        let count = requests.len();
        let named = self.environment.bind(py).getattr_opt("fields")?;
        let wanted: Option<Vec<String>> = match named {
            Some(fields) => fields.extract()?,
            None => None,
        };
        let unknown = wanted.iter().flatten().find(|name| !FIELDS.contains(&name.as_str()));
        if let Some(name) = unknown {
            return Err(to_python(Error::Unknown {
                kind: "field of a message",
                name: name.clone(),
                known: FIELDS.map(str::to_owned).to_vec(),
            }));
        }
        let points = |of: fn(&Request) -> Vec3| -> PyResult<Bound<'py, PyAny>> {
            let all: Vec<Vec3> = requests.iter().map(of).collect();
            let floats = all.as_slice().as_flattened_floats().to_vec();
            Ok(floats.into_pyarray(py).reshape([count, 3])?.into_any())
        };
        let messages = PyDict::new(py);
        for name in FIELDS {
            if wanted.as_ref().is_some_and(|fields| !fields.iter().any(|field| field == name)) {
                continue;
            }
            let field = match name {
                "parameters" => {
                    let (numbers, widest) = table(requests);
                    numbers.into_pyarray(py).reshape([count, widest])?.into_any()
                }
                "positions" => points(|one| one.position)?,
                "headings" => points(|one| one.heading)?,
                "lefts" => points(|one| one.left)?,
                "ups" => points(|one| one.up)?,
                "widths" => {
                    let widths: Vec<f32> = requests.iter().map(|one| one.width).collect();
                    widths.into_pyarray(py).into_any()
                }
                "modules" => {
                    let modules: Vec<u64> = requests.iter().map(|one| one.module as u64).collect();
                    modules.into_pyarray(py).into_any()
                }
                _ => {
                    let following: Vec<Option<(&str, Vec<f32>)>> = requests
                        .iter()
                        .map(|one| one.following.as_ref())
                        .map(|next| next.map(|next| (next.symbol, next.parameters.to_vec())))
                        .collect();
                    following.into_pyobject(py)?.into_any()
                }
            };
            messages.set_item(name, field)?;
        }
        Ok(messages)
    }

    fn call(
        &self,
        py: Python<'_>,
        step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> PyResult<()> {
        let count = requests.len();
        let messages = self.messages(py, requests)?;
        let answer = self.environment.bind(py).call_method1("exchange", (step, messages))?;
        if answer.is_none() {
            return Ok(());
        }
        let numpy = py.import("numpy")?;
        let answer = numpy.call_method1("asarray", (answer, numpy.getattr("float32")?))?;
        let answer: PyReadonlyArray2<'_, f32> = answer.extract()?;
        let answer = answer.as_array();
        if answer.shape()[0] != count {
            let found = format!("answers of shape ({}, {})", answer.shape()[0], answer.shape()[1]);
            let expected = format!("shape ({count}, k), one row per message");
            return Err(to_python(Error::value("exchange", found, expected)));
        }
        for (reply, row) in replies.iter_mut().zip(answer.rows()) {
            for (own, &value) in reply.parameters.iter_mut().zip(row) {
                // What is no number leaves the parameter as it is.
                if !value.is_nan() {
                    *own = value;
                }
            }
        }
        Ok(())
    }
}

impl lsystem::Environment for Callback {
    fn exchange(
        &mut self,
        step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        Python::attach(|py| {
            let name = self
                .environment
                .bind(py)
                .get_type()
                .name()
                .map_or_else(|_| "environment".to_owned(), |name| name.to_string());
            let outcome = self.call(py, step, requests, replies);
            outcome.map_err(|error| EnvironmentError::Gone { name, reason: error.to_string() })
        })
    }

    fn memory(&self) -> bioscope_core::Result<Vec<u8>> {
        let save = |py: Python<'_>| self.environment.bind(py).call_method0("_save")?.extract();
        Python::attach(save).map_err(|error| from_python("environment", "save", error))
    }

    fn recall(&mut self, memory: &[u8]) -> bioscope_core::Result<()> {
        let restore = |py: Python<'_>| {
            let memory = PyBytes::new(py, memory);
            self.environment.bind(py).call_method1("_restore", (memory,)).map(drop)
        };
        Python::attach(restore).map_err(|error| from_python("environment", "restore", error))
    }
}
