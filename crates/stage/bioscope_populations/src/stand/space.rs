//! Where a stand is, and where in it its plants are.
//!
//! The environment of a stand thinks in the units of the model, in one space for all plants: that of a turtle whose
//! start is the origin of the stand.

use bioscope_core::{Quat, Vec3, math};
use bioscope_geometry::Transform;
use bioscope_lsystem::Letter;
use serde::{Deserialize, Serialize};

/// From the space of the model to the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Space {
    pub origin: Vec3,
    /// Metres per unit of the model.
    pub size: f32,
    /// Whether the plane of the turtle's drawing is the ground.
    pub lying: bool,
}

impl Space {
    fn stance(&self) -> Quat {
        let quarter = -math::sqrt(0.5);
        // A quarter turn about X lays the turtle's up (+Z) to the world's up (+Y).
        if self.lying { Quat::from_xyzw(quarter, 0.0, 0.0, -quarter) } else { Quat::IDENTITY }
    }

    /// From the space of the model to the world.
    pub fn of_surroundings(&self) -> Transform {
        Transform::new(self.origin, self.stance(), self.size)
    }

    /// From the plant's own space to the world.
    pub fn of_plant(&self, position: Vec3, yaw: f32) -> Transform {
        Transform::new(position, Quat::from_rotation_y(yaw) * self.stance(), self.size)
    }

    /// A letter of a plant, as the environment reads it.
    pub fn addressed(&self, letter: &Letter, position: Vec3, yaw: f32) -> Letter {
        let back = self.stance().inverse();
        let turn = back * (Quat::from_rotation_y(yaw) * self.stance());
        let base = back * ((position - self.origin) / self.size);
        Letter {
            position: base + turn * letter.position,
            heading: turn * letter.heading,
            left: turn * letter.left,
            up: turn * letter.up,
            ..letter.clone()
        }
    }
}
