//! Discs and balls sorted into square cells, to find those near a point.

/// Most cells along one side.
const MOST: f64 = 1024.0;

/// Numbers of points by the cell of a plane that they lie in.
pub(super) struct Cells {
    low: [f64; 2],
    cell: f64,
    size: [usize; 2],
    starts: Vec<u32>,
    /// Points cell by cell, in the order they were given.
    pub points: Vec<u32>,
}

impl Cells {
    /// Sorts points into cells that are at least so wide.
    pub fn new(places: &[[f64; 2]], cell: f64) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for place in places {
            for axis in 0..2 {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
        }
        if places.is_empty() {
            (low, high) = ([0.0; 2], [0.0; 2]);
        }
        let widest = (high[0] - low[0]).max(high[1] - low[1]);
        // No more cells than points need, whatever the sizes.
        let most = (places.len() as f64).sqrt().ceil().clamp(1.0, MOST);
        let cell = cell.max(widest / most).max(1e-9);
        let size = [0, 1].map(|axis| ((high[axis] - low[axis]) / cell) as usize + 1);
        let mut cells = Self { low, cell, size, starts: Vec::new(), points: Vec::new() };
        let own: Vec<usize> =
            places.iter().map(|&place| cells.index(cells.cell_of(place))).collect();
        let mut starts = vec![0_u32; size[0] * size[1] + 1];
        own.iter().for_each(|&index| starts[index + 1] += 1);
        for index in 1..starts.len() {
            starts[index] += starts[index - 1];
        }
        let mut next = starts.clone();
        cells.points = vec![0; places.len()];
        for (point, &index) in own.iter().enumerate() {
            cells.points[next[index] as usize] = point as u32;
            next[index] += 1;
        }
        cells.starts = starts;
        cells
    }

    fn cell_of(&self, place: [f64; 2]) -> [usize; 2] {
        [0, 1].map(|axis| {
            let cell = (place[axis] - self.low[axis]) / self.cell;
            (cell.max(0.0) as usize).min(self.size[axis] - 1)
        })
    }

    fn index(&self, [x, y]: [usize; 2]) -> usize {
        y * self.size[0] + x
    }

    /// The ranges in [`Self::points`] of the cells within `reach` of a place, a row at a time.
    pub fn near(
        &self,
        place: [f64; 2],
        reach: f64,
    ) -> impl Iterator<Item = std::ops::Range<usize>> {
        let from = self.cell_of([place[0] - reach, place[1] - reach]);
        let to = self.cell_of([place[0] + reach, place[1] + reach]);
        (from[1]..=to[1]).flat_map(move |y| {
            (from[0]..=to[0]).map(move |x| {
                let index = self.index([x, y]);
                self.starts[index] as usize..self.starts[index + 1] as usize
            })
        })
    }

    /// All ranges, cell by cell.
    pub fn ranges(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        self.starts.windows(2).map(|pair| pair[0] as usize..pair[1] as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_points_are_found() {
        let places: Vec<[f64; 2]> =
            (0..400).map(|i| [f64::from(i % 20) * 0.7, f64::from(i / 20) * 0.3]).collect();
        let cells = Cells::new(&places, 1.0);
        for &[x, y] in &places {
            let mut found: Vec<u32> =
                cells.near([x, y], 1.3).flat_map(|range| cells.points[range].to_vec()).collect();
            found.sort_unstable();
            for (index, other) in places.iter().enumerate() {
                if (other[0] - x).hypot(other[1] - y) <= 1.3 {
                    assert!(found.binary_search(&(index as u32)).is_ok());
                }
            }
        }
        assert_eq!(cells.ranges().map(|range| range.len()).sum::<usize>(), 400);
        assert_eq!(Cells::new(&[], 1.0).near([0.0, 0.0], 5.0).count(), 1);
    }
}
