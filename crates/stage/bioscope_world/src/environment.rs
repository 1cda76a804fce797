use std::sync::Arc;

use bioscope_core::{Result, Vec3, math, parameters};
use bioscope_dynamics::{Field, Influence};
use bioscope_geometry::{Medium, Scene, Sky, Solids, Sun, Terrain};

parameters! {
    /// Light and water of a world.
    pub struct EnvironmentParameters {
        /// Height of the sun above the horizon.
        sun_elevation: f32 = 58.0, "deg", 0.0..=90.0, "choice";
        /// Direction of the sun, from +Z (0) towards +X (90).
        sun_azimuth: f32 = 48.0, "deg", -180.0..=180.0, "choice";
        /// Strength of the sun's light.
        sunlight: f32 = 1.0, "1", 0.0..=4.0, "choice";
        /// How much the water absorbs and scatters, 1 being clear tropical sea.
        turbidity: f32 = 1.0, "1", 0.0..=10.0, "choice";
        /// Strength of the bright pattern that waves cast.
        caustics: f32 = 1.0, "1", 0.0..=2.0, "choice";
        /// Strength of visible sun shafts.
        shafts: f32 = 1.0, "1", 0.0..=2.0, "choice";
        /// Temperature of the medium.
        temperature: f32 = 24.0, "degC", -5.0..=60.0, "choice";
    }
}

/// What is not alive: terrain, medium, light, obstacles and fields.
#[derive(Clone, Default)]
pub struct Environment {
    /// The ground, if there is any.
    pub terrain: Option<Arc<Terrain>>,
    /// The medium before the parameters act on it.
    pub medium: Medium,
    /// The light of the sky.
    pub sky: Sky,
    /// Solids to steer round.
    pub obstacles: Solids,
    /// Everything that acts at a distance, by name.
    pub fields: Vec<(String, Box<dyn Field>)>,
    /// Light and water.
    pub parameters: EnvironmentParameters,
}

impl Environment {
    /// Fills everything below `surface` (metres) with clear tropical sea water.
    ///
    /// Absorption and scattering per metre are those of clear ocean water in linear RGB (after
    /// Pope and Fry 1997 for the absorption of pure water).
    pub fn fill_with_water(&mut self, surface: f32) {
        self.medium = Medium {
            surface: Some(surface),
            absorption: [0.32, 0.07, 0.03],
            scattering: [0.03, 0.03, 0.03],
            glow: [0.02, 0.28, 0.42],
            caustics: 1.0,
            caustic_scale: 1.1,
            shafts: 0.6,
        };
    }

    /// Everything that acts at these points at `time` (seconds), in the order of the points.
    pub fn influence(&self, points: &[Vec3], time: f64) -> Result<Vec<Influence>> {
        let mut out = vec![Influence::default(); points.len()];
        for (_, field) in &self.fields {
            field.add_to(points, time, &mut out)?;
        }
        Ok(out)
    }

    /// The sun as the parameters set it.
    pub fn sun(&self) -> Sun {
        let elevation = self.parameters.sun_elevation.to_radians();
        let azimuth = self.parameters.sun_azimuth.to_radians();
        let level = math::cos(elevation);
        let direction =
            Vec3::new(level * math::sin(azimuth), math::sin(elevation), level * math::cos(azimuth));
        Sun { direction, color: Sun::default().color.map(|one| one * self.parameters.sunlight) }
    }

    /// The medium as the parameters set it.
    pub fn medium(&self) -> Medium {
        let EnvironmentParameters { turbidity, caustics, shafts, sunlight, .. } = self.parameters;
        Medium {
            absorption: self.medium.absorption.map(|one| one * turbidity),
            scattering: self.medium.scattering.map(|one| one * turbidity),
            glow: self.medium.glow.map(|one| one * sunlight),
            caustics: self.medium.caustics * caustics,
            shafts: self.medium.shafts * shafts,
            ..self.medium
        }
    }

    pub(crate) fn publish(&self, scene: &mut Scene) {
        scene.sun = self.sun();
        scene.sky = self.sky;
        scene.medium = self.medium();
    }
}
