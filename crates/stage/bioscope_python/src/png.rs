use bioscope_core::Error;
use numpy::{IntoPyArray, PyArray3, PyArrayMethods, PyReadonlyArray3};
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

/// Most pixels of a picture that is read.
const MOST_PIXELS: usize = 100_000_000;

/// The pixels (height, width, 4) of a PNG file: sRGB and opacity, whatever the file has.
#[pyfunction]
pub fn decode_png<'py>(py: Python<'py>, file: &[u8]) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let decoded = py.detach(|| decoded(file));
    let (pixels, [width, height]) =
        decoded.map_err(|error| to_python(Error::format("picture", error.to_string())))?;
    pixels.into_pyarray(py).reshape([height, width, 4])
}

fn decoded(file: &[u8]) -> Result<(Vec<u8>, [usize; 2]), ::png::DecodingError> {
    use ::png::Transformations;
    let limits = ::png::Limits { bytes: 4 * MOST_PIXELS };
    let mut decoder = ::png::Decoder::new_with_limits(std::io::Cursor::new(file), limits);
    decoder.set_transformations(
        Transformations::EXPAND | Transformations::STRIP_16 | Transformations::ALPHA,
    );
    let mut reader = decoder.read_info()?;
    let size = reader.output_buffer_size().filter(|&size| size <= 4 * MOST_PIXELS);
    let mut data = vec![0; size.ok_or(::png::DecodingError::LimitsExceeded)?];
    let info = reader.next_frame(&mut data)?;
    data.truncate(info.buffer_size());
    if info.color_type == ::png::ColorType::GrayscaleAlpha {
        data = data
            .as_chunks::<2>()
            .0
            .iter()
            .flat_map(|&[gray, opacity]| [gray, gray, gray, opacity])
            .collect();
    }
    Ok((data, [info.width as usize, info.height as usize]))
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
