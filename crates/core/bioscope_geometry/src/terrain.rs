use std::sync::OnceLock;

use bioscope_core::{Error, Result, Vec3};
use serde::{Deserialize, Serialize};

use crate::Mesh;

/// A heightfield: heights on a square grid, bilinear in between, level with its rim outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Terrain {
    /// x and z of the first sample, metres.
    pub origin: [f32; 2],
    /// Distance of neighboring samples, metres.
    pub spacing: f32,
    /// Samples along x.
    pub columns: usize,
    /// Heights in metres, row by row along x, rows along z.
    pub heights: Vec<f32>,
    /// Bounds of those heights, made when they are asked for first.
    #[serde(skip)]
    summits: Summits,
}

/// Cells along the side of a block of [`Summits`].
const BLOCK: usize = 8;

/// The greatest height of each block of cells, row by row; follows from the heights, so that it never differs where those are
/// equal.
#[derive(Clone, Debug, Default)]
struct Summits(OnceLock<Vec<f32>>);

impl PartialEq for Summits {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Terrain {
    /// A terrain of these samples; at least two by two, all finite.
    pub fn new(origin: [f32; 2], spacing: f32, columns: usize, heights: Vec<f32>) -> Result<Self> {
        if columns < 2 || heights.len() < 2 * columns || !heights.len().is_multiple_of(columns) {
            let shape = format!("{} heights in rows of {columns}", heights.len());
            return Err(Error::value("heights", shape, "at least two full rows of two or more"));
        }
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(Error::value("spacing", spacing, "a positive length in metres"));
        }
        if let Some(index) = heights.iter().position(|height| !height.is_finite()) {
            return Err(Error::value(format!("heights[{index}]"), heights[index], "finite metres"));
        }
        Ok(Self { origin, spacing, columns, heights, summits: Summits::default() })
    }

    /// Samples along z.
    pub fn rows(&self) -> usize {
        self.heights.len() / self.columns
    }

    /// Height of the ground in metres at (x, z).
    pub fn height(&self, x: f32, z: f32) -> f32 {
        let (column, u) = self.cell(x - self.origin[0], self.columns);
        let (row, v) = self.cell(z - self.origin[1], self.rows());
        let first = row * self.columns + column;
        let second = first + self.columns;
        let near = self.heights[first] * (1.0 - u) + self.heights[first + 1] * u;
        let far = self.heights[second] * (1.0 - u) + self.heights[second + 1] * u;
        near * (1.0 - v) + far * v
    }

    /// A height in metres that the ground nowhere rises above between two corners (x, z) of a rectangle; found from the greatest
    /// heights of blocks of 8 by 8 cells, so it is quick but not the least such height.
    pub fn bound(&self, low: [f32; 2], high: [f32; 2]) -> f32 {
        let (columns, rows) = (self.columns - 1, self.rows() - 1);
        let summits = self.summits.0.get_or_init(|| self.summits_of(columns, rows));
        let block = |place: f32, origin: f32, cells: usize| {
            let place = ((place - origin) / self.spacing).clamp(0.0, (cells - 1) as f32);
            place as usize / BLOCK
        };
        let xs = [low, high].map(|corner| block(corner[0], self.origin[0], columns));
        let zs = [low, high].map(|corner| block(corner[1], self.origin[1], rows));
        let across = columns.div_ceil(BLOCK);
        let blocks = (zs[0]..=zs[1]).flat_map(|row| &summits[row * across..][xs[0]..=xs[1]]);
        blocks.fold(f32::NEG_INFINITY, |greatest, &one| greatest.max(one))
    }

    fn summits_of(&self, columns: usize, rows: usize) -> Vec<f32> {
        let mut summits = Vec::new();
        for row in (0..rows).step_by(BLOCK) {
            for column in (0..columns).step_by(BLOCK) {
                // The samples on the far rim belong to its last cells.
                let (last_row, last) = ((row + BLOCK).min(rows), (column + BLOCK).min(columns));
                let samples = (row..=last_row)
                    .flat_map(|row| &self.heights[row * self.columns..][column..=last]);
                summits.push(samples.fold(f32::NEG_INFINITY, |a, &b| a.max(b)));
            }
        }
        summits
    }

    /// Unit normal of the ground at (x, z), from central differences one sample wide.
    pub fn normal(&self, x: f32, z: f32) -> Vec3 {
        let step = self.spacing;
        let slope_x = self.height(x + step, z) - self.height(x - step, z);
        let slope_z = self.height(x, z + step) - self.height(x, z - step);
        Vec3::new(-slope_x, 2.0 * step, -slope_z).normalize()
    }

    /// The ground as a mesh; texture coordinates are metres divided by `texture_size`.
    pub fn mesh(&self, texture_size: f32) -> Mesh {
        let mut mesh = Mesh::default();
        for row in 0..self.rows() {
            for column in 0..self.columns {
                let x = self.origin[0] + column as f32 * self.spacing;
                let z = self.origin[1] + row as f32 * self.spacing;
                mesh.positions.push(Vec3::new(x, self.heights[row * self.columns + column], z));
                mesh.normals.push(self.normal(x, z));
                mesh.uvs.push([x / texture_size, z / texture_size]);
            }
        }
        for row in 0..self.rows() - 1 {
            for column in 0..self.columns - 1 {
                let a = (row * self.columns + column) as u32;
                let (b, c) = (a + 1, a + self.columns as u32);
                mesh.triangles.extend([[a, c, b], [b, c, c + 1]]);
            }
        }
        mesh
    }

    fn cell(&self, offset: f32, count: usize) -> (usize, f32) {
        let place = (offset / self.spacing).clamp(0.0, (count - 1) as f32);
        let cell = (place as usize).min(count - 2);
        (cell, place - cell as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_keeps_its_heights_and_its_normal_points_up() {
        let heights = (0..12).map(|index| (index % 4) as f32 * 0.5).collect();
        let terrain = Terrain::new([1.0, 2.0], 2.0, 4, heights).unwrap();
        assert!((terrain.height(2.5, 3.0) - 0.375).abs() < 1e-6);
        assert_eq!(terrain.height(-50.0, 3.0), 0.0);
        let normal = terrain.normal(4.0, 4.0);
        assert!((normal.x / normal.y + 0.25).abs() < 1e-5);
        let mesh = terrain.mesh(1.0);
        let [a, b, c] = mesh.triangles[0].map(|index| mesh.positions[index as usize]);
        assert!((b - a).cross(c - a).y > 0.0);
    }

    #[test]
    fn the_ground_stays_below_its_bound() {
        let heights = (0..40 * 23).map(|index| ((index * 7919) % 101) as f32 * 0.1).collect();
        let terrain = Terrain::new([-3.0, 2.0], 0.5, 40, heights).unwrap();
        assert_eq!(terrain.bound([-9.0; 2], [99.0; 2]), 10.0);
        for corner in 0..40 {
            let low = [-5.0 + 0.6 * corner as f32, 1.0 + 0.3 * corner as f32];
            let high = [low[0] + 1.7, low[1] + 0.9];
            let bound = terrain.bound(low, high);
            for step in 0..=100 {
                let [x, z] = [0, 1].map(|axis| {
                    let share = if axis == 0 { step % 10 } else { step / 10 } as f32 / 10.0;
                    low[axis] + share * (high[axis] - low[axis])
                });
                assert!(terrain.height(x, z) <= bound + 1e-5, "{x} {z}");
            }
        }
    }

    #[test]
    fn refuses_what_is_no_heightfield() {
        assert!(Terrain::new([0.0; 2], 1.0, 2, vec![0.0; 3]).is_err());
        assert!(Terrain::new([0.0; 2], 0.0, 2, vec![0.0; 4]).is_err());
        let error = Terrain::new([0.0; 2], 1.0, 2, vec![0.0, f32::NAN, 0.0, 0.0]).unwrap_err();
        assert!(error.to_string().contains("heights[1]"));
    }
}
