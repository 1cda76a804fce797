//! The coarsest levels of detail: a few large triangles stand for very many small ones. Unlike a surface that
//! loses vertices, this keeps color and mass of corals and foliage that are a few pixels in size (stochastic
//! simplification, Cook et al. 2007, with evenly spaced instead of random choices).

use glam::Vec3;

use super::simplify::taken;
use super::{Mesh, Skin};

/// Triangles of the sparse levels.
const COUNTS: [usize; 4] = [96, 32, 12, 5];

/// Projected diameter above which single triangles could be told apart, pixels.
const LARGEST: f32 = 4.0;

impl Mesh {
    /// Sparse levels below a mesh's `coarsest` one of so many triangles, each with the projected diameter in
    /// pixels from which downward it serves: when it has two triangles for every square pixel of surface.
    pub(crate) fn sparse_levels(&self, radius: f32, coarsest: (f32, usize)) -> Vec<(f32, Mesh)> {
        let areas: Vec<f32> = self.triangles.iter().map(|&corners| self.area(corners)).collect();
        let area: f32 = areas.iter().sum();
        let (mut size, mut last) = coarsest;
        let mut levels = Vec::new();
        for count in COUNTS {
            if area > 0.0 && area.is_finite() && count * 3 < last * 2 {
                size = size.min(2.0 * radius * (0.5 * count as f32 / area).sqrt()).min(LARGEST);
                levels.push((size, self.sparse(&areas, area, count)));
                last = count;
            }
        }
        levels
    }

    fn area(&self, corners: [u32; 3]) -> f32 {
        let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
        0.5 * (b - a).cross(c - a).length()
    }

    /// Every triangle chosen is made equilateral, with an equal share of the area; what its corners have
    /// besides their place stays.
    fn sparse(&self, areas: &[f32], area: f32, count: usize) -> Mesh {
        let share = area / count as f32;
        let chosen = evenly_spaced(areas, share, count);
        let mut kept = Vec::with_capacity(3 * count);
        let mut positions = Vec::with_capacity(3 * count);
        for corners in chosen.map(|number| self.triangles[number]) {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
            let center = (a + b + c) / 3.0;
            // From the center to a corner of an equilateral triangle of this area.
            let reach = (share * 4.0 / (3.0 * 3f32.sqrt())).sqrt();
            let first = (a - center).normalize_or(normal.any_orthonormal_vector()) * reach;
            let aside = normal.cross(first) * (0.5 * 3f32.sqrt());
            positions
                .extend([first, aside - 0.5 * first, -aside - 0.5 * first].map(|way| center + way));
            kept.extend(corners.map(|corner| corner as usize));
        }
        Mesh {
            normals: taken(&self.normals, &kept),
            uvs: taken(&self.uvs, &kept),
            colors: taken(&self.colors, &kept),
            triangles: (0..positions.len() as u32 / 3)
                .map(|one| [0, 1, 2].map(|k| 3 * one + k))
                .collect(),
            skin: self.skin.as_ref().map(|skin| Skin {
                joints: skin.joints.clone(),
                indices: taken(&skin.indices, &kept),
                weights: taken(&skin.weights, &kept),
            }),
            positions,
            ..Mesh::default()
        }
    }
}

/// The triangles on which evenly spaced points fall when all areas lie in a row.
fn evenly_spaced(areas: &[f32], share: f32, count: usize) -> impl Iterator<Item = usize> {
    let mut next = 0.5 * share;
    let mut sum = 0.0;
    let mut left = count;
    areas.iter().enumerate().flat_map(move |(number, area)| {
        sum += area;
        let mut times = 0;
        while next < sum && left > 0 {
            next += share;
            left -= 1;
            times += 1;
        }
        std::iter::repeat_n(number, times)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn board(columns: u32) -> Mesh {
        let positions = (0..=columns)
            .flat_map(|x| [Vec3::new(x as f32, 0.0, 0.0), Vec3::new(x as f32, 1.0, 0.0)]);
        let triangles = (0..columns)
            .flat_map(|x| [[2 * x, 2 * x + 2, 2 * x + 1], [2 * x + 1, 2 * x + 2, 2 * x + 3]]);
        Mesh { positions: positions.collect(), triangles: triangles.collect(), ..Mesh::default() }
    }

    #[test]
    fn the_area_and_the_middle_stay() {
        let mesh = board(300);
        let levels = mesh.sparse_levels(150.0, (1000.0, 600));
        assert_eq!(
            levels.iter().map(|(_, level)| level.triangles.len()).collect::<Vec<_>>(),
            COUNTS
        );
        assert!(levels.is_sorted_by(|a, b| a.0 >= b.0));
        for (_, level) in &levels {
            let area: f32 = level.triangles.iter().map(|&corners| level.area(corners)).sum();
            assert!((area - 300.0).abs() < 1.0, "{area}");
            let middle = level.positions.iter().sum::<Vec3>() / level.positions.len() as f32;
            assert!((middle - Vec3::new(150.0, 0.5, 0.0)).length() < 3.0, "{middle}");
            for corners in &level.triangles {
                let [a, b, c] = corners.map(|corner| level.positions[corner as usize]);
                assert!((b - a).cross(c - a).z > 0.0, "turned over");
            }
        }
    }

    #[test]
    fn small_or_flawed_meshes_get_none() {
        assert!(board(3).sparse_levels(2.0, (10.0, 6)).is_empty());
        let mut flat = board(300);
        flat.positions.fill(Vec3::ZERO);
        assert!(flat.sparse_levels(1.0, (10.0, 600)).is_empty());
    }
}
