//! Where the sun does not reach: heights along the sun's direction on a grid that faces the sun.

use bioscope_core::Vec3;
use rayon::prelude::*;

use super::arithmetic::unit;
use super::cover::{Sheet, Tests};
use super::lens::Window;
use super::prepare::{Prepared, Thing};

/// Texels per side.
const SIZE: usize = 1024;

/// Rows worked on at a time.
const BAND: usize = 128;

/// Things larger than this (the ground) do not decide what the map covers, metres.
const LARGE: f32 = 8.0;

/// The map reaches at most this far from its middle, metres.
const REACH: f32 = 40.0;

/// A shadow map.
#[derive(Debug)]
pub(crate) struct Shadow {
    frame: Frame,
    /// Greatest height of anything above each texel's place, metres along the sun's direction.
    heights: Vec<f32>,
}

/// The grid in the world.
#[derive(Clone, Copy, Debug)]
struct Frame {
    across: Vec3,
    along: Vec3,
    sun: Vec3,
    /// Texel coordinates of the world's origin.
    start: [f32; 2],
    per_meter: f32,
}

impl Frame {
    /// Covers the box round all things that are not large.
    fn new(prepared: &Prepared) -> Option<Self> {
        let solid = || prepared.things.iter().filter(|thing| !prepared.is_veil(thing));
        let small = |thing: &&Thing| thing.radius < LARGE;
        let any_small = solid().any(|thing| small(&thing));
        let casters = || solid().filter(|thing| !any_small || small(thing));
        let count = casters().count() as f32;
        let mean = casters().map(|thing| thing.center).sum::<Vec3>() / count.max(1.0);
        let light = &prepared.light;
        let sun = if light.depth(mean.y) > 0.0 { light.sun_below } else { light.sun };
        let across = unit(sun.cross(Vec3::new(0.28, 0.0, 0.96)));
        let along = sun.cross(across);
        let mut low = [f32::INFINITY; 2];
        let mut high = [f32::NEG_INFINITY; 2];
        for thing in casters() {
            for (axis, way) in [across, along].into_iter().enumerate() {
                let offset = (thing.center - mean).dot(way);
                low[axis] = low[axis].min(offset - thing.radius).max(-REACH);
                high[axis] = high[axis].max(offset + thing.radius).min(REACH);
            }
        }
        let side = (high[0] - low[0]).max(high[1] - low[1]) + 0.5;
        if !side.is_finite() || side <= 0.0 {
            return None;
        }
        let per_meter = SIZE as f32 / side;
        let start = |axis: usize, way: Vec3| {
            SIZE as f32 * 0.5 - (mean.dot(way) + 0.5 * (low[axis] + high[axis])) * per_meter
        };
        Some(Self { across, along, sun, start: [start(0, across), start(1, along)], per_meter })
    }

    /// Texel coordinates and height of a point.
    #[inline(always)]
    fn place(&self, point: Vec3) -> Vec3 {
        Vec3::new(
            self.start[0] + point.dot(self.across) * self.per_meter,
            self.start[1] + point.dot(self.along) * self.per_meter,
            point.dot(self.sun),
        )
    }
}

impl Shadow {
    /// The shadows of a scene; none if it is empty.
    pub fn new(prepared: &Prepared) -> Option<Self> {
        let frame = Frame::new(prepared)?;
        let mut heights = vec![0.0; SIZE * SIZE];
        heights.par_chunks_mut(BAND * SIZE).enumerate().for_each_init(
            Sheet::default,
            |sheet, (number, part)| {
                let rows = [number * BAND, (number + 1) * BAND];
                band(prepared, &frame, rows, sheet);
                part.copy_from_slice(sheet.nearness());
            },
        );
        Some(Self { frame, heights })
    }

    /// 1 where the sun reaches a point in open space, else 0.
    #[inline(always)]
    pub fn reached(&self, point: Vec3) -> f32 {
        let place = self.frame.place(point);
        let inside = place.x >= 0.0 && place.y >= 0.0;
        if !inside || place.x >= SIZE as f32 || place.y >= SIZE as f32 {
            return 1.0;
        }
        let blocker = self.heights[place.y as usize * SIZE + place.x as usize];
        if blocker <= place.z { 1.0 } else { 0.0 }
    }

    /// Share of the sun's disc seen from a surface point with this normal (on the sun's side), softened
    /// over a texel; 1 outside the map.
    #[inline(always)]
    pub fn lit(&self, point: Vec3, normal: Vec3) -> f32 {
        let texel = 1.0 / self.frame.per_meter;
        let place = self.frame.place(point + normal * (2.0 * texel));
        let (x, y) = (place.x - 0.5, place.y - 0.5);
        if !(x >= 0.0 && y >= 0.0 && x < (SIZE - 2) as f32 && y < (SIZE - 2) as f32) {
            return 1.0;
        }
        let (column, row) = (x as usize, y as usize);
        let (u, v) = (x - column as f32, y - row as f32);
        let height = place.z + texel;
        let lit = |blocker: f32| if blocker <= height { 1.0 } else { 0.0 };
        let mixed = |line: &[f32]| {
            let (first, second) = (lit(line[0]), lit(line[1]));
            first + (second - first) * u
        };
        let first = row * SIZE + column;
        let (near, far) = (mixed(&self.heights[first..]), mixed(&self.heights[first + SIZE..]));
        near + (far - near) * v
    }
}

/// Heights of the rows of one band.
fn band(prepared: &Prepared, frame: &Frame, rows: [usize; 2], sheet: &mut Sheet) {
    sheet.clear(SIZE, rows, f32::NEG_INFINITY);
    let mut places = Vec::new();
    for thing in prepared.things.iter().filter(|thing| !prepared.is_veil(thing)) {
        let middle = frame.place(thing.center);
        let reach = thing.radius * frame.per_meter + 1.0;
        let outside = |value: f32, low: f32, high: f32| value + reach < low || value - reach > high;
        let columns_missed = outside(middle.x, 0.0, SIZE as f32);
        if columns_missed || outside(middle.y, rows[0] as f32, rows[1] as f32) {
            continue;
        }
        let visible = |error: f32, _: f32| error * frame.per_meter * prepared.options.detail > 1.0;
        if !prepared.has_turn(thing, Vec3::ZERO, visible) {
            continue;
        }
        let part = prepared.part(thing);
        let level = part.level(reach * prepared.options.detail);
        places.clear();
        let half = Vec3::new(0.5, 0.5, 0.0);
        places.extend(
            prepared.posed(thing, level).points.iter().map(|&point| frame.place(point) - half),
        );
        for triangle in &part.levels[level].1.triangles {
            cover(sheet, triangle.map(|corner| places[corner as usize]), rows);
        }
    }
}

/// Raises the heights under a triangle given in texel coordinates.
#[inline(always)]
fn cover(sheet: &mut Sheet, [a, b, c]: [Vec3; 3], rows: [usize; 2]) {
    let low = a.min(b).min(c);
    let high = a.max(b).max(c);
    let bound = |value: f32, low: usize, high: usize| {
        (value.max(0.0) as u32).clamp(low as u32, high as u32)
    };
    let window = Window {
        columns: [bound(low.x, 0, SIZE), bound(high.x + 1.0, 0, SIZE)],
        rows: [bound(low.y, rows[0], rows[1]), bound(high.y + 1.0, rows[0], rows[1])],
    };
    if window.is_empty() {
        return;
    }
    let [flat_a, flat_b, flat_c] = [a, b, c].map(|corner| Vec3::new(corner.x, corner.y, 1.0));
    let sides = [flat_b.cross(flat_c), flat_c.cross(flat_a), flat_a.cross(flat_b)];
    let area = flat_a.dot(sides[0]);
    if area == 0.0 || !area.is_finite() {
        return;
    }
    let sides = if area < 0.0 { sides.map(|side| -side) } else { sides };
    let plane = (sides[0] * a.z + sides[1] * b.z + sides[2] * c.z) / area.abs();
    sheet.cover_flat(&window, &Tests::new(sides, plane, f32::INFINITY), 0, None);
}
