use std::sync::Arc;

use bioscope_core::{Parameters, Percepts, Result, Retina, Vec3, parameters, state};
use bioscope_geometry::{Camera, Transform};
use serde::{Deserialize, Serialize};

use super::eye_camera;
use crate::{Sense, Surroundings};

/// Share of each linear color in what looks bright (ITU-R BT.709).
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

parameters! {
    /// How finely an eye sees.
    pub struct EyeParameters {
        /// Columns of the retina.
        width: f32 = 32.0, "px", 1.0..=512.0, "choice";
        /// Rows of the retina.
        height: f32 = 32.0, "px", 1.0..=512.0, "choice";
        /// Whole angle in which it sees, centered on the direction it looks in.
        field_of_view: f32 = 300.0, "deg", 1.0..=300.0, "Tu and Terzopoulos 1994";
        /// Mean luminance of the retina that counts as full daylight.
        daylight: f32 = 0.5, "1", 0.001..=100.0, "choice";
    }
}

/// The cyclopean eye with its retina; see the [module](super). Put it after the sense of light, whose
/// brightness it replaces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Eye {
    parameters: EyeParameters,
}

impl Eye {
    /// An eye this good.
    pub fn new(parameters: EyeParameters) -> Self {
        Self { parameters }
    }
}

impl Sense for Eye {
    fn kind(&self) -> &str {
        "eye"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        let EyeParameters { width, height, field_of_view, daylight } = self.parameters;
        let placement = Transform::new(surroundings.position, surroundings.attitude, 1.0);
        let camera = eye_camera(&placement, surroundings.body_length, field_of_view.to_radians());
        let view = surroundings.outlook.prepared().look(&camera, width as usize, height as usize);
        let retina = Retina {
            width: view.width,
            height: view.height,
            color: view.color,
            range: view.depth,
            identity: view.identity,
        };
        percepts.light = brightness(&retina) / daylight;
        percepts.retina = Some(Arc::new(retina));
        Ok(())
    }

    fn eye(&self, placement: &Transform, body_length: f32) -> Option<Camera> {
        Some(eye_camera(placement, body_length, self.parameters.field_of_view.to_radians()))
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.parameters)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.parameters)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}

/// Mean luminance of the pixels within the round field of view.
fn brightness(retina: &Retina) -> f32 {
    let (width, height) = (retina.width as f32, retina.height as f32);
    let radius = 0.5 * width.min(height);
    let (mut sum, mut count) = (0.0, 0.0);
    for (index, color) in retina.color.iter().enumerate() {
        let x = ((index % retina.width) as f32 + 0.5 - 0.5 * width) / radius;
        let y = ((index / retina.width) as f32 + 0.5 - 0.5 * height) / radius;
        if x * x + y * y <= 1.0 {
            sum += Vec3::from(*color).dot(LUMINANCE);
            count += 1.0;
        }
    }
    if count > 0.0 { sum / count } else { 0.0 }
}
