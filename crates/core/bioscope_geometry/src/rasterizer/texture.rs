//! Pictures on meshes, prepared for reading at any size.

use std::sync::LazyLock;

use super::arithmetic::rough_log2;
use crate::Texture;

/// Linear value of each sRGB byte.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let value = byte as f32 / 255.0;
        if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
});

/// sRGB byte of a linear value, rounded; values outside 0 to 1 saturate.
pub(crate) fn encoded(linear: f32) -> u8 {
    const STEPS: usize = 4096;
    static BYTES: LazyLock<Vec<u8>> = LazyLock::new(|| {
        // Steps are even in the square root, where sRGB is nearly straight.
        let encode = |root: f32| {
            let value = root * root;
            let coded = if value <= 0.003_130_8 {
                value * 12.92
            } else {
                1.055 * value.powf(1.0 / 2.4) - 0.055
            };
            (coded * 255.0).round() as u8
        };
        (0..=STEPS).map(|step| encode(step as f32 / STEPS as f32)).collect()
    });
    BYTES[(linear.clamp(0.0, 1.0).sqrt() * STEPS as f32 + 0.5) as usize]
}

/// A texture with its halved versions; repeats in both directions.
#[derive(Debug)]
pub(crate) struct Mipmap {
    levels: Vec<Level>,
    linear: &'static [f32; 256],
}

#[derive(Debug)]
struct Level {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 4]>,
}

impl Mipmap {
    pub fn new(texture: &Texture) -> Self {
        let (width, height) = (texture.width as usize, texture.height as usize);
        let mut levels = vec![if width * height == 0 || texture.pixels.len() != width * height {
            Level { width: 1, height: 1, pixels: vec![[255; 4]] }
        } else {
            Level { width, height, pixels: texture.pixels.clone() }
        }];
        while levels[levels.len() - 1].pixels.len() > 1 {
            levels.push(levels[levels.len() - 1].halved());
        }
        Self { levels, linear: &LINEAR }
    }

    /// Texels in the finest level.
    pub fn texels(&self) -> f32 {
        self.levels[0].pixels.len() as f32
    }

    /// Linear color and opacity at (u, v), for a reader that takes `footprint` texels at once:
    /// the nearest texel of the fitting level, or with `smooth` the bilinear mean in it.
    #[inline(always)]
    pub fn read(&self, uv: [f32; 2], footprint: f32, smooth: bool) -> [f32; 4] {
        let level = rough_log2(footprint.max(1.0)) + if smooth { 0.3 } else { 0.5 };
        let level = &self.levels[(level as usize).min(self.levels.len() - 1)];
        let u = (uv[0] - whole(uv[0])) * level.width as f32;
        let v = (uv[1] - whole(uv[1])) * level.height as f32;
        if smooth {
            return self.bilinear(level, u + 0.5, v + 0.5);
        }
        let (column, row) = ((u as usize).min(level.width - 1), (v as usize).min(level.height - 1));
        self.decode(level.pixels[row * level.width + column])
    }

    /// Mean of the four texels round a place, given in texels from half a texel before the first.
    #[inline(always)]
    fn bilinear(&self, level: &Level, x: f32, y: f32) -> [f32; 4] {
        let (column, row) = ((x as usize).min(level.width), (y as usize).min(level.height));
        let (u, v) = (x - column as f32, y - row as f32);
        let around = |place: usize, count: usize| {
            let before = if place == 0 { count - 1 } else { place - 1 };
            [before, if place == count { 0 } else { place }]
        };
        let [left, right] = around(column, level.width);
        let [top, bottom] = around(row, level.height).map(|row| row * level.width);
        let corners = [top + left, top + right, bottom + left, bottom + right];
        let shares = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
        let mut sum = [0.0; 4];
        for (corner, share) in corners.into_iter().zip(shares) {
            let texel = self.decode(level.pixels[corner]);
            for (total, value) in sum.iter_mut().zip(texel) {
                *total += value * share;
            }
        }
        sum
    }

    #[inline(always)]
    fn decode(&self, [red, green, blue, opacity]: [u8; 4]) -> [f32; 4] {
        let [red, green, blue] = [red, green, blue].map(|byte| self.linear[byte as usize]);
        [red, green, blue, f32::from(opacity) * (1.0 / 255.0)]
    }
}

impl Level {
    /// Half the size: mean linear color weighted by opacity.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut pixels = Vec::with_capacity(width * height);
        for row in 0..height {
            for column in 0..width {
                let corner = |down: usize, aside: usize| {
                    let row = (2 * row + down).min(self.height - 1);
                    self.pixels[row * self.width + (2 * column + aside).min(self.width - 1)]
                };
                pixels.push(mean([corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)]));
            }
        }
        Self { width, height, pixels }
    }
}

fn mean(texels: [[u8; 4]; 4]) -> [u8; 4] {
    let mut color = [0.0; 3];
    let mut opacity = 0.0;
    for texel in texels {
        let weight = f32::from(texel[3]) + 0.01;
        opacity += weight;
        for (sum, byte) in color.iter_mut().zip(texel) {
            *sum += LINEAR[byte as usize] * weight;
        }
    }
    let [red, green, blue] = color.map(|sum| encoded(sum / opacity));
    [red, green, blue, (opacity * 0.25).min(255.0) as u8]
}

/// Greatest whole number not above x (the library's `floor` is a slow call on old processors).
#[inline(always)]
fn whole(x: f32) -> f32 {
    let cut = x as i32 as f32;
    if cut > x { cut - 1.0 } else { cut }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_decoding_and_encoding() {
        for byte in 0..=255u8 {
            assert_eq!(encoded(LINEAR[byte as usize]), byte);
        }
    }

    #[test]
    fn levels_keep_the_mean_and_repeat() {
        let checks = (0..64)
            .map(|index| if (index + index / 8) % 2 == 0 { [255; 4] } else { [0, 0, 0, 255] });
        let picture = Mipmap::new(&Texture::new(8, 8, checks.collect()));
        assert_eq!(picture.levels.len(), 4);
        let [gray, ..] = picture.read([0.3, 0.7], 100.0, true);
        assert!((gray - 0.5).abs() < 0.01, "{gray}");
        assert_eq!(picture.read([0.01, 0.01], 1.0, false)[0], 1.0);
        assert_eq!(picture.read([-0.99, 5.01], 1.0, false)[0], 1.0);
        assert_eq!(picture.read([0.01 + 1.0 / 8.0, 0.01], 1.0, false)[0], 0.0);
        let [between, ..] = picture.read([1.0 / 8.0, 1.0 / 16.0], 1.0, true);
        assert!((between - 0.5).abs() < 0.01, "{between}");
    }
}
