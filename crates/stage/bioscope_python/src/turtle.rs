//! The turtle of L-systems: strings become shapes.

use std::path::PathBuf;
use std::sync::Arc;

use bioscope_core::{Error, Vec3};
use bioscope_lsystem::{MeshOptions, Palette, Turtle, TurtleOptions};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Array1, Array2, Array3, Floats};
use crate::error::to_python;
use crate::lsystem::ModuleString;
use crate::mesh::Mesh;

/// See `bioscope.ViewFile`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct ViewFile {
    pub view: Arc<bioscope_lsystem::View>,
}

#[pymethods]
impl ViewFile {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let view = py.detach(|| bioscope_lsystem::View::read(path));
        Ok(Self { view: Arc::new(view.map_err(to_python)?) })
    }

    /// What was not understood, or is missing.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.view.warnings.iter().map(ToString::to_string).collect()
    }

    #[getter]
    fn sides(&self) -> u32 {
        self.view.sides
    }

    /// Options of the turtle: step, angle, width, width step, color, color step.
    #[getter]
    fn turtle(&self) -> (f32, f32, f32, f32, i32, i32) {
        let turtle = &self.view.turtle;
        (
            turtle.step,
            turtle.angle,
            turtle.width,
            turtle.width_step,
            turtle.color,
            turtle.color_step,
        )
    }

    /// Viewpoint, reference point, twist, whether perspective, angle, distances, scale.
    #[getter]
    #[allow(clippy::type_complexity)] // A row of numbers.
    fn camera(&self) -> ([f32; 3], [f32; 3], f32, bool, f32, [f32; 2], f32) {
        let camera = &self.view.camera;
        (
            camera.viewpoint.to_array(),
            camera.reference.to_array(),
            camera.twist,
            camera.perspective,
            camera.angle,
            camera.distances,
            camera.scale,
        )
    }

    /// Names of the textures, number 1 first.
    #[getter]
    fn textures(&self) -> Vec<String> {
        self.view.textures.iter().map(|texture| texture.file.clone()).collect()
    }

    /// Letters of the surfaces and numbers of the contours.
    #[getter]
    fn shapes(&self) -> (Vec<String>, Vec<i32>) {
        let shapes = &self.view.turtle.shapes;
        let letters = shapes.surfaces.keys().map(ToString::to_string).collect();
        (letters, shapes.contours.keys().copied().collect())
    }

    /// Value of function `id` (1 is the first) at `x`; none if there is none.
    fn function(&self, id: usize, x: f64) -> Option<f64> {
        Some(self.view.functions.get(id.checked_sub(1)?)?.value(x))
    }
}

/// See `bioscope.lsystem.AnimateFile`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct AnimateFile {
    animation: bioscope_lsystem::Animation,
}

#[pymethods]
impl AnimateFile {
    #[new]
    fn new(path: PathBuf) -> PyResult<Self> {
        let (bytes, name) = small_file(&path)?;
        let animation = bioscope_lsystem::Animation::parse(&bytes, &name);
        Ok(Self { animation: animation.map_err(|error| to_python(error.into()))? })
    }

    /// What was not understood.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.animation.warnings.iter().map(ToString::to_string).collect()
    }

    /// Names of the switches that are on.
    #[getter]
    fn switches(&self) -> Vec<String> {
        self.animation.switches.clone()
    }

    /// How long each frame stays, in refreshes of a screen.
    #[getter]
    fn swap_interval(&self) -> u32 {
        self.animation.swap_interval
    }

    /// The steps that are shown; `length` is the last if the file does not say.
    fn frames(&self, length: u64) -> Vec<u64> {
        self.animation.frames(length)
    }
}

/// The bytes of a file of reasonable size, and its name.
fn small_file(path: &std::path::Path) -> PyResult<(Vec<u8>, String)> {
    const LARGEST: u64 = 1 << 20;
    let name = path.to_string_lossy().into_owned();
    let broken = |error: std::io::Error| to_python(Error::format(name.clone(), error.to_string()));
    if std::fs::metadata(path).map_err(broken)?.len() > LARGEST {
        return Err(to_python(Error::format(name, "such a file has less than 1 MiB")));
    }
    let bytes = std::fs::read(path).map_err(broken)?;
    Ok((bytes, name))
}

/// Linear colors of a color map (.map) or material file (.mat).
#[pyfunction]
pub fn read_colors(path: PathBuf) -> PyResult<Vec<[f32; 3]>> {
    let (bytes, name) = small_file(&path)?;
    let is_map = path.extension().is_some_and(|suffix| suffix == "map");
    let palette = if is_map {
        bioscope_lsystem::read_color_map(&bytes, &name)
    } else {
        bioscope_lsystem::read_materials(&bytes, &name)
    };
    let palette = palette.map_err(to_python)?;
    Ok((0..256).map(|number| palette.color(number)).collect())
}

/// See `bioscope.Interpretation`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Interpretation {
    interpretation: bioscope_lsystem::Interpretation,
}

/// What the turtle draws of a string; `options` are fields of the turtle's options, which begin with those of the view.
#[pyfunction]
#[pyo3(signature = (string, options, view=None))]
pub fn interpret(
    py: Python<'_>,
    string: &Bound<'_, ModuleString>,
    options: &Bound<'_, PyDict>,
    view: Option<&Bound<'_, ViewFile>>,
) -> PyResult<Interpretation> {
    let turtle = self::options(&string.get().system, options, view)?;
    let seen = string.get().appearance(py)?;
    let interpretation = py.detach(|| Turtle::interpret(&seen.string, &turtle));
    Ok(Interpretation { interpretation: interpretation.map_err(to_python)? })
}

/// What the string looks like with equal branches drawn once: the rest, then each branch with its
/// places (n, 3) and rotations (n, 4; x, y, z, w).
#[pyfunction]
#[allow(clippy::type_complexity)] // A row of arrays.
#[pyo3(signature = (string, options, view=None))]
pub fn share<'py>(
    py: Python<'py>,
    string: &Bound<'py, ModuleString>,
    options: &Bound<'py, PyDict>,
    view: Option<&Bound<'py, ViewFile>>,
) -> PyResult<(Interpretation, Vec<(Interpretation, Array2<'py, f32>, Array2<'py, f32>)>)> {
    let turtle = self::options(&string.get().system, options, view)?;
    let seen = string.get().appearance(py)?;
    let plant = py.detach(|| Turtle::share(&seen.string, &turtle)).map_err(to_python)?;
    let mut parts = Vec::with_capacity(plant.parts.len());
    for part in plant.parts {
        let count = part.places.len();
        let places: Vec<f32> =
            part.places.iter().flat_map(|place| place.position.to_array()).collect();
        let turns: Vec<f32> =
            part.places.iter().flat_map(|place| place.rotation().to_array()).collect();
        parts.push((
            Interpretation { interpretation: part.drawn },
            places.into_pyarray(py).reshape([count, 3])?,
            turns.into_pyarray(py).reshape([count, 4])?,
        ));
    }
    Ok((Interpretation { interpretation: plant.rest }, parts))
}

/// Options of the turtle: those of the view, the angle of the model, then these.
pub fn options(
    system: &bioscope_lsystem::LSystem,
    given: &Bound<'_, PyDict>,
    view: Option<&Bound<'_, ViewFile>>,
) -> PyResult<TurtleOptions> {
    let mut turtle =
        view.map_or_else(TurtleOptions::default, |view| view.get().view.turtle.clone());
    if let Some(angle) = system.angle() {
        turtle.angle = angle;
    }
    for (name, value) in given.iter() {
        set(&mut turtle, &name.extract::<String>()?, &value)?;
    }
    Ok(turtle)
}

const OPTIONS: [&str; 16] = [
    "position",
    "heading",
    "up",
    "step",
    "angle",
    "width",
    "width_step",
    "color",
    "color_step",
    "scale",
    "scale_step",
    "slash_rolls_right",
    "tropism",
    "susceptibility",
    "tapered",
    "cpfg",
];

pub fn set(turtle: &mut TurtleOptions, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
    match name {
        "position" => turtle.position = Vec3::from_array(value.extract()?),
        "heading" => turtle.heading = Vec3::from_array(value.extract()?),
        "up" => turtle.up = Vec3::from_array(value.extract()?),
        "step" => turtle.step = value.extract()?,
        "angle" => turtle.angle = value.extract()?,
        "width" => turtle.width = value.extract()?,
        "width_step" => turtle.width_step = value.extract()?,
        "color" => turtle.color = value.extract()?,
        "color_step" => turtle.color_step = value.extract()?,
        "scale" => turtle.scale = value.extract()?,
        "scale_step" => turtle.scale_step = value.extract()?,
        "slash_rolls_right" => turtle.slash_rolls_right = value.extract()?,
        "tropism" => turtle.tropism = Vec3::from_array(value.extract()?),
        "susceptibility" => turtle.susceptibility = value.extract()?,
        "tapered" => turtle.tapered = value.extract()?,
        "cpfg" => {
            turtle.conventions = if value.extract()? {
                bioscope_lsystem::Conventions::Cpfg
            } else {
                bioscope_lsystem::Conventions::Notes
            };
        }
        _ => {
            return Err(to_python(Error::Unknown {
                kind: "turtle option",
                name: name.to_owned(),
                known: OPTIONS.map(str::to_owned).to_vec(),
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

    /// Centers (n, 3), radii (n,) and colors (n,) of the balls.
    fn balls<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Array2<'py, f32>, Array1<'py, f32>, Array1<'py, i32>)> {
        let balls = &self.interpretation.balls;
        let centers: Vec<f32> = balls.iter().flat_map(|one| one.center.to_array()).collect();
        let radii: Vec<f32> = balls.iter().map(|one| one.radius).collect();
        let colors: Vec<i32> = balls.iter().map(|one| one.color).collect();
        Ok((
            centers.into_pyarray(py).reshape([balls.len(), 3])?,
            radii.into_pyarray(py),
            colors.into_pyarray(py),
        ))
    }

    /// Centers (n, 3), normals (n, 3), radii (n,), rims (n,; 0 is filled) and colors (n,) of the discs.
    #[allow(clippy::type_complexity)] // A row of arrays.
    fn discs<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(
        Array2<'py, f32>,
        Array2<'py, f32>,
        Array1<'py, f32>,
        Array1<'py, f32>,
        Array1<'py, i32>,
    )> {
        let discs = &self.interpretation.discs;
        let centers: Vec<f32> = discs.iter().flat_map(|one| one.center.to_array()).collect();
        let normals: Vec<f32> = discs.iter().flat_map(|one| one.normal.to_array()).collect();
        let radii: Vec<f32> = discs.iter().map(|one| one.radius).collect();
        let rims: Vec<f32> = discs.iter().map(|one| one.rim.unwrap_or(0.0)).collect();
        let colors: Vec<i32> = discs.iter().map(|one| one.color).collect();
        Ok((
            centers.into_pyarray(py).reshape([discs.len(), 3])?,
            normals.into_pyarray(py).reshape([discs.len(), 3])?,
            radii.into_pyarray(py),
            rims.into_pyarray(py),
            colors.into_pyarray(py),
        ))
    }

    /// Control points (n, 16, 3) and colors (n,) of the patches.
    fn patches<'py>(&self, py: Python<'py>) -> PyResult<(Array3<'py, f32>, Array1<'py, i32>)> {
        let patches = &self.interpretation.patches;
        let points = patches.iter().flat_map(|one| one.points.as_flattened());
        let points: Vec<f32> = points.flat_map(|point| point.to_array()).collect();
        let colors: Vec<i32> = patches.iter().map(|one| one.color).collect();
        Ok((points.into_pyarray(py).reshape([patches.len(), 16, 3])?, colors.into_pyarray(py)))
    }

    /// The labels as (position, numbers).
    #[getter]
    fn labels(&self) -> Vec<([f32; 3], Vec<f32>)> {
        let labels = self.interpretation.labels.iter();
        labels.map(|one| (one.position.to_array(), one.parameters.clone())).collect()
    }

    /// One mesh with vertex colors; `palette` are linear colors by index, `texture` the only one that counts.
    #[pyo3(signature = (sides=8, palette=None, texture=None))]
    fn mesh(
        &self,
        py: Python<'_>,
        sides: u32,
        palette: Option<Vec<[f32; 3]>>,
        texture: Option<u16>,
    ) -> PyResult<Mesh> {
        if !(3..=64).contains(&sides) {
            return Err(to_python(Error::value("sides", sides, "3 to 64")));
        }
        let mut options = MeshOptions { sides, ..MeshOptions::default() };
        if let Some(colors) = palette {
            options.palette = Palette::new(colors);
        }
        let mesh = py.detach(|| match texture {
            Some(texture) => self.interpretation.mesh_of_texture(&options, texture),
            None => self.interpretation.mesh(&options),
        });
        Ok(Mesh { mesh: Arc::new(mesh) })
    }
}
