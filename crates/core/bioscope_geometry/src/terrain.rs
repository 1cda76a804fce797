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
        Ok(Self { origin, spacing, columns, heights })
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
    fn refuses_what_is_no_heightfield() {
        assert!(Terrain::new([0.0; 2], 1.0, 2, vec![0.0; 3]).is_err());
        assert!(Terrain::new([0.0; 2], 0.0, 2, vec![0.0; 4]).is_err());
        let error = Terrain::new([0.0; 2], 1.0, 2, vec![0.0, f32::NAN, 0.0, 0.0]).unwrap_err();
        assert!(error.to_string().contains("heights[1]"));
    }
}
