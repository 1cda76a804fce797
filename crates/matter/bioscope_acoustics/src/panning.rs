use bioscope_core::math::{self, PI};
use bioscope_core::{Quat, Vec3};

/// Distance between the ears in metres: with the speed of sound it gives the interaural delay.
const EAR_DISTANCE: f32 = 0.18;
/// Share of the full left-right range that panning uses; fully silent sides sound unnatural.
const WIDTH: f32 = 0.85;
/// Within about this many metres a source surrounds the listener instead of having a direction.
const BLUR: f32 = 0.2;
/// Corner frequency in hertz of the head's shadow on the far ear.
const HEAD_SHADOW: f32 = 5_000.0;
/// Corner frequency in hertz of what the outer ear keeps off from behind.
const BEHIND_SHADOW: f32 = 12_000.0;

/// How one ear hears a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Share of the amplitude; the squares of both ears sum to 1.
    pub gain: f32,
    /// Delay against the middle of the head in seconds, negative for the nearer ear.
    pub delay: f32,
    /// Inverse of the corner frequency of the shadow, in seconds; 0 without shadow.
    pub shadow: f32,
}

/// Left and right ear for a source at `offset` metres (world axes) from a listener.
pub fn pan(offset: Vec3, rotation: Quat, sound_speed: f32) -> [Side; 2] {
    let local = rotation.inverse() * offset;
    let direction = local / math::sqrt(local.length_squared().min(1e30) + BLUR * BLUR);
    let right = direction.x.clamp(-1.0, 1.0);
    let angle = PI / 4.0 * (1.0 + WIDTH * right);
    let half_delay = 0.5 * EAR_DISTANCE / sound_speed * right;
    let behind = direction.z.max(0.0) / BEHIND_SHADOW;
    let side = |gain, delay, turned_away: f32| Side {
        gain,
        delay,
        shadow: turned_away.max(0.0) / HEAD_SHADOW + behind,
    };
    [side(math::cos(angle), half_delay, right), side(math::sin(angle), -half_delay, -right)]
}
