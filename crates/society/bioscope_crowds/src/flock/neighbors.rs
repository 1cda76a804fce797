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
    count: u32,
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
#[derive(Clone, Copy, Debug, Default)]
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
    /// Slots of the neighbors, in the order of the candidates.
    neighbors: Vec<u32>,
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
        true
    }

    #[inline]
    fn add(&mut self, Range { start, end }: Range<usize>) {
        let mut first = start;
        while first < end {
            let count = (end - first).min(4) as u32;
            self.candidates.push(Four { first: first as u32, count });
            first += 4;
        }
    }

    /// Weighted sums over the neighbors.
    pub fn sums(&mut self, sorted: Sorted, perception: &Perception) -> Sums {
        let coincident = self.sieve(sorted.positions, perception);
        if self.neighbors.len() > perception.most {
            self.keep_nearest(sorted.positions, perception);
        }
        let count = self.neighbors.len();
        let nobody = sorted.rows.len() as u32 - 1;
        self.neighbors.resize(count.next_multiple_of(4), nobody);
        let weighed = match perception.exponent {
            1.0 => self.weigh(sorted.rows, perception, |_, floored| floored),
            2.0 => self.weigh(sorted.rows, perception, |square, _| square),
            3.0 => self.weigh(sorted.rows, perception, |square, floored| square * floored),
            exponent => self.weigh(sorted.rows, perception, |_, floored| {
                f32x4::new(floored.to_array().map(|distance| math::pow(distance, exponent)))
            }),
        };
        Sums { count, coincident, ..weighed }
    }

    /// Finds the neighbors among the candidates: all within the radius but not in the very same
    /// place; returns whether another than the individual itself is there.
    fn sieve(&mut self, positions: &Columns, perception: &Perception) -> bool {
        let zero = f32x4::splat(0.0);
        let limit = f32x4::splat(perception.radius * perception.radius);
        let Vec3 { x, y, z } = perception.place;
        let here = [f32x4::splat(x), f32x4::splat(y), f32x4::splat(z)];
        let columns = positions.all();
        // Four are always written, so there must be room for as many after the last.
        self.neighbors.resize(4 * self.candidates.len() + 4, 0);
        let (mut found, mut same) = (0, 0);
        for &Four { first, count } in &self.candidates {
            let way = |axis: usize| four(columns[axis], first as usize) - here[axis];
            let (x, y, z) = (way(0), way(1), way(2));
            let square = x * x + y * y + z * z;
            let meant = (1 << count) - 1;
            let near = square.simd_lt(limit).to_bitmask() & meant;
            let apart = square.simd_gt(zero).to_bitmask();
            let chosen = &CHOSEN[(near & apart) as usize];
            let room = &mut self.neighbors[found..found + 4];
            for (slot, lane) in room.iter_mut().zip(chosen.lanes) {
                *slot = first + lane;
            }
            found += chosen.count;
            same += CHOSEN[(near & !apart) as usize].count;
        }
        self.neighbors.truncate(found);
        same > 1
    }

    /// Keeps only as many neighbors as are heeded, the nearest.
    fn keep_nearest(&mut self, positions: &Columns, perception: &Perception) {
        let Perception { place, most, .. } = *perception;
        let square = |slot: u32| positions.at(slot as usize).distance_squared(place);
        self.ranking.clear();
        self.ranking.extend(self.neighbors.iter().map(|&slot| (square(slot), slot)));
        self.ranking.select_nth_unstable_by(most, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        self.ranking.truncate(most);
        self.ranking.sort_unstable_by_key(|one| one.1);
        self.neighbors.clear();
        self.neighbors.extend(self.ranking.iter().map(|one| one.1));
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
        let mut weights = zero;
        for slots in self.neighbors.as_chunks().0 {
            let [a, b, c, d]: [&Row; 4] = slots.each_ref().map(|&slot| &rows[slot as usize]);
            let way = f32x4::transpose([a[0] - here, b[0] - here, c[0] - here, d[0] - here]);
            let velocity = f32x4::transpose([a[1], b[1], c[1], d[1]]);
            let square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
            let distance = square.sqrt();
            let floored = distance.fast_max(least);
            // Those that fill up the last four are nowhere near.
            let near = square.simd_lt(limit);
            let inverse = one / (power(floored * floored, floored) * distance);
            let by_distance = inverse & near;
            let weight = by_distance * distance;
            for axis in 0..3 {
                crowding[axis] += by_distance * way[axis];
                toward[axis] += weight * way[axis];
                motion[axis] += weight * velocity[axis];
            }
            weights += weight;
        }
        Sums {
            toward: total(toward),
            crowding: total(crowding),
            motion: total(motion),
            weight: across(weights),
            ..Sums::default()
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

/// Which of four lanes are chosen, moved to the front, and how many.
#[derive(Clone, Copy)]
struct Chosen {
    lanes: [u32; 4],
    count: usize,
}

/// What each mask of four bits chooses.
const CHOSEN: [Chosen; 16] = {
    let mut all = [Chosen { lanes: [0; 4], count: 0 }; 16];
    let mut mask = 0;
    while mask < 16 {
        let mut lane = 0;
        while lane < 4 {
            if mask >> lane & 1 == 1 {
                let chosen = &mut all[mask];
                chosen.lanes[chosen.count] = lane as u32;
                chosen.count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    all
};
