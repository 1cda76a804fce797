//! Corals and sponges that are lumps, plates and tubes. All stand on the origin and are about one
//! metre wide, or high if they are slender; `detail` 0 is the finest version.

use bioscope_core::{Purpose, Random, Vec3, math};
use bioscope_geometry::{Mesh, Noise, Transform};

use crate::scenery::forms::{icosphere, tube};

const FORM: Purpose = Purpose::new("coral form");

pub(super) fn form_random(seed: u32) -> Random {
    Random::new(u64::from(seed), 1, 2, FORM)
}

/// A dome of brain coral: low, wide and a little dented; the grooves are in its texture.
pub(super) fn brain(seed: u32, detail: u32) -> Mesh {
    let noise = Noise::new(seed);
    let mut random = form_random(seed);
    let (height, lumps) = (random.range(0.55, 0.85), random.range(0.12, 0.3));
    dome(detail, 5.0, |direction| {
        let radius = 0.5 * (1.0 + lumps * noise.fractal(direction * 1.6, 2));
        direction * radius * Vec3::new(1.0, height, 1.0)
    })
}

/// A massive coral of many rounded lobes.
pub(super) fn lobes(seed: u32, detail: u32) -> Mesh {
    let noise = Noise::new(seed);
    let mut random = form_random(seed);
    let (height, coarse) = (random.range(0.7, 1.15), random.range(1.7, 2.5));
    dome(detail, 5.0, |direction| {
        let cell = noise.cell(direction * coarse + 20.0);
        let bulge = (1.0 - cell.nearest * cell.nearest * 1.5).max(0.0) * (0.6 + 0.6 * cell.random);
        let radius = 0.34 * (1.0 + 0.75 * bulge + 0.15 * noise.fractal(direction * 2.0, 2));
        direction * radius * Vec3::new(1.0, height, 1.0)
    })
}

/// A ball shaped by `surface` and sunk by a third, with texture coordinates spread from the top
/// (equal areas) so that the picture repeats `repeats` times across.
fn dome(detail: u32, repeats: f32, surface: impl Fn(Vec3) -> Vec3) -> Mesh {
    let mut mesh = icosphere(4u32.saturating_sub(detail));
    let directions = std::mem::take(&mut mesh.positions);
    for &direction in &directions {
        let point = surface(direction);
        mesh.positions.push(point + Vec3::Y * 0.06);
        // Lambert's azimuthal projection: areas stay equal, shapes nearly so on the upper half.
        let spread = 0.5 / math::sqrt((1.0 + direction.y).max(0.1));
        let u = 0.5 + direction.x * spread * 0.7;
        let v = 0.5 + direction.z * spread * 0.7;
        mesh.uvs.push([u * repeats, v * repeats]);
        let foot = 0.4 + 0.6 * math::smoothstep(-0.12, 0.3, point.y);
        mesh.colors.push([foot; 3]);
    }
    // What is below the ground is never seen.
    let low = |&index: &u32| mesh.positions[index as usize].y < -0.2;
    mesh.triangles.retain(|triangle| !triangle.iter().all(low));
    mesh.compute_normals();
    mesh
}

/// A table: a thin plate on a stalk, its rim pale, its top set with short upright branches.
pub(super) fn table(seed: u32, detail: u32) -> Mesh {
    let noise = Noise::new(seed);
    let mut random = form_random(seed);
    let rings = [9, 6, 4, 2, 1][detail.min(4) as usize];
    let sides = [40, 28, 16, 10, 7][detail.min(4) as usize];
    let height = random.range(0.13, 0.27);
    let lean = Vec3::new(random.range(-0.14, 0.14), 0.0, random.range(-0.14, 0.14));
    let plate = |share: f32, angle: f32| {
        let (x, z) = (math::sin(angle), math::cos(angle));
        let around = Vec3::new(x, 0.3, z);
        let outline = 0.46 * (1.0 + 0.28 * noise.fractal(around * 1.1, 3));
        let point = Vec3::new(x, 0.0, z) * (outline * share);
        let bowl = 0.12 * share * share + 0.05 * share * noise.fractal(around * 2.0 + share, 2);
        point + lean + Vec3::Y * (height + bowl + lean.dot(point) * 1.5)
    };
    let mut mesh = Mesh::default();
    for underside in [false, true] {
        let first = mesh.positions.len() as u32;
        for ring in 0..=rings {
            let share = ring as f32 / rings as f32;
            for side in 0..=sides {
                let point = plate(share, side as f32 / sides as f32 * math::TAU);
                let thick = if underside { 0.012 + 0.06 * (1.0 - share) } else { 0.0 };
                let rim = math::smoothstep(0.82, 1.0, share);
                let tone = if underside { 0.45 + 0.25 * share } else { 0.72 + 0.6 * rim };
                mesh.positions.push(point - Vec3::Y * thick);
                mesh.uvs.push([point.x * 5.0, point.z * 5.0]);
                mesh.colors.push([tone, tone, tone * (1.0 + 0.1 * rim)]);
            }
        }
        let row = sides as u32 + 1;
        for ring in 0..rings as u32 {
            for side in 0..sides as u32 {
                let a = first + ring * row + side;
                let (b, c, d) = (a + 1, a + row, a + row + 1);
                let faces = if underside { [[a, b, c], [b, d, c]] } else { [[a, c, b], [b, c, d]] };
                mesh.triangles.extend(faces);
            }
        }
    }
    mesh.compute_normals();
    let count = [230, 90, 0, 0, 0][detail.min(4) as usize];
    for _ in 0..count {
        let share = math::sqrt(random.uniform()) * 0.98;
        let foot = plate(share, random.range(0.0, math::TAU));
        let lean = (foot - lean - Vec3::Y * foot.y) * 0.9 + random.in_ball() * 0.3;
        let tip = foot + (Vec3::Y + lean).normalize() * random.range(0.018, 0.045);
        add_spike(&mut mesh, foot - Vec3::Y * 0.006, tip, random.range(0.008, 0.013));
    }
    let stalk: Vec<Vec3> = (0..4)
        .map(|step| {
            let share = step as f32 / 3.0;
            lean * share * share + Vec3::Y * (share * (height - 0.02) - 0.15 * (1.0 - share))
        })
        .collect();
    let tone = 0.4;
    append_toned(&mut mesh, &tube(&stalk, &[0.2, 0.11, 0.1, 0.12], 8, 0.3), [tone; 3]);
    mesh
}

/// A pointed branchlet of three sides, pale at its tip.
fn add_spike(mesh: &mut Mesh, foot: Vec3, tip: Vec3, radius: f32) {
    let axis = (tip - foot).normalize_or(Vec3::Y);
    let across = axis.any_orthonormal_vector();
    let along = axis.cross(across);
    let first = mesh.positions.len() as u32;
    for side in 0..3 {
        let angle = side as f32 * math::TAU / 3.0;
        let outward = across * math::cos(angle) + along * math::sin(angle);
        mesh.positions.push(foot + outward * radius);
        mesh.normals.push(outward);
        mesh.uvs.push([foot.x * 5.0, foot.z * 5.0]);
        mesh.colors.push([0.62; 3]);
    }
    mesh.positions.push(tip);
    mesh.normals.push(axis);
    mesh.uvs.push([foot.x * 5.0, foot.z * 5.0]);
    mesh.colors.push([1.5; 3]);
    for side in 0..3 {
        mesh.triangles.push([first + side, first + (side + 1) % 3, first + 3]);
    }
}

/// Adds a mesh in one vertex color.
pub(super) fn append_toned(mesh: &mut Mesh, other: &Mesh, tone: [f32; 3]) {
    let mut other = other.clone();
    other.colors = vec![tone; other.positions.len()];
    mesh.append(&other, &Transform::IDENTITY);
}

/// A cluster of tube sponges: each a vase with a pale lip and a dark inside.
pub(super) fn tubes(seed: u32, detail: u32) -> Mesh {
    let mut random = form_random(seed);
    let noise = Noise::new(seed);
    let sides = [18, 12, 8, 6, 4][detail.min(4) as usize];
    let steps = [12, 8, 5, 3, 2][detail.min(4) as usize];
    let count = 4 + random.below(4);
    let mut mesh = Mesh::default();
    for number in 0..count {
        let angle = (number as f32 + random.uniform() * 0.6) / count as f32 * math::TAU;
        let outward = Vec3::new(math::sin(angle), 0.0, math::cos(angle));
        let foot = outward * random.range(0.06, 0.14);
        let height = random.range(0.45, 1.0) * if number == 0 { 1.0 } else { 0.85 };
        let width = random.range(0.055, 0.095);
        let splay = random.range(0.08, 0.35);
        let path = |share: f32| {
            let bend = outward * (splay * share * share * height);
            foot + bend + Vec3::Y * (share * height - 0.08 * (1.0 - share))
        };
        let radius = |share: f32| {
            let bulge = 0.75 + 0.45 * math::smoothstep(0.0, 0.75, share);
            width * bulge * (1.0 + 0.22 * noise.fractal(path(share) * 6.0, 2))
        };
        append_vase(&mut mesh, &path, &radius, steps, sides);
    }
    mesh
}

/// One tube with a rounded lip and its inner wall.
fn append_vase(
    mesh: &mut Mesh,
    path: &dyn Fn(f32) -> Vec3,
    radius: &dyn Fn(f32) -> f32,
    steps: usize,
    sides: usize,
) {
    let outside: Vec<f32> = (0..=steps).map(|step| step as f32 / steps as f32).collect();
    let inside = [(1.012, 0.9), (1.006, 0.8), (0.97, 0.72), (0.7, 0.68), (0.5, 0.02)];
    let stations: Vec<(f32, f32)> =
        outside.iter().map(|&share| (share, 1.0)).chain(inside).collect();
    let points: Vec<Vec3> = stations.iter().map(|&(share, _)| path(share)).collect();
    let radii: Vec<f32> =
        stations.iter().map(|&(share, width)| radius(share.min(1.0)) * width).collect();
    let row = sides + 1;
    let first = mesh.positions.len() as u32;
    for (index, (&point, &radius)) in points.iter().zip(&radii).enumerate() {
        let (share, _) = stations[index];
        let tone = match index {
            _ if index < steps => 0.45 + 0.45 * share,
            _ if index <= steps + 2 => 1.15,
            _ => 0.5 - 0.44 * ((index - steps - 2) as f32 / 3.0),
        };
        for side in 0..=sides {
            let turn = side as f32 / sides as f32;
            let angle = turn * math::TAU;
            let outward = Vec3::new(math::cos(angle), 0.0, -math::sin(angle));
            mesh.positions.push(point + outward * radius);
            mesh.normals.push(if index > steps + 2 { -outward } else { outward });
            mesh.uvs.push([turn * 1.0, share * 2.0]);
            mesh.colors.push([tone; 3]);
        }
    }
    for ring in 0..(points.len() - 1) as u32 {
        for side in 0..sides as u32 {
            let a = first + ring * row as u32 + side;
            let (b, c, d) = (a + 1, a + row as u32, a + row as u32 + 1);
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
}
