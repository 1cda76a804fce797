use bioscope_core::{Intention, Vec3, math};

/// What the motor controllers are asked to do in this tick: turn, climb, swim or back away, brake, open the
/// mouth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Angle to turn by, radians, positive to the left.
    pub turn: f32,
    /// Angle to climb at, radians, negative to dive.
    pub pitch: f32,
    /// Speed in body lengths per second; negative to back away.
    pub speed: f32,
    /// How hard to brake, 0 to 1.
    pub brake: f32,
    /// How far to open the mouth, 0 to 1.
    pub mouth: f32,
}

impl Command {
    /// Swims straight on at this speed (body lengths per second).
    pub fn ahead(speed: f32) -> Self {
        Self { speed, ..Self::default() }
    }

    /// Turns towards a direction of the own frame at this speed.
    pub fn toward(direction: Vec3, speed: f32) -> Self {
        let level = math::sqrt(direction.x * direction.x + direction.z * direction.z);
        let turn = math::atan2(direction.x, direction.z);
        Self { turn, pitch: math::atan2(direction.y, level), speed, ..Self::default() }
    }

    /// The direction to move in, own frame, unit length.
    pub fn heading(&self) -> Vec3 {
        let level = math::cos(self.pitch);
        let ahead = Vec3::new(math::sin(self.turn), 0.0, math::cos(self.turn)) * level;
        ahead.with_y(math::sin(self.pitch))
    }

    /// The same as an intention, with the strength it takes at most `full_speed` body lengths per second.
    pub fn intention(&self, full_speed: f32) -> Intention {
        let urgency = (self.speed.abs() / full_speed.max(1e-3)).max(self.turn.abs() / math::PI);
        Intention {
            heading: self.heading(),
            speed: self.speed,
            urgency: urgency.max(self.brake).clamp(0.1, 1.0),
            brake: self.brake,
            mouth: self.mouth,
            ..Intention::default()
        }
    }
}
