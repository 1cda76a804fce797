//! Where things that stay are put: areas of ground, and what kind of ground they favor.

use std::collections::BTreeMap;

use bioscope_core::{Error, Id, Purpose, Random, Result, Vec2, Vec3, math};
use bioscope_geometry::{Noise, Terrain};
use bioscope_world::{Environment, Growth};
use serde::{Deserialize, Serialize};

/// A part of the level plane, x and z in metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Area {
    /// Everything between two corners.
    Rectangle {
        /// Least x and z.
        low: [f32; 2],
        /// Greatest x and z.
        high: [f32; 2],
    },
    /// Everything around a point.
    Disk {
        /// x and z of the point.
        center: [f32; 2],
        /// Greatest distance from it.
        radius: f32,
    },
    /// These places, one individual after the other, from the beginning again if there are more.
    Points(Vec<[f32; 2]>),
}

impl Default for Area {
    fn default() -> Self {
        Self::Rectangle { low: [-8.0, -8.0], high: [8.0, 8.0] }
    }
}

impl Area {
    /// Refuses areas without extent and coordinates that are not finite.
    pub fn check(&self) -> Result<()> {
        let good = match self {
            Self::Rectangle { low, high } => {
                (0..2).all(|side| (high[side] - low[side]).is_finite() && low[side] <= high[side])
            }
            Self::Disk { center, radius } => {
                center.iter().all(|one| one.is_finite()) && radius.is_finite() && *radius >= 0.0
            }
            Self::Points(points) => {
                !points.is_empty() && points.iter().flatten().all(|one| one.is_finite())
            }
        };
        if good {
            return Ok(());
        }
        let found: String = format!("{self:?}").chars().take(120).collect();
        Err(Error::value("area", found, "a rectangle, a disk or a list of places, in metres"))
    }

    /// Whether a place belongs to it.
    pub fn contains(&self, x: f32, z: f32) -> bool {
        match self {
            Self::Rectangle { low, high } => {
                (low[0]..=high[0]).contains(&x) && (low[1]..=high[1]).contains(&z)
            }
            Self::Disk { center, radius } => {
                Vec2::new(x - center[0], z - center[1]).length() <= *radius
            }
            Self::Points(points) => points.contains(&[x, z]),
        }
    }

    /// Whether what spreads by itself may settle here: within the area; anywhere if it is a list of places.
    pub(crate) fn is_open_at(&self, x: f32, z: f32) -> bool {
        matches!(self, Self::Points(_)) || self.contains(x, z)
    }

    /// A place uniform in the area; the `index`-th of a list.
    fn draw(&self, index: usize, random: &mut Random) -> [f32; 2] {
        match self {
            Self::Rectangle { low, high } => {
                [random.range(low[0], high[0]), random.range(low[1], high[1])]
            }
            Self::Disk { center, radius } => {
                let distance = math::sqrt(random.uniform()) * radius * 0.9999;
                let angle = random.range(0.0, math::TAU);
                [center[0] + distance * math::sin(angle), center[1] + distance * math::cos(angle)]
            }
            Self::Points(points) => points[index % points.len()],
        }
    }
}

/// The kind of ground on which something grows or lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Habitat {
    /// Where at all.
    pub area: Area,
    /// Least and greatest steepness of the ground, degrees.
    pub slope: [f32; 2],
    /// Least and greatest height of the ground, metres.
    pub height: [f32; 2],
    /// 0 (spread evenly) to 1 (only in patches).
    pub patchiness: f32,
    /// Size of a patch, metres.
    pub patch: f32,
}

impl Default for Habitat {
    fn default() -> Self {
        Self {
            area: Area::default(),
            slope: [0.0, 90.0],
            height: [-1e6, 1e6],
            patchiness: 0.0,
            patch: 3.0,
        }
    }
}

/// A place on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Site {
    pub position: Vec3,
    pub normal: Vec3,
}

/// How often a place is drawn for one individual before the best so far is taken.
const DRAWS: usize = 48;

impl Habitat {
    /// Refuses ranges that are none.
    pub fn check(&self) -> Result<()> {
        self.area.check()?;
        for (name, [low, high]) in [("slope", self.slope), ("height", self.height)] {
            if !(low.is_finite() && high.is_finite() && low <= high) {
                return Err(Error::value(name, format!("[{low}, {high}]"), "[least, greatest]"));
            }
        }
        if !(self.patch.is_finite() && self.patch > 0.0) {
            return Err(Error::value("patch", self.patch, "a positive length in metres"));
        }
        Ok(())
    }

    /// One site per individual, `room` metres (those of the list in turn) from one another where
    /// the area is large enough.
    pub(crate) fn sites(
        &self,
        ids: &[Id],
        room: &[f32],
        growth: &Growth,
        purpose: Purpose,
    ) -> Vec<Site> {
        let environment = &*growth.environment;
        let widest = room.iter().copied().fold(1e-3, f32::max);
        let mut crowd = Crowd { cell: 2.0 * widest, cells: BTreeMap::new() };
        let noise = Noise::new(growth.moment.seed as u32 ^ 0x9A7C);
        let mut sites = Vec::with_capacity(ids.len());
        for (index, &id) in ids.iter().enumerate() {
            let mut random = growth.moment.random(id, purpose);
            let radius = room[index % room.len()];
            let mut best = (f32::MIN, self.area.draw(index, &mut random));
            for _ in 0..DRAWS {
                let place = self.area.draw(index, &mut random);
                let rating = self.rating(place, environment, &noise) * crowd.room(place, radius);
                if rating > best.0 {
                    best = (rating, place);
                }
                if random.uniform() < rating {
                    break;
                }
            }
            crowd.add(best.1, radius);
            sites.push(site(best.1, environment.terrain.as_deref()));
        }
        sites
    }

    /// How well a place suits, 0 to 1.
    fn rating(&self, [x, z]: [f32; 2], environment: &Environment, noise: &Noise) -> f32 {
        let mut rating = 1.0;
        if let Some(terrain) = &environment.terrain {
            let slope = math::acos(terrain.normal(x, z).y.min(1.0)).to_degrees();
            rating *= within(slope, self.slope, 6.0);
            rating *= within(terrain.height(x, z), self.height, 0.4);
        }
        if self.patchiness > 0.0 {
            let density = noise.fractal(Vec3::new(x, 0.4 * self.patch, z) / self.patch, 2);
            let patch = math::smoothstep(-0.05, 0.35, density);
            rating *= math::mix(1.0, patch * patch, self.patchiness.min(1.0));
        }
        rating
    }
}

/// 1 inside a range, falling to 0 over `edge` outside.
fn within(value: f32, [low, high]: [f32; 2], edge: f32) -> f32 {
    let excess = (low - value).max(value - high).max(0.0);
    (1.0 - excess / edge).max(0.0)
}

pub(crate) fn site([x, z]: [f32; 2], terrain: Option<&Terrain>) -> Site {
    match terrain {
        Some(terrain) => {
            let position = Vec3::new(x, terrain.height(x, z), z);
            Site { position, normal: terrain.normal(x, z) }
        }
        None => Site { position: Vec3::new(x, 0.0, z), normal: Vec3::Y },
    }
}

/// What has been placed so far, by cells, to keep things apart.
struct Crowd {
    cell: f32,
    cells: BTreeMap<(i32, i32), Vec<(Vec2, f32)>>,
}

impl Crowd {
    fn key(&self, [x, z]: [f32; 2]) -> (i32, i32) {
        ((x / self.cell).floor() as i32, (z / self.cell).floor() as i32)
    }

    fn add(&mut self, place: [f32; 2], radius: f32) {
        self.cells.entry(self.key(place)).or_default().push((Vec2::from(place), radius));
    }

    /// 1 where nothing is near, 0 in the middle of something.
    fn room(&self, place: [f32; 2], radius: f32) -> f32 {
        let (column, row) = self.key(place);
        let near = (-1..=1).flat_map(|dx| (-1..=1).map(move |dz| (dx, dz)));
        let near = near.filter_map(|(dx, dz)| {
            self.cells.get(&(column.saturating_add(dx), row.saturating_add(dz)))
        });
        let gaps = near.flatten().map(|&(other, other_radius)| {
            other.distance(Vec2::from(place)) / (radius + other_radius).max(1e-6)
        });
        let gap = gaps.fold(1.0f32, f32::min);
        gap * gap * gap
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_hold_what_is_drawn_from_them() {
        let areas = [
            Area::Rectangle { low: [2.0, -4.0], high: [9.0, -1.0] },
            Area::Disk { center: [3.0, 3.0], radius: 2.0 },
            Area::Points(vec![[1.0, 1.0], [-2.0, 5.0]]),
        ];
        let mut random = Random::new(1, 1, 0, Purpose::new("areas"));
        for area in areas {
            for index in 0..200 {
                let [x, z] = area.draw(index, &mut random);
                assert!(area.contains(x, z), "{x} {z} not in {area:?}");
            }
        }
    }

    #[test]
    fn refuses_areas_without_extent() {
        assert!(Area::Rectangle { low: [1.0; 2], high: [0.0; 2] }.check().is_err());
        assert!(Area::Disk { center: [f32::NAN, 0.0], radius: 1.0 }.check().is_err());
        assert!(Area::Points(Vec::new()).check().is_err());
        let steep = Habitat { slope: [50.0, 10.0], ..Habitat::default() };
        assert!(steep.check().is_err());
    }
}
