//! The z-buffer: which triangle each sample sees, and how near.

use bioscope_core::Vec3;
use wide::{f32x4, u32x4};

use super::lens::{BLOCK, Lens, Round, Window};
use super::texture::Level;

/// Windows of up to so many groups of samples are asked without looking at blocks first.
const SMALL: u32 = 24;

/// Owner of samples that see nothing.
pub(crate) const NOBODY: u32 = u32::MAX;

/// A triangle whose texture has holes: texture coordinates along a ray r are (u·r, v·r) / whole·r; all
/// linear as in [`Tests`].
#[derive(Clone, Copy)]
pub(crate) struct Holes<'a> {
    pub u: Vec3,
    pub v: Vec3,
    pub whole: Vec3,
    pub level: &'a Level,
}

/// Nearness and owner of the samples of some rows, four samples at a time. Nearness is 1/distance for a
/// fish-eye, 1/distance along the axis for a perspective, height along the sun for a shadow.
#[derive(Debug, Default)]
pub(crate) struct Sheet {
    groups: usize,
    first_row: usize,
    nearness: Vec<f32x4>,
    owners: Vec<u32x4>,
}

/// A triangle ready to be asked: a ray r is inside if every side·r is at least its limit, and its
/// nearness there is plane·r. All linear in rays, or in (column, row, 1).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tests {
    pub sides: [Vec3; 3],
    limits: [f32; 3],
    pub plane: Vec3,
    /// Greatest nearness that is seen.
    pub nearest: f32,
}

impl Tests {
    /// `sides` are planes through the eye, positive inside.
    #[inline(always)]
    pub fn new(sides: [Vec3; 3], plane: Vec3, nearest: f32) -> Self {
        Self { sides, limits: sides.map(limit), plane, nearest }
    }
}

impl Tests {
    /// Nearness where a ray, or (column, row, 1), meets the triangle; none where it misses it.
    #[inline(always)]
    pub fn nearness(&self, at: Vec3) -> Option<f32> {
        let inside = (0..3).all(|side| self.sides[side].dot(at) >= self.limits[side]);
        let nearness = self.plane.dot(at);
        (inside && nearness > 0.0 && nearness <= self.nearest).then_some(nearness)
    }

    /// Which of four rays are inside, given their values at the sides.
    #[inline(always)]
    fn inside(&self, values: [f32x4; 3]) -> f32x4 {
        let [a, b, c] = [0, 1, 2].map(|side| values[side].simd_ge(f32x4::splat(self.limits[side])));
        a & b & c
    }
}

impl Holes<'_> {
    /// The lanes `asked` for that are not in a hole; `along` gives the values of a test there.
    #[inline(always)]
    fn kept(&self, asked: f32x4, along: impl Fn(Vec3) -> f32x4) -> f32x4 {
        if asked.none() {
            return asked;
        }
        let whole = along(self.whole);
        let (u, v) = ((along(self.u) / whole).to_array(), (along(self.v) / whole).to_array());
        let bits = asked.to_bitmask();
        let lanes: [u32; 4] = std::array::from_fn(|lane| {
            let asked = bits >> lane & 1 == 1;
            if asked && self.level.solid([u[lane], v[lane]]) { u32::MAX } else { 0 }
        });
        bytemuck::cast(lanes)
    }
}

/// A ray exactly on a side belongs to one of the two triangles that share it: the one whose test
/// vector points to the positive half of the directions.
#[inline(always)]
fn limit(side: Vec3) -> f32 {
    let owns = side.x > 0.0 || (side.x == 0.0 && (side.y > 0.0 || (side.y == 0.0 && side.z > 0.0)));
    if owns { 0.0 } else { f32::MIN_POSITIVE }
}

impl Sheet {
    /// Clears rows `first_row` to `last_row` (exclusive) of a grid `width` samples wide; `farthest` is the
    /// nearness below which nothing is seen.
    pub fn clear(&mut self, width: usize, rows: [usize; 2], farthest: f32) {
        self.groups = width.div_ceil(4);
        self.first_row = rows[0];
        let count = self.groups * (rows[1] - rows[0]);
        self.nearness.clear();
        self.nearness.resize(count, f32x4::splat(farthest));
        self.owners.clear();
        self.owners.resize(count, u32x4::splat(NOBODY));
    }

    /// Nearness of all samples, row by row, each row padded to a multiple of four.
    pub fn nearness(&self) -> &[f32] {
        bytemuck::cast_slice(&self.nearness)
    }

    /// Owners of all samples, in the same order.
    pub fn owners(&self) -> &[u32] {
        bytemuck::cast_slice(&self.owners)
    }

    /// Samples per row, padding included.
    pub fn stride(&self) -> usize {
        self.groups * 4
    }

    /// Covers the samples of a triangle for which it is the nearest, and which are not in its
    /// holes.
    #[inline(always)]
    pub fn cover(
        &mut self,
        lens: &Lens,
        window: &Window,
        tests: &Tests,
        owner: u32,
        holes: Option<&Holes>,
    ) {
        match &lens.round {
            None => self.cover_flat(window, tests, owner, holes),
            Some(round) => self.cover_round(round, window, tests, owner, holes),
        }
    }

    /// With tests linear in column and row.
    #[inline(always)]
    pub fn cover_flat(
        &mut self,
        window: &Window,
        tests: &Tests,
        owner: u32,
        holes: Option<&Holes>,
    ) {
        let steps = f32x4::from([0.0, 1.0, 2.0, 3.0]);
        let [first, last] = [window.columns[0] / 4, window.columns[1].div_ceil(4)];
        let mut all = [f32x4::ZERO; 4];
        for row in window.rows[0]..window.rows[1] {
            let mut span = [window.columns[0] as f32, window.columns[1] as f32];
            let wide = last - first > 4;
            for (value, test) in
                all.iter_mut().zip([tests.sides[0], tests.sides[1], tests.sides[2], tests.plane])
            {
                *value = f32x4::splat(test.y * row as f32 + test.z);
            }
            if wide {
                for side in tests.sides {
                    narrow(&mut span, side.x, side.y * row as f32 + side.z);
                }
            }
            let [first, last] = if wide {
                [
                    (span[0].max(0.0) as u32 / 4).max(first),
                    ((span[1].max(0.0) as u32).div_ceil(4)).min(last),
                ]
            } else {
                [first, last]
            };
            let line = (row as usize - self.first_row) * self.groups;
            for group in first..last {
                let columns = f32x4::splat((group * 4) as f32) + steps;
                let values = [
                    columns * tests.sides[0].x + all[0],
                    columns * tests.sides[1].x + all[1],
                    columns * tests.sides[2].x + all[2],
                ];
                let inside = tests.inside(values);
                if inside.any() {
                    let nearness = columns * tests.plane.x + all[3];
                    let along = |test: Vec3| columns * test.x + (test.y * row as f32 + test.z);
                    let keep = |wins| holes.map_or(wins, |holes| holes.kept(wins, along));
                    self.settle(line + group as usize, inside, nearness, tests, owner, keep);
                }
            }
        }
    }

    /// With tests linear in rays.
    #[inline(always)]
    fn cover_round(
        &mut self,
        round: &Round,
        window: &Window,
        tests: &Tests,
        owner: u32,
        holes: Option<&Holes>,
    ) {
        let [first, last] = [window.columns[0] / 4, window.columns[1].div_ceil(4)];
        let rows = window.rows;
        if (last - first) * (rows[1] - rows[0]) <= SMALL {
            self.cover_rays(round, [first, last], rows, tests, owner, holes);
            return;
        }
        let widths = tests.sides.map(|side| side.length_squared().sqrt());
        for down in rows[0] / BLOCK..rows[1].div_ceil(BLOCK) {
            for aside in first / 2..last.div_ceil(2) {
                let (center, reach) = round.blocks[(down * round.across + aside) as usize];
                let missed =
                    (0..3).any(|side| tests.sides[side].dot(center) < -widths[side] * reach);
                if missed {
                    continue;
                }
                let rows = [rows[0].max(down * BLOCK), rows[1].min((down + 1) * BLOCK)];
                let groups = [first.max(aside * 2), last.min(aside * 2 + 2)];
                self.cover_rays(round, groups, rows, tests, owner, holes);
            }
        }
    }

    #[inline(always)]
    fn cover_rays(
        &mut self,
        round: &Round,
        groups: [u32; 2],
        rows: [u32; 2],
        tests: &Tests,
        owner: u32,
        holes: Option<&Holes>,
    ) {
        for row in rows[0]..rows[1] {
            let line = (row as usize - self.first_row) * self.groups;
            let rays = &round.rays[row as usize * self.groups..];
            for group in groups[0]..groups[1] {
                let [x, y, z] = rays[group as usize];
                let along = |test: Vec3| x * test.x + y * test.y + z * test.z;
                let inside = tests.inside(tests.sides.map(along));
                if inside.any() {
                    let keep = |wins| holes.map_or(wins, |holes| holes.kept(wins, along));
                    let nearness = along(tests.plane);
                    self.settle(line + group as usize, inside, nearness, tests, owner, keep);
                }
            }
        }
    }

    #[inline(always)]
    fn settle(
        &mut self,
        index: usize,
        inside: f32x4,
        nearness: f32x4,
        tests: &Tests,
        owner: u32,
        keep: impl Fn(f32x4) -> f32x4,
    ) {
        let old = self.nearness[index];
        let wins =
            keep(inside & nearness.simd_gt(old) & nearness.simd_le(f32x4::splat(tests.nearest)));
        self.nearness[index] = wins.bitselect(nearness, old);
        let mask: u32x4 = bytemuck::cast(wins);
        self.owners[index] = mask.bitselect(u32x4::splat(owner), self.owners[index]);
    }
}

/// Cuts a span of columns down to where slope · column + start ≥ 0, with a column to spare.
#[inline(always)]
fn narrow(span: &mut [f32; 2], slope: f32, start: f32) {
    let crossing = -start / slope;
    if slope > 0.0 {
        span[0] = span[0].max(crossing - 1.0);
    } else if slope < 0.0 {
        span[1] = span[1].min(crossing + 2.0);
    }
}
