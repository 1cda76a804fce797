use std::path::PathBuf;
use std::sync::Arc;

use bioscope_core::Error;
use bioscope_lsystem::{
    Derivation, DerivationError, DerivationOptions, FunctionTable, TurtleOptions, View,
};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::Array1;
use crate::environments::Environment;
use crate::error::to_python;
use crate::turtle::ViewFile;

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
        let (options, time) = self.options(seed, options)?;
        let derived = py.detach(|| match time {
            Some(time) => derived(&self.system, options, |derivation| until(derivation, time)),
            None => derived(&self.system, options, |derivation| {
                while derivation.step() < steps.unwrap_or_else(|| derivation.length()) {
                    derivation.advance()?;
                }
                Ok(())
            }),
        });
        let Derived { string, ids, output, remarks } =
            derived.map_err(|error| to_python(error.into()))?;
        Ok(ModuleString { string, system: self.system.clone(), seed, ids, output, remarks })
    }
}

const OPTIONS: [&str; 7] = ["environment", "view", "start", "time", "folder", "seconds", "threads"];

impl LSystem {
    /// Options of a derivation, and the time of a timed model until which it goes.
    fn options(
        &self,
        seed: Option<u64>,
        given: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<(DerivationOptions, Option<f64>)> {
        let refused = |error: bioscope_lsystem::EnvironmentError| {
            to_python(DerivationError::Environment { error, step: 0 }.into())
        };
        let mut options = DerivationOptions::of(&self.system).map_err(refused)?;
        options.seed = seed;
        let mut time = None;
        for (name, value) in given.into_iter().flatten() {
            match name.extract::<String>()?.as_str() {
                "environment" => {
                    options.environment = Some(match value.cast::<Environment>() {
                        Ok(kept) => kept.get().shared(),
                        Err(_) => {
                            let words = value.extract::<String>()?;
                            DerivationOptions::environment_of(&words).map_err(refused)?
                        }
                    });
                }
                "view" => {
                    let view = match value.cast::<ViewFile>() {
                        Ok(read) => read.get().view.clone(),
                        Err(_) => {
                            let path = value.extract::<PathBuf>()?;
                            Arc::new(View::read(path).map_err(to_python)?)
                        }
                    };
                    options.functions = Some(Arc::new(FunctionTable::new(&view)));
                    options.turtle = view.turtle.clone();
                }
                "start" => {
                    let start = value.extract::<PyRef<'_, ModuleString>>()?;
                    options.start = Some(start.string.clone());
                }
                "time" => time = Some(self.time(value.extract()?)?),
                "folder" => options.folder = Some(value.extract::<PathBuf>()?),
                "seconds" => options.seconds = Some(value.extract()?),
                "threads" => options.threads = value.extract()?,
                other => {
                    return Err(to_python(Error::Unknown {
                        kind: "option of a derivation",
                        name: other.to_owned(),
                        known: OPTIONS.map(str::to_owned).to_vec(),
                    }));
                }
            }
        }
        Ok((options, time))
    }

    fn time(&self, seconds: f64) -> PyResult<f64> {
        const MOST_STEPS: f64 = 1e7;
        let Some(step) = self.system.seconds_per_step() else {
            let expected = "a timed model (a line 'timed:')";
            return Err(to_python(Error::value("time", seconds, expected)));
        };
        if !(seconds >= 0.0 && seconds <= MOST_STEPS * step) {
            let expected = format!("0 to {MOST_STEPS} steps of {step} seconds");
            return Err(to_python(Error::value("time", seconds, expected)));
        }
        Ok(seconds)
    }
}

/// What became of a derivation.
struct Derived {
    string: bioscope_lsystem::ModuleString,
    ids: Vec<u64>,
    output: String,
    remarks: Vec<String>,
}

fn derived(
    system: &bioscope_lsystem::LSystem,
    options: DerivationOptions,
    advance: impl FnOnce(&mut Derivation) -> Result<(), DerivationError>,
) -> Result<Derived, DerivationError> {
    let mut derivation = Derivation::with_options(system, options)?;
    advance(&mut derivation)?;
    let (remarks, ids) = (derivation.remarks(), derivation.ids().to_vec());
    let (string, output) = derivation.finish_with_output()?;
    Ok(Derived { string, ids, output, remarks })
}

/// Lets so many seconds pass: in steps of the model, and one shorter step at the end.
fn until(derivation: &mut Derivation, time: f64) -> Result<(), DerivationError> {
    const NEGLIGIBLE: f64 = 1e-9;
    let step = derivation.span();
    if time == 0.0 {
        return Ok(());
    }
    for _ in 0..(time / step + NEGLIGIBLE) as u64 {
        derivation.advance()?;
    }
    let rest = time - derivation.time();
    if rest > NEGLIGIBLE * step { derivation.pass(rest) } else { Ok(()) }
}

/// See `bioscope.ModuleString`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct ModuleString {
    pub string: bioscope_lsystem::ModuleString,
    pub system: Arc<bioscope_lsystem::LSystem>,
    pub seed: Option<u64>,
    pub ids: Vec<u64>,
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
        Self {
            string,
            system,
            seed: Some(seed),
            ids: Vec::new(),
            output: String::new(),
            remarks: Vec::new(),
        }
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
        let system = self.system.clone();
        Ok(Self { string, system, seed: self.seed, ids: Vec::new(), output, remarks })
    }

    /// The words that it falls into at modules of this symbol: word, position, heading, up, width and color.
    #[allow(clippy::type_complexity)] // A row of numbers.
    #[pyo3(signature = (dead, options, view=None))]
    fn fragments(
        &self,
        py: Python<'_>,
        dead: &str,
        options: &Bound<'_, PyDict>,
        view: Option<&Bound<'_, ViewFile>>,
    ) -> PyResult<Vec<(Self, [f32; 3], [f32; 3], [f32; 3], f32, i32)>> {
        let turtle: TurtleOptions = crate::turtle::options(&self.system, options, view)?;
        let found = py.detach(|| self.system.fragments(&self.string, dead, self.seed, &turtle));
        let found = found.map_err(|error| to_python(error.into()))?;
        let own = |string: bioscope_lsystem::ModuleString| Self {
            string,
            system: self.system.clone(),
            seed: self.seed,
            ids: Vec::new(),
            output: String::new(),
            remarks: Vec::new(),
        };
        let row = |one: bioscope_lsystem::Fragment| {
            let (heading, up) = (one.frame.heading.to_array(), one.frame.up.to_array());
            (own(one.word), one.position.to_array(), heading, up, one.width, one.color)
        };
        Ok(found.into_iter().map(row).collect())
    }

    /// Identities of the modules of a timed model.
    #[getter]
    fn ids<'py>(&self, py: Python<'py>) -> Array1<'py, u64> {
        self.ids.clone().into_pyarray(py)
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

    /// How many parameters a module of each kind of the alphabet has.
    #[getter]
    fn arities<'py>(&self, py: Python<'py>) -> Array1<'py, u8> {
        let kinds = self.string.alphabet().kinds().iter();
        kinds.map(|kind| kind.arity).collect::<Vec<_>>().into_pyarray(py)
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
