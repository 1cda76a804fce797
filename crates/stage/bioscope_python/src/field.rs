use std::sync::{Mutex, PoisonError};

use bioscope_core::{Error, Result, Vec3};
use bioscope_dynamics::{Current, CurrentParameters, Influence};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::arrays;
use crate::error::{from_python, to_python};

/// A field of the engine before it is added to a world.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Field {
    field: Mutex<Option<Box<dyn bioscope_dynamics::Field>>>,
}

impl Field {
    /// Takes the field out; it can act in one world only.
    pub fn take(&self) -> Result<Box<dyn bioscope_dynamics::Field>> {
        let mut field = self.field.lock().unwrap_or_else(PoisonError::into_inner);
        let missing = || Error::value("field", "already added", "one not in any world yet");
        field.take().ok_or_else(missing)
    }
}

/// Water that flows, is rocked by a swell and curls in eddies.
#[pyfunction]
#[pyo3(signature = (direction, **parameters))]
pub fn current(direction: [f32; 3], parameters: Option<&Bound<'_, PyDict>>) -> PyResult<Field> {
    let mut values = CurrentParameters::default();
    set_all(&mut values, parameters)?;
    let field = Current::new(Vec3::from_array(direction), values);
    Ok(Field { field: Mutex::new(Some(Box::new(field))) })
}

/// Sets parameters from keywords.
pub fn set_all(
    parameters: &mut dyn bioscope_core::Parameters,
    keywords: Option<&Bound<'_, PyDict>>,
) -> PyResult<()> {
    for (name, value) in keywords.into_iter().flat_map(|keywords| keywords.iter()) {
        parameters.set(&name.extract::<String>()?, value.extract()?).map_err(to_python)?;
    }
    Ok(())
}

/// A field written in Python (`bioscope.Field`).
pub struct PythonField {
    object: Py<PyAny>,
    name: String,
}

impl PythonField {
    pub fn new(object: Py<PyAny>, name: String) -> Self {
        Self { object, name }
    }

    /// Brings one back from its saved state by the class registered under its kind.
    pub fn rebuild(kind: &str, bytes: &[u8]) -> Result<Self> {
        let build = |py: Python<'_>| -> PyResult<Py<PyAny>> {
            let module = py.import("bioscope.world.field")?;
            module.call_method1("rebuild", (kind, PyBytes::new(py, bytes))).map(Bound::unbind)
        };
        let object = Python::attach(build).map_err(|error| from_python(kind, "restore", error))?;
        Ok(Self { object, name: kind.to_owned() })
    }
}

impl bioscope_dynamics::Field for PythonField {
    fn kind(&self) -> &str {
        &self.name
    }

    fn add_to(&self, points: &[Vec3], time: f64, out: &mut [Influence]) -> Result<()> {
        let call = |py: Python<'_>| -> PyResult<()> {
            let rows: Vec<_> = points.iter().map(|point| point.to_array().to_vec()).collect();
            let points = PyArray2::from_vec2(py, &rows)?;
            let found = self.object.bind(py).call_method1("at", (points, time))?;
            for (name, values) in found.cast_into::<PyDict>()?.iter() {
                let name = name.extract::<String>()?;
                add(&name, &values, out)?;
            }
            Ok(())
        };
        if points.is_empty() {
            return Ok(());
        }
        Python::attach(call).map_err(|error| from_python(&self.name, "at", error))
    }

    fn boxed_clone(&self) -> Box<dyn bioscope_dynamics::Field> {
        let object = Python::attach(|py| self.object.clone_ref(py));
        Box::new(Self { object, name: self.name.clone() })
    }

    fn save(&self) -> Result<Vec<u8>> {
        Python::attach(|py| self.object.bind(py).call_method0("_save")?.extract())
            .map_err(|error| from_python(&self.name, "save", error))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        Python::attach(|py| {
            self.object.bind(py).call_method1("_restore", (PyBytes::new(py, bytes),))?;
            Ok(())
        })
        .map_err(|error| from_python(&self.name, "restore", error))
    }
}

/// Adds one named array of a field's answer to the influences.
fn add(name: &str, values: &Bound<'_, PyAny>, out: &mut [Influence]) -> PyResult<()> {
    if matches!(name, "flow" | "force") {
        let array = values.extract::<PyReadonlyArray2<'_, f32>>()?;
        let vectors = arrays::vectors(name, &array).map_err(to_python)?;
        arrays::same_count(name, vectors.len(), out.len()).map_err(to_python)?;
        for (influence, vector) in out.iter_mut().zip(vectors) {
            let sum = if name == "flow" { &mut influence.flow } else { &mut influence.force };
            *sum += vector;
        }
        return Ok(());
    }
    let numbers = values.extract::<Vec<f32>>()?;
    arrays::same_count(name, numbers.len(), out.len()).map_err(to_python)?;
    for (influence, number) in out.iter_mut().zip(numbers) {
        match name {
            "light" => influence.light += number,
            "temperature" => influence.temperature += number,
            "scent" => influence.scent += number,
            _ => {
                let known = ["flow", "force", "light", "temperature", "scent"];
                return Err(to_python(Error::Unknown {
                    kind: "influence",
                    name: name.to_owned(),
                    known: known.map(str::to_owned).to_vec(),
                }));
            }
        }
    }
    Ok(())
}
