use bioscope_core::math;
use serde::{Deserialize, Serialize};

/// Share of vigor at which a behavior that tiredness has ended is taken up again (choice).
const RESTED: f32 = 0.75;

/// How tired a fish is of one behavior (Tu 1996, 6.3.2): its vigor `φ` falls as `exp(−t/T)` while it is
/// followed in vain and recovers with the same time constant while it is not (that success does not tire is a
/// choice: a courtship outlasts the time constant).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fatigue {
    vigor: f32,
    /// Whether tiredness has ended it, so that it rests before it begins anew.
    resting: bool,
}

impl Default for Fatigue {
    fn default() -> Self {
        Self { vigor: 1.0, resting: false }
    }
}

impl Fatigue {
    /// Lets `dt` seconds pass.
    pub fn advance(&mut self, active: bool, dt: f32, time_constant: f32) {
        let goal = if active { 0.0 } else { 1.0 };
        self.vigor += (goal - self.vigor) * math::relaxation(dt, time_constant);
        self.resting &= self.vigor < RESTED;
    }

    /// A drive as far as tiredness leaves it; below `threshold` for tiredness alone it rests.
    pub fn weaken(&mut self, drive: f32, threshold: f32) -> f32 {
        let left = if self.resting { 0.0 } else { drive * self.vigor };
        self.resting |= drive > threshold && left <= threshold;
        left
    }
}
