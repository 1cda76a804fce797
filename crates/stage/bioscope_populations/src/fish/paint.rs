//! The texture of a fish, painted from the colors and patterns of its species.

use std::f32::consts::TAU;

use bioscope_core::{Vec3, math};
use bioscope_geometry::{Noise, Texture};
use rayon::prelude::*;

use super::atlas::{Atlas, Cell, HEIGHT, WIDTH};
use super::color::Color;
use super::fins::Fin;
use super::species::{Bar, Eye, FinLook, FishSpecies, Line, Patch, Place, Spots};
use super::trunk::Trunk;

const BLACK: Color = Color([0.004, 0.005, 0.006]);
const WHITE: Color = Color([1.0, 1.0, 1.0]);

/// Paints the texture of a species.
pub fn paint(species: &FishSpecies, trunk: &Trunk, fins: &[Fin], atlas: &Atlas) -> Texture {
    let mut pixels = vec![[0; 4]; (WIDTH * HEIGHT) as usize];
    let mut fill = |cell: Cell, color: &(dyn Fn([f32; 2]) -> [u8; 4] + Sync)| {
        let [left, top, right, bottom] = cell.bounds.map(|bound| bound as usize);
        let rows = pixels.par_chunks_mut(WIDTH as usize).enumerate().take(bottom).skip(top);
        rows.for_each(|(row, pixels)| {
            for (column, pixel) in pixels.iter_mut().enumerate().take(right).skip(left) {
                *pixel = color(cell.place(column, row));
            }
        });
    };
    let painter = Painter::new(species, trunk);
    fill(atlas.trunk, &|[x, y]| painter.trunk([x * trunk.end, 1.0 - y]).pixel(1.0));
    fill(atlas.eye, &|place| painter.eye_cell(place).pixel(1.0));
    for (number, (fin, &cell)) in fins.iter().zip(&atlas.fins).enumerate() {
        let web = Web {
            look: &fin.look,
            lengths: fin.ray_lengths(trunk),
            root: fin.is_tail().then_some(&painter),
            noise: Noise::new(100 + number as u32),
        };
        fill(cell, &|[ray, down]| web.pixel(ray, 1.0 - down));
    }
    Texture::new(WIDTH, HEIGHT, pixels)
}

/// 1 within `reach`, 0 beyond, softly between.
fn falloff(distance: f32, reach: f32, softness: f32) -> f32 {
    1.0 - math::smoothstep(reach * (1.0 - softness), reach * (1.0 + softness) + 1e-5, distance)
}

/// 1 from `low` to `high`, fading out over `fade` on either side.
fn within(value: f32, [low, high]: [f32; 2], fade: f32) -> f32 {
    math::smoothstep(low - fade, low + fade, value)
        * (1.0 - math::smoothstep(high - fade, high + fade, value))
}

struct Painter<'a> {
    species: &'a FishSpecies,
    trunk: &'a Trunk,
    noise: Noise,
    stripes: Vec<Drawn<'a>>,
    lines: Vec<Drawn<'a>>,
}

/// A line with its points on the skin.
struct Drawn<'a> {
    line: &'a Line,
    points: Vec<Vec3>,
    /// Range along the body that it can reach.
    reach: [f32; 2],
}

impl<'a> Drawn<'a> {
    fn new(line: &'a Line, trunk: &Trunk) -> Self {
        const STEPS: usize = 24;
        let last = line.path.len() - 1;
        let points: Vec<Vec3> = (0..=STEPS)
            .map(|step| {
                let place = step as f32 / STEPS as f32 * last as f32;
                let segment = (place as usize).min(last - 1);
                trunk.point(along(&line.path, segment, place - segment as f32))
            })
            .collect();
        let low = points.iter().map(|point| point.z).fold(f32::MAX, f32::min);
        let high = points.iter().map(|point| point.z).fold(f32::MIN, f32::max);
        Self { line, points, reach: [low - 3.0 * line.width, high + 3.0 * line.width] }
    }

    /// How much of the line's color a point takes, and how much it is lit or shaded by its relief.
    fn cover(&self, point: Vec3) -> (f32, f32) {
        if point.z < self.reach[0] || point.z > self.reach[1] {
            return (0.0, 1.0);
        }
        let last = (self.points.len() - 1) as f32;
        let (mut nearest, mut share, mut ahead) = (f32::MAX, 0.0, 0.0);
        for (index, ends) in self.points.windows(2).enumerate() {
            let step = ends[1] - ends[0];
            let part =
                ((point - ends[0]).dot(step) / step.length_squared().max(1e-12)).clamp(0.0, 1.0);
            let offset = point - ends[0] - step * part;
            if offset.length_squared() < nearest {
                (nearest, ahead) = (offset.length_squared(), offset.z);
                share = (index as f32 + part) / last;
            }
        }
        let width = 0.5 * self.line.width * (1.0 - self.line.taper * share);
        let cover = self.line.strength * falloff(nearest.sqrt(), width, self.line.softness);
        let ends = math::smoothstep(0.0, 0.2, share) * (1.0 - math::smoothstep(0.8, 1.0, share));
        let side = ahead / self.line.width;
        let bright =
            side.signum() * math::smoothstep(0.0, 0.6, side.abs()) * falloff(side.abs(), 1.7, 0.5);
        (cover, 1.0 + 0.35 * self.line.relief * ends * bright)
    }
}

/// A point of a smooth path through places (Catmull & Rom).
fn along(path: &[Place], segment: usize, t: f32) -> Place {
    let get = |index: usize| path[index.min(path.len() - 1)];
    let (p, q) = (get(segment), get(segment + 1));
    let (before, after) = (get(segment.saturating_sub(1)), get(segment + 2));
    let (t2, t3) = (t * t, t * t * t);
    std::array::from_fn(|part| {
        let enter = 0.5 * (q[part] - before[part]);
        let leave = 0.5 * (after[part] - p[part]);
        p[part] * (2.0 * t3 - 3.0 * t2 + 1.0)
            + enter * (t3 - 2.0 * t2 + t)
            + q[part] * (3.0 * t2 - 2.0 * t3)
            + leave * (t3 - t2)
    })
}

impl<'a> Painter<'a> {
    fn new(species: &'a FishSpecies, trunk: &'a Trunk) -> Self {
        let draw = |lines: &'a [Line]| lines.iter().map(|line| Drawn::new(line, trunk)).collect();
        let mut lines: Vec<Drawn> = draw(&species.lines);
        lines.push(Drawn::new(&species.mouth, trunk));
        Self { species, trunk, noise: Noise::new(7), stripes: draw(&species.stripes), lines }
    }

    /// The color of the trunk at a place, eye included.
    fn trunk(&self, place: Place) -> Color {
        self.eye(self.skin(place), self.trunk.point(place))
    }

    /// The color of the skin at a place.
    fn skin(&self, place: Place) -> Color {
        let point = self.trunk.point(place);
        let mut color = self.countershading(place, point);
        for patch in &self.species.patches {
            color = color.mix(patch.color, self.patch(patch, place, point));
        }
        for bar in &self.species.bars {
            color = color.mix(bar.color, self.bar(bar, place, point));
        }
        for stripe in &self.stripes {
            color = color.mix(stripe.line.color, stripe.cover(point).0);
        }
        for (number, spots) in self.species.spots.iter().enumerate() {
            color = color.mix(spots.color, self.spots(spots, number as u32, place, point));
        }
        color = color.times(self.texture(place, point));
        for line in &self.lines {
            let (cover, light) = line.cover(point);
            color = color.times(light).mix(line.line.color, cover);
        }
        color
    }

    fn countershading(&self, [_, level]: Place, point: Vec3) -> Color {
        let skin = &self.species.skin;
        let wobble = 0.5 * skin.softness * self.noise.fractal(point * 14.0, 3);
        let level = level + wobble;
        let soft = skin.softness;
        let above = |border: f32| math::smoothstep(border - soft, border + soft, level);
        let color = skin.belly.mix(skin.flank, above(skin.levels[0]));
        let color = color.mix(skin.back, above(skin.levels[1]));
        if skin.iridescence <= 0.0 {
            return color;
        }
        let flank = above(skin.levels[0]) * (1.0 - above(skin.levels[1] + soft));
        let turn = 16.0 * level + 2.5 * self.noise.smooth(point * 9.0);
        let play = 0.3 * skin.iridescence * flank;
        let hue = |shift: f32| 1.0 + play * (turn + shift).sin();
        Color([color.0[0] * hue(0.0), color.0[1] * hue(2.1), color.0[2] * hue(4.2)])
    }

    fn patch(&self, patch: &Patch, [at, level]: Place, point: Vec3) -> f32 {
        let aside = (at - patch.place[0]) / patch.size[0];
        let above = (level - patch.place[1]) / patch.size[1];
        let out = aside.hypot(above);
        if out > 1.3 + patch.softness {
            return 0.0;
        }
        let wobble = 0.12 * self.noise.fractal(point * 22.0, 2);
        patch.strength * falloff(out + wobble, 1.0, patch.softness)
    }

    fn bar(&self, bar: &Bar, [at, level]: Place, point: Vec3) -> f32 {
        let nearest = |at: f32| bar.at.iter().map(|one| (at - one).abs()).fold(f32::MAX, f32::min);
        if nearest(at) > 2.5 * bar.width {
            return 0.0;
        }
        let ragged = bar.ragged * self.noise.fractal(point * 30.0, 3);
        let half = 0.5 * bar.width * (1.0 + 0.4 * ragged);
        let across = falloff(nearest(at + 0.6 * bar.width * ragged), half, bar.softness);
        bar.strength * across * within(level, bar.levels, 0.06)
    }

    fn spots(&self, spots: &Spots, number: u32, [at, level]: Place, point: Vec3) -> f32 {
        let inside = within(at, spots.along, 0.03) * within(level, spots.levels, 0.05);
        if inside <= 0.0 {
            return 0.0;
        }
        let cell = Noise::new(31 + number).cell(Vec3::new(0.0, point.y, point.z) / spots.spacing);
        let radius = spots.size * (0.6 + 0.6 * cell.random);
        spots.strength * inside * falloff(cell.nearest, radius, 0.35)
    }

    /// Brightness from scales and mottling, about 1.
    fn texture(&self, [at, level]: Place, point: Vec3) -> f32 {
        let skin = &self.species.skin;
        let mottle = if skin.mottle > 0.0 { self.noise.fractal(point * 45.0, 4) } else { 0.0 };
        let mottle = 1.0 + 0.5 * skin.mottle * mottle;
        if skin.scale <= 0.0 || skin.scaling <= 0.0 {
            return mottle;
        }
        let head = self.species.eye.place[0] + 3.0 * self.species.eye.radius;
        let inside = math::smoothstep(head, head + 0.08, at) * math::smoothstep(0.0, 0.15, level);
        let [shade, glint] = scale([at / skin.scale, point.y / skin.scale], self.noise);
        mottle * (1.0 + inside * skin.scaling * (0.3 * glint + shade))
    }

    /// The skin darkens where it dips towards the eye; the eye itself is seen where it has no dome.
    fn eye(&self, skin: Color, point: Vec3) -> Color {
        let socket = &self.species.eye;
        let offset = (point - self.trunk.point(socket.place)) / socket.radius;
        let out = offset.length();
        if out > 1.5 {
            return skin;
        }
        let shade = 1.0 - 0.35 * (1.0 - math::smoothstep(0.95, 1.4, out));
        let seen = eye(socket, [0.5 - 0.5 * offset.z, 0.5 - 0.5 * offset.y]);
        seen.mix(skin.times(shade), math::smoothstep(0.85, 1.0, out))
    }
}

impl Painter<'_> {
    /// The dome of the eye, its rim in the color of the skin round it.
    fn eye_cell(&self, [x, y]: [f32; 2]) -> Color {
        let socket = &self.species.eye;
        let offset = Vec3::new(0.0, 1.0 - 2.0 * y, 1.0 - 2.0 * x) * socket.radius;
        self.eye(self.skin(socket.place), self.trunk.point(socket.place) + offset)
    }
}

/// The eye seen from the left: pupil, bright ring, dark rim and a small highlight above and in front.
fn eye(eye: &Eye, [x, y]: [f32; 2]) -> Color {
    let (aft, rise) = (2.0 * x - 1.0, 1.0 - 2.0 * y);
    let out = aft.hypot(rise);
    let angle = rise.atan2(aft);
    let fibres = 1.0 + 0.07 * (angle * 23.0).sin() * (angle * 7.0 + 1.0).cos();
    // Dark above, like the back; a bright ring round the pupil.
    let shade = 1.0 - 0.55 * math::smoothstep(0.0, 0.9, rise);
    let ring = 1.0 + 0.7 * falloff((out - eye.pupil - 0.05).abs(), 0.04, 0.9);
    let color = eye.iris.times(fibres * shade * ring);
    let color = color.mix(BLACK, math::smoothstep(0.78, 1.0, out) * 0.8);
    // The pupil of a fish is not quite round: it is drawn out towards the snout.
    let pupil = (aft + if aft < 0.0 { -0.12 * aft } else { 0.0 }).hypot(rise);
    let color = color.mix(BLACK, falloff(pupil, eye.pupil, 0.06));
    let glint = (aft + 0.24).hypot(rise - 0.3);
    color.mix(WHITE, 0.9 * falloff(glint, 0.085, 0.5))
}

/// Overlapping scales, one wide and long, the front ones on top: shade (dark under the free edge of the scale
/// before, bright towards the own edge) and a random glint, about −1 to 1 each.
fn scale([along, above]: [f32; 2], noise: Noise) -> [f32; 2] {
    const RADIUS: f32 = 0.78;
    let row = (above * 2.0).floor();
    let mut front = [f32::MAX, 0.0, 0.0];
    for row in [row, row + 1.0] {
        let offset = 0.5 * row.rem_euclid(2.0);
        for step in [-1.0, 0.0] {
            let column = (along - offset).floor() + step + offset;
            let (dx, dy) = (along - column - 0.3, above - 0.5 * row);
            let out = dx.hypot(dy) / RADIUS;
            if out < 1.0 && column < front[0] {
                front = [column, out, row];
            }
        }
    }
    let [column, out, row] = front;
    let shade = math::smoothstep(0.55, 0.85, out) * 0.25 - math::smoothstep(0.88, 1.0, out) * 0.55;
    [shade, noise.smooth(Vec3::new(column * 1.37, row * 0.73, 0.5))]
}

/// What a fin is painted from.
struct Web<'a> {
    look: &'a FinLook,
    /// Length of the rays, as (place, length).
    lengths: Vec<[f32; 2]>,
    /// The skin that runs on over the base of a tail fin.
    root: Option<&'a Painter<'a>>,
    noise: Noise,
}

impl Web<'_> {
    /// The pixel at a ray (0 front to 1 rear) and a share of the way out.
    fn pixel(&self, ray: f32, out: f32) -> [u8; 4] {
        let look = self.look;
        let grain = self.noise.fractal(Vec3::new(ray * 9.0, out * 2.0, 0.0), 3);
        let outer = look.outer.unwrap_or(look.color);
        let mut color = look.color.mix(outer, math::smoothstep(0.1, 0.95, out + 0.15 * grain));
        // Rays fork half way out; the skin between them is thin.
        let rays = TAU * look.rays as f32 * (ray + 0.004 * grain);
        let single = 0.5 + 0.5 * rays.cos();
        let forked = 0.5 + 0.5 * (rays * 2.0).cos();
        let stem = math::mix(single, forked, math::smoothstep(0.4, 0.75, out));
        if look.rays > 0 {
            color = color.times(1.0 + look.contrast * (0.4 - stem * 0.7));
        }
        color = color.times(1.0 + 0.12 * grain);
        if let Some(painter) = self.root {
            let skin = painter.skin([painter.trunk.end, 0.92 - 0.84 * ray]);
            color = skin.mix(color, math::smoothstep(0.15, 0.5 + 0.15 * stem, out));
        }
        let to_edge = (1.0 - out) * self.length(ray);
        if let Some(seam) = look.seam {
            let width = look.seam_width * (1.0 + 0.2 * grain);
            color = color.mix(seam, 1.0 - math::smoothstep(0.7 * width, 1.2 * width, to_edge));
        }
        color.pixel(if self.is_hole(ray, out, stem) { 0.0 } else { 1.0 })
    }

    fn is_hole(&self, ray: f32, out: f32, stem: f32) -> bool {
        let look = self.look;
        let tear = self.noise.smooth(Vec3::new(ray * look.rays as f32 * 1.3, 5.0, 0.0));
        let notch = look.fray * (1.0 - stem) * (0.5 + tear).clamp(0.0, 1.2);
        notch > 0.0 && out > 1.0 - 0.16 * notch
    }

    fn length(&self, ray: f32) -> f32 {
        let next = self.lengths.iter().position(|one| one[0] >= ray).unwrap_or(0).max(1);
        let ([from, short], [to, long]) = (self.lengths[next - 1], self.lengths[next]);
        math::mix(short, long, (ray - from) / (to - from))
    }
}
