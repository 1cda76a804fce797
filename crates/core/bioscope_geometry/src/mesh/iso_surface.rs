//! The surface in space on which a field of numbers has one value.

use bioscope_core::Vec3;

use super::Mesh;

/// What a cube without a vertex says.
const NONE: u32 = u32::MAX;

/// The surface on which numbers given at points of a grid have the value `level`, by surface nets: one vertex in
/// each cube of eight neighboring points that do not all lie on one side, at the mean of the places where the
/// cube's edges cross the surface. Point (x, y, z) of the grid is at (x, y, z); x runs first in `values`, then
/// y, then z. The surface looks to where the numbers are less, and is open where it meets the grid's border.
///
/// Source: S. F. F. Gibson, "Constrained elastic surface nets", MICCAI 1998, without the relaxation.
///
/// # Panics
///
/// If there are not as many values as points.
pub fn iso_surface(size: [usize; 3], values: &[f32], level: f32) -> Mesh {
    assert_eq!(values.len(), size.iter().product(), "values of a grid");
    let mut mesh = Mesh::default();
    if size.iter().any(|&count| count < 2) {
        return mesh;
    }
    let grid = Grid { size, values, level };
    let mut vertices = vec![NONE; values.len()];
    for at in points([0; 3], size.map(|count| count - 1)) {
        if let Some(vertex) = grid.vertex(at) {
            vertices[grid.index(at)] = mesh.positions.len() as u32;
            mesh.positions.push(vertex);
        }
    }
    for axis in 0..3 {
        grid.walls(axis, &vertices, &mut mesh.triangles);
    }
    mesh.compute_normals();
    mesh
}

struct Grid<'a> {
    size: [usize; 3],
    values: &'a [f32],
    level: f32,
}

/// The points from one corner of a box to before the other, x first.
fn points(first: [usize; 3], last: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    let line = move |y: usize, z: usize| (first[0]..last[0]).map(move |x| [x, y, z]);
    (first[2]..last[2]).flat_map(move |z| (first[1]..last[1]).flat_map(move |y| line(y, z)))
}

impl Grid<'_> {
    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    fn is_inside(&self, at: [usize; 3]) -> bool {
        self.values[self.index(at)] >= self.level
    }

    /// The vertex in the cube between a point and the next in all three directions.
    fn vertex(&self, at: [usize; 3]) -> Option<Vec3> {
        let corner = |number: usize| [0, 1, 2].map(|axis| at[axis] + (number >> axis & 1));
        let values: [f32; 8] =
            std::array::from_fn(|number| self.values[self.index(corner(number))]);
        let inside = values.map(|value| value >= self.level);
        if inside == [inside[0]; 8] {
            return None;
        }
        let (mut sum, mut count) = (Vec3::ZERO, 0.0);
        for first in 0..8 {
            for axis in 0..3 {
                let second = first | 1 << axis;
                if second == first || inside[first] == inside[second] {
                    continue;
                }
                let share = (self.level - values[first]) / (values[second] - values[first]);
                let mut place = Vec3::from_array(corner(first).map(|one| one as f32));
                place[axis] += if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
                sum += place;
                count += 1.0;
            }
        }
        Some(sum / count)
    }

    /// Two triangles across each edge along `axis` that crosses the surface, between the vertices of the four
    /// cubes around it.
    fn walls(&self, axis: usize, vertices: &[u32], triangles: &mut Vec<[u32; 3]>) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (mut first, mut last) = ([1; 3], self.size.map(|count| count - 1));
        first[axis] = 0;
        last[axis] = self.size[axis] - 1;
        for at in points(first, last) {
            let mut next = at;
            next[axis] += 1;
            let inside = self.is_inside(at);
            if inside == self.is_inside(next) {
                continue;
            }
            let cube = |back_u: usize, back_v: usize| {
                let mut cube = at;
                cube[u] -= back_u;
                cube[v] -= back_v;
                vertices[self.index(cube)]
            };
            let [a, b, c, d] = [cube(1, 1), cube(0, 1), cube(0, 0), cube(1, 0)];
            if [a, b, c, d].contains(&NONE) {
                continue;
            }
            let faces = if inside { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
            triangles.extend(faces);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn a_ball_is_closed_smooth_and_looks_outward() {
        let size = [24, 26, 28];
        let center = Vec3::new(11.3, 12.6, 13.1);
        let value = |at: [usize; 3]| -Vec3::from_array(at.map(|one| one as f32)).distance(center);
        let values: Vec<f32> = points([0; 3], size).map(value).collect();
        let mesh = iso_surface(size, &values, -8.0);
        assert!(mesh.positions.len() > 500);
        for (place, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let outward = *place - center;
            assert!((outward.length() - 8.0).abs() < 0.12, "{}", outward.length());
            assert!(outward.normalize().dot(*normal) > 0.97);
        }
        let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for [a, b, c] in &mesh.triangles {
            for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
                *edges.entry([from.min(to), from.max(to)]).or_default() +=
                    if from < to { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|&sum| sum == 0), "each edge is walked both ways");
    }

    #[test]
    fn odd_fields_give_no_nonsense() {
        assert!(iso_surface([0, 3, 3], &[], 0.0).triangles.is_empty());
        assert!(iso_surface([2, 2, 1], &[0.0, 1.0, 1.0, 0.0], 0.5).triangles.is_empty());
        let values = [f32::NAN, f32::INFINITY, 1.0, 0.0, f32::NEG_INFINITY, 2.0, 0.5, 0.5];
        let mesh = iso_surface([2, 2, 2], &values, 0.5);
        assert!(mesh.positions.iter().all(|place| place.is_finite()));
    }
}
