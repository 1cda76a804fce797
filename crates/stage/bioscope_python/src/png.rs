use bioscope_core::Error;
use numpy::PyReadonlyArray3;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::to_python;

/// A PNG file of pixels (height, width, 3 or 4): sRGB, with opacity if there are four channels.
#[pyfunction]
pub fn encode_png<'py>(
    py: Python<'py>,
    pixels: PyReadonlyArray3<'py, u8>,
) -> PyResult<Bound<'py, PyBytes>> {
    let array = pixels.as_array();
    let (height, width, channels) = array.dim();
    let color = match channels {
        3 => ::png::ColorType::Rgb,
        4 => ::png::ColorType::Rgba,
        _ => ::png::ColorType::Indexed,
    };
    let sides = 1..=1 << 20;
    if color == ::png::ColorType::Indexed || !sides.contains(&height) || !sides.contains(&width) {
        let found = format!("shape ({height}, {width}, {channels})");
        let expected = "shape (height, width, 3 or 4), not empty";
        return Err(to_python(Error::value("pixels", found, expected)));
    }
    let data = array.iter().copied().collect::<Vec<u8>>();
    let file = py.detach(|| encoded(&data, [width as u32, height as u32], color));
    let file = file.map_err(|error| pyo3::exceptions::PyValueError::new_err(error.to_string()))?;
    Ok(PyBytes::new(py, &file))
}

fn encoded(
    data: &[u8],
    [width, height]: [u32; 2],
    color: ::png::ColorType,
) -> Result<Vec<u8>, ::png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_compression(::png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(file)
}
