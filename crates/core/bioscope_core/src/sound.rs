use std::borrow::Cow;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::Id;

/// One noise, heard by ears and by the sound track alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoundEvent {
    /// What made it; the same source may sound again.
    pub source: Id,
    /// Which noise: `bubble`, `bite`, `splash`, `crackle`, `swish`; the synthesizers know these words.
    pub kind: Cow<'static, str>,
    /// World time at which it begins, in seconds.
    pub time: f64,
    /// How long it lasts, in seconds.
    pub duration: f32,
    /// Where it begins, in metres.
    pub position: Vec3,
    /// How its source moves, in metres per second (for Doppler shift and motion while it lasts).
    pub velocity: Vec3,
    /// Amplitude at one metre, 1 being full scale.
    pub amplitude: f32,
    /// Main frequency in hertz.
    pub pitch: f32,
}
