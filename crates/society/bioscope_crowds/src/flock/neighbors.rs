//! The neighbors of each individual: candidates looked up once per cell, sieved by distance four
//! at a time, and the neighbors among them weighed four at a time.

use std::ops::Range;

use bioscope_core::{Vec3, math};
use wide::f32x4;

use crate::columns::{Columns, Row, four};
use crate::grid::{Cell, Grid};

/// Greatest number of fours that are looked at; of more, a regular sample is. Bounds the time
/// that a heap of individuals in one place takes.
const MOST_FOURS: usize = 1024;

/// Up to four slots in a row.
#[derive(Clone, Copy, Debug)]
struct Four {
    first: u32,
    /// Which of the four are meant, one bit each.
    meant: u32,
}

/// Positions and velocities of all, by slot.
#[derive(Clone, Copy)]
pub struct Sorted<'a> {
    /// Positions for sieving, metres.
    pub positions: &'a Columns,
    /// Positions (metres) and velocities (m/s) for weighing.
    pub rows: &'a [Row],
}

/// Where and how far an individual looks.
#[derive(Clone, Copy, Debug)]
pub struct Perception {
    /// Where it is, metres.
    pub place: Vec3,
    /// How far it looks, metres.
    pub radius: f32,
    /// Exponent k of the weight max(d, least)^-k.
    pub exponent: f32,
    /// Distance in metres below which the weight does not grow.
    pub least: f32,
    /// Number of neighbors heeded, the nearest.
    pub most: usize,
}

/// Weighted sums over the neighbors.
#[derive(Clone, Copy, Debug)]
pub struct Sums {
    /// Σ w (pⱼ − pᵢ).
    pub toward: Vec3,
    /// Σ w (pⱼ − pᵢ) / d.
    pub crowding: Vec3,
    /// Σ w vⱼ.
    pub motion: Vec3,
    /// Σ w.
    pub weight: f32,
    /// How many neighbors there are.
    pub count: usize,
    /// Whether another is in the very same place.
    pub coincident: bool,
}

/// The neighborhood that one thread works at; memory is reused.
#[derive(Default)]
pub struct Neighborhood {
    cell: Option<Cell>,
    /// All in the cell and in the 26 cells around it.
    candidates: Vec<Four>,
    /// Slots of all within the radius, in the order of the candidates; room for all of them and
    /// four more.
    slots: Vec<u32>,
    /// How many slots are those of neighbors.
    found: usize,
    /// Squared distance and slot of each, where only the nearest count.
    ranking: Vec<(f32, u32)>,
}

impl Neighborhood {
    /// Looks up the surroundings of `cell` unless they are known; returns whether it did.
    pub fn enter(&mut self, grid: &Grid, cell: Cell) -> bool {
        if self.cell == Some(cell) {
            return false;
        }
        self.cell = Some(cell);
        let low = cell.map(|one| one.saturating_sub(1));
        let high = cell.map(|one| one.saturating_add(1));
        self.candidates.clear();
        grid.runs(low, high, |run| self.add(run));
        if self.candidates.len() > MOST_FOURS {
            let stride = self.candidates.len().div_ceil(MOST_FOURS);
            self.candidates = self.candidates.iter().step_by(stride).copied().collect();
        }
        self.slots.resize(4 * self.candidates.len() + 4, 0);
        true
    }

    #[inline]
    fn add(&mut self, Range { start, end }: Range<usize>) {
        let mut first = start;
        while first < end {
            let count = (end - first).min(4);
            self.candidates.push(Four { first: first as u32, meant: (1 << count) - 1 });
            first += 4;
        }
    }

    /// Weighted sums over the neighbors.
    pub fn sums(&mut self, sorted: Sorted, perception: &Perception) -> Sums {
        self.sieve(sorted.positions, perception);
        if self.found > perception.most {
            self.keep_nearest(sorted.positions, perception);
        }
        let nobody = sorted.rows.len() as u32 - 1;
        self.slots[self.found..self.found + 3].fill(nobody);
        match perception.exponent {
            1.0 => self.weigh(sorted.rows, perception, |_, floored| floored),
            2.0 => self.weigh(sorted.rows, perception, |square, _| square),
            3.0 => self.weigh(sorted.rows, perception, |square, floored| square * floored),
            exponent => self.weigh(sorted.rows, perception, |_, floored| {
                f32x4::new(floored.to_array().map(|distance| math::pow(distance, exponent)))
            }),
        }
    }

    /// Finds all candidates within the radius, the individual itself included.
    fn sieve(&mut self, positions: &Columns, perception: &Perception) {
        let limit = f32x4::splat(perception.radius * perception.radius);
        let Vec3 { x, y, z } = perception.place;
        let here = [f32x4::splat(x), f32x4::splat(y), f32x4::splat(z)];
        let columns = positions.all();
        let mut found = 0;
        for &Four { first, meant } in &self.candidates {
            let way = |axis: usize| four(columns[axis], first as usize) - here[axis];
            let (x, y, z) = (way(0), way(1), way(2));
            let near = (x * x + y * y + z * z).simd_lt(limit).to_bitmask() & meant;
            // Four are always written; those that are not near are overwritten by the next.
            let lanes = &CHOSEN[near as usize & 15];
            let room = &mut self.slots[found..found + 4];
            for (slot, lane) in room.iter_mut().zip(lanes) {
                *slot = first + lane;
            }
            found += usize::from(COUNT[near as usize & 15]);
        }
        self.found = found;
    }

    /// Keeps only as many neighbors as are heeded, the nearest, and all in the very same place.
    fn keep_nearest(&mut self, positions: &Columns, perception: &Perception) {
        let Perception { place, most, .. } = *perception;
        let square = |slot: u32| positions.at(slot as usize).distance_squared(place);
        let ranking = &mut self.ranking;
        ranking.clear();
        ranking.extend(self.slots[..self.found].iter().map(|&slot| (square(slot), slot)));
        let same = ranking.iter().filter(|one| one.0 == 0.0).count();
        let kept = (most + same).min(ranking.len());
        if kept < ranking.len() {
            ranking.select_nth_unstable_by(kept, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        ranking.truncate(kept);
        ranking.sort_unstable_by_key(|one| one.1);
        for (slot, one) in self.slots.iter_mut().zip(ranking) {
            *slot = one.1;
        }
        self.found = kept;
    }

    /// `power` gives max(d, least)^k from its square and itself.
    #[inline(always)]
    fn weigh(
        &self,
        rows: &[Row],
        perception: &Perception,
        power: impl Fn(f32x4, f32x4) -> f32x4,
    ) -> Sums {
        let [zero, one] = [f32x4::splat(0.0), f32x4::splat(1.0)];
        let least = f32x4::splat(perception.least);
        let limit = f32x4::splat(perception.radius * perception.radius);
        let here = perception.place.extend(0.0).to_array();
        let here = f32x4::new(here);
        let mut toward = [zero; 3];
        let mut crowding = [zero; 3];
        let mut motion = [zero; 3];
        let [mut weights, mut count, mut same] = [zero, zero, zero];
        for slots in self.slots[..self.found.next_multiple_of(4)].as_chunks().0 {
            let [a, b, c, d]: [&Row; 4] = slots.each_ref().map(|&slot| &rows[slot as usize]);
            let way = f32x4::transpose([a[0] - here, b[0] - here, c[0] - here, d[0] - here]);
            let velocity = f32x4::transpose([a[1], b[1], c[1], d[1]]);
            let square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
            let distance = square.sqrt();
            let floored = distance.fast_max(least);
            // Those that fill up the last four are nowhere near; others may be in the same place.
            let (near, apart) = (square.simd_lt(limit), square.simd_gt(zero));
            let inverse = one / (power(floored * floored, floored) * distance);
            let by_distance = inverse & near & apart;
            let weight = by_distance * distance;
            for axis in 0..3 {
                crowding[axis] += by_distance * way[axis];
                toward[axis] += weight * way[axis];
                motion[axis] += weight * velocity[axis];
            }
            weights += weight;
            count += one & near & apart;
            same += one - (one & apart);
        }
        Sums {
            toward: total(toward),
            crowding: total(crowding),
            motion: total(motion),
            weight: across(weights),
            count: across(count) as usize,
            // One of them is the individual itself.
            coincident: across(same) > 1.0,
        }
    }
}

fn total([x, y, z]: [f32x4; 3]) -> Vec3 {
    Vec3::new(across(x), across(y), across(z))
}

/// Sum of the lanes in a fixed order.
fn across(lanes: f32x4) -> f32 {
    let [a, b, c, d] = lanes.to_array();
    (a + b) + (c + d)
}

/// For each mask of four bits, the lanes that it chooses, moved to the front.
const CHOSEN: [[u32; 4]; 16] = {
    let mut all = [[0; 4]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut lane, mut count) = (0, 0);
        while lane < 4 {
            if mask >> lane & 1 == 1 {
                all[mask][count] = lane as u32;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    all
};

/// How many bits each mask of four bits has.
const COUNT: [u8; 16] = [0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4];
