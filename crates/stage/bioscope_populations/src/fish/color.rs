//! Colors as people write them, and their arithmetic in linear light.

use std::fmt;

use serde::{Deserialize, Deserializer, de};

/// A color written `#rrggbb` in sRGB; held in linear light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub [f32; 3]);

impl Color {
    /// Reads `#rrggbb`.
    pub fn parse(text: &str) -> Option<Self> {
        let digits = text.strip_prefix('#')?;
        let proper = digits.len() == 6 && digits.bytes().all(|byte| byte.is_ascii_hexdigit());
        let bits = u32::from_str_radix(digits, 16).ok().filter(|_| proper)?;
        Some(Self([16, 8, 0].map(|shift| to_linear((bits >> shift) as u8))))
    }

    /// The color this share of the way towards another.
    pub fn mix(self, other: Self, share: f32) -> Self {
        Self(std::array::from_fn(|part| self.0[part] + (other.0[part] - self.0[part]) * share))
    }

    /// The color made brighter or darker.
    pub fn times(self, factor: f32) -> Self {
        Self(self.0.map(|part| part * factor))
    }

    /// The color in sRGB with an opacity.
    pub fn pixel(self, opacity: f32) -> [u8; 4] {
        let [red, green, blue] = self.0.map(to_srgb);
        [red, green, blue, (opacity.clamp(0.0, 1.0) * 255.0).round() as u8]
    }
}

fn to_linear(byte: u8) -> f32 {
    let part = f32::from(byte) / 255.0;
    if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
}

fn to_srgb(part: f32) -> u8 {
    let part = part.clamp(0.0, 1.0);
    let encoded =
        if part <= 0.003_130_8 { part * 12.92 } else { 1.055 * part.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl de::Visitor<'_> for Reader {
            type Value = Color;
            fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
                out.write_str("a color like \"#1f6fb4\"")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Color, E> {
                Color::parse(text).ok_or_else(|| E::invalid_value(de::Unexpected::Str(text), &self))
            }
        }
        deserializer.deserialize_str(Reader)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_and_writes_the_same_color() {
        for text in ["#000000", "#ffffff", "#1f6fb4", "#808080"] {
            let color = Color::parse(text).unwrap(); // the texts are proper
            let [red, green, blue, opacity] = color.pixel(1.0);
            assert_eq!(format!("#{red:02x}{green:02x}{blue:02x}"), text);
            assert_eq!(opacity, 255);
        }
        for text in ["", "#fff", "1f6fb4", "#1f6fbg", "#+f6fb4", "#1f6fb4ff"] {
            assert_eq!(Color::parse(text), None, "{text}");
        }
    }
}
