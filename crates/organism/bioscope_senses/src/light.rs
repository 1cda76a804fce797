use bioscope_core::{Percepts, Result, Vec3, math, state};
use bioscope_geometry::Sun;
use serde::{Deserialize, Serialize};

use crate::{Sense, Surroundings};

/// Share of each linear color in what looks bright (ITU-R BT.709).
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// The sense of brightness and warmth in the skin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Light;

impl Light {
    /// Brightness of level ground at the animal's place, 0 to 1: what the water above leaves of the
    /// sun (Beer and Lambert, along the vertical), plus what lamps add.
    fn brightness(surroundings: &Surroundings) -> f32 {
        let depth = surroundings.depth().max(0.0);
        let left = surroundings.medium.absorption.map(|one| math::exp(-one * depth));
        let sun = Vec3::from(surroundings.sun.color).dot(Vec3::from(left) * LUMINANCE);
        let full = Vec3::from(Sun::default().color).dot(LUMINANCE);
        let daylight = sun / full * surroundings.sun.direction.y.max(0.0);
        (daylight + surroundings.influence.light).clamp(0.0, 1.0)
    }
}

impl Sense for Light {
    fn kind(&self) -> &str {
        "light"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        percepts.light = Self::brightness(surroundings);
        percepts.temperature = surroundings.temperature + surroundings.influence.temperature;
        Ok(())
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}
