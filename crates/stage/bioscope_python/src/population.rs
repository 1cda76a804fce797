use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use bioscope_core::{Error, Id, Parameter, Parameters, Result};
use bioscope_populations::catalog;
use bioscope_world::{Growth, Inspection, Population};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::camera::Camera;
use crate::environments::Environment;
use crate::error::from_python;
use crate::publication::Publication;
use crate::values;
use crate::view::View;

/// A population of the engine before it is added to a world.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Resident {
    population: Mutex<Option<Box<dyn Population>>>,
}

/// A population of this kind with these options (a JSON object) and parameters; a stand may be given an environment.
#[pyfunction]
#[pyo3(signature = (kind, options, parameters, environment=None))]
pub fn resident(
    py: Python<'_>,
    kind: &str,
    options: &str,
    parameters: BTreeMap<String, f64>,
    environment: Option<&Environment>,
) -> PyResult<Resident> {
    let own = environment.map(Environment::shared);
    let build = || match own {
        Some(own) => catalog::stand_in(own, options, &parameters),
        None => catalog::population(kind, options, &parameters),
    };
    let population = py.detach(build).map_err(crate::error::to_python)?;
    Ok(Resident::new(population))
}

/// The names of the species of fish that come with the engine.
#[pyfunction]
pub fn fish_species() -> Vec<&'static str> {
    bioscope_populations::fish::FishSpecies::names()
}

impl Resident {
    pub fn new(population: Box<dyn Population>) -> Self {
        Self { population: Mutex::new(Some(population)) }
    }

    /// Takes the population out; it can live in one world only.
    pub fn take(&self) -> Result<Box<dyn Population>> {
        let mut population = self.population.lock().unwrap_or_else(PoisonError::into_inner);
        let missing = || Error::value("population", "already added", "one not in any world yet");
        population.take().ok_or_else(missing)
    }
}

/// A population written in Python: an object with the five verbs (`bioscope.Population`).
pub struct PythonPopulation {
    object: Py<PyAny>,
    name: String,
    tunable: Tunable,
}

impl PythonPopulation {
    pub fn new(object: Py<PyAny>, name: String) -> PyResult<Self> {
        let tunable = Python::attach(|py| Tunable::of(object.bind(py)))?;
        Ok(Self { object, name, tunable })
    }

    /// Brings one back from its saved state by the class registered under its kind.
    pub fn rebuild(kind: &str, bytes: &[u8]) -> Result<Self> {
        let build = |py: Python<'_>| -> PyResult<Py<PyAny>> {
            let module = py.import("bioscope.world.population")?;
            module.call_method1("rebuild", (kind, PyBytes::new(py, bytes))).map(Bound::unbind)
        };
        let population =
            Python::attach(build).and_then(|object| Self::new(object, kind.to_owned()));
        population.map_err(|error| from_python(kind, "restore", error))
    }

    fn call(
        &self,
        verb: &'static str,
        body: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<()>,
    ) -> Result<()> {
        Python::attach(|py| body(self.object.bind(py)))
            .map_err(|error| from_python(&self.name, verb, error))
    }
}

impl Population for PythonPopulation {
    fn kind(&self) -> &str {
        &self.name
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        self.grow_with("settle", growth)
    }

    fn sense(&mut self, view: &bioscope_world::View) -> Result<()> {
        self.call("sense", |object| {
            object.call_method1("sense", (View::new(view),))?;
            Ok(())
        })
    }

    fn decide(&mut self, _view: &bioscope_world::View) -> Result<()> {
        self.call("decide", |object| {
            object.call_method0("decide")?;
            Ok(())
        })
    }

    fn advance(&mut self, view: &bioscope_world::View) -> Result<()> {
        self.call("move", |object| {
            object.call_method1("move", (view.moment.dt,))?;
            Ok(())
        })
    }

    fn grow(&mut self, growth: &mut Growth) -> Result<()> {
        self.grow_with("grow", growth)
    }

    fn publish(&self, publication: &mut bioscope_world::Publication) -> Result<()> {
        self.call("publish", |object| {
            let own = Bound::new(object.py(), Publication::new(publication.moment))?;
            object.call_method1("publish", (&own,))?;
            own.get().deliver(publication);
            Ok(())
        })
    }

    fn count(&self) -> usize {
        Python::attach(|py| self.object.bind(py).getattr("count")?.extract()).unwrap_or(0)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Python::attach(|py| {
            let bytes = self.object.bind(py).call_method0("_save")?;
            bytes.extract::<Vec<u8>>()
        })
        .map_err(|error| from_python(&self.name, "save", error))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        self.call("restore", |object| {
            object.call_method1("_restore", (PyBytes::new(object.py(), bytes),))?;
            Ok(())
        })
    }

    fn inspect(&self, individual: Id) -> Option<Inspection> {
        let read = |py: Python<'_>| -> PyResult<Option<Inspection>> {
            let found = self.object.bind(py).call_method1("inspect", (individual,))?;
            if found.is_none() {
                return Ok(None);
            }
            let found = found.cast_into::<PyDict>()?.copy()?;
            let eye = match found.get_item("eye")? {
                Some(eye) if eye.is_instance_of::<Camera>() => {
                    found.del_item("eye")?;
                    Some(eye.cast_into::<Camera>()?.get().camera)
                }
                _ => None,
            };
            let values = values::from_dict(Some(&found)).map_err(crate::error::to_python)?;
            let species = self.name.clone();
            Ok(Some(Inspection { species, values, eye, ..Inspection::default() }))
        };
        // An inspector must not stop the world: what cannot be read is not shown.
        Python::attach(|py| read(py).ok().flatten())
    }

    fn statistics(&self) -> BTreeMap<String, f64> {
        let read = |py: Python<'_>| {
            self.object.bind(py).call_method0("statistics")?.extract::<BTreeMap<String, f64>>()
        };
        Python::attach(|py| read(py).unwrap_or_default())
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.tunable)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.tunable)
    }

    fn may_fail(&self) -> bool {
        true
    }
}

impl PythonPopulation {
    /// Lets Python ask for new individuals: `settle` and `grow` return how many are to be born,
    /// `born` gets their identities.
    fn grow_with(&mut self, verb: &'static str, growth: &mut Growth) -> Result<()> {
        let mut wanted = 0_usize;
        self.call(verb, |object| {
            let births = object.call_method0(verb)?;
            wanted = if births.is_none() { 0 } else { births.extract()? };
            Ok(())
        })?;
        if wanted == 0 {
            return Ok(());
        }
        let ids = growth.identities(wanted)?;
        self.call(verb, |object| {
            let ids = PyArray1::from_vec(object.py(), ids);
            object.call_method1("born", (ids,))?;
            Ok(())
        })
    }
}

/// The attributes that the class declares as `tunable`; the values are the object's.
struct Tunable {
    object: Py<PyAny>,
    descriptions: Vec<Parameter>,
}

impl Tunable {
    fn of(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let rows = object.getattr("tunable")?.cast_into::<PyDict>()?;
        let describe = |(name, row): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            let name = name.extract::<String>()?;
            let (unit, minimum, maximum, default, meaning) = row.extract()?;
            if !object.hasattr(name.as_str())? {
                object.setattr(name.as_str(), default)?;
            }
            let source = String::from("declared by its class");
            Ok(Parameter { name, unit, minimum, maximum, default, meaning, source })
        };
        let descriptions = rows.iter().map(describe).collect::<PyResult<_>>()?;
        Ok(Self { object: object.clone().unbind(), descriptions })
    }
}

impl Parameters for Tunable {
    fn descriptions(&self) -> Vec<Parameter> {
        self.descriptions.clone()
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.descriptions.iter().find(|one| one.name == name)?;
        Python::attach(|py| self.object.bind(py).getattr(name)?.extract::<f64>()).ok()
    }

    fn set(&mut self, name: &str, value: f64) -> Result<()> {
        let Some(parameter) = self.descriptions.iter().find(|one| one.name == name) else {
            return Err(Error::Unknown {
                kind: "parameter",
                name: name.to_owned(),
                known: self.descriptions.iter().map(|one| one.name.clone()).collect(),
            });
        };
        let value = parameter.check(value)?;
        Python::attach(|py| self.object.bind(py).setattr(name, value))
            .map_err(|error| from_python(name, "set", error))
    }
}
