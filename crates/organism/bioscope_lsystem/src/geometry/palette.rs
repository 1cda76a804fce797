use bioscope_core::{Error, Result};

/// Linear colors by number.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette {
    colors: Vec<[f32; 3]>,
}

impl Default for Palette {
    /// Bark, greens from dark to light, and a few colors of flowers and fruit.
    fn default() -> Self {
        Self {
            colors: vec![
                [0.10, 0.06, 0.03],
                [0.05, 0.16, 0.03],
                [0.09, 0.26, 0.04],
                [0.17, 0.38, 0.06],
                [0.32, 0.50, 0.10],
                [0.60, 0.08, 0.06],
                [0.75, 0.45, 0.05],
                [0.70, 0.65, 0.60],
            ],
        }
    }
}

impl Palette {
    /// These colors, numbered from 0.
    pub fn new(colors: Vec<[f32; 3]>) -> Self {
        Self { colors }
    }

    /// Reads a palette from text: per line a number from 0 to 255 and linear red, green and blue;
    /// `#` begins a comment. `file_name` is what errors call the text.
    pub fn parse(text: &str, file_name: &str) -> Result<Self> {
        let mut colors = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let words: Vec<&str> =
                line.split('#').next().unwrap_or("").split_whitespace().collect();
            if words.is_empty() {
                continue;
            }
            let (number, color) = entry(&words).ok_or_else(|| {
                let place = format!("{file_name}:{}:1", index + 1);
                Error::format(place, "expected a number from 0 to 255 and red, green, blue")
            })?;
            if colors.len() <= number {
                colors.resize(number + 1, [0.5; 3]);
            }
            colors[number] = color;
        }
        Ok(Self { colors })
    }

    /// The color of this number; the nearest there is if there are not so many.
    pub fn color(&self, number: i32) -> [f32; 3] {
        let last = self.colors.len().saturating_sub(1);
        let index = (number.max(0) as usize).min(last);
        self.colors.get(index).copied().unwrap_or([0.5; 3])
    }
}

fn entry(words: &[&str]) -> Option<(usize, [f32; 3])> {
    let [number, red, green, blue] = words else { return None };
    let part = |text: &str| text.parse::<f32>().ok().filter(|part| (0.0..=100.0).contains(part));
    let number = usize::from(number.parse::<u8>().ok()?);
    Some((number, [part(red)?, part(green)?, part(blue)?]))
}
