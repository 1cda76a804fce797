//! Pictures on meshes, prepared for reading at any size.

use std::sync::LazyLock;

use super::arithmetic::{Rgb, rough_log2};
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
}

/// Linear color and opacity, 0 to 65535.
type Texel = [u16; 4];

/// The picture at one size.
#[derive(Debug)]
pub(crate) struct Level {
    width: usize,
    height: usize,
    texels: Vec<Texel>,
}

impl Mipmap {
    pub fn new(texture: &Texture) -> Self {
        let (width, height) = (texture.width as usize, texture.height as usize);
        let mut levels = vec![if width * height == 0 || texture.pixels.len() != width * height {
            Level { width: 1, height: 1, texels: vec![[u16::MAX; 4]] }
        } else {
            let table = &*LINEAR;
            let linear = |byte: u8| (table[byte as usize] * 65_535.0 + 0.5) as u16;
            let texel = |&[red, green, blue, opacity]: &[u8; 4]| {
                [linear(red), linear(green), linear(blue), u16::from(opacity) * 257]
            };
            Level { width, height, texels: texture.pixels.iter().map(texel).collect() }
        }];
        while levels[levels.len() - 1].texels.len() > 1 {
            levels.push(levels[levels.len() - 1].halved());
        }
        Self { levels }
    }

    /// Texels in the finest level.
    pub fn texels(&self) -> f32 {
        self.levels[0].texels.len() as f32
    }

    /// The level whose texels fit a reader that takes `footprint` of the finest at once.
    #[inline(always)]
    pub fn level(&self, footprint: f32, smooth: bool) -> &Level {
        let level = rough_log2(footprint.max(1.0)) + if smooth { 0.3 } else { 0.5 };
        &self.levels[(level as usize).min(self.levels.len() - 1)]
    }

    /// Linear color, with opacity as the fourth number, at (u, v), for a reader that takes `footprint`
    /// texels at once: the nearest texel of the fitting level, or with `smooth` the bilinear mean in it.
    #[inline(always)]
    pub fn read(&self, uv: [f32; 2], footprint: f32, smooth: bool) -> Rgb {
        let level = self.level(footprint, smooth);
        let u = (uv[0] - whole(uv[0])) * level.width as f32;
        let v = (uv[1] - whole(uv[1])) * level.height as f32;
        if smooth {
            return level.bilinear(u + 0.5, v + 0.5);
        }
        let (column, row) = ((u as usize).min(level.width - 1), (v as usize).min(level.height - 1));
        level.decoded(row * level.width + column)
    }
}

impl Level {
    /// Whether the nearest texel is opaque.
    #[inline(always)]
    pub fn solid(&self, [u, v]: [f32; 2]) -> bool {
        let column = ((u - whole(u)) * self.width as f32) as usize;
        let row = ((v - whole(v)) * self.height as f32) as usize;
        let index = row.min(self.height - 1) * self.width + column.min(self.width - 1);
        self.texels[index][3] > u16::MAX / 2
    }

    /// Mean of the four texels round a place, given in texels from half a texel before the first.
    #[inline(always)]
    fn bilinear(&self, x: f32, y: f32) -> Rgb {
        let (column, row) = ((x as usize).min(self.width), (y as usize).min(self.height));
        let (u, v) = (x - column as f32, y - row as f32);
        let around = |place: usize, count: usize| {
            let before = if place == 0 { count - 1 } else { place - 1 };
            [before, if place == count { 0 } else { place }]
        };
        let [left, right] = around(column, self.width);
        let [top, bottom] = around(row, self.height).map(|row| row * self.width);
        let [a, b, c, d] = [top + left, top + right, bottom + left, bottom + right]
            .map(|index| self.decoded(index));
        a.lerp(b, u).lerp(c.lerp(d, u), v)
    }

    #[inline(always)]
    fn decoded(&self, index: usize) -> Rgb {
        Rgb::from_array(self.texels[index].map(f32::from)) * (1.0 / 65_535.0)
    }

    /// Half the size: mean color weighted by opacity.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut texels = Vec::with_capacity(width * height);
        for row in 0..height {
            for column in 0..width {
                let corner = |down: usize, aside: usize| {
                    let row = (2 * row + down).min(self.height - 1);
                    self.texels[row * self.width + (2 * column + aside).min(self.width - 1)]
                };
                texels.push(mean([corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)]));
            }
        }
        Self { width, height, texels }
    }
}

fn mean(texels: [Texel; 4]) -> Texel {
    let mut color = [0u64; 3];
    let mut opacity = 0;
    for texel in texels {
        // Where all is clear, the color still counts a little.
        let weight = u64::from(texel[3]) + 1;
        opacity += weight;
        for (sum, value) in color.iter_mut().zip(texel) {
            *sum += u64::from(value) * weight;
        }
    }
    let [red, green, blue] = color.map(|sum| (sum / opacity) as u16);
    [red, green, blue, ((opacity - 4) / 4) as u16]
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
        let gray = picture.read([0.3, 0.7], 100.0, true).x;
        assert!((gray - 0.5).abs() < 0.01, "{gray}");
        assert_eq!(picture.read([0.01, 0.01], 1.0, false).x, 1.0);
        assert_eq!(picture.read([-0.99, 5.01], 1.0, false).x, 1.0);
        assert_eq!(picture.read([0.01 + 1.0 / 8.0, 0.01], 1.0, false).x, 0.0);
        let between = picture.read([1.0 / 8.0, 1.0 / 16.0], 1.0, true).x;
        assert!((between - 0.5).abs() < 0.01, "{between}");
    }
}
