use std::sync::Arc;

use bioscope_core::{Error, Vec3};
use bioscope_lsystem::{MeshOptions, Palette, Turtle, TurtleOptions};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Array1, Array2, Floats};
use crate::error::to_python;
use crate::mesh::Mesh;

/// See `bioscope.LSystem`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct LSystem {
    system: Arc<bioscope_lsystem::LSystem>,
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
    string: bioscope_lsystem::ModuleString,
    system: Arc<bioscope_lsystem::LSystem>,
    seed: u64,
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
    fn appearance(&self, py: Python<'_>) -> PyResult<Self> {
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

/// See `bioscope.Interpretation`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Interpretation {
    interpretation: bioscope_lsystem::Interpretation,
}

/// What the turtle draws of a string; `options` are fields of the turtle's options.
#[pyfunction]
pub fn interpret(
    py: Python<'_>,
    string: &Bound<'_, ModuleString>,
    options: &Bound<'_, PyDict>,
) -> PyResult<Interpretation> {
    let mut turtle = TurtleOptions::default();
    if let Some(angle) = string.get().system.angle() {
        turtle.angle = angle;
    }
    for (name, value) in options.iter() {
        set(&mut turtle, &name.extract::<String>()?, &value)?;
    }
    let seen = string.get().appearance(py)?;
    let interpretation = py.detach(|| Turtle::interpret(&seen.string, &turtle));
    Ok(Interpretation { interpretation: interpretation.map_err(to_python)? })
}

fn set(turtle: &mut TurtleOptions, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
    match name {
        "step" => turtle.step = value.extract()?,
        "angle" => turtle.angle = value.extract()?,
        "width" => turtle.width = value.extract()?,
        "width_step" => turtle.width_step = value.extract()?,
        "color" => turtle.color = value.extract()?,
        "slash_rolls_right" => turtle.slash_rolls_right = value.extract()?,
        "tropism" => turtle.tropism = Vec3::from_array(value.extract()?),
        "susceptibility" => turtle.susceptibility = value.extract()?,
        _ => {
            let known = [
                "step",
                "angle",
                "width",
                "width_step",
                "color",
                "slash_rolls_right",
                "tropism",
                "susceptibility",
            ];
            return Err(to_python(Error::Unknown {
                kind: "turtle option",
                name: name.to_owned(),
                known: known.map(str::to_owned).to_vec(),
            }));
        }
    }
    Ok(())
}

#[pymethods]
impl Interpretation {
    /// Starts (n, 3), ends (n, 3), radii (n, 2), colors (n,), axes (n,) of the segments.
    #[allow(clippy::type_complexity)] // A row of arrays.
    fn segments<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Array2<'py, f32>,
        Array2<'py, f32>,
        Array2<'py, f32>,
        Array1<'py, i32>,
        Array1<'py, u32>,
    )> {
        let segments = &self.interpretation.segments;
        let count = segments.len();
        let points = |of: fn(&bioscope_lsystem::Segment) -> Vec3| {
            segments.iter().map(of).collect::<Vec<_>>().as_flattened_floats().to_vec()
        };
        let starts = points(|one| one.start).into_pyarray(py).reshape([count, 3])?;
        let ends = points(|one| one.end).into_pyarray(py).reshape([count, 3])?;
        let radii: Vec<f32> =
            segments.iter().flat_map(|one| [one.start_radius, one.end_radius]).collect();
        let colors: Vec<i32> = segments.iter().map(|one| one.color).collect();
        let axes: Vec<u32> = segments.iter().map(|one| one.axis).collect();
        Ok((
            starts,
            ends,
            radii.into_pyarray(py).reshape([count, 2])?,
            colors.into_pyarray(py),
            axes.into_pyarray(py),
        ))
    }

    /// The polygons as (corners (n, 3), color).
    #[getter]
    fn polygons<'py>(&self, py: Python<'py>) -> PyResult<Vec<(Array2<'py, f32>, i32)>> {
        let polygons = self.interpretation.polygons.iter();
        polygons
            .map(|one| {
                let corners = one.corners.as_slice().as_flattened_floats().to_vec();
                let corners = corners.into_pyarray(py).reshape([one.corners.len(), 3])?;
                Ok((corners, one.color))
            })
            .collect()
    }

    /// The surfaces as (name, position, scale, color).
    #[getter]
    fn surfaces(&self) -> Vec<(String, [f32; 3], [f32; 3], i32)> {
        let surfaces = self.interpretation.surfaces.iter();
        surfaces
            .map(|one| {
                (one.name.to_string(), one.position.to_array(), one.scale.to_array(), one.color)
            })
            .collect()
    }

    /// One mesh with vertex colors; `palette` are linear colors by index.
    #[pyo3(signature = (sides=8, palette=None))]
    fn mesh(&self, py: Python<'_>, sides: u32, palette: Option<Vec<[f32; 3]>>) -> PyResult<Mesh> {
        if !(3..=64).contains(&sides) {
            return Err(to_python(Error::value("sides", sides, "3 to 64")));
        }
        let mut options = MeshOptions { sides, ..MeshOptions::default() };
        if let Some(colors) = palette {
            options.palette = Palette::new(colors);
        }
        Ok(Mesh { mesh: Arc::new(py.detach(|| self.interpretation.mesh(&options))) })
    }
}
