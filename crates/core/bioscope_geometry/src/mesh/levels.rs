//! Levels of detail: coarser versions of a mesh for when it is small on the screen.

use std::sync::Arc;

use glam::Vec3;

use super::{Mesh, simplify::Simplifier};

/// Error on the screen at which a level begins to serve, pixels.
const ALLOWED: f32 = 0.6;

/// Triangles of a level relative to the next finer one.
const RATIO: f32 = 0.4;

/// No level has fewer triangles to aim at than this.
const FEWEST: usize = 8;

/// At most so many coarser levels.
const MOST: usize = 6;

impl Mesh {
    /// The mesh with coarser levels made from it (any it had are replaced). Texture coordinates,
    /// colors and skin weights are kept; levels have the same joints.
    pub fn with_levels(self) -> Mesh {
        self.leveled(false)
    }

    fn leveled(mut self, locked: bool) -> Mesh {
        self.levels.clear();
        let corners = self.triangles.iter().flatten();
        let usable = corners.clone().all(|&corner| (corner as usize) < self.positions.len());
        if !usable || self.positions.iter().any(|point| !point.is_finite()) {
            return self;
        }
        let radius = self.radius();
        let mut simplifier = Simplifier::new(&self, locked);
        let mut levels: Vec<(f32, Arc<Mesh>)> = Vec::new();
        let mut last = self.triangles.len();
        while levels.len() < MOST && last > FEWEST {
            simplifier.reduce(((last as f32 * RATIO) as usize).max(FEWEST));
            if simplifier.count() == 0 || simplifier.count() * 5 > last * 4 {
                break;
            }
            last = simplifier.count();
            let size = ALLOWED * 2.0 * radius / simplifier.error.max(1e-4 * radius);
            levels.push((size, Arc::new(simplifier.result())));
        }
        self.levels = levels;
        self
    }

    /// Half the diagonal of the box round the mesh, metres.
    fn radius(&self) -> f32 {
        let (low, high) = self.bounds();
        if self.positions.is_empty() { 0.0 } else { (high - low).length() * 0.5 }
    }

    /// A large mesh (ground, reef wall) cut into tiles of at most `size` triangles, each with its own
    /// levels. The outlines of tiles stay as they are at all levels, so that neighboring tiles of different
    /// levels leave no gap.
    pub fn tiles(&self, size: usize) -> Vec<Mesh> {
        let places = self.triangles.iter().map(|triangle| {
            let corners = triangle.map(|corner| self.positions.get(corner as usize).copied());
            let sum = |sum: Vec3, corner: &Option<Vec3>| sum + corner.unwrap_or(Vec3::NAN);
            corners.iter().fold(Vec3::ZERO, sum)
        });
        let mut all: Vec<(Vec3, [u32; 3])> = places.zip(self.triangles.iter().copied()).collect();
        all.retain(|(place, _)| place.is_finite());
        let mut groups = Vec::new();
        halve(&mut all, size.max(16), &mut groups);
        groups.iter().map(|group| self.part(group).leveled(true)).collect()
    }
}

/// Cuts a set of triangles in two along its longest side until each part is small enough.
fn halve(all: &mut [(Vec3, [u32; 3])], size: usize, groups: &mut Vec<Vec<[u32; 3]>>) {
    if all.len() <= size {
        if !all.is_empty() {
            groups.push(all.iter().map(|&(_, triangle)| triangle).collect());
        }
        return;
    }
    let around = |(low, high): (Vec3, Vec3), place: Vec3| (low.min(place), high.max(place));
    let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = all.iter().fold(start, |bounds, &(place, _)| around(bounds, place));
    let axis = (high - low).max_position();
    let middle = all.len() / 2;
    all.select_nth_unstable_by(middle, |(a, first), (b, second)| {
        a[axis].total_cmp(&b[axis]).then(first.cmp(second))
    });
    let (left, right) = all.split_at_mut(middle);
    halve(left, size, groups);
    halve(right, size, groups);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{Joint, Skin, Terrain, Transform};

    /// A ball with a texture seam and two joints.
    fn ball(rows: usize, columns: usize) -> Mesh {
        let mut mesh = Mesh::default();
        for row in 0..=rows {
            for column in 0..=columns {
                let [u, v] = [column as f32 / columns as f32, row as f32 / rows as f32];
                let (azimuth, polar) = (u * std::f32::consts::TAU, v * std::f32::consts::PI);
                let round = if column == columns { 0.0 } else { azimuth };
                let (ring, height) = if row == rows { (0.0, -1.0) } else { (polar.sin(), polar.cos()) };
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
        let joint = |name: &str| Joint { name: name.into(), parent: None, rest: Transform::IDENTITY };
        let weights = mesh.positions.iter().map(|point| [0.5 + 0.5 * point.y, 0.5 - 0.5 * point.y, 0.0, 0.0]);
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
        assert!(counts.is_sorted_by(|a, b| b * 10 < a * 5), "{counts:?}");
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
            let poles = triangle.iter().any(|&corner| mesh.levels[0].1.positions[corner as usize].y.abs() > 0.99);
            assert!(poles || us.iter().fold(0.0, |a: f32, &b| a.max((b - us[0]).abs())) < 0.5, "{us:?}");
        }
    }

    #[test]
    fn tiles_of_ground_keep_their_outline() {
        let heights = (0..3600).map(|index| ((index % 60) as f32 * 0.2).sin() * ((index / 60) as f32 * 0.3).cos());
        let ground = Terrain::new([0.0, 0.0], 0.5, 60, heights.collect()).unwrap().mesh(1.0);
        let tiles = ground.tiles(1000);
        assert_eq!(tiles.iter().map(|tile| tile.triangles.len()).sum::<usize>(), ground.triangles.len());
        for tile in &tiles {
            assert!(tile.triangles.len() <= 1000 && !tile.levels.is_empty());
            for (_, level) in &tile.levels {
                assert_eq!(outline(tile), outline(level));
            }
        }
    }

    /// Edges with one triangle, as sorted pairs of places.
    fn outline(mesh: &Mesh) -> Vec<[[u32; 3]; 2]> {
        let place = |corner: u32| mesh.positions[corner as usize].to_array().map(f32::to_bits);
        let mut edges = Vec::new();
        for &[a, b, c] in &mesh.triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let mut edge = [place(from), place(to)];
                edge.sort_unstable();
                edges.push(edge);
            }
        }
        edges.sort_unstable();
        let count = |edge: &[[u32; 3]; 2]| edges.iter().filter(|other| *other == edge).count();
        let alone = edges.clone().into_iter().filter(|edge| count(edge) == 1);
        alone.collect()
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
            mesh.tiles(16);
        }
    }
}
