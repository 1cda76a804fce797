//! What is in the cells of a box, made visible.

use bioscope_core::Vec3;
use bioscope_geometry::Mesh;
use bioscope_geometry::mesh::iso_surface;

/// Linear color of a painted field where there is most; where there is nothing it is black.
const MOST: [f32; 3] = [0.025, 0.13, 0.62];
/// How far a painted field lies behind what grows in it, cells.
const BEHIND: f32 = 0.7;
/// How much deeper it lies where there is nothing, cells: a relief, so that simplified versions of it keep what is
/// painted.
const RELIEF: f32 = 0.8;
/// Most points of a painted field in a direction.
const POINTS: usize = 512;

/// Amounts of something, such as water, in the cells of a box, flat (one layer) or deep.
#[derive(Clone, Debug, PartialEq)]
pub struct Amounts {
    /// Number of cells in x, y and z.
    pub cells: [usize; 3],
    /// Lowest corner of the box, in units of the model.
    pub low: Vec3,
    /// Width of a cell, in units of the model.
    pub cell: f32,
    /// Amount in each cell: x runs first, then y, then z.
    pub values: Vec<f32>,
}

impl Amounts {
    /// Whether the box has depth, so that its amounts are shown by surfaces in space.
    pub fn is_deep(&self) -> bool {
        self.cells.iter().all(|&count| count > 1)
    }

    /// Middle of a cell, which may lie between cells.
    fn middle(&self, at: Vec3) -> Vec3 {
        self.low + (at + Vec3::splat(0.5)) * self.cell
    }

    /// The surface on which a deep field has this amount; empty for a flat one. It looks to where there is less.
    pub fn surface(&self, amount: f32) -> Mesh {
        let mut mesh = iso_surface(self.cells, &self.values, amount);
        mesh.positions.iter_mut().for_each(|place| *place = self.middle(*place));
        mesh
    }

    /// The first layer of the field painted on a sheet behind what grows in it, from black, where there is nothing,
    /// to blue, where there is `most`.
    pub fn sheet(&self, most: f32) -> Mesh {
        let [columns, rows, _] = self.cells;
        let mut mesh = Mesh::default();
        if columns < 2 || rows < 2 {
            return mesh;
        }
        let steps = [columns, rows].map(|count| (count - 1).div_ceil(POINTS - 1));
        let places = [0, 1].map(|axis| {
            let last = self.cells[axis] - 1;
            (0..=last.div_ceil(steps[axis])).map(|step| (step * steps[axis]).min(last)).collect()
        });
        let [across, down]: [Vec<usize>; 2] = places;
        for &y in &down {
            for &x in &across {
                let share = (self.values[y * columns + x] / most).clamp(0.0, 1.0);
                let share = if share.is_finite() { share } else { 0.0 };
                let depth = -BEHIND - RELIEF * (1.0 - share);
                mesh.positions.push(self.middle(Vec3::new(x as f32, y as f32, depth)));
                mesh.colors.push(MOST.map(|part| part * share));
            }
        }
        let count = across.len();
        for corner in
            (0..down.len() - 1).flat_map(|row| (0..count - 1).map(move |x| row * count + x))
        {
            let [a, b] = [corner, corner + count].map(|one| one as u32);
            mesh.triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
        }
        mesh.compute_normals();
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_is_painted_by_the_amounts_and_stays_small() {
        let values: Vec<f32> = (0..12).map(|number| number as f32).collect();
        let flat = Amounts { cells: [4, 3, 1], low: Vec3::ZERO, cell: 2.0, values };
        let mesh = flat.sheet(11.0);
        assert_eq!(mesh.positions[5].truncate().to_array(), [3.0, 3.0]);
        assert_eq!((mesh.colors[0], mesh.colors[11]), ([0.0; 3], MOST));
        assert_eq!(mesh.triangles.len(), 2 * 3 * 2);
        assert!(flat.surface(3.0).triangles.is_empty());
        let wide = Amounts { cells: [3000, 2, 1], values: vec![1.0; 6000], ..flat };
        let mesh = wide.sheet(0.0);
        assert!(mesh.positions.len() <= 2 * POINTS);
        assert_eq!(mesh.positions[mesh.positions.len() - 1].x, 2999.5 * 2.0);
    }
}
