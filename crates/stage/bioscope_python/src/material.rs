use std::sync::Arc;

use bioscope_geometry as geometry;
use numpy::PyReadonlyArray3;
use pyo3::prelude::*;

use crate::arrays::{self, Array3};
use crate::error::to_python;

/// See `bioscope.Material`.
#[pyclass(frozen, module = "bioscope._engine")]
pub struct Material {
    pub material: Arc<geometry::Material>,
}

#[pymethods]
impl Material {
    #[new]
    #[pyo3(signature = (
        name="matt", *, color=[0.8, 0.8, 0.8], texture=None, cutout=false, roughness=0.8,
        specular=0.04, translucency=0.0, opacity=1.0, two_sided=false
    ))]
    #[allow(clippy::too_many_arguments)] // Keywords of a Python call.
    fn new(
        name: &str,
        color: [f32; 3],
        texture: Option<PyReadonlyArray3<'_, u8>>,
        cutout: bool,
        roughness: f32,
        specular: f32,
        translucency: f32,
        opacity: f32,
        two_sided: bool,
    ) -> PyResult<Self> {
        let texture = texture.map(|pixels| picture(&pixels)).transpose().map_err(to_python)?;
        Ok(Self {
            material: Arc::new(geometry::Material {
                name: name.to_owned(),
                color,
                texture,
                cutout,
                roughness: roughness.clamp(0.0, 1.0),
                specular: specular.clamp(0.0, 1.0),
                translucency: translucency.clamp(0.0, 1.0),
                opacity: opacity.clamp(0.0, 1.0),
                two_sided,
                ..Default::default()
            }),
        })
    }

    /// Key by which the same material is recognized in two scenes.
    #[getter]
    fn key(&self) -> u64 {
        self.material.key.number()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.material.name
    }

    #[getter]
    fn color(&self) -> [f32; 3] {
        self.material.color
    }

    #[getter]
    fn cutout(&self) -> bool {
        self.material.cutout
    }

    #[getter]
    fn roughness(&self) -> f32 {
        self.material.roughness
    }

    #[getter]
    fn specular(&self) -> f32 {
        self.material.specular
    }

    #[getter]
    fn translucency(&self) -> f32 {
        self.material.translucency
    }

    #[getter]
    fn opacity(&self) -> f32 {
        self.material.opacity
    }

    #[getter]
    fn two_sided(&self) -> bool {
        self.material.two_sided
    }

    /// Pixels (height, width, 4) of the texture, sRGB and opacity; none without one.
    #[getter]
    fn texture<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Array3<'py, u8>>> {
        let Some(texture) = &slf.get().material.texture else { return Ok(None) };
        let shape = [texture.height as usize, texture.width as usize, 4];
        arrays::view(slf.as_any(), texture.pixels.as_flattened(), shape).map(Some)
    }

    /// Key by which the same texture is recognized in two materials; none without one.
    #[getter]
    fn texture_key(&self) -> Option<u64> {
        self.material.texture.as_ref().map(|texture| texture.key.number())
    }
}

fn picture(pixels: &PyReadonlyArray3<'_, u8>) -> bioscope_core::Result<Arc<geometry::Texture>> {
    let array = pixels.as_array();
    let (height, width, channels) = array.dim();
    if !(3..=4).contains(&channels) || height == 0 || width == 0 || height.max(width) > 8192 {
        let found = format!("shape ({height}, {width}, {channels})");
        let expected = "shape (height, width, 3 or 4), up to 8192 pixels wide and high";
        return Err(bioscope_core::Error::value("texture", found, expected));
    }
    let pixel = |row: usize, column: usize| {
        let alpha = if channels == 4 { array[[row, column, 3]] } else { 255 };
        [array[[row, column, 0]], array[[row, column, 1]], array[[row, column, 2]], alpha]
    };
    let rows = (0..height).flat_map(|row| (0..width).map(move |column| (row, column)));
    let pixels = rows.map(|(row, column)| pixel(row, column)).collect();
    Ok(Arc::new(geometry::Texture::new(width as u32, height as u32, pixels)))
}
