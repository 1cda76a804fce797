use bioscope_core::{Event, SoundEvent};
use bioscope_geometry::Scene;

use crate::Moment;

/// Where populations put what they show of a tick.
pub struct Publication {
    /// Now.
    pub moment: Moment,
    /// What can be seen.
    pub scene: Scene,
    /// What can be heard.
    pub sounds: Vec<SoundEvent>,
    /// What happened.
    pub events: Vec<Event>,
}
