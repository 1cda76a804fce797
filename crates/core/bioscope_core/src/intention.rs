use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::{Id, Value};

/// What a mind wants of its body in this tick: plain data that any body can serve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Intention {
    /// Name of the behavior that won: `wander`, `avoid`, `chase`.
    pub behavior: Cow<'static, str>,
    /// Direction to move in, own frame (X left, Y up, Z ahead); need not have unit length.
    pub heading: Vec3,
    /// Speed wanted, in own body lengths per second.
    pub speed: f32,
    /// How urgent, 0 (drift) to 1 (all strength).
    pub urgency: f32,
    /// Point to look at, own frame, metres.
    pub gaze: Option<Vec3>,
    /// Whom it concerns.
    pub target: Option<Id>,
    /// Further commands that only some bodies understand (`mouth`, `fold_fins`).
    pub other: BTreeMap<String, Value>,
}

impl Default for Intention {
    fn default() -> Self {
        Self {
            behavior: Cow::Borrowed("rest"),
            heading: Vec3::Z,
            speed: 0.0,
            urgency: 0.0,
            gaze: None,
            target: None,
            other: BTreeMap::new(),
        }
    }
}
