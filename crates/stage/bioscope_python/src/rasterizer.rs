use std::sync::{Arc, Mutex, PoisonError};

use bioscope_core::Error;
use bioscope_geometry::{self as geometry, Options, Prepared};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{Array2, Array3};
use crate::camera::Camera;
use crate::error::to_python;
use crate::scene::Scene;

/// Pixels of one view at most.
const MOST_PIXELS: usize = 1 << 26;

/// Looks at scenes; remembers what it worked out for their meshes and textures.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Rasterizer {
    options: Options,
    memory: Mutex<Memory>,
}

#[derive(Default)]
struct Memory {
    rasterizer: geometry::Rasterizer,
    last: Option<(Arc<geometry::Scene>, Arc<Prepared>)>,
}

/// Colour (height, width, 3), depth (height, width) and identity (height, width).
type Arrays<'py> = (Array3<'py, f32>, Array2<'py, f32>, Array2<'py, u32>);

#[pymethods]
impl Rasterizer {
    /// For pictures (shadows, four samples per pixel, sun shafts) or for animals' eyes.
    #[new]
    #[pyo3(signature = (*, picture=false, shadows=None))]
    fn new(picture: bool, shadows: Option<bool>) -> Self {
        let mut options = if picture { Options::picture() } else { Options::eye() };
        options.shadows = shadows.unwrap_or(options.shadows);
        Self { options, memory: Mutex::default() }
    }

    /// What each camera sees of the scene.
    fn look<'py>(
        &self,
        py: Python<'py>,
        scene: &Bound<'py, Scene>,
        cameras: Vec<Bound<'py, Camera>>,
        width: usize,
        height: usize,
    ) -> PyResult<Vec<Arrays<'py>>> {
        check_size(width, height)?;
        let scene = scene.get().scene.clone();
        let cameras: Vec<_> = cameras.iter().map(|camera| camera.get().camera).collect();
        let views = py.detach(|| {
            let prepared = self.prepared(scene);
            match cameras.as_slice() {
                [camera] => vec![prepared.look(camera, width, height)],
                cameras => prepared.look_many(cameras, width, height),
            }
        });
        views.into_iter().map(|view| arrays(py, view)).collect()
    }

    /// What one camera sees as a picture for a screen: (height, width, 3) sRGB bytes.
    #[pyo3(signature = (scene, camera, width, height, exposure=1.0))]
    fn picture<'py>(
        &self,
        py: Python<'py>,
        scene: &Bound<'py, Scene>,
        camera: &Bound<'py, Camera>,
        width: usize,
        height: usize,
        exposure: f32,
    ) -> PyResult<Array3<'py, u8>> {
        check_size(width, height)?;
        let scene = scene.get().scene.clone();
        let camera = camera.get().camera;
        let pixels =
            py.detach(|| self.prepared(scene).look(&camera, width, height).developed(exposure));
        pixels.into_pyarray(py).reshape([height, width, 3])
    }
}

impl Rasterizer {
    /// The scene made ready; the last one is kept for further looks.
    fn prepared(&self, scene: Arc<geometry::Scene>) -> Arc<Prepared> {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((last, prepared)) = &memory.last
            && Arc::ptr_eq(last, &scene)
        {
            return prepared.clone();
        }
        let prepared = Arc::new(memory.rasterizer.prepare(&scene, &self.options));
        memory.last = Some((scene, prepared.clone()));
        prepared
    }
}

fn check_size(width: usize, height: usize) -> PyResult<()> {
    let pixels = width.checked_mul(height);
    if pixels.is_some_and(|pixels| (1..=MOST_PIXELS).contains(&pixels)) {
        return Ok(());
    }
    let expected = format!("1 to {MOST_PIXELS} pixels");
    Err(to_python(Error::value("size", format!("{width}x{height}"), expected)))
}

fn arrays(py: Python<'_>, view: geometry::View) -> PyResult<Arrays<'_>> {
    let (height, width) = (view.height, view.width);
    let color = view.color.into_flattened().into_pyarray(py).reshape([height, width, 3])?;
    let depth = view.depth.into_pyarray(py).reshape([height, width])?;
    let identity = view.identity.into_pyarray(py).reshape([height, width])?;
    Ok((color, depth, identity))
}
