use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::{Display, Id, Value, math};

/// What a mind wants of its body in this tick: plain data that any body can serve.
///
/// Bodies with motor controllers of their own (a fish's swim, turn, ascend, descend, brake, backward)
/// read them as [`turn`](Self::turn), [`pitch`](Self::pitch), `speed` and `brake`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intention {
    /// Name of the behavior that won: `wander`, `avoid`, `chase`.
    pub behavior: Cow<'static, str>,
    /// Direction to move in, own frame (X left, Y up, Z ahead); need not have unit length.
    pub heading: Vec3,
    /// Speed wanted, in own body lengths per second; negative to back away.
    pub speed: f32,
    /// How urgent, 0 (drift) to 1 (all strength).
    pub urgency: f32,
    /// How hard to brake, 0 (not) to 1 (at once).
    pub brake: f32,
    /// How far to open the mouth, 0 to 1.
    pub mouth: f32,
    /// Point to look at, own frame, metres.
    pub gaze: Option<Vec3>,
    /// Whom it concerns.
    pub target: Option<Id>,
    /// What to show of all this.
    pub display: Display,
    /// Further commands that only some bodies understand (`fold_fins`).
    pub other: BTreeMap<String, Value>,
}

impl Intention {
    /// Angle to turn by, radians, positive to the left: that of the heading about the own Y.
    pub fn turn(&self) -> f32 {
        math::atan2(self.heading.x, self.heading.z)
    }

    /// Angle to climb at, radians, negative to dive: that of the heading over the own XZ plane.
    pub fn pitch(&self) -> f32 {
        let level = math::sqrt(self.heading.x * self.heading.x + self.heading.z * self.heading.z);
        math::atan2(self.heading.y, level)
    }
}

impl Default for Intention {
    fn default() -> Self {
        Self {
            behavior: Cow::Borrowed("rest"),
            heading: Vec3::Z,
            speed: 0.0,
            urgency: 0.0,
            brake: 0.0,
            mouth: 0.0,
            gaze: None,
            target: None,
            display: Display::NONE,
            other: BTreeMap::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_are_turns_and_pitches() {
        let toward = |heading: Vec3| {
            let intention = Intention { heading, ..Intention::default() };
            (intention.turn(), intention.pitch())
        };
        assert_eq!(toward(Vec3::Z * 3.0), (0.0, 0.0));
        let (turn, pitch) = toward(Vec3::new(1.0, math::sqrt(2.0), 1.0));
        assert!((turn - math::PI / 4.0).abs() < 1e-6 && (pitch - math::PI / 4.0).abs() < 1e-6);
        assert!(toward(Vec3::new(-0.1, 0.0, -1.0)).0 < -3.0);
    }
}
