use bioscope_core::Vec3;
use rayon::prelude::*;
use wide::f32x4;

/// Positions as one column per component, for reading four neighboring slots at once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
}

/// Slots after the last, so that four can be read from any slot on.
const MARGIN: usize = 3;

impl Columns {
    /// Becomes `vectors[order[0]]`, `vectors[order[1]]` and so on.
    pub fn gather(&mut self, vectors: &[Vec3], order: &[u32]) {
        for column in [&mut self.x, &mut self.y, &mut self.z] {
            column.resize(order.len() + MARGIN, 0.0);
        }
        (&mut self.x, &mut self.y, &mut self.z, order)
            .into_par_iter()
            .with_min_len(1024)
            .for_each(|(x, y, z, &index)| (*x, *y, *z) = vectors[index as usize].into());
    }

    /// The vector in one slot.
    pub fn at(&self, slot: usize) -> Vec3 {
        Vec3::new(self.x[slot], self.y[slot], self.z[slot])
    }

    /// The columns with their margins, all of one length.
    pub fn all(&self) -> [&[f32]; 3] {
        let length = self.x.len();
        [&self.x[..length], &self.y[..length], &self.z[..length]]
    }
}

/// Four slots of a column from `slot` on.
#[inline(always)]
pub(crate) fn four(column: &[f32], slot: usize) -> f32x4 {
    let mut lanes = [0.0; 4];
    lanes.copy_from_slice(&column[slot..slot + 4]);
    f32x4::new(lanes)
}

/// Position and velocity of one individual, for reading single slots; the fourth lanes are zero.
pub(crate) type Row = [f32x4; 2];

/// The row of nobody, far from everybody.
const NOBODY: Row = [f32x4::new([1e15, 1e15, 1e15, 0.0]), f32x4::new([0.0; 4])];

/// Positions and velocities in this order, and the row of nobody at the end.
pub(crate) fn gather_rows(
    rows: &mut Vec<Row>,
    positions: &[Vec3],
    velocities: &[Vec3],
    order: &[u32],
) {
    rows.resize(order.len() + 1, NOBODY);
    let lanes = |vector: Vec3| f32x4::new(vector.extend(0.0).to_array());
    (&mut rows[..order.len()], order).into_par_iter().with_min_len(1024).for_each(
        |(row, &index)| {
            let index = index as usize;
            *row = [lanes(positions[index]), lanes(velocities[index])];
        },
    );
    rows[order.len()] = NOBODY;
}

/// Position and velocity in a row.
pub(crate) fn moving(row: &Row) -> [Vec3; 2] {
    let vector = |lanes: f32x4| {
        let [x, y, z, _] = lanes.to_array();
        Vec3::new(x, y, z)
    };
    [vector(row[0]), vector(row[1])]
}
