use std::path::PathBuf;
use std::sync::Arc;

use bioscope_core::Error;
use bioscope_lsystem::{Derivation, DerivationError, DerivationOptions, FunctionTable, View};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

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
    #[pyo3(signature = (source, file, folder=None))]
    fn new(py: Python<'_>, source: &str, file: &str, folder: Option<PathBuf>) -> PyResult<Self> {
        let parsed = py.detach(|| match &folder {
            Some(folder) => bioscope_lsystem::LSystem::parse_in(source, file, folder),
            None => bioscope_lsystem::LSystem::parse(source, file),
        });
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

    /// Name and parameters of the environment that the file asks for.
    #[getter]
    fn environment(&self) -> Option<&str> {
        self.system.environment()
    }

    #[pyo3(signature = (steps=None, seed=None, **options))]
    fn derive(
        &self,
        py: Python<'_>,
        steps: Option<u64>,
        seed: Option<u64>,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<ModuleString> {
        let options = self.options(seed, options)?;
        let derived = py.detach(|| derived(&self.system, steps, options));
        let (string, output, remarks) = derived.map_err(|error| to_python(error.into()))?;
        Ok(ModuleString { string, system: self.system.clone(), seed, output, remarks })
    }
}

impl LSystem {
    fn options(
        &self,
        seed: Option<u64>,
        given: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<DerivationOptions> {
        let refused = |error: bioscope_lsystem::EnvironmentError| {
            to_python(DerivationError::Environment { error, step: 0 }.into())
        };
        let mut options = DerivationOptions::of(&self.system).map_err(refused)?;
        options.seed = seed;
        for (name, value) in given.into_iter().flatten() {
            match name.extract::<String>()?.as_str() {
                "environment" => {
                    let words = value.extract::<String>()?;
                    let environment = DerivationOptions::environment_of(&words).map_err(refused)?;
                    options.environment = Some(environment);
                }
                "view" => {
                    let view = View::read(value.extract::<PathBuf>()?).map_err(to_python)?;
                    options.functions = Some(Arc::new(FunctionTable::new(&view)));
                    options.turtle = view.turtle;
                }
                "folder" => options.folder = Some(value.extract::<PathBuf>()?),
                "seconds" => options.seconds = Some(value.extract()?),
                "threads" => options.threads = value.extract()?,
                other => {
                    return Err(to_python(Error::Unknown {
                        kind: "option of a derivation",
                        name: other.to_owned(),
                        known: ["environment", "view", "folder", "seconds", "threads"]
                            .map(str::to_owned)
                            .to_vec(),
                    }));
                }
            }
        }
        Ok(options)
    }
}

/// The string, what the model printed, and what was doubtful.
fn derived(
    system: &bioscope_lsystem::LSystem,
    steps: Option<u64>,
    options: DerivationOptions,
) -> Result<(bioscope_lsystem::ModuleString, String, Vec<String>), DerivationError> {
    let mut derivation = Derivation::with_options(system, options)?;
    while derivation.step() < steps.unwrap_or_else(|| derivation.length()) {
        derivation.advance()?;
    }
    let remarks = derivation.remarks();
    let (string, output) = derivation.finish_with_output()?;
    Ok((string, output, remarks))
}

/// See `bioscope.ModuleString`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct ModuleString {
    pub string: bioscope_lsystem::ModuleString,
    pub system: Arc<bioscope_lsystem::LSystem>,
    pub seed: Option<u64>,
    pub output: String,
    pub remarks: Vec<String>,
}

impl ModuleString {
    /// A string that a model has been derived to.
    pub fn derived(
        string: bioscope_lsystem::ModuleString,
        system: Arc<bioscope_lsystem::LSystem>,
        seed: u64,
    ) -> Self {
        Self { string, system, seed: Some(seed), output: String::new(), remarks: Vec::new() }
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
        let (output, remarks) = (self.output.clone(), self.remarks.clone());
        Ok(Self { string, system: self.system.clone(), seed: self.seed, output, remarks })
    }

    /// What the model has printed.
    #[getter]
    fn output(&self) -> &str {
        &self.output
    }

    /// What was tolerated but is doubtful.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
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
