//! Levels of detail for what is too large to have one level all over: ground, reef walls.
//!
//! The mesh is cut in two again and again. Each piece is simplified on its own, from its halves'
//! results, and the vertices that it shares with its surroundings stay. So any choice of pieces that
//! covers the mesh once fits together without gaps, and the seams inside a piece are simplified with it.

use glam::Vec3;

use super::{
    Mesh,
    simplify::{Simplifier, weld},
};

/// A piece of a mesh at one level of detail.
#[derive(Clone, Debug)]
pub(crate) struct Tile {
    pub mesh: Mesh,
    /// Corners of the box round the piece; it holds the boxes of the pieces that it replaces.
    pub corners: [Vec3; 2],
    /// Greatest distance from the true shape, metres; never less than that of the pieces it replaces.
    pub error: f32,
    /// Number of the coarser tile that replaces this one together with its sibling.
    pub parent: Option<usize>,
}

/// The original mesh while it is cut.
struct Ground<'a> {
    mesh: &'a Mesh,
    /// Middle and vertices of each triangle, in the order of the tree's leaves.
    triangles: &'a [(Vec3, [u32; 3])],
    /// First and last place in that order of the triangles at each vertex's place.
    spans: Vec<[usize; 2]>,
    size: usize,
}

/// A tile in the making, with vertices numbered as in the original mesh.
struct Piece {
    triangles: Vec<[u32; 3]>,
    corners: [Vec3; 2],
    error: f32,
    halves: Option<Box<[Piece; 2]>>,
}

impl Mesh {
    /// All pieces of the mesh at all levels of detail; the finest have at most `size` triangles each. The
    /// first tile replaces all others. Skins are not for tiles.
    pub(crate) fn tiles(&self, size: usize) -> Vec<Tile> {
        let middle = |triangle: &[u32; 3]| {
            triangle.iter().map(|&corner| self.positions[corner as usize]).sum::<Vec3>() / 3.0
        };
        let places = self.triangles.iter().map(|triangle| (middle(triangle), *triangle));
        let mut triangles: Vec<_> = places.filter(|(place, _)| place.is_finite()).collect();
        if triangles.is_empty() {
            return Vec::new();
        }
        let size = size.max(16);
        sort(&mut triangles, size);
        let spans = self.spans(&triangles);
        let ground = Ground { mesh: self, triangles: &triangles, spans, size };
        let mut tiles = Vec::new();
        ground.enter(&ground.piece(0, triangles.len()), None, &mut tiles);
        tiles
    }

    fn spans(&self, triangles: &[(Vec3, [u32; 3])]) -> Vec<[usize; 2]> {
        let (nodes, places) = weld(&self.positions);
        let mut spans = vec![[usize::MAX, 0]; places.len()];
        for (number, (_, triangle)) in triangles.iter().enumerate() {
            for &corner in triangle {
                let [first, last] = &mut spans[nodes[corner as usize] as usize];
                *first = number.min(*first);
                *last = number.max(*last);
            }
        }
        nodes.iter().map(|&node| spans[node as usize]).collect()
    }
}

/// Sorts triangles so that halves, halves of halves and so on down to `size` lie apart.
fn sort(triangles: &mut [(Vec3, [u32; 3])], size: usize) {
    if triangles.len() <= size {
        return;
    }
    let [low, high] = bounds(triangles.iter().map(|&(place, _)| place));
    let axis = (high - low).max_position();
    let middle = triangles.len() / 2;
    triangles.select_nth_unstable_by(middle, |(a, first), (b, second)| {
        a[axis].total_cmp(&b[axis]).then(first.cmp(second))
    });
    let (left, right) = triangles.split_at_mut(middle);
    sort(left, size);
    sort(right, size);
}

fn bounds(points: impl Iterator<Item = Vec3>) -> [Vec3; 2] {
    points.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], point| {
        [low.min(point), high.max(point)]
    })
}

impl Ground<'_> {
    /// The piece of the triangles from `first` up to `last`.
    fn piece(&self, first: usize, last: usize) -> Piece {
        let triangles = &self.triangles[first..last];
        if triangles.len() <= self.size {
            let triangles: Vec<_> = triangles.iter().map(|&(_, triangle)| triangle).collect();
            let places =
                triangles.iter().flatten().map(|&corner| self.mesh.positions[corner as usize]);
            let corners = bounds(places);
            return Piece { triangles, corners, error: 0.0, halves: None };
        }
        let middle = first + triangles.len() / 2;
        let (left, right) = rayon::join(|| self.piece(first, middle), || self.piece(middle, last));
        let corners = bounds([left.corners, right.corners].into_iter().flatten());
        let all = [left.triangles.as_slice(), &right.triangles].concat();
        let (mesh, kept) = self.mesh.part(&all);
        let outside = |vertex: usize| {
            let [from, to] = self.spans[kept[vertex]];
            from < first || to >= last
        };
        let mut simplifier = Simplifier::new(&mesh, outside);
        simplifier.reduce(all.len() / 2);
        let original = |triangle: [u32; 3]| triangle.map(|corner| kept[corner as usize] as u32);
        Piece {
            triangles: simplifier.triangles().into_iter().map(original).collect(),
            corners,
            error: left.error.max(right.error) + simplifier.error,
            halves: Some(Box::new([left, right])),
        }
    }

    /// Adds a piece and all it replaces.
    fn enter(&self, piece: &Piece, parent: Option<usize>, tiles: &mut Vec<Tile>) {
        let number = tiles.len();
        let mesh = self.mesh.part(&piece.triangles).0;
        tiles.push(Tile { mesh, corners: piece.corners, error: piece.error, parent });
        for half in piece.halves.iter().flat_map(|halves| halves.iter()) {
            self.enter(half, Some(number), tiles);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Terrain;

    fn ground() -> Mesh {
        let height =
            |index: usize| ((index % 60) as f32 * 0.2).sin() * ((index / 60) as f32 * 0.3).cos();
        let heights = (0..3600).map(height).collect();
        Terrain::new([0.0, 0.0], 0.5, 60, heights).unwrap().mesh(1.0)
    }

    /// Edges as pairs of places, with the number of triangles that have them.
    fn edges(meshes: &[&Mesh]) -> Vec<([[u32; 3]; 2], usize)> {
        let mut edges = Vec::new();
        for mesh in meshes {
            let place = |corner: u32| mesh.positions[corner as usize].to_array().map(f32::to_bits);
            for &[a, b, c] in &mesh.triangles {
                for [from, to] in [[a, b], [b, c], [c, a]] {
                    let mut edge = [place(from), place(to)];
                    edge.sort_unstable();
                    edges.push(edge);
                }
            }
        }
        edges.sort_unstable();
        let runs = edges.chunk_by(|a, b| a == b);
        runs.map(|run| (run[0], run.len())).collect()
    }

    #[test]
    fn any_choice_of_tiles_fits_together() {
        let tiles = ground().tiles(500);
        assert!(tiles[0].mesh.triangles.len() < 500, "{}", tiles[0].mesh.triangles.len());
        for allowed in [0.0, 0.02, 0.05, 0.1, 0.2] {
            let chosen = |tile: &&Tile| {
                tile.error <= allowed
                    && tile.parent.is_none_or(|parent| tiles[parent].error > allowed)
            };
            let meshes: Vec<_> = tiles.iter().filter(chosen).map(|tile| &tile.mesh).collect();
            let place = |bits: [u32; 3]| Vec3::from(bits.map(f32::from_bits));
            let rim = |point: Vec3| {
                point.x <= 0.0 || point.z <= 0.0 || point.x >= 29.5 || point.z >= 29.5
            };
            for ([from, to], count) in edges(&meshes) {
                let on_rim = rim(place(from)) && rim(place(to));
                assert!(
                    count == 2 || (count == 1 && on_rim),
                    "{allowed}: {count} triangles at an edge"
                );
            }
        }
    }

    #[test]
    fn coarser_tiles_hold_and_exceed_finer_ones() {
        let tiles = ground().tiles(500);
        for tile in &tiles {
            let Some(parent) = tile.parent.map(|parent| &tiles[parent]) else { continue };
            assert!(tile.corners[0].cmpge(parent.corners[0]).all());
            assert!(tile.corners[1].cmple(parent.corners[1]).all());
            assert!(parent.error >= tile.error);
        }
    }
}
