use bioscope_core::{Error, Parameter, Parameters, Result, Vec3, math, parameters, state};
use serde::{Deserialize, Serialize};

use crate::{Field, Influence};

parameters! {
    /// How strong and how restless a current is.
    pub struct CurrentParameters {
        /// Mean speed of the water.
        speed: f32 = 0.1, "m/s", 0.0..=3.0, "choice";
        /// Speed of the swell that rocks everything to and fro near the surface.
        surge: f32 = 0.12, "m/s", 0.0..=3.0, "choice";
        /// Time from one swell to the next.
        surge_period: f32 = 5.5, "s", 0.5..=60.0, "choice";
        /// Speed of the eddies.
        turbulence: f32 = 0.06, "m/s", 0.0..=3.0, "choice";
        /// Size of the eddies.
        eddy_size: f32 = 2.5, "m", 0.1..=100.0, "choice";
        /// Factor on all of it: 0 is off.
        strength: f32 = 1.0, "1", 0.0..=4.0, "choice";
    }
}

/// Water that flows one way, is rocked by a swell that travels with it, and curls in eddies that have no
/// divergence.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Current {
    direction: Vec3,
    parameters: CurrentParameters,
}

impl Current {
    /// A current towards `direction` (any length but zero).
    pub fn new(direction: Vec3, parameters: CurrentParameters) -> Self {
        Self { direction: direction.normalize_or(Vec3::X), parameters }
    }

    /// Velocity of the water at a point (metres) and time (seconds), metres per second.
    pub fn flow(&self, point: Vec3, time: f64) -> Vec3 {
        let CurrentParameters { speed, surge, surge_period, turbulence, eddy_size, strength } =
            self.parameters;
        let phase = (time / f64::from(surge_period)).fract() as f32 * math::TAU;
        let travel = point.dot(self.direction) * 0.35;
        let swell = surge * math::sin(phase - travel.min(1e4));
        let flow = self.direction * (speed + swell) + eddies(point / eddy_size, time) * turbulence;
        flow * strength
    }

    /// Direction of the flow on the level, from +Z (0) towards +X (90).
    fn bearing() -> Parameter {
        Parameter {
            name: String::from("bearing"),
            unit: String::from("deg"),
            minimum: -180.0,
            maximum: 180.0,
            default: 90.0,
            meaning: String::from("Direction in which it flows, from +Z (0) towards +X (90)."),
            source: String::from("choice"),
        }
    }
}

/// A sum of shear waves, each perpendicular to its wave vector, so that it has no divergence;
/// root mean square about 1.
fn eddies(point: Vec3, time: f64) -> Vec3 {
    const WAVES: [(Vec3, Vec3, f64); 4] = [
        (Vec3::new(1.0, 0.3, 0.5), Vec3::new(-0.5, 0.0, 1.0), 0.31),
        (Vec3::new(-0.4, 0.2, 1.1), Vec3::new(1.1, 0.0, 0.4), 0.23),
        (Vec3::new(1.7, 0.9, -1.2), Vec3::new(0.9, -1.7, 0.0), 0.47),
        (Vec3::new(-1.3, 0.5, -1.6), Vec3::new(0.0, 1.6, 0.5), 0.61),
    ];
    WAVES.iter().fold(Vec3::ZERO, |sum, &(wave, sway, rate)| {
        let drift = (time * rate / std::f64::consts::TAU).fract() as f32 * math::TAU;
        sum + sway * (0.55 * math::sin(point.dot(wave) + drift))
    })
}

/// How strong it is, and where it flows.
impl Parameters for Current {
    fn descriptions(&self) -> Vec<Parameter> {
        let mut all = self.parameters.descriptions();
        all.push(Self::bearing());
        all
    }

    fn get(&self, name: &str) -> Option<f64> {
        if name == "bearing" {
            let bearing = math::atan2(self.direction.x, self.direction.z);
            return Some(f64::from(bearing.to_degrees()));
        }
        self.parameters.get(name)
    }

    fn set(&mut self, name: &str, value: f64) -> Result<()> {
        if name == "bearing" {
            let bearing = (Self::bearing().check(value)? as f32).to_radians();
            let level = self.direction.with_y(0.0).length();
            // A current straight up or down lies down.
            let level = if level > 1e-3 { level } else { 1.0 };
            let aside = Vec3::new(math::sin(bearing), 0.0, math::cos(bearing)) * level;
            self.direction = aside.with_y(self.direction.y).normalize();
            return Ok(());
        }
        if self.parameters.get(name).is_none() {
            let known = self.descriptions().into_iter().map(|one| one.name).collect();
            return Err(Error::Unknown { kind: "parameter", name: name.to_owned(), known });
        }
        self.parameters.set(name, value)
    }
}

impl Field for Current {
    fn kind(&self) -> &str {
        "current"
    }

    fn add_to(&self, points: &[Vec3], time: f64, out: &mut [Influence]) -> Result<()> {
        for (influence, &point) in out.iter_mut().zip(points) {
            influence.flow += self.flow(point, time);
        }
        Ok(())
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(self)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(self)
    }

    fn boxed_clone(&self) -> Box<dyn Field> {
        Box::new(self.clone())
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        *self = state::from_bytes("current", bytes)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eddies_have_no_divergence() {
        let h = 1e-2;
        for index in 0..50 {
            let point = Vec3::new(index as f32 * 0.37, 1.0, index as f32 * -0.21);
            let slope = |axis: Vec3| {
                (eddies(point + axis * h, 3.0) - eddies(point - axis * h, 3.0)).dot(axis)
                    / (2.0 * h)
            };
            let divergence = slope(Vec3::X) + slope(Vec3::Y) + slope(Vec3::Z);
            assert!(divergence.abs() < 2e-3, "{divergence} at {point}");
        }
    }
}
