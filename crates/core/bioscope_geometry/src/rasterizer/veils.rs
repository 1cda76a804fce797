//! Surfaces that one sees through, laid over what is solid from the farthest to the nearest.

use bioscope_core::Vec3;

use super::arithmetic::{channels, rgb};
use super::cover::Tests;
use super::lens::Window;
use super::look::{Draw, Look};
use super::shade::Patch;
use super::view::Strip;

/// A triangle that one sees through.
pub(super) struct Veil<'a> {
    patch: Patch<'a>,
    tests: Tests,
    /// Samples that it may cover.
    window: Window,
    /// Metres from the eye to its middle.
    distance: f32,
    /// Share of what is behind that it hides.
    opacity: f32,
}

impl<'a> Look<'a> {
    /// The triangles of things that one sees through, farthest first.
    pub fn veils_of(&self, draws: &[Draw]) -> Vec<Veil<'a>> {
        let prepared = self.shader.prepared;
        let mut veils = Vec::new();
        for draw in draws {
            let thing = &draw.thing;
            let mesh = &prepared.part(thing).levels[draw.level].1;
            let material = &prepared.scene.batches[thing.batch as usize].material;
            let points = &prepared.posed(thing, draw.level).points;
            let inward = |&point: &Vec3| self.lens.see(self.shader.stand.inward(point));
            let seen: Vec<_> = points.iter().map(inward).collect();
            let both = material.two_sided;
            for (number, triangle) in mesh.triangles.iter().enumerate() {
                let corners = triangle.map(|corner| &seen[corner as usize]);
                let window = self.lens.window(corners, [0, self.lens.height as u32]);
                let corners = corners.map(|corner| corner.point);
                let (Some(window), Some(tests)) = (window, self.tests(corners, both)) else {
                    continue;
                };
                let patch = self.shader.patch(thing, draw.level, number);
                let distance = corners.iter().sum::<Vec3>().length() / 3.0;
                let opacity = material.opacity.clamp(0.0, 1.0);
                veils.push(Veil { patch, tests, window, distance, opacity });
            }
        }
        veils.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        veils
    }
}

impl Veil<'_> {
    /// Draws the part of the triangle that lies in a strip, where nothing solid is before it.
    pub fn draw(&self, look: &Look, strip: &mut Strip) {
        let samples = look.samples as u32;
        let pixels = |[first, last]: [u32; 2]| [first / samples, last.div_ceil(samples)];
        let [left, right] = pixels(self.window.columns);
        let [top, bottom] = pixels(self.window.rows);
        let (top, bottom) = (top.max(strip.rows[0] as u32), bottom.min(strip.rows[1] as u32));
        for row in top..bottom {
            for column in left..right.min(strip.width as u32) {
                let index = (row as usize - strip.rows[0]) * strip.width + column as usize;
                self.blend(look, strip, index, [column, row]);
            }
        }
    }

    /// Lays the triangle over a pixel, as much as it covers of it.
    fn blend(&self, look: &Look, strip: &mut Strip, index: usize, [column, row]: [u32; 2]) {
        let samples = look.samples as u32;
        let (mut covered, mut found) = (0, None);
        for sample in 0..samples * samples {
            let place = [column * samples + sample % samples, row * samples + sample / samples];
            let [x, y] = place.map(|one| one as usize);
            let Some(ray) = look.lens.ray(x, y) else { continue };
            let round = look.lens.round.is_some();
            let at = if round { ray } else { Vec3::new(x as f32, y as f32, 1.0) };
            let Some(nearness) = self.tests.nearness(at) else { continue };
            let along = if round { 1.0 } else { -ray.z };
            covered += 1;
            found = Some((look.shader.stand.outward(ray), 1.0 / (nearness * along)));
        }
        let Some((direction, distance)) = found else { return };
        if distance >= strip.depth[index] {
            return;
        }
        let share = self.opacity * covered as f32 / (samples * samples) as f32;
        let color = look.shader.surface(&self.patch, direction, distance);
        strip.color[index] = channels(rgb(strip.color[index]).lerp(color, share));
    }
}
