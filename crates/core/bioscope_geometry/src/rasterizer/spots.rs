//! Small round things, drawn as discs over the finished picture.

use std::f32::consts::FRAC_1_PI;

use bioscope_core::{Id, Vec3};

use super::arithmetic::{Rgb, channels, rgb, smoothstep};
use super::lens::Lens;
use super::light::{ambient, daylight};
use super::prepare::Prepared;
use super::shade::Shader;
use super::view::Strip;

/// Discs are never drawn smaller than this radius in pixels; they fade instead.
const LEAST: f32 = 0.7;

/// Discs fainter than this are left out.
const FAINTEST: f32 = 1.0 / 512.0;

/// A disc in the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    x: f32,
    y: f32,
    /// Pixels.
    radius: f32,
    /// Metres from the eye.
    distance: f32,
    opacity: f32,
    glassy: bool,
    /// Radiance that arrives at the eye.
    color: Rgb,
    id: Id,
}

/// The discs that an eye sees, farthest first. `samples` is the number of the lens's samples per pixel.
pub(crate) fn spots(
    prepared: &Prepared,
    shader: &Shader,
    lens: &Lens,
    samples: usize,
) -> Vec<Spot> {
    let per_pixel = 1.0 / samples as f32;
    let farthest = prepared.light.visibility().min(lens.far);
    let mut spots = Vec::new();
    for points in &prepared.scene.points {
        let faintest = FAINTEST / points.opacity.clamp(0.0, 1.0).max(1e-9);
        for ((&center, &radius), &id) in points.positions.iter().zip(&points.radii).zip(&points.ids)
        {
            let distance = (center - shader.stand.eye).length();
            let size = radius * lens.scale * per_pixel / distance;
            let share = (size / LEAST).min(1.0);
            let fading = share * share;
            let visible = fading > faintest && distance > lens.near && distance < farthest;
            if !visible || lens.sees_ball(shader.stand.inward(center), radius).is_none() {
                continue;
            }
            let seen = lens.see(shader.stand.inward(center));
            spots.push(Spot {
                x: seen.x * per_pixel,
                y: seen.y * per_pixel,
                radius: size.max(LEAST),
                distance,
                opacity: points.opacity.clamp(0.0, 1.0) * fading,
                glassy: points.glassy,
                color: color(shader, center, rgb(points.color), points.glassy),
                id,
            });
        }
    }
    spots.sort_by(|a, b| b.distance.total_cmp(&a.distance).then(a.id.cmp(&b.id)));
    spots
}

/// What arrives from a small ball: sun from one side, the surroundings from all.
fn color(shader: &Shader, center: Vec3, albedo: Rgb, glassy: bool) -> Rgb {
    let light = &shader.prepared.light;
    let depth = light.depth(center.y);
    let dim = daylight(light, depth);
    let sun = shader.sunlight(center, Vec3::ZERO, depth);
    let offset = center - shader.stand.eye;
    let distance = offset.length();
    let even = if glassy {
        ambient(light, Vec3::Y, depth, dim) * 1.2 + sun * 0.15
    } else {
        sun * (0.4 * FRAC_1_PI) + ambient(light, Vec3::ZERO, depth, dim)
    };
    shader.arriving(offset / distance, distance, albedo * even)
}

impl Spot {
    /// Draws the part of the disc that lies in a strip.
    pub fn draw(&self, strip: &mut Strip) {
        let (rows, width) = (strip.rows, strip.width);
        let reach = self.radius + 0.5;
        let bound =
            |value: f32, low: usize, high: usize| (value.max(0.0) as usize).clamp(low, high);
        let top = bound(self.y - reach, rows[0], rows[1]);
        let bottom = bound(self.y + reach + 1.0, rows[0], rows[1]);
        let left = bound(self.x - reach, 0, width);
        let right = bound(self.x + reach + 1.0, 0, width);
        for row in top..bottom {
            for column in left..right {
                let offset = [column as f32 + 0.5 - self.x, row as f32 + 0.5 - self.y];
                let index = (row - rows[0]) * width + column;
                if self.distance < strip.depth[index] {
                    self.blend(strip, index, offset);
                }
            }
        }
    }

    fn blend(&self, strip: &mut Strip, index: usize, [x, y]: [f32; 2]) {
        let away = (x * x + y * y).sqrt();
        let inside = (self.radius + 0.5 - away).clamp(0.0, 1.0);
        let mut opacity = self.opacity * inside;
        let mut color = self.color;
        if self.glassy && self.radius > 1.0 {
            let rim = smoothstep(0.45, 0.95, away / self.radius);
            let glint = smoothstep(0.35, 0.1, (x / self.radius + 0.3).hypot(y / self.radius + 0.4));
            opacity *= 0.12 + 0.75 * rim + 0.6 * glint;
            // The upper half of the rim mirrors the bright surface, the lower half the deep.
            color *= 0.9 - 0.5 * (y / self.radius) * rim + glint;
        }
        let opacity = opacity.min(1.0);
        let old = rgb(strip.color[index]);
        strip.color[index] = channels(old.lerp(color, opacity));
        if inside >= 0.5 && self.opacity >= 0.5 {
            strip.depth[index] = self.distance;
            strip.identity[index] = self.id;
        }
    }
}
