use bioscope_core::{Error, Result};

use crate::Palette;

/// Bytes of one material: number, transparency, ambient, diffuse, emitted and specular red, green
/// and blue, shininess.
const MATERIAL: usize = 15;

/// Reads a color map (.map): red, green and blue bytes of 256 colors as on the screen (sRGB).
pub fn read_color_map(bytes: &[u8], file: &str) -> Result<Palette> {
    if bytes.len() != 768 {
        let message = format!("a color map has 768 bytes, this file {}", bytes.len());
        return Err(Error::format(file, message));
    }
    let colors = bytes.chunks_exact(3).map(|color| [0, 1, 2].map(|part| linear(color[part])));
    Ok(Palette::new(colors.collect()))
}

/// Reads a material file (.mat): what materials reflect and emit, by number.
pub fn read_materials(bytes: &[u8], file: &str) -> Result<Palette> {
    if bytes.is_empty() || !bytes.len().is_multiple_of(MATERIAL) {
        let message =
            format!("materials take {MATERIAL} bytes each, this file has {}", bytes.len());
        return Err(Error::format(file, message));
    }
    let mut colors = vec![[0.5; 3]; 256];
    for material in bytes.chunks_exact(MATERIAL) {
        let part = |first: usize, index: usize| linear(material[first + index]);
        colors[material[0] as usize] =
            [0, 1, 2].map(|index| (part(5, index) + part(8, index)).min(1.0));
    }
    Ok(Palette::new(colors))
}

/// The linear value of a byte that is meant for the screen (IEC 61966-2-1).
fn linear(byte: u8) -> f32 {
    let value = f32::from(byte) / 255.0;
    if value <= 0.04045 {
        value / 12.92
    } else {
        bioscope_core::math::pow((value + 0.055) / 1.055, 2.4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_become_linear() {
        let mut bytes = vec![0; 768];
        bytes[3..6].copy_from_slice(&[255, 128, 0]);
        let palette = read_color_map(&bytes, "a.map").unwrap();
        let [red, green, blue] = palette.color(1);
        assert!((red, blue) == (1.0, 0.0) && (green - 0.2159).abs() < 1e-3, "{green}");
        let error = read_color_map(&bytes[1..], "a.map").unwrap_err().to_string();
        assert_eq!(error, "a.map: a color map has 768 bytes, this file 767");
        assert!(read_materials(&[1; 30], "a.mat").is_ok() && read_materials(b"x", "a").is_err());
    }
}
