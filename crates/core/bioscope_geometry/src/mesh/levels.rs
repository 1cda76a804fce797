//! Levels of detail: coarser versions of a mesh for when it is small on the screen.

use std::sync::Arc;

use super::{Mesh, simplify::Simplifier};

/// Error on the screen at which a level begins to serve, pixels.
pub(crate) const ALLOWED: f32 = 0.6;

/// Triangles of a level relative to the next finer one.
const RATIO: f32 = 0.4;

/// No level has fewer triangles to aim at than this.
const FEWEST: usize = 8;

/// At most so many coarser levels.
const MOST: usize = 6;

impl Mesh {
    /// The mesh with coarser levels made from it (any it had are replaced). Texture coordinates,
    /// colors and skin weights are kept; levels have the same joints.
    pub fn with_levels(mut self) -> Mesh {
        self.levels.clear();
        let corners = self.triangles.iter().flatten();
        let usable = corners.clone().all(|&corner| (corner as usize) < self.positions.len());
        if !usable || self.positions.iter().any(|point| !point.is_finite()) {
            return self;
        }
        let (low, high) = self.bounds();
        let radius = if self.positions.is_empty() { 0.0 } else { (high - low).length() * 0.5 };
        let mut simplifier = Simplifier::new(&self, |_| false);
        let mut levels: Vec<(f32, Arc<Mesh>)> = Vec::new();
        let mut last = self.triangles.len();
        while levels.len() < MOST && last > FEWEST {
            simplifier.reduce(((last as f32 * RATIO) as usize).max(FEWEST));
            if simplifier.count() == 0 || simplifier.count() * 5 > last * 4 {
                break;
            }
            last = simplifier.count();
            let size = ALLOWED * 2.0 * radius / simplifier.error.max(1e-4 * radius);
            levels.push((size, Arc::new(self.part(&simplifier.triangles()).0)));
        }
        self.levels = levels;
        self
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use proptest::prelude::*;

    use super::*;
    use crate::{Joint, Skin, Transform};

    /// A ball with a texture seam and two joints.
    fn ball(rows: usize, columns: usize) -> Mesh {
        let mut mesh = Mesh::default();
        for row in 0..=rows {
            for column in 0..=columns {
                let [u, v] = [column as f32 / columns as f32, row as f32 / rows as f32];
                let (azimuth, polar) = (u * std::f32::consts::TAU, v * std::f32::consts::PI);
                let round = if column == columns { 0.0 } else { azimuth };
                let (ring, height) =
                    if row == rows { (0.0, -1.0) } else { (polar.sin(), polar.cos()) };
                let point = Vec3::new(ring * round.sin(), height, ring * round.cos());
                mesh.positions.push(point);
                mesh.normals.push(point);
                mesh.uvs.push([u, v]);
            }
        }
        let stride = columns as u32 + 1;
        for row in 0..rows as u32 {
            for column in 0..columns as u32 {
                let [a, b] = [row * stride + column, (row + 1) * stride + column];
                mesh.triangles.extend([[a, b, a + 1], [a + 1, b, b + 1]]);
            }
        }
        let joint =
            |name: &str| Joint { name: name.into(), parent: None, rest: Transform::IDENTITY };
        let weights =
            mesh.positions.iter().map(|point| [0.5 + 0.5 * point.y, 0.5 - 0.5 * point.y, 0.0, 0.0]);
        mesh.skin = Some(Skin {
            joints: vec![joint("upper"), joint("lower")],
            indices: vec![[0, 1, 0, 0]; mesh.positions.len()],
            weights: weights.collect(),
        });
        mesh
    }

    #[test]
    fn levels_of_a_ball_stay_round_and_bound() {
        let mesh = ball(24, 32).with_levels();
        assert!(mesh.levels.len() >= 3, "{}", mesh.levels.len());
        let counts: Vec<_> = mesh.levels.iter().map(|(_, level)| level.triangles.len()).collect();
        assert!(counts.is_sorted_by(|a, b| b * 10 < a * 7), "{counts:?}");
        assert!(mesh.levels.is_sorted_by(|a, b| a.0 > b.0), "sizes fall");
        let (_, coarsest) = &mesh.levels[mesh.levels.len() - 1];
        assert!(coarsest.triangles.len() < 40, "{counts:?}");
        for (_, level) in &mesh.levels {
            let skin = level.skin.as_ref().expect("levels keep their skin");
            assert_eq!(skin.weights.len(), level.positions.len());
            for triangle in &level.triangles {
                let [a, b, c] = triangle.map(|corner| level.positions[corner as usize]);
                assert!((b - a).cross(c - a).dot(a + b + c) > 0.0, "a triangle turned over");
            }
        }
        // A textured seam stays one: no triangle of the finest level spans the whole picture.
        for triangle in &mesh.levels[0].1.triangles {
            let us = triangle.map(|corner| mesh.levels[0].1.uvs[corner as usize][0]);
            let poles = triangle
                .iter()
                .any(|&corner| mesh.levels[0].1.positions[corner as usize].y.abs() > 0.99);
            assert!(
                poles || us.iter().fold(0.0, |a: f32, &b| a.max((b - us[0]).abs())) < 0.5,
                "{us:?}"
            );
        }
    }

    proptest! {
        #[test]
        fn any_soup_of_triangles_can_be_leveled(
            corners in prop::collection::vec(prop::array::uniform3(-2i8..3), 1..30),
            triangles in prop::collection::vec(prop::array::uniform3(0u32..32), 0..60),
        ) {
            let positions = corners.iter().map(|corner| Vec3::from(corner.map(f32::from))).collect();
            let mesh = Mesh { positions, triangles, ..Mesh::default() }.with_levels();
            for (_, level) in &mesh.levels {
                for triangle in &level.triangles {
                    prop_assert!(triangle.iter().all(|&corner| (corner as usize) < level.positions.len()));
                }
            }
        }
    }
}
