//! One look at a prepared scene: choose what may be seen, fill the z-buffer, color what is seen.

use std::sync::Arc;

use bioscope_core::{Id, Vec3};
use rayon::prelude::*;

use super::arithmetic::{Rgb, channels};
use super::cover::{Holes, NOBODY, Sheet, Tests};
use super::lens::{Lens, Seen, Stand};
use super::light::Eye;
use super::prepare::{Prepared, Thing};
use super::shade::{Patch, Shader};
use super::shafts::add_shafts;
use super::spots::{Spot, spots};
use super::veils::Veil;
use super::view::{Strip, View};
use crate::mesh::levels::ALLOWED;
use crate::{Camera, Mesh};

/// Views with more pixels than this are painted in strips by several threads.
const SMALL: usize = 128 * 128;

/// Rows per strip.
const ROWS: usize = 72;

/// Share of the visibility beyond which pixels are colored two by two.
const HAZE: f32 = 0.2;

/// Rise of a direction under which waves let no sky through: Snell's window begins at 0.66.
const STEEP: f32 = 0.4;

/// Things that would be smaller than this many pixels are left out.
const LEAST: f32 = 0.3;

/// A thing to draw at one level of detail.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draw {
    pub thing: Thing,
    pub level: usize,
    /// Rows of samples that it may touch.
    rows: [u32; 2],
    /// Number of its first triangle among all triangles of the look, and the number after its last.
    first: u32,
    last: u32,
}

/// One look in the making.
pub(super) struct Look<'a> {
    pub shader: Shader<'a>,
    pub lens: &'a Lens,
    /// Samples per pixel and direction.
    pub samples: usize,
    /// Nearness below which haze hides fine differences.
    haze: f32,
    draws: Vec<Draw>,
    veils: Vec<Veil<'a>>,
    spots: Vec<Spot>,
}

/// The patch that was colored last.
struct Last<'a> {
    owner: u32,
    draw: &'a Draw,
    patch: Patch<'a>,
}

/// Memory that is used again and again.
#[derive(Default)]
struct Scratch {
    sheet: Sheet,
    seen: Vec<Seen>,
}

impl Prepared {
    /// What a camera sees: `width` × `height` pixels of color, depth and identity. Large pictures are
    /// painted by all threads; the result does not depend on their number.
    pub fn look(&self, camera: &Camera, width: usize, height: usize) -> View {
        let lens = Lens::new(camera, width, height, self.samples());
        self.look_through(&lens, camera, [width, height], &mut Scratch::default())
    }

    /// What each camera sees, in their order, worked out by all threads.
    pub fn look_many(&self, cameras: &[Camera], width: usize, height: usize) -> Vec<View> {
        let mut lenses: Vec<Arc<Lens>> = Vec::new();
        let mut lens_of = |camera: &Camera| {
            let known = lenses.iter().rev().find(|lens| lens.fits(camera));
            known.cloned().unwrap_or_else(|| {
                lenses.push(Arc::new(Lens::new(camera, width, height, self.samples())));
                lenses[lenses.len() - 1].clone()
            })
        };
        let jobs: Vec<_> = cameras.iter().map(|camera| (camera, lens_of(camera))).collect();
        jobs.par_iter()
            .map_init(Scratch::default, |scratch, (camera, lens)| {
                self.look_through(lens, camera, [width, height], scratch)
            })
            .collect()
    }

    fn samples(&self) -> usize {
        if self.options.smooth { 2 } else { 1 }
    }

    fn look_through(
        &self,
        lens: &Lens,
        camera: &Camera,
        [width, height]: [usize; 2],
        scratch: &mut Scratch,
    ) -> View {
        let mut view = View::empty(width, height);
        if width * height == 0 {
            return view;
        }
        let look = self.begin(lens, camera);
        if width * height <= SMALL {
            for mut strip in view.strips(height) {
                look.paint(&mut strip, scratch);
            }
        } else {
            let strips = view.strips(ROWS);
            strips.into_par_iter().for_each_init(Scratch::default, |scratch, mut strip| {
                look.paint(&mut strip, scratch);
            });
        }
        if self.options.smooth {
            add_shafts(&mut view, &look.shader, lens, look.samples);
        }
        view
    }

    /// Chooses what a look has to paint.
    fn begin<'a>(&'a self, lens: &'a Lens, camera: &Camera) -> Look<'a> {
        let samples = self.samples();
        let stand = Stand::new(camera);
        let eye = Eye::new(&self.light, stand.eye);
        let shader = Shader { prepared: self, stand, eye, pitch: lens.pitch() * samples as f32 };
        let spots = spots(self, &shader, lens, samples);
        let draws = self.draws(lens, &stand, samples, false);
        let haze = 1.0 / (HAZE * self.light.visibility());
        let mut look = Look { shader, lens, samples, haze, draws, veils: Vec::new(), spots };
        look.veils = look.veils_of(&self.draws(lens, &stand, samples, true));
        look
    }

    /// What may be seen, of what is solid or of what one sees through: not outside the view, not lost in the
    /// haze, not too small.
    fn draws(&self, lens: &Lens, stand: &Stand, samples: usize, veils: bool) -> Vec<Draw> {
        let farthest = self.light.visibility().min(lens.far);
        let detail = self.options.detail / samples as f32;
        let mut draws = Vec::new();
        let mut first: u32 = 0;
        for thing in self.things.iter().filter(|thing| self.is_veil(thing) == veils) {
            let center = stand.inward(thing.center);
            let distance = center.length();
            if distance - thing.radius > farthest {
                continue;
            }
            let visible =
                |error: f32, distance: f32| lens.size(0.5 * error, distance) * detail > ALLOWED;
            if !self.has_turn(thing, stand.eye, visible) {
                continue;
            }
            let Some(rows) = lens.sees_ball(center, thing.radius) else { continue };
            let size = lens.size(thing.radius, distance - 0.5 * thing.radius);
            if size < LEAST * samples as f32 || rows[0] >= rows[1] {
                continue;
            }
            let part = self.part(thing);
            let level = part.level(size * detail);
            let count = part.levels[level].1.triangles.len() as u32;
            let Some(next) = first.checked_add(count).filter(|&next| next < NOBODY) else { break };
            draws.push(Draw { thing: *thing, level, rows, first, last: next });
            first = next;
        }
        draws
    }
}

impl Look<'_> {
    /// Fills a strip, with the wider instructions of newer processors where there are any. Both ways do
    /// the same arithmetic in the same order, so they give the same bits.
    fn paint(&self, strip: &mut Strip, scratch: &mut Scratch) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has just been found to have the instructions.
            return unsafe { self.paint_wide(strip, scratch) };
        }
        self.paint_plain(strip, scratch);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn paint_wide(&self, strip: &mut Strip, scratch: &mut Scratch) {
        self.paint_plain(strip, scratch);
    }

    #[inline(always)]
    fn paint_plain(&self, strip: &mut Strip, scratch: &mut Scratch) {
        let rows = strip.rows.map(|row| row * self.samples);
        let farthest = if self.lens.far.is_finite() { 1.0 / self.lens.far } else { 0.0 };
        scratch.sheet.clear(self.lens.width, rows, farthest);
        for draw in &self.draws {
            let rows = [draw.rows[0].max(rows[0] as u32), draw.rows[1].min(rows[1] as u32)];
            if rows[0] < rows[1] {
                self.cover(draw, rows, scratch);
            }
        }
        if self.samples == 1 {
            self.color(strip, &scratch.sheet);
        } else {
            self.color_smoothly(strip, &scratch.sheet);
        }
        for veil in &self.veils {
            veil.draw(self, strip);
        }
        for spot in &self.spots {
            spot.draw(strip);
        }
    }

    /// Enters a thing's triangles in the z-buffer.
    #[inline(always)]
    fn cover(&self, draw: &Draw, rows: [u32; 2], scratch: &mut Scratch) {
        let prepared = self.shader.prepared;
        let thing = &draw.thing;
        let mesh: &Mesh = &prepared.part(thing).levels[draw.level].1;
        let material = &prepared.scene.batches[thing.batch as usize].material;
        let Scratch { sheet, seen } = scratch;
        seen.clear();
        let points = &prepared.posed(thing, draw.level).points;
        seen.extend(points.iter().map(|&point| self.lens.see(self.shader.stand.inward(point))));
        let (both, holes) = (material.two_sided, material.cutout && material.texture.is_some());
        for (number, triangle) in mesh.triangles.iter().enumerate() {
            let corners = triangle.map(|corner| &seen[corner as usize]);
            if !both && self.lens.turned_away(corners) {
                continue;
            }
            let Some(window) = self.lens.window(corners, rows) else { continue };
            let Some(tests) = self.tests(corners.map(|corner| corner.point), both) else {
                continue;
            };
            let owner = draw.first + number as u32;
            if !holes {
                sheet.cover(self.lens, &window, &tests, owner, None);
                continue;
            }
            let corners = corners.map(|corner| corner.point);
            let holes = self.holes(&self.shader.bare_patch(thing, mesh, *triangle, corners));
            sheet.cover(self.lens, &window, &tests, owner, holes.as_ref());
        }
    }

    /// Where the texture of a patch given in camera space has holes.
    #[inline(always)]
    fn holes<'a>(&self, patch: &Patch<'a>) -> Option<Holes<'a>> {
        let [u, v, whole] = patch.texture_planes().map(|test| self.lens.coefficients(test));
        let smooth = self.shader.prepared.options.smooth;
        Some(Holes { u, v, whole, level: patch.level(self.shader.pitch, smooth)? })
    }

    /// The tests of a triangle given in camera space; none if it is seen from behind (unless `both`
    /// sides show) or edge on.
    #[inline(always)]
    pub fn tests(&self, [a, b, c]: [Vec3; 3], both: bool) -> Option<Tests> {
        let normal = (b - a).cross(c - a);
        let height = normal.dot(a);
        if height == 0.0 || !height.is_finite() || (height > 0.0 && !both) {
            return None;
        }
        // Counterclockwise from outside means clockwise planes from the eye: turn them inward.
        let sides = if height < 0.0 {
            [c.cross(b), a.cross(c), b.cross(a)]
        } else {
            [b.cross(c), c.cross(a), a.cross(b)]
        };
        let coefficients = |test: Vec3| self.lens.coefficients(test);
        let plane = coefficients(normal / height);
        Some(Tests::new(sides.map(coefficients), plane, 1.0 / self.lens.near))
    }

    /// One sample per pixel.
    #[inline(always)]
    fn color(&self, strip: &mut Strip, sheet: &Sheet) {
        let mut last = None;
        for row in strip.rows[0]..strip.rows[1] {
            let line = (row - strip.rows[0]) * sheet.stride();
            for column in 0..strip.width {
                let Some(ray) = self.lens.ray(column, row) else { continue };
                let (owner, nearness) =
                    (sheet.owners()[line + column], sheet.nearness()[line + column]);
                let index = (row - strip.rows[0]) * strip.width + column;
                let (color, depth, identity) = self.sample(owner, nearness, ray, &mut last);
                strip.color[index] = channels(color);
                strip.depth[index] = depth;
                strip.identity[index] = identity;
            }
        }
    }

    /// Four samples per pixel; samples of one thing at about one distance are colored once, and in the haze
    /// pixels of one thing two by two.
    #[inline(always)]
    fn color_smoothly(&self, strip: &mut Strip, sheet: &Sheet) {
        let mut last = None;
        let samples = Samples { sheet, first_row: strip.rows[0] };
        for row in strip.rows[0]..strip.rows[1] {
            for column in 0..strip.width {
                let (owners, nearness) = samples.of(column, row);
                let corner = [column & !1, (row & !1).max(strip.rows[0])];
                let index = (row - strip.rows[0]) * strip.width + column;
                if corner != [column, row] && nearness[0] < self.haze {
                    let thing = [owners, samples.of(corner[0], corner[1]).0];
                    let alike = self.is_one_thing(thing.as_flattened(), &last)
                        && (owners[0] != NOBODY || self.sees_only_water(corner));
                    if alike {
                        let known = (corner[1] - strip.rows[0]) * strip.width + corner[0];
                        strip.color[index] = strip.color[known];
                        strip.depth[index] = strip.depth[known];
                        strip.identity[index] = strip.identity[known];
                        continue;
                    }
                }
                let (color, depth, identity) =
                    self.blend([column, row], owners, nearness, &mut last);
                strip.color[index] = channels(color);
                strip.depth[index] = depth;
                strip.identity[index] = identity;
            }
        }
    }

    /// Whether samples with these owners see the same thing, or nothing.
    #[inline(always)]
    fn is_one_thing(&self, owners: &[u32], last: &Option<Last>) -> bool {
        if owners[0] == NOBODY {
            return owners.iter().all(|&owner| owner == NOBODY);
        }
        let draw = self.draw_of(owners[0], last);
        owners.iter().all(|owner| (draw.first..draw.last).contains(owner))
    }

    /// Whether a pixel that shows no thing shows water only: neither sky nor Snell's window.
    #[inline(always)]
    fn sees_only_water(&self, [column, row]: [usize; 2]) -> bool {
        self.shader.eye.depth > 0.0
            && self
                .lens
                .ray(column * 2, row * 2)
                .is_none_or(|ray| self.shader.stand.outward(ray).y < STEEP)
    }

    /// Mean color of a pixel's four samples; depth and identity of the thing that most of them see.
    #[inline(always)]
    fn blend<'a>(
        &'a self,
        pixel: [usize; 2],
        owners: [u32; 4],
        nearness: [f32; 4],
        last: &mut Option<Last<'a>>,
    ) -> (Rgb, f32, Id) {
        let corner = [pixel[0] * 2, pixel[1] * 2];
        if owners.iter().all(|&owner| owner == owners[0])
            && let Some(ray) = self.lens.ray(corner[0], corner[1])
        {
            return self.sample(owners[0], nearness[0], ray, last);
        }
        let mut shares = [0.25f32; 4];
        for sample in 1..4 {
            let same = |other: &usize| {
                let (owners, nearness) =
                    ([owners[sample], owners[*other]], [nearness[sample], nearness[*other]]);
                shares[*other] > 0.0 && self.alike(owners, nearness, last)
            };
            if let Some(other) = (0..sample).find(same) {
                shares[other] += 0.25;
                shares[sample] = 0.0;
            }
        }
        let mut color = Rgb::ZERO;
        let mut best = (0.0, f32::INFINITY, 0);
        for sample in 0..4 {
            if shares[sample] == 0.0 {
                continue;
            }
            let place = [corner[0] + sample % 2, corner[1] + sample / 2];
            let Some(ray) = self.lens.ray(place[0], place[1]) else { continue };
            let (radiance, depth, identity) =
                self.sample(owners[sample], nearness[sample], ray, last);
            color += radiance * shares[sample];
            if shares[sample] > best.0 {
                best = (shares[sample], depth, identity);
            }
        }
        (color, best.1, best.2)
    }

    /// Whether two samples see the same thing at about the same distance.
    #[inline(always)]
    fn alike(&self, owners: [u32; 2], nearness: [f32; 2], last: &Option<Last>) -> bool {
        if owners[0] == owners[1] {
            return true;
        }
        if owners.contains(&NOBODY) || (nearness[0] - nearness[1]).abs() > 0.02 * nearness[0] {
            return false;
        }
        let draw = self.draw_of(owners[0], last);
        (draw.first..draw.last).contains(&owners[1])
    }

    /// The draw of a triangle; neighboring samples often share that of the `last` one.
    #[inline(always)]
    fn draw_of<'a>(&'a self, owner: u32, last: &Option<Last<'a>>) -> &'a Draw {
        if let Some(last) = last
            && (last.draw.first..last.draw.last).contains(&owner)
        {
            return last.draw;
        }
        &self.draws[self.draws.partition_point(|draw| draw.first <= owner) - 1]
    }

    /// Color, depth and identity of a sample, given its unit ray in camera space. `last` is the patch that
    /// was colored last, often the one that is needed next.
    #[inline(always)]
    fn sample<'a>(
        &'a self,
        owner: u32,
        nearness: f32,
        ray: Vec3,
        last: &mut Option<Last<'a>>,
    ) -> (Rgb, f32, Id) {
        let direction = self.shader.stand.outward(ray);
        if owner == NOBODY {
            return (self.shader.background(direction), f32::INFINITY, 0);
        }
        let along = if self.lens.round.is_some() { 1.0 } else { -ray.z };
        let distance = 1.0 / (nearness * along);
        if last.as_ref().is_none_or(|last| last.owner != owner) {
            let draw = self.draw_of(owner, last);
            let triangle = (owner - draw.first) as usize;
            let patch = self.shader.patch(&draw.thing, draw.level, triangle);
            *last = Some(Last { owner, draw, patch });
        }
        let Some(last) = last else { return (Rgb::ZERO, f32::INFINITY, 0) };
        let color = self.shader.surface(&last.patch, direction, distance);
        (color, distance, last.draw.thing.id)
    }
}

/// The samples of a strip whose rows begin at `first_row`.
struct Samples<'a> {
    sheet: &'a Sheet,
    first_row: usize,
}

impl Samples<'_> {
    /// Owners and nearness of a pixel's four samples.
    #[inline(always)]
    fn of(&self, column: usize, row: usize) -> ([u32; 4], [f32; 4]) {
        let stride = self.sheet.stride();
        let upper = (row - self.first_row) * 2 * stride + column * 2;
        let four = [upper, upper + 1, upper + stride, upper + stride + 1];
        let (owners, nearness) = (self.sheet.owners(), self.sheet.nearness());
        (four.map(|place| owners[place]), four.map(|place| nearness[place]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rasterizer::tests::{ball_scene, eyes_and_pictures, lenses};

    #[test]
    fn wide_instructions_give_the_same_bits() {
        let scene = ball_scene();
        for options in eyes_and_pictures() {
            let prepared = crate::prepare(&scene, &options);
            for camera in lenses(Vec3::new(0.3, -2.0, 3.0), Vec3::new(0.0, -2.2, 0.0)) {
                let lens = Lens::new(&camera, 40, 30, prepared.samples());
                let look = prepared.begin(&lens, &camera);
                let mut views = [View::empty(40, 30), View::empty(40, 30)];
                look.paint(&mut views[0].strips(30)[0], &mut Scratch::default());
                look.paint_plain(&mut views[1].strips(30)[0], &mut Scratch::default());
                assert_eq!(views[0], views[1]);
            }
        }
    }
}
