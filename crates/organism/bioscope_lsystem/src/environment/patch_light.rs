//! Light on the ground in patches, under leaves that shade it.

use std::collections::BTreeMap;

use bioscope_core::state;
use serde::{Deserialize, Serialize};

use super::settings::{Settings, bounded};
use super::{Environment, EnvironmentError, Reply, Request};

/// Most leaves at once.
const MOST: usize = 2_000_000;

/// Light that varies from place to place, and level leaves above the ground.
///
/// | message | means |
/// |---|---|
/// | `?E(0,x)` or `?E(x)` | how much light is here? x becomes the answer |
/// | `?E(1,r)` | a leaf of radius r is born here |
/// | `?E(2,r)` | the leaf of radius r here dies |
///
/// Births and deaths of a step count before its questions. Outside the map it is dark.
///
/// Source: R. Měch and P. Prusinkiewicz, SIGGRAPH 1996, section 4.2; the field program clover.
#[derive(Clone, Debug)]
pub struct PatchLight {
    map: LightMap,
    /// Share of the light that each leaf lets through.
    transmittance: f32,
    /// Whether messages give the areas of leaves, not their radii (clover).
    areas: bool,
    /// The two axes of the ground.
    plane: [usize; 2],
    leaves: BTreeMap<[i32; 2], Vec<Leaf>>,
    count: usize,
    cell: f32,
    largest: f32,
}

/// Light by place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightMap {
    /// Lowest corner.
    pub low: [f32; 2],
    /// Width and height.
    pub size: [f32; 2],
    /// Columns and rows.
    pub cells: [usize; 2],
    /// Light from 0 to 1, rows from the lowest on.
    pub light: Vec<f32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Leaf {
    place: [f32; 2],
    radius: f32,
}

impl LightMap {
    /// Full light on a square of this width around the origin.
    pub fn bright(width: f32) -> Self {
        Self { low: [-width / 2.0; 2], size: [width; 2], cells: [1, 1], light: vec![1.0] }
    }

    /// Light that a function gives, at the middles of cells of a square around the origin.
    pub fn painted(width: f32, cells: usize, light: impl Fn(f32, f32) -> f32) -> Self {
        let step = width / cells as f32;
        let middle = |index: usize| (index as f32 + 0.5) * step - width / 2.0;
        let all = (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column)));
        let light = all.map(|(row, column)| light(middle(column), middle(row)).clamp(0.0, 1.0));
        let light = light.collect();
        Self { low: [-width / 2.0; 2], size: [width; 2], cells: [cells; 2], light }
    }

    /// The patches of the clonal plant: II at (18, 18), I at (−16, −16), poor light between.
    pub fn three_patches() -> Self {
        Self::painted(60.0, 240, |x, y| {
            let near = |a: f32, b: f32, radius: f32| (x - a).hypot(y - b) < radius;
            if near(18.0, 18.0, 10.0) {
                0.6
            } else if near(-16.0, -16.0, 13.0) {
                1.0
            } else {
                0.3
            }
        })
    }

    fn at(&self, place: [f32; 2]) -> f32 {
        let cell = [0, 1].map(|axis| {
            let share = (place[axis] - self.low[axis]) / self.size[axis];
            let inside = (0.0..1.0).contains(&share);
            inside.then(|| ((share * self.cells[axis] as f32) as usize).min(self.cells[axis] - 1))
        });
        match cell {
            [Some(column), Some(row)] => {
                self.light.get(row * self.cells[0] + column).copied().unwrap_or(0.0)
            }
            _ => 0.0,
        }
    }
}

impl PatchLight {
    /// Light of this map, under leaves that let through this share.
    pub fn new(map: LightMap, transmittance: f32) -> Self {
        Self {
            map,
            transmittance,
            areas: false,
            plane: [0, 1],
            leaves: BTreeMap::new(),
            count: 0,
            cell: 1.0,
            largest: 0.0,
        }
    }

    /// The built-in process `patch_light map=patches`; without a map the whole field of `width` is bright.
    pub fn from_settings(settings: &Settings) -> Result<Self, EnvironmentError> {
        const NAME: &str = "patch_light";
        settings.check(NAME, &["map", "width", "tau", "transmittance"])?;
        let width = bounded(NAME, "width", settings.number(&["width"], 60.0), (1e-3, 1e6))?;
        let map = match settings.get(&["map"]) {
            Some("patches") => LightMap::three_patches(),
            None => LightMap::bright(width),
            Some(other) => {
                return Err(EnvironmentError::Refused {
                    name: NAME.into(),
                    reason: format!("map = {other}: expected 'patches', or a map given as numbers"),
                });
            }
        };
        let tau = settings.number(&["tau", "transmittance"], 0.0);
        Ok(Self::new(map, bounded(NAME, "tau", tau, (0.0, 1.0))?))
    }

    /// The field program clover; its picture, if it has one, must be given as a map.
    pub fn clover(
        settings: &Settings,
        picture: Option<LightMap>,
    ) -> Result<Self, EnvironmentError> {
        const NAME: &str = "clover";
        settings.check(
            NAME,
            &[
                "grid size",
                "grid position",
                "grid range",
                "transmittance",
                "input image",
                "remove old leaves",
                "z is up",
            ],
        )?;
        let pair = |name: &str, usual: [f32; 2]| match settings.numbers(&[name])[..] {
            [x, y, ..] => [x, y],
            _ => usual,
        };
        let mut map = picture.unwrap_or_else(|| LightMap::bright(2.0));
        map.low = pair("grid position", [-1.0; 2]);
        map.size = pair("grid range", [2.0; 2]).map(|size| size.abs().max(1e-6));
        let tau = settings.number(&["transmittance"], 0.6);
        let tau = bounded(NAME, "transmittance", tau, (0.0, 1.0))?;
        let up = settings.switch(&["z is up"], true);
        let plane = if up { [0, 1] } else { [0, 2] };
        Ok(Self { areas: true, plane, ..Self::new(map, tau) })
    }

    /// Number of leaves now.
    pub fn leaves(&self) -> usize {
        self.count
    }

    fn key(&self, place: [f32; 2]) -> [i32; 2] {
        place.map(|part| (part / self.cell).floor() as i32)
    }

    fn leaf(&self, request: &Request) -> Option<Leaf> {
        let size = request.parameters.get(1).copied().filter(|size| size.is_finite())?;
        let radius = if self.areas { (size.max(0.0) / std::f32::consts::PI).sqrt() } else { size };
        Some(Leaf { place: self.plane.map(|axis| request.position[axis]), radius })
    }

    fn born(&mut self, leaf: Leaf) -> Result<(), EnvironmentError> {
        if self.count >= MOST {
            return Err(EnvironmentError::Refused {
                name: "patch_light".into(),
                reason: format!("more than {MOST} leaves"),
            });
        }
        self.largest = self.largest.max(leaf.radius);
        if leaf.radius > 4.0 * self.cell {
            // Sort anew, so that few cells hold what shades a point.
            self.cell = leaf.radius;
            let all: Vec<Leaf> = std::mem::take(&mut self.leaves).into_values().flatten().collect();
            for one in all {
                self.leaves.entry(self.key(one.place)).or_default().push(one);
            }
        }
        self.leaves.entry(self.key(leaf.place)).or_default().push(leaf);
        self.count += 1;
        Ok(())
    }

    /// Removes the leaf nearest to this one, within a thousandth of its radius.
    fn dies(&mut self, leaf: Leaf) {
        const NEAR: f32 = 1e-3;
        let reach = NEAR * leaf.radius.max(1e-3);
        let from = self.key(leaf.place.map(|part| part - reach));
        let to = self.key(leaf.place.map(|part| part + reach));
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                let Some(leaves) = self.leaves.get_mut(&[x, y]) else { continue };
                let same = |one: &Leaf| {
                    let [a, b] = [0, 1].map(|axis| (one.place[axis] - leaf.place[axis]).abs());
                    a.max(b) <= reach && (one.radius - leaf.radius).abs() <= reach
                };
                if let Some(index) = leaves.iter().position(same) {
                    leaves.remove(index);
                    self.count -= 1;
                    return;
                }
            }
        }
    }

    fn light(&self, place: [f32; 2]) -> f32 {
        let mut light = self.map.at(place);
        let from = self.key(place.map(|part| part - self.largest));
        let to = self.key(place.map(|part| part + self.largest));
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                for leaf in self.leaves.get(&[x, y]).into_iter().flatten() {
                    let [a, b] = [0, 1].map(|axis| leaf.place[axis] - place[axis]);
                    if a * a + b * b < leaf.radius * leaf.radius {
                        light *= self.transmittance;
                    }
                }
                if light == 0.0 {
                    return 0.0;
                }
            }
        }
        light
    }
}

impl Environment for PatchLight {
    fn exchange(
        &mut self,
        _step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        let kind = |request: &Request| match request.parameters {
            [_] => Some(0),
            [kind, ..] => Some(*kind as i32),
            [] => None,
        };
        for request in requests {
            let leaf = self.leaf(request).filter(|leaf| leaf.radius > 0.0);
            match (kind(request), leaf) {
                (Some(1), Some(leaf)) => self.born(leaf)?,
                (Some(2), Some(leaf)) => self.dies(leaf),
                _ => {}
            }
        }
        for (request, reply) in requests.iter().zip(replies) {
            let place = self.plane.map(|axis| request.position[axis]);
            if kind(request) == Some(0) {
                let answer = if self.areas { 0 } else { reply.parameters.len().min(2) - 1 };
                reply.parameters[answer] = self.light(place);
            }
        }
        Ok(())
    }

    fn memory(&self) -> bioscope_core::Result<Vec<u8>> {
        Ok(state::to_bytes(&(&self.leaves, self.count, self.cell, self.largest)))
    }

    fn recall(&mut self, memory: &[u8]) -> bioscope_core::Result<()> {
        (self.leaves, self.count, self.cell, self.largest) =
            state::from_bytes("leaves over the ground", memory)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use bioscope_core::Vec3;

    use super::*;
    use crate::environment::ask;

    #[test]
    fn leaves_are_born_before_questions_and_shade_until_they_die() {
        let mut light = PatchLight::new(LightMap::three_patches(), 0.0);
        let here = Vec3::new(-16.0, -16.0, 0.0);
        let far = Vec3::new(18.0, 18.0, 0.0);
        let asked: [(&[f32], Vec3, Vec3); 3] = [
            (&[0.0, 9.0], here + Vec3::X * 0.5, Vec3::Y),
            (&[0.0, 9.0], far, Vec3::Y),
            (&[1.0, 1.0], here, Vec3::Y),
        ];
        let answers = ask(&mut light, &asked);
        assert_eq!([answers[0][1], answers[1][1]], [0.0, 0.6]);
        assert_eq!(light.leaves(), 1);
        let answers = ask(&mut light, &[(&[2.0, 1.0], here, Vec3::Y), asked[0]]);
        assert_eq!((answers[1][1], light.leaves()), (1.0, 0));
        let dark = ask(&mut light, &[(&[0.0, 9.0], Vec3::X * 31.0, Vec3::Y)]);
        assert_eq!(dark[0][1], 0.0, "outside the map it is dark");
    }

    #[test]
    fn clover_counts_leaves_by_area() {
        let mut settings = Settings::default();
        settings.set("grid position", "-50 -50");
        settings.set("grid range", "100x100");
        settings.set("transmittance", "0.5");
        let mut light = PatchLight::clover(&settings, None).unwrap();
        let area = std::f32::consts::PI * 4.0;
        let leaf: (&[f32], Vec3, Vec3) = (&[1.0, area], Vec3::ZERO, Vec3::Y);
        let question: (&[f32], Vec3, Vec3) = (&[0.0], Vec3::X * 1.9, Vec3::Y);
        assert_eq!(ask(&mut light, &[leaf, leaf, question])[2], [0.25]);
    }
}
