//! Shapes that scenery is built from: spheres to be displaced, tubes, and their texture coordinates.

use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Quat, Vec3, math};
use bioscope_geometry::Mesh;

/// A sphere of radius 1 from an icosahedron whose faces are split `splits` times: 20 · 4^splits
/// triangles. Only positions and triangles are set.
pub(crate) fn icosphere(splits: u32) -> Mesh {
    let long = 0.5 * (1.0 + math::sqrt(5.0));
    let mut positions: Vec<Vec3> = Vec::new();
    for (a, b) in [(1.0, long), (-1.0, long), (1.0, -long), (-1.0, -long)] {
        for point in [Vec3::new(a, b, 0.0), Vec3::new(0.0, a, b), Vec3::new(b, 0.0, a)] {
            positions.push(point.normalize());
        }
    }
    let mut triangles = hull_of_icosahedron(&positions);
    for _ in 0..splits.min(7) {
        let mut middles = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        let split = |[a, b, c]: [u32; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(split).collect();
    }
    Mesh { positions, triangles, ..Mesh::default() }
}

/// The twenty faces: all triples of corners at the least distance from one another.
fn hull_of_icosahedron(corners: &[Vec3]) -> Vec<[u32; 3]> {
    let near = |a: usize, b: usize| corners[a].distance(corners[b]) < 1.2;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outward = (corners[b] - corners[a]).cross(corners[c] - corners[a]);
                    let face = if outward.dot(corners[a]) > 0.0 { [a, b, c] } else { [a, c, b] };
                    faces.push(face.map(|one| one as u32));
                }
            }
        }
    }
    faces
}

/// A tube along a path, `sides` round, with a radius at each point; u runs once round, v along the
/// path in metres divided by `texture_size`. A last radius of zero gives a pointed tip.
pub(crate) fn tube(path: &[Vec3], radii: &[f32], sides: usize, texture_size: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut length = 0.0;
    let mut frame = Quat::from_rotation_arc(Vec3::Y, direction(path, 0));
    for (index, (&point, &radius)) in path.iter().zip(radii).enumerate() {
        if index > 0 {
            length += point.distance(path[index - 1]);
            let turn = Quat::from_rotation_arc(frame * Vec3::Y, direction(path, index));
            frame = (turn * frame).normalize();
        }
        for side in 0..=sides {
            let share = side as f32 / sides as f32;
            let angle = share * math::TAU;
            let outward = frame * Vec3::new(math::cos(angle), 0.0, -math::sin(angle));
            mesh.positions.push(point + outward * radius);
            mesh.uvs.push([share, length / texture_size]);
        }
    }
    let row = sides as u32 + 1;
    for ring in 0..path.len().saturating_sub(1) as u32 {
        for side in 0..sides as u32 {
            let a = ring * row + side;
            mesh.triangles.extend([[a, a + 1, a + row], [a + 1, a + row + 1, a + row]]);
        }
    }
    mesh.compute_normals();
    close_seam(&mut mesh.normals, row as usize);
    mesh
}

/// Gives the two vertices at the seam of each ring the same normal.
fn close_seam(normals: &mut [Vec3], row: usize) {
    for ring in normals.chunks_mut(row) {
        let mean = (ring[0] + ring[row - 1]).normalize_or(ring[0]);
        ring[0] = mean;
        ring[row - 1] = mean;
    }
}

/// Unit tangent of a path at one of its points.
fn direction(path: &[Vec3], index: usize) -> Vec3 {
    let before = path[index.saturating_sub(1)];
    let after = path[(index + 1).min(path.len() - 1)];
    (after - before).normalize_or(Vec3::Y)
}

/// Wraps a repeating texture round a mesh from three sides: each triangle is seen from the axis it
/// faces most. Vertices where the side changes are doubled; normals and colors are kept.
pub(crate) fn wrap_from_three_sides(mesh: &Mesh, texture_size: f32) -> Mesh {
    let mut wrapped = Mesh::default();
    let mut doubled = BTreeMap::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
        let facing = (b - a).cross(c - a).abs();
        let axis = if facing.y >= 0.8 * facing.x.max(facing.z) {
            1
        } else if facing.x > facing.z {
            0
        } else {
            2
        };
        let corners = triangle.map(|index| {
            *doubled.entry((index, axis)).or_insert_with(|| {
                let index = index as usize;
                let point = mesh.positions[index];
                let uv = match axis {
                    0 => [point.z, -point.y],
                    1 => [point.x, point.z],
                    _ => [point.x, -point.y],
                };
                wrapped.positions.push(point);
                wrapped.normals.push(mesh.normals[index]);
                wrapped.uvs.push(uv.map(|one| one / texture_size));
                wrapped.colors.extend(mesh.colors.get(index));
                wrapped.positions.len() as u32 - 1
            })
        });
        wrapped.triangles.push(corners);
    }
    wrapped
}

/// Projected diameters in pixels below which the second, third and fourth version of a mesh serve.
const SIZES: [f32; 4] = [320.0, 110.0, 40.0, 14.0];

/// A mesh with `count` coarser versions (up to 4): `build(0)` is the finest, `build(1)` the next.
pub(crate) fn with_details(count: usize, build: impl Fn(u32) -> Mesh) -> Arc<Mesh> {
    let mut finest = build(0);
    let sizes = &SIZES[SIZES.len().saturating_sub(count)..];
    let coarser = (1..=sizes.len() as u32).map(|detail| Arc::new(build(detail)));
    finest.levels = sizes.iter().copied().zip(coarser).collect();
    Arc::new(finest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_are_closed_and_face_outward() {
        let sphere = icosphere(2);
        assert_eq!(sphere.triangles.len(), 320);
        assert_eq!(sphere.positions.len(), 162, "closed: V = 2 + F / 2");
        for triangle in &sphere.triangles {
            let [a, b, c] = triangle.map(|index| sphere.positions[index as usize]);
            assert!((b - a).cross(c - a).dot(a + b + c) > 0.0);
        }
    }

    #[test]
    fn tubes_face_outward_and_keep_their_radius() {
        let path = [Vec3::ZERO, Vec3::new(0.1, 0.5, 0.0), Vec3::new(0.4, 0.9, 0.2)];
        let mesh = tube(&path, &[0.1; 3], 6, 1.0);
        for (index, (&point, &normal)) in mesh.positions.iter().zip(&mesh.normals).enumerate() {
            let outward = point - path[index / 7];
            assert!((outward.length() - 0.1).abs() < 1e-5);
            assert!(outward.dot(normal) > 0.05, "{outward} {normal}");
        }
    }

    #[test]
    fn wrapping_keeps_triangles_and_gives_every_vertex_a_place_in_the_texture() {
        let mut sphere = icosphere(1);
        sphere.compute_normals();
        let wrapped = wrap_from_three_sides(&sphere, 0.5);
        assert_eq!(wrapped.triangles.len(), sphere.triangles.len());
        assert_eq!(wrapped.uvs.len(), wrapped.positions.len());
        assert_eq!(wrapped.normals.len(), wrapped.positions.len());
        for (a, b) in wrapped.triangles.iter().zip(&sphere.triangles) {
            for (a, b) in a.iter().zip(b) {
                assert_eq!(wrapped.positions[*a as usize], sphere.positions[*b as usize]);
            }
        }
    }
}
