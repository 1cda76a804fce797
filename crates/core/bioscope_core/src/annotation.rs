use std::borrow::Cow;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::Id;

/// Something a sense, mind or solver wants to show about its work. Overlays draw it; nothing
/// in the world reads it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Annotation {
    /// Whose work it shows.
    pub subject: Id,
    /// What it stands for: `heading`, `avoid`, `target`, `neighbors`; one colour per role.
    pub role: Cow<'static, str>,
    /// The shape to draw.
    pub mark: Mark,
}

/// Shape of an annotation; positions in metres in the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Mark {
    /// A line from one point to another.
    Line {
        /// Where it starts.
        from: Vec3,
        /// Where it ends.
        to: Vec3,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        center: Vec3,
        /// Its radius in metres.
        radius: f32,
    },
    /// A short text at a point.
    Label {
        /// Where it stands.
        position: Vec3,
        /// What it says.
        text: String,
    },
}
