//! The ground of a reef: a sandy basin, a wall of rock at its back, coral heads, a channel.

use bioscope_core::{Error, Purpose, Random, Result, Vec3, math};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{Noise, Terrain};

/// How a reef's ground is shaped. The wall rises at the back (towards −Z) and comes forward on both
/// sides, so that the basin lies open towards +Z.
///
/// ```
/// use bioscope_geometry::ReefRelief;
/// let ground = ReefRelief::default().terrain().unwrap();
/// assert!(ground.height(0.0, -16.0) > ground.height(0.0, 4.0) + 2.0);
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ReefRelief {
    /// Which of the reefs of this shape.
    pub seed: u64,
    /// Extent along x and z in metres, centered at the origin.
    pub size: [f32; 2],
    /// Distance of neighboring samples in metres.
    pub spacing: f32,
    /// Height of the sand in metres.
    pub floor: f32,
    /// Height of the reef's top in metres.
    pub crest: f32,
    /// z of the wall's foot in the middle, metres.
    pub wall: f32,
    /// Level distance from the foot to the top of the wall, metres.
    pub wall_width: f32,
    /// How far the wall comes forward at the sides, metres.
    pub embrace: f32,
    /// Roughness of rock, 0 (smooth) to 2 (rugged); 1 gives crags of about half a metre.
    pub roughness: f32,
    /// Coral heads strewn over the basin, beside those of `mounds`.
    pub bommies: u32,
    /// Coral heads at given places.
    pub mounds: Vec<Mound>,
    /// x of the sand channel that cuts the wall, metres; none for a closed wall.
    pub channel: Option<f32>,
    /// Width of the channel in metres.
    pub channel_width: f32,
    /// Height of the sand waves in metres.
    pub sand_waves: f32,
}

/// One coral head: a steep hill of rock.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mound {
    /// x and z of its middle, metres.
    pub center: [f32; 2],
    /// Radius of its foot, metres.
    pub radius: f32,
    /// Height above the sand, metres.
    pub height: f32,
}

impl Default for ReefRelief {
    fn default() -> Self {
        Self {
            seed: 1,
            size: [48.0, 44.0],
            spacing: 0.15,
            floor: -5.6,
            crest: -1.3,
            wall: -6.5,
            wall_width: 5.0,
            embrace: 7.0,
            roughness: 1.0,
            bommies: 5,
            mounds: Vec::new(),
            channel: Some(4.5),
            channel_width: 2.6,
            sand_waves: 0.07,
        }
    }
}

/// Most samples of a generated terrain.
const LARGEST: f32 = 4_000_000.0;
/// Height at which noise is cut: away from the lattice planes, where it is weak.
const OFF_LATTICE: f32 = 0.37;
const MOUND: Purpose = Purpose::new("mound");

impl ReefRelief {
    /// The ground as a heightfield; refuses what is not finite, not positive or too large.
    pub fn terrain(&self) -> Result<Terrain> {
        self.check()?;
        let samples = |extent: f32| (extent / self.spacing).ceil() as usize + 1;
        let (columns, rows) = (samples(self.size[0]), samples(self.size[1]));
        let origin = self.size.map(|extent| -0.5 * extent);
        let mounds = self.all_mounds();
        let height = |index: usize| {
            let x = origin[0] + (index % columns) as f32 * self.spacing;
            let z = origin[1] + (index / columns) as f32 * self.spacing;
            self.height(x, z, &mounds)
        };
        let heights = (0..columns * rows).into_par_iter().map(height).collect();
        Terrain::new(origin, self.spacing, columns, heights)
    }

    fn check(&self) -> Result<()> {
        let lengths = [
            ("size[0]", self.size[0]),
            ("size[1]", self.size[1]),
            ("spacing", self.spacing),
            ("wall_width", self.wall_width),
            ("channel_width", self.channel_width),
        ];
        for (name, length) in lengths {
            if !(length.is_finite() && length > 0.0) {
                return Err(Error::value(name, length, "a positive length in metres"));
            }
        }
        let cells = [self.size[0] / self.spacing, self.size[1] / self.spacing];
        if cells[0] < 2.0 || cells[1] < 2.0 || cells[0] * cells[1] > LARGEST {
            let expected = format!("two or more along each side, up to {LARGEST} in all");
            return Err(Error::value("samples", format!("{cells:?}"), expected));
        }
        if self.bommies > 1000 || self.mounds.len() > 1000 {
            return Err(Error::value("bommies", self.bommies, "up to 1000"));
        }
        Ok(())
    }

    /// The given coral heads and the strewn ones.
    fn all_mounds(&self) -> Vec<Mound> {
        let strewn = (0..self.bommies).map(|number| {
            let mut random = Random::new(self.seed, number + 1, 0, MOUND);
            let rise = (self.crest - self.floor).abs();
            let radius = random.range(0.9, 2.2);
            let x = random.range(-0.42, 0.42) * self.size[0];
            let z = random.range(self.wall + 1.0, 0.42 * self.size[1]);
            Mound { center: [x, z], radius, height: (radius * random.range(0.7, 1.2)).min(rise) }
        });
        self.mounds.iter().copied().chain(strewn).collect()
    }

    fn height(&self, x: f32, z: f32, mounds: &[Mound]) -> f32 {
        let point = Vec3::new(x, OFF_LATTICE, z);
        let noise = Noise::new(self.seed as u32);
        let sand = self.sand(point, noise);
        let wall = self.wall_height(point, noise);
        let open = self.channel_openness(point, noise);
        let mut rock = wall * (1.0 - open);
        for mound in mounds {
            rock = join(rock, mound_height(mound, point, noise), 0.35);
        }
        sand + rock + self.crags(point, rock, noise)
    }

    /// Height of the sand: a shallow basin with long, bent waves.
    fn sand(&self, point: Vec3, noise: Noise) -> f32 {
        let basin = noise.fractal(point * 0.09, 3) * 0.45;
        let bend = noise.smooth(point * 0.25 + 40.0) * 2.2;
        let crest = math::sin((point.z * 0.9 + point.x * 0.25) * 3.1 + bend * 2.0);
        let patch = 0.5 + 0.5 * noise.smooth(point * 0.17 + 80.0);
        self.floor + basin + self.sand_waves * (0.5 * crest + 0.5 * crest * crest) * patch
    }

    /// Height of the wall above the sand, before crags.
    fn wall_height(&self, point: Vec3, noise: Noise) -> f32 {
        let side = point.x / (0.5 * self.size[0]);
        let buttress = noise.ridged(Vec3::new(point.x * 0.13, 3.7, point.z * 0.05), 2) - 0.5;
        let wander = noise.fractal(point * 0.16 + 20.0, 4) * 2.0;
        let foot = self.wall + self.embrace * side * side + buttress * 4.0 + wander;
        let rise = ((foot - point.z) / self.wall_width).clamp(0.0, 1.0);
        let terraces = rise + 0.07 * math::sin(rise * 3.0 * math::TAU);
        let top = noise.fractal(point * 0.2 + 60.0, 3) * 0.9;
        (self.crest - self.floor) * math::smoothstep(-0.08, 0.95, terraces) + top * rise
    }

    /// How much the channel has washed away here, 0 to 1.
    fn channel_openness(&self, point: Vec3, noise: Noise) -> f32 {
        let Some(middle) = self.channel else { return 0.0 };
        let bend = noise.smooth(Vec3::new(0.0, 9.1, point.z * 0.13)) * 2.5;
        let edge = noise.fractal(point * 0.5 + 11.0, 2) * 0.6;
        let across = (point.x - middle - bend).abs() / (0.5 * self.channel_width) + edge;
        1.0 - math::smoothstep(0.7, 2.0, across)
    }

    /// Crags and holes where there is rock.
    fn crags(&self, point: Vec3, rock: f32, noise: Noise) -> f32 {
        let share = math::smoothstep(0.08, 1.2, rock) * self.roughness;
        if share <= 0.0 {
            return 0.0;
        }
        let large = noise.ridged(point * 0.55 + 5.0, 3) - 0.55;
        let knobs = 0.5 - noise.cell(point * 1.1 + 7.0).nearest;
        let small = noise.fractal(point * 2.3, 3);
        share * (0.75 * large + 0.32 * knobs + 0.13 * small)
    }
}

/// Height of a coral head above the sand: a dome with steep flanks and a lobed outline.
fn mound_height(mound: &Mound, point: Vec3, noise: Noise) -> f32 {
    let offset = point - Vec3::new(mound.center[0], OFF_LATTICE, mound.center[1]);
    let lobes = 1.0 + 0.3 * noise.fractal(point * 0.7 + 31.0, 3);
    let distance = offset.length() / (mound.radius.max(1e-3) * lobes.max(0.4));
    let squared = distance * distance;
    mound.height * (1.0 - squared * squared).max(0.0)
}

/// The greater of two heights, rounded where they meet within `width` metres.
fn join(a: f32, b: f32, width: f32) -> f32 {
    let gap = (width - (a - b).abs()).max(0.0);
    a.max(b) + if a.min(b) > 0.0 { gap * gap / (4.0 * width) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn has_a_basin_a_wall_a_channel_and_its_mounds() {
        let relief = ReefRelief {
            mounds: vec![Mound { center: [-3.0, 3.0], radius: 1.5, height: 1.4 }],
            bommies: 0,
            ..ReefRelief::default()
        };
        let ground = relief.terrain().unwrap();
        let basin = ground.height(2.0, 8.0);
        assert!((basin - relief.floor).abs() < 1.0, "{basin}");
        assert!(ground.height(-3.0, 3.0) > basin + 0.9);
        let row = |z: f32| (-40..=40).map(move |x| ground.height(x as f32 * 0.5, z));
        let along_crest: Vec<f32> = row(-17.0).collect();
        let highest = along_crest.iter().fold(f32::MIN, |a, &b| a.max(b));
        let lowest = along_crest.iter().fold(f32::MAX, |a, &b| a.min(b));
        assert!(highest > relief.crest - 1.0 && highest < relief.crest + 2.0, "{highest}");
        assert!(lowest < relief.floor + 1.5, "no channel: {lowest}");
    }

    #[test]
    fn equal_seeds_give_equal_ground_and_others_differ() {
        let relief = |seed| ReefRelief { seed, spacing: 0.5, ..ReefRelief::default() };
        assert_eq!(relief(4).terrain().unwrap(), relief(4).terrain().unwrap());
        assert_ne!(relief(4).terrain().unwrap(), relief(5).terrain().unwrap());
    }

    #[test]
    fn refuses_what_is_no_ground_or_too_much_of_it() {
        let refused = |relief: ReefRelief| relief.terrain().is_err();
        assert!(refused(ReefRelief { spacing: 1e-6, ..ReefRelief::default() }));
        assert!(refused(ReefRelief { spacing: f32::NAN, ..ReefRelief::default() }));
        assert!(refused(ReefRelief { size: [-4.0, 4.0], ..ReefRelief::default() }));
        assert!(refused(ReefRelief { crest: f32::INFINITY, ..ReefRelief::default() }));
        assert!(refused(ReefRelief { bommies: u32::MAX, ..ReefRelief::default() }));
    }
}
