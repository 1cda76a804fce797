use std::sync::Arc;

use numpy::IntoPyArray;
use pyo3::prelude::*;

use crate::arrays::Array1;
use crate::error::to_python;

/// See `bioscope.LSystem`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct LSystem {
    pub system: Arc<bioscope_lsystem::LSystem>,
}

#[pymethods]
impl LSystem {
    #[new]
    fn new(py: Python<'_>, source: &str, file: &str) -> PyResult<Self> {
        let parsed = py.detach(|| bioscope_lsystem::LSystem::parse(source, file));
        let system = parsed.map_err(|error| to_python(error.into()))?;
        Ok(Self { system: Arc::new(system) })
    }

    #[getter]
    fn steps(&self) -> u32 {
        self.system.derivation_length()
    }

    #[getter]
    fn angle(&self) -> Option<f32> {
        self.system.angle()
    }

    #[getter]
    fn constants(&self) -> Vec<(String, f64)> {
        self.system.constants().to_vec()
    }

    /// What is doubtful in the file but not wrong.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.system.warnings().iter().map(ToString::to_string).collect()
    }

    fn derive(&self, py: Python<'_>, steps: u64, seed: u64) -> PyResult<ModuleString> {
        let string = py.detach(|| self.system.derive(steps, seed));
        let string = string.map_err(|error| to_python(error.into()))?;
        Ok(ModuleString { string, system: self.system.clone(), seed })
    }
}

/// See `bioscope.ModuleString`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct ModuleString {
    pub string: bioscope_lsystem::ModuleString,
    pub system: Arc<bioscope_lsystem::LSystem>,
    pub seed: u64,
}

impl ModuleString {
    /// A string that a model has been derived to.
    pub fn derived(
        string: bioscope_lsystem::ModuleString,
        system: Arc<bioscope_lsystem::LSystem>,
        seed: u64,
    ) -> Self {
        Self { string, system, seed }
    }
}

#[pymethods]
impl ModuleString {
    fn __len__(&self) -> usize {
        self.string.len()
    }

    /// The canonical text.
    fn string(&self, py: Python<'_>) -> String {
        py.detach(|| self.string.to_string())
    }

    /// The string after the homomorphism, as the turtle reads it.
    pub fn appearance(&self, py: Python<'_>) -> PyResult<Self> {
        let string = py.detach(|| self.system.appearance(&self.string, self.seed));
        let string = string.map_err(|error| to_python(error.into()))?;
        Ok(Self { string, system: self.system.clone(), seed: self.seed })
    }

    /// Symbols of the alphabet; `kinds` holds indices into it.
    #[getter]
    fn symbols(&self) -> Vec<String> {
        self.string.alphabet().kinds().iter().map(|kind| kind.symbol.to_string()).collect()
    }

    #[getter]
    fn kinds<'py>(&self, py: Python<'py>) -> Array1<'py, u8> {
        self.string.kinds().to_vec().into_pyarray(py)
    }

    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> Array1<'py, f32> {
        self.string.parameters().to_vec().into_pyarray(py)
    }
}
