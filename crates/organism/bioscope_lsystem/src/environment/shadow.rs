//! Grids of voxels: shadows that crowns throw, and counts of what is where.

use bioscope_core::Vec3;

use super::settings::{Settings, bounded};
use super::{Environment, EnvironmentError, Reply, Request};

/// Most voxels along one side, and most of all.
const SIDE: f32 = 401.0;
const MOST: usize = 64 << 20;

/// Light in voxels, each bud of a crown shading a pyramid below it.
///
/// A message `?E(s)` or `?E(s,x,y,z)` throws a shadow from here if s > 0; the answer is the light
/// here, and in x, y, z the direction in which it grows. Each step begins unshaded.
///
/// Source: W. Palubicki and others, "Self-organizing tree models for image synthesis", SIGGRAPH 2009.
#[derive(Clone, Debug)]
pub struct ShadowVoxels {
    count: usize,
    span: f32,
    spread: f32,
    depth: usize,
    weight: f32,
    dissipation: f32,
    vertical: f32,
    reach: i64,
    light: Vec<f32>,
}

impl ShadowVoxels {
    /// The field program shadowpyramid, also built in as `shadow_voxels`.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        const NAME: &str = "shadowpyramid";
        settings.check(
            NAME,
            &[
                "grid size",
                "grid span",
                "shadow spread",
                "shadow depth",
                "shadow weight",
                "shadow dissipation",
                "light randomness",
                "light vertical bias",
                "sample radius",
            ],
        )?;
        let count = settings.number(&["grid size"], 201.0);
        let count = bounded(NAME, "grid size", count, (1.0, SIDE))? as usize;
        let span = bounded(NAME, "grid span", settings.number(&["grid span"], 200.0), (1e-6, 1e6))?;
        let depth = settings.number(&["shadow depth"], 6.0);
        Ok(Self {
            count,
            span,
            spread: settings.number(&["shadow spread"], 1.0).clamp(0.0, 4.0),
            depth: bounded(NAME, "shadow depth", depth, (0.0, 100.0))? as usize,
            weight: settings.number(&["shadow weight"], 0.58),
            dissipation: settings.number(&["shadow dissipation"], 6.9).max(1e-6),
            vertical: settings.number(&["light vertical bias"], 0.0),
            reach: settings.number(&["sample radius"], 1.0).clamp(1.0, 100.0) as i64,
            light: Vec::new(),
        })
    }

    fn voxel(&self, place: Vec3) -> Option<[i64; 3]> {
        let low = Vec3::new(-self.span / 2.0, 0.0, -self.span / 2.0);
        let part = (place - low) / self.span * self.count as f32;
        let inside =
            part.cmpge(Vec3::ZERO).all() && part.cmplt(Vec3::splat(self.count as f32)).all();
        inside.then(|| part.to_array().map(|one| one as i64))
    }

    fn index(&self, voxel: [i64; 3]) -> Option<usize> {
        let count = self.count as i64;
        let inside = voxel.iter().all(|one| (0..count).contains(one));
        inside.then(|| ((voxel[1] * count + voxel[2]) * count + voxel[0]) as usize)
    }

    fn lit(&self, voxel: [i64; 3]) -> f32 {
        self.index(voxel).map_or(1.0, |index| self.light[index])
    }

    fn shade(&mut self, voxel: [i64; 3]) {
        for tier in 0..=self.depth as i64 {
            let wide = (self.spread * tier as f32).floor() as i64;
            for x in -wide..=wide {
                for z in -wide..=wide {
                    let below = [voxel[0] + x, voxel[1] - tier, voxel[2] + z];
                    let Some(index) = self.index(below) else { continue };
                    let distance = ((x * x + z * z + tier * tier) as f32).sqrt();
                    let falling = bioscope_core::math::pow(self.dissipation, -distance);
                    self.light[index] *= (1.0 - self.weight * falling).max(0.0);
                }
            }
        }
    }
}

impl Environment for ShadowVoxels {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let layer = self.count * self.count;
        self.light.clear();
        for y in 0..self.count {
            let light = 1.0 + self.vertical * (y as f32 / self.count as f32 - 0.5);
            self.light.resize(layer * (y + 1), light.max(0.0));
        }
        let voxels: Vec<_> = requests.iter().map(|request| self.voxel(request.position)).collect();
        for (request, voxel) in requests.iter().zip(&voxels) {
            if let (Some(&shadow), Some(voxel)) = (request.parameters.first(), voxel)
                && shadow > 0.0
            {
                self.shade(*voxel);
            }
        }
        for (reply, voxel) in replies.iter_mut().zip(voxels) {
            let voxel = voxel.unwrap_or([-1; 3]);
            if let Some(answer) = reply.parameters.first_mut() {
                *answer = self.lit(voxel);
            }
            if let [_, parts @ ..] = &mut *reply.parameters
                && parts.len() >= 3
            {
                for (axis, part) in parts.iter_mut().take(3).enumerate() {
                    let (mut before, mut after) = (voxel, voxel);
                    before[axis] -= self.reach;
                    after[axis] += self.reach;
                    *part = (self.lit(after) - self.lit(before)) / (2.0 * self.reach as f32);
                }
            }
        }
        Ok(())
    }

    fn forgets(&self) -> bool {
        true
    }
}

/// Amounts that messages `?E(v)` add up in voxels; the answer is the sum in the voxel so far.
///
/// The field program density3d. Each step begins empty.
#[derive(Clone, Debug)]
pub struct DensityVoxels {
    low: Vec3,
    size: Vec3,
    cells: [usize; 3],
    amounts: Vec<f32>,
}

impl DensityVoxels {
    /// The field program density3d.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        const NAME: &str = "density3d";
        settings.check(NAME, &["range", "position", "grid size"])?;
        let vector = |name: &str, usual: f32| match settings.numbers(&[name])[..] {
            [x, y, z, ..] => Vec3::new(x, y, z),
            _ => Vec3::splat(usual),
        };
        let size = vector("range", 2.0).abs().max(Vec3::splat(1e-6));
        let cells = vector("grid size", 1.0).to_array().map(|one| one.clamp(1.0, 4096.0) as usize);
        let count = cells.iter().product::<usize>();
        if count > MOST {
            return Err(EnvironmentError::Refused {
                name: NAME.into(),
                reason: format!("grid size: at most {MOST} voxels"),
            });
        }
        Ok(Self { low: vector("position", -1.0), size, cells, amounts: vec![0.0; count] })
    }
}

impl Environment for DensityVoxels {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        self.amounts.fill(0.0);
        for (request, reply) in requests.iter().zip(replies) {
            let Some(answer) = reply.parameters.first_mut() else { continue };
            let part = (request.position - self.low) / self.size;
            let cell = [0, 1, 2].map(|axis| {
                let inside = (0.0..1.0).contains(&part[axis]);
                inside.then(|| (part[axis] * self.cells[axis] as f32) as usize)
            });
            if let [Some(x), Some(y), Some(z)] = cell {
                let index = (z * self.cells[1] + y) * self.cells[0] + x;
                if let Some(amount) = self.amounts.get_mut(index) {
                    *amount += *answer;
                    *answer = *amount;
                }
            }
        }
        Ok(())
    }
}

/// How crowded it is: each part counts 1 / (1 + d²) at distance d, in the plane of x and y.
///
/// A message `?E(a)` is a source of strength a, for good; any other is a part. `?E(v,a,g)` is
/// answered with the density here without the part itself, and direction (degrees) and size of
/// its descent. The field program density.
#[derive(Clone, Debug)]
pub struct Density {
    sources: Vec<([f32; 2], f32)>,
    one_point: bool,
    vector: bool,
}

impl Density {
    /// Most sources and parts: each pair counts.
    const MOST: usize = 20_000;

    /// The field program density.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        settings.check(
            "density",
            &[
                "range",
                "position",
                "output image",
                "frame intervals",
                "quantization step",
                "gamma",
                "one point value",
                "return vector",
            ],
        )?;
        let one_point = settings.switch(&["one point value"], false);
        let vector = settings.switch(&["return vector"], false);
        Ok(Self { sources: Vec::new(), one_point, vector })
    }

    fn at(&self, parts: &[[f32; 2]], own: usize, [x, y]: [f32; 2]) -> f32 {
        let mut density = 0.0;
        for (number, part) in parts.iter().enumerate() {
            if number != own {
                let (a, b) = (x - part[0], y - part[1]);
                density += 1.0 / (1.0 + a * a + b * b);
            }
        }
        for (place, strength) in &self.sources {
            let (a, b) = (x - place[0], y - place[1]);
            density += strength / (1.0 + (a * a + b * b).sqrt());
        }
        density
    }

    /// Density at (or least around) a part, and the descent there.
    fn around(&self, parts: &[[f32; 2]], own: usize) -> (f32, [f32; 2]) {
        const SAMPLES: usize = 6;
        let [x, y] = parts[own];
        let at = |a: f32, b: f32| self.at(parts, own, [a, b]);
        if self.one_point {
            let descent = [at(x - 0.5, y) - at(x + 0.5, y), at(x, y - 0.5) - at(x, y + 0.5)];
            return (at(x, y), descent);
        }
        let offset = |index: usize| index as f32 / (SAMPLES - 1) as f32 - 0.5;
        let mut grid = [[0.0; SAMPLES]; SAMPLES];
        for (i, column) in grid.iter_mut().enumerate() {
            for (j, density) in column.iter_mut().enumerate() {
                *density = at(x + offset(i), y + offset(j));
            }
        }
        let least = grid.as_flattened().iter().copied().fold(f32::INFINITY, f32::min);
        let middle = SAMPLES / 2;
        let step = |other: f32| (other - grid[middle][middle]) / SAMPLES as f32;
        (least, [step(grid[middle - 1][middle]), step(grid[middle][middle - 1])])
    }
}

impl Environment for Density {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        if self.sources.len() + requests.len() > Self::MOST {
            return Err(EnvironmentError::Refused {
                name: "density".into(),
                reason: format!("more than {} parts and sources", Self::MOST),
            });
        }
        let mut parts = Vec::new();
        let mut asking = Vec::new();
        for (number, request) in requests.iter().enumerate() {
            let place = [request.position.x, request.position.y];
            match request.parameters {
                [strength] => self.sources.push((place, *strength)),
                parameters => {
                    if parameters.len() == 3 {
                        asking.push((number, parts.len()));
                    }
                    parts.push(place);
                }
            }
        }
        for (number, part) in asking {
            let (density, [x, y]) = self.around(&parts, part);
            let direction = bioscope_core::math::atan2(y, x).to_degrees().rem_euclid(360.0);
            let size = (x * x + y * y).sqrt();
            let direction = if size > 0.0 { direction } else { 90.0 };
            let (second, third) = if self.vector { (x, y) } else { (direction, size) };
            replies[number].parameters.copy_from_slice(&[density, second, third]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::ask;

    #[test]
    fn shadows_fall_downward_and_light_is_beside() {
        let mut shadow = ShadowVoxels::from_settings(&Settings::default()).unwrap();
        let bud = Vec3::new(0.2, 50.0, 0.2);
        let asked: [(&[f32], Vec3, Vec3); 4] = [
            (&[1.0], bud, Vec3::Y),
            (&[0.0, 0.0, 0.0, 0.0], bud - Vec3::Y * 2.0 + Vec3::X, Vec3::Y),
            (&[0.0], bud + Vec3::Y * 3.0, Vec3::Y),
            (&[0.0], bud - Vec3::Y * 20.0, Vec3::Y),
        ];
        let answers = ask(&mut shadow, &asked);
        assert!(answers[1][0] < 1.0 && answers[1][1] > 0.0, "light grows away from the bud");
        assert_eq!([answers[2][0], answers[3][0]], [1.0, 1.0]);
        assert!((answers[0][0] - (1.0 - 0.58)).abs() < 1e-6);
    }

    #[test]
    fn density_counts_neighbors() {
        let mut settings = Settings::default();
        settings.set("one point value", "on");
        let mut density = Density::from_settings(&settings).unwrap();
        let asked: [(&[f32], Vec3, Vec3); 3] = [
            (&[0.0, 0.0, 0.0], Vec3::ZERO, Vec3::Y),
            (&[0.0, 0.0], Vec3::X, Vec3::Y),
            (&[0.0, 0.0], Vec3::X * 2.0, Vec3::Y),
        ];
        let answers = ask(&mut density, &asked);
        assert!((answers[0][0] - 0.7).abs() < 1e-6, "1/2 + 1/5");
        assert!((answers[0][1] - 180.0).abs() < 1e-3, "away from the others");
        let mut voxels = DensityVoxels::from_settings(&Settings::default()).unwrap();
        let inside: (&[f32], Vec3, Vec3) = (&[2.0], Vec3::ZERO, Vec3::Y);
        assert_eq!(ask(&mut voxels, &[inside, inside]).concat(), [2.0, 4.0]);
    }
}
