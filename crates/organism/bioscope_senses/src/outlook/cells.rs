use std::ops::RangeInclusive;

use bioscope_core::{Id, Vec3};

/// A thing that senses can notice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thing {
    /// Where it is, metres in the world.
    pub position: Vec3,
    /// Its greatest extent, metres.
    pub size: f32,
    /// Its identity.
    pub id: Id,
    /// Where to find it: in which batch or group of points of the scene,
    pub group: u32,
    /// and which of that group.
    pub member: u32,
}

/// Cell edges per thing's size: about half the distance from which a thing is noticed at 4 degrees.
const EDGE: f32 = 8.0;
/// Bits of a cell's coordinate along one axis.
const BITS: u32 = 19;
const GREATEST: i64 = (1 << BITS) - 1;

/// Things sorted by octave of size, then by cell (z, y, x), then as they came.
#[derive(Debug, Default)]
pub(super) struct Cells {
    keys: Vec<u64>,
    /// Which thing each key is of.
    order: Vec<u32>,
    /// Octaves that occur.
    octaves: Vec<i32>,
    /// No cell is smaller, metres.
    least_edge: f32,
}

impl Cells {
    /// These things, in cells not smaller than `least_edge` metres.
    pub fn new(things: &[Thing], least_edge: f32) -> Self {
        let indexed = things.iter().enumerate();
        let mut keyed: Vec<(u64, u32)> =
            indexed.map(|(index, one)| (key(one, least_edge), index as u32)).collect();
        keyed.sort_unstable();
        let mut octaves: Vec<i32> = Vec::new();
        for &(key, _) in &keyed {
            let octave = (key >> (3 * BITS)) as i32 - OCTAVE_ZERO;
            if octaves.last() != Some(&octave) {
                octaves.push(octave);
            }
        }
        let (keys, order) = keyed.into_iter().unzip();
        Self { keys, order, octaves, least_edge }
    }

    /// Calls `visit` with the index of every thing that may lie within the distance that `reach` gives for its octave's
    /// greatest size (metres), in a fixed order; some that lie farther are visited too.
    pub fn near(&self, center: Vec3, reach: impl Fn(f32) -> f32, mut visit: impl FnMut(u32)) {
        for &octave in &self.octaves {
            let size = largest(octave);
            let radius = reach(size);
            if radius <= 0.0 {
                continue;
            }
            let edge = (EDGE * size).max(self.least_edge);
            let span = |axis: usize| -> RangeInclusive<i64> {
                let cell = |place: f32| coordinate(place, edge);
                cell(center[axis] - radius)..=cell(center[axis] + radius)
            };
            self.visit_box(octave, [span(0), span(1), span(2)], &mut visit);
        }
    }

    /// Visits the things in a box of cells. In the sorted list those are runs, one for each row of cells that is not empty; a
    /// step forward that doubles until it is too long finds the next one, so that empty rows cost nothing.
    fn visit_box(
        &self,
        octave: i32,
        [xs, ys, zs]: [RangeInclusive<i64>; 3],
        visit: &mut impl FnMut(u32),
    ) {
        let corner = |z: i64, y: i64, x: i64| code(octave, z, y, x);
        let last = corner(*zs.end(), *ys.end(), *xs.end());
        let mut next = corner(*zs.start(), *ys.start(), *xs.start());
        let mut index = self.keys.partition_point(|&key| key < next);
        while let Some(&key) = self.keys.get(index).filter(|&&key| key <= last) {
            let [z, y, x] = [2, 1, 0].map(|axis| ((key >> (axis * BITS)) as i64) & GREATEST);
            next = if y < *ys.start() {
                corner(z, *ys.start(), *xs.start())
            } else if y > *ys.end() {
                corner(z + 1, *ys.start(), *xs.start())
            } else if x < *xs.start() {
                corner(z, y, *xs.start())
            } else if x > *xs.end() {
                corner(z, y + 1, *xs.start())
            } else {
                visit(self.order[index]);
                index += 1;
                continue;
            };
            index = self.seek(index, next);
        }
    }

    /// Index of the first key not below `wanted`, at or after `from`, whose key is below it.
    fn seek(&self, from: usize, wanted: u64) -> usize {
        let (mut low, mut step) = (from, 1);
        while self.keys.get(low + step).is_some_and(|&key| key < wanted) {
            low += step;
            step *= 2;
        }
        let end = (low + step).min(self.keys.len());
        low + self.keys[low..end].partition_point(|&key| key < wanted)
    }
}

/// Octave that is coded as zero.
const OCTAVE_ZERO: i32 = 40;

fn key(thing: &Thing, least_edge: f32) -> u64 {
    let octave = octave(thing.size);
    let edge = (EDGE * largest(octave)).max(least_edge);
    let [x, y, z] = thing.position.to_array().map(|place| coordinate(place, edge));
    code(octave, z, y, x)
}

fn code(octave: i32, z: i64, y: i64, x: i64) -> u64 {
    let octave = (octave + OCTAVE_ZERO) as u64;
    // Sums, so that the cell after the last of a row is the first of the next row.
    (((((octave << BITS) + z as u64) << BITS) + y as u64) << BITS) + x as u64
}

/// Power of two at or above a size in metres: sizes in (2^(n-1), 2^n] are of octave n. From 2^-30 to 2^20.
fn octave(size: f32) -> i32 {
    let size = if size.is_finite() { size.max(1e-9) } else { 1e9 };
    let exponent = ((size.to_bits() >> 23) & 0xff) as i32 - 127;
    let exact = size.to_bits() & 0x007f_ffff == 0;
    (if exact { exponent } else { exponent + 1 }).clamp(-30, 20)
}

/// Greatest size of an octave, metres.
fn largest(octave: i32) -> f32 {
    f32::from_bits(((octave + 127) as u32) << 23)
}

fn coordinate(place: f32, edge: f32) -> i64 {
    ((place / edge).floor() as i64).saturating_add(1 << (BITS - 1)).clamp(0, GREATEST)
}
