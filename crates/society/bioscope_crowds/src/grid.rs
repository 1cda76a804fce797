use std::ops::Range;

use bioscope_core::Vec3;

use rayon::prelude::*;

use crate::columns::Columns;

/// Least number of cells along each axis: a reach of one cell then never meets a cell twice.
const LEAST_SIDE: usize = 4;
/// Greatest number of cells along one axis.
const GREATEST_SIDE: usize = 1024;
/// Cells per point above which space is folded.
const CELLS_PER_POINT: usize = 8;

/// Points sorted into cubic cells, for finding all within some distance of a place at a cost that
/// does not depend on how many points there are.
///
/// The cells form a table whose sides are powers of two; space beyond its sides folds back into
/// it, so that any positions need bounded memory (points from elsewhere are told apart by their
/// distance). Points lie cell by cell in memory, in the order of their indices within a cell, so
/// the three neighboring cells of a row are one run.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    edge: f32,
    /// Cells along x, y, z minus one.
    masks: [usize; 3],
    /// First slot of each cell, and the end.
    starts: Vec<u32>,
    /// Index of the point in each slot.
    order: Vec<u32>,
    /// Slot of each point.
    slots: Vec<u32>,
    /// Position in each slot.
    positions: Columns,
    /// Cell of each point, while building.
    cells: Vec<u32>,
}

/// Coordinates of a cell, unfolded.
pub(crate) type Cell = [i32; 3];

impl Grid {
    /// A grid over `positions` (metres) with cells of `edge` metres.
    pub fn new(positions: &[Vec3], edge: f32) -> Self {
        let mut grid = Self::default();
        grid.build(positions, edge);
        grid
    }

    /// Sorts `positions` anew (counting sort); memory is reused.
    pub fn build(&mut self, positions: &[Vec3], edge: f32) {
        self.edge = edge.max(1e-6);
        self.masks = sides(positions, self.edge).map(|side| side - 1);
        let mut cells = std::mem::take(&mut self.cells);
        positions
            .par_iter()
            .with_min_len(1024)
            .map(|&position| self.folded(self.cell(position)) as u32)
            .collect_into_vec(&mut cells);
        self.sort(&cells);
        self.cells = cells;
        self.positions.gather(positions, &self.order);
    }

    fn sort(&mut self, cells: &[u32]) {
        let count = self.masks.iter().map(|mask| mask + 1).product::<usize>();
        self.starts.clear();
        self.starts.resize(count + 1, 0);
        for &cell in cells {
            self.starts[cell as usize] += 1;
        }
        // Turns counts into ends; placing from the back then turns ends into starts.
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
        self.order.resize(cells.len(), 0);
        self.slots.resize(cells.len(), 0);
        for (index, &cell) in cells.iter().enumerate().rev() {
            let slot = &mut self.starts[cell as usize];
            *slot -= 1;
            self.order[*slot as usize] = index as u32;
            self.slots[index] = *slot;
        }
    }

    /// Index of the point in each slot.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Slot of each point.
    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    /// Positions by slot, metres.
    pub(crate) fn positions(&self) -> &Columns {
        &self.positions
    }

    /// Calls `visit(index, squared distance)` for every point nearer than `radius` metres to
    /// `center`, in a fixed order; allocates nothing.
    pub fn within(&self, center: Vec3, radius: f32, mut visit: impl FnMut(usize, f32)) {
        let reach = Vec3::splat(radius);
        self.runs(self.cell(center - reach), self.cell(center + reach), |run| {
            for slot in run {
                let square = self.positions.at(slot).distance_squared(center);
                if square < radius * radius {
                    visit(self.order[slot] as usize, square);
                }
            }
        });
    }

    /// Calls `visit` with each run of slots that holds the points of the cells from `low` to
    /// `high`, both included, and perhaps some from elsewhere; no slot comes twice.
    pub(crate) fn runs(&self, low: Cell, high: Cell, mut visit: impl FnMut(Range<usize>)) {
        if self.starts.is_empty() {
            return;
        }
        let sides = self.masks.map(|mask| mask + 1);
        let span = |axis: usize| {
            let cells = i64::from(high[axis]) - i64::from(low[axis]) + 1;
            usize::try_from(cells).unwrap_or(0).min(sides[axis])
        };
        let first = |axis: usize| low[axis] as usize & self.masks[axis];
        let (x, y, z) = (first(0), first(1), first(2));
        let (length, rows, layers) = (span(0), span(1), span(2));
        let straight = length.min(sides[0] - x);
        for layer in z..z + layers {
            let layer = (layer & self.masks[2]) * sides[1];
            for row in y..y + rows {
                let row = (layer + (row & self.masks[1])) * sides[0];
                visit(self.run(row + x, straight));
                if straight < length {
                    visit(self.run(row, length - straight));
                }
            }
        }
    }

    fn run(&self, cell: usize, length: usize) -> Range<usize> {
        self.starts[cell] as usize..self.starts[cell + length] as usize
    }

    /// Cell in which a position lies, unfolded.
    pub(crate) fn cell(&self, position: Vec3) -> Cell {
        let cells = position / self.edge;
        [floor(cells.x), floor(cells.y), floor(cells.z)]
    }

    fn folded(&self, cell: Cell) -> usize {
        let fold = |axis: usize| cell[axis] as usize & self.masks[axis];
        let (x, y, z) = (fold(0), fold(1), fold(2));
        (z * (self.masks[1] + 1) + y) * (self.masks[0] + 1) + x
    }
}

/// Greatest integer not above `value`; saturates. (The method of `f32` is a call without SSE 4.)
fn floor(value: f32) -> i32 {
    let whole = value as i32;
    whole.saturating_sub(i32::from((whole as f32) > value))
}

/// Cells along each axis: enough for the extent of the points, as far as memory allows.
fn sides(positions: &[Vec3], edge: f32) -> [usize; 3] {
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) =
        positions.iter().fold(start, |(low, high), &point| (low.min(point), high.max(point)));
    // Two more than fit, so that neighbors of the outermost cells fold onto empty ones.
    let cells = ((high - low) / edge).to_array().map(|cells| cells as usize);
    let mut sides = cells
        .map(|cells| cells.saturating_add(2).clamp(LEAST_SIDE, GREATEST_SIDE).next_power_of_two());
    let limit = CELLS_PER_POINT * positions.len().max(16);
    while sides.iter().product::<usize>() > limit {
        let longest = sides.iter_mut().max().expect("three axes");
        *longest /= 2;
    }
    sides
}

#[cfg(test)]
mod tests {
    use bioscope_core::{Purpose, Random};
    use proptest::prelude::*;

    use super::*;

    fn point(size: f32) -> impl Strategy<Value = Vec3> {
        (-size..size, -size..size, -size..size).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    fn scattered(count: usize, half_side: f32) -> Vec<Vec3> {
        let mut random = Random::new(4, 0, 0, Purpose::new("grid"));
        let mut along = || random.range(-half_side, half_side);
        (0..count).map(|_| Vec3::new(along(), along(), along())).collect()
    }

    proptest! {
        #[test]
        fn finds_what_trying_all_finds(
            points in prop::collection::vec(point(30.0), 0..200), center in point(40.0),
            radius in 0.01f32..25.0, edge in 0.3f32..12.0
        ) {
            let grid = Grid::new(&points, edge);
            let mut found = Vec::new();
            grid.within(center, radius, |index, square| found.push((index, square)));
            found.sort_by_key(|one| one.0);
            let all = points.iter().map(|point| point.distance_squared(center)).enumerate();
            let expected: Vec<_> = all.filter(|one| one.1 < radius * radius).collect();
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn candidates_per_point_do_not_grow_with_the_number_of_points() {
        let mean = |count: usize| {
            let points = scattered(count, (count as f32).cbrt());
            let grid = Grid::new(&points, 1.5);
            let tests = |&point: &Vec3| {
                let [x, y, z] = grid.cell(point);
                let mut tests = 0;
                grid.runs([x - 1, y - 1, z - 1], [x + 1, y + 1, z + 1], |run| tests += run.len());
                tests
            };
            points.iter().map(tests).sum::<usize>() as f32 / count as f32
        };
        // At this density an interior point meets itself and 27 · 1.5³ / 8 = 11.4 others.
        let (small, large) = (mean(1000), mean(100_000));
        assert!(small < 12.5 && large < 12.5 && large < 1.35 * small, "{small} {large}");
    }

    #[test]
    fn far_and_strange_places_need_little_memory() {
        let points = [Vec3::ZERO, Vec3::splat(1e30), Vec3::splat(-1e30), Vec3::splat(f32::NAN)];
        let grid = Grid::new(&points, 1e-3);
        assert!(grid.starts.len() <= 129);
        let mut found = Vec::new();
        grid.within(Vec3::ZERO, 1.0, |index, _| found.push(index));
        assert_eq!(found, [0]);
        Grid::default().within(Vec3::ZERO, 1.0, |_, _| panic!("nothing is there"));
    }
}
