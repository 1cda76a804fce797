use bioscope_core::{Error, Result, math};
use serde::{Deserialize, Serialize};

/// Frequency in hertz up to which a sound next to the ear is whole.
const BRIGHT: f32 = 20_000.0;

/// What sound travels through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Medium {
    /// Speed of sound in metres per second.
    pub sound_speed: f32,
    /// Distance in metres at which the band that reaches the ear has shrunk from 20 kHz to half.
    /// Chosen for the ear, as haze is for the eye: calm sea water itself absorbs far less.
    pub dulling_distance: f32,
    /// Distance in metres within which a sound grows no louder.
    pub reference_distance: f32,
    /// Level of the continuous water bed in the sound track, root mean square, 1 being full
    /// scale; 0 for none.
    pub bed: f32,
}

impl Medium {
    /// Sea water near the surface.
    pub const WATER: Self =
        Self { sound_speed: 1500.0, dulling_distance: 12.0, reference_distance: 0.5, bed: 0.03 };

    /// Air at 20 degrees Celsius.
    pub const AIR: Self =
        Self { sound_speed: 343.0, dulling_distance: 80.0, reference_distance: 0.5, bed: 0.0 };

    /// Share of the amplitude at one metre that is left after `distance` metres: the pressure of
    /// a spherical wave, 1/r, held at the reference distance.
    pub fn gain(&self, distance: f32) -> f32 {
        1.0 / distance.max(self.reference_distance)
    }

    /// Corner frequency in hertz of the one-pole low-pass that `distance` metres amount to.
    pub fn cutoff(&self, distance: f32) -> f32 {
        BRIGHT / (1.0 + distance / self.dulling_distance)
    }

    /// Share of a tone of `frequency` hertz that passes the low-pass of `distance` metres.
    pub fn transmission(&self, distance: f32, frequency: f32) -> f32 {
        let ratio = frequency / self.cutoff(distance);
        1.0 / math::sqrt(1.0 + ratio * ratio)
    }

    /// Refuses a medium in which sound could not travel.
    pub(crate) fn check(&self) -> Result<()> {
        let positive = [
            ("sound_speed", self.sound_speed, 10.0, 10_000.0),
            ("dulling_distance", self.dulling_distance, 0.01, 1e6),
            ("reference_distance", self.reference_distance, 0.01, 1e3),
            ("bed", self.bed, 0.0, 1.0),
        ];
        for (name, value, low, high) in positive {
            if !(low..=high).contains(&value) {
                return Err(Error::value(name, value, format!("{low} to {high}")));
            }
        }
        Ok(())
    }
}
