//! Corals that are branches: bushes, fans and whips. Conventions as for the massive ones.

use bioscope_core::{Quat, Random, Vec3, math};
use bioscope_geometry::{Mesh, Noise};

use super::massive::{append_toned, form_random};
use crate::scenery::forms::tube;

/// A bush of staghorn coral: forking branches that grow upward and apart, pale at their tips.
pub(super) fn bush(seed: u32, detail: u32) -> Mesh {
    let mut random = form_random(seed);
    let mut mesh = Mesh::default();
    let stems = 5 + random.below(4);
    for stem in 0..stems {
        let angle = (stem as f32 + random.uniform()) / stems as f32 * math::TAU;
        let lean = random.range(0.25, 1.0);
        let heading = Vec3::new(math::sin(angle) * lean, 1.0, math::cos(angle) * lean).normalize();
        let branch = Branch {
            foot: Vec3::new(math::sin(angle), 0.0, math::cos(angle)) * 0.05 - Vec3::Y * 0.05,
            heading,
            length: random.range(0.26, 0.38),
            radius: random.range(0.024, 0.032),
            order: 0,
        };
        branch.grow(&mut mesh, &mut random, detail);
    }
    mesh
}

struct Branch {
    foot: Vec3,
    heading: Vec3,
    length: f32,
    radius: f32,
    order: u32,
}

impl Branch {
    /// Adds itself and its forks.
    fn grow(&self, mesh: &mut Mesh, random: &mut Random, detail: u32) {
        let sides = [5, 4, 3, 3, 3][detail.min(4) as usize];
        let steps = [4, 3, 2, 1, 1][detail.min(4) as usize];
        let last = self.order >= 3;
        let bend = random.in_ball() * 0.25 + Vec3::Y * 0.3;
        let mut path = Vec::with_capacity(steps + 2);
        let mut radii = Vec::with_capacity(steps + 2);
        for step in 0..=steps {
            let share = step as f32 / steps as f32;
            path.push(self.at(share, bend));
            radii.push(self.radius * (1.0 - 0.35 * share));
        }
        let tip = self.at(1.0, bend);
        path.push(tip + (tip - self.at(0.9, bend)).normalize_or(Vec3::Y) * self.radius * 0.8);
        radii.push(self.radius * 0.12);
        let mut own = tube(&path, &radii, sides, 0.12);
        let row = sides + 1;
        let order = self.order as f32;
        own.colors = (0..own.positions.len())
            .map(|index| {
                let along = (index / row) as f32 / (path.len() - 1) as f32;
                let pale = if last { math::smoothstep(0.45, 1.0, along) } else { 0.0 };
                let tone = 0.42 + 0.13 * (order + along) + 0.75 * pale;
                [tone, tone, tone * (1.0 + 0.12 * pale)]
            })
            .collect();
        mesh.append(&own, &bioscope_geometry::Transform::IDENTITY);
        if last || (detail >= 3 && self.order >= 2) || (detail >= 4 && self.order >= 1) {
            return;
        }
        let forks = if self.order == 0 { 3 } else { 2 + random.below(2) };
        for fork in 0..forks {
            let share = if fork == 0 { 0.97 } else { random.range(0.45, 0.95) };
            let foot = self.at(share, bend);
            let apart = random.direction() * random.range(0.5, 0.95);
            let heading = (self.heading + bend * share * 0.7 + apart + Vec3::Y * 0.25).normalize();
            Self {
                foot,
                heading,
                length: self.length * random.range(0.6, 0.86),
                radius: self.radius * random.range(0.66, 0.8),
                order: self.order + 1,
            }
            .grow(mesh, random, detail);
        }
    }

    fn at(&self, share: f32, bend: Vec3) -> Vec3 {
        self.foot + (self.heading * share + bend * (0.5 * share * share)) * self.length
    }
}

/// A sea fan: a bent sheet for the cut-out net, across the local Z axis, on a short stem.
pub(super) fn fan(seed: u32, detail: u32) -> Mesh {
    let noise = Noise::new(seed);
    let cells = [12, 8, 5, 3, 2][detail.min(4) as usize];
    let mut mesh = Mesh::default();
    for row in 0..=cells {
        let up = row as f32 / cells as f32;
        for column in 0..=cells {
            let across = column as f32 / cells as f32;
            let x = (across - 0.5) * 1.15;
            let curl = 0.35 * x * x + 0.07 * noise.fractal(Vec3::new(x, up, 0.4) * 2.2, 2);
            mesh.positions.push(Vec3::new(x, up * 1.05, curl * (0.3 + up)));
            mesh.uvs.push([across, 1.0 - up]);
            mesh.colors.push([0.75 + 0.4 * up; 3]);
        }
    }
    let width = cells as u32 + 1;
    for row in 0..cells as u32 {
        for column in 0..cells as u32 {
            let a = row * width + column;
            mesh.triangles.extend([[a, a + 1, a + width], [a + 1, a + width + 1, a + width]]);
        }
    }
    mesh.compute_normals();
    mesh
}

/// Sea whips: a sheaf of long bent rods.
pub(super) fn whips(seed: u32, detail: u32) -> Mesh {
    let mut random = form_random(seed);
    let sides = [6, 5, 4, 3, 3][detail.min(4) as usize];
    let steps = [14, 9, 6, 4, 3][detail.min(4) as usize];
    let mut mesh = Mesh::default();
    let count = 6 + random.below(6);
    for _ in 0..count {
        let angle = random.range(0.0, math::TAU);
        let turn = Quat::from_rotation_y(angle);
        let height = random.range(0.5, 1.05);
        let (splay, swing) = (random.range(0.1, 0.45), random.range(-0.06, 0.06));
        let foot = turn * Vec3::Z * random.range(0.01, 0.05);
        let path: Vec<Vec3> = (0..=steps)
            .map(|step| {
                let share = step as f32 / steps as f32;
                let side = swing * math::sin(share * 7.0);
                let out = splay * math::pow(share, 0.7) * (1.0 - 0.35 * share);
                foot + turn * Vec3::new(side, share - 0.04, out) * height
            })
            .collect();
        let radii: Vec<f32> =
            (0..=steps).map(|step| 0.011 * (1.0 - 0.55 * step as f32 / steps as f32)).collect();
        let tone = random.range(0.8, 1.1);
        append_toned(&mut mesh, &tube(&path, &radii, sides, 0.1), [tone; 3]);
    }
    mesh
}
