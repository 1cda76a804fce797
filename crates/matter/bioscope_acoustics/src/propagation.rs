use bioscope_core::{SoundEvent, Vec3};

use crate::Medium;

/// Fastest source as a share of the speed of sound; the shock wave beyond is not modelled.
const FASTEST_SOURCE: f64 = 0.9;

/// How the sound that reaches a place at one instant came there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// World time in seconds at which it left the source.
    pub emission_time: f64,
    /// Way it travelled, in metres.
    pub distance: f32,
    /// From the listener to where the source was at emission, in metres, world axes.
    pub offset: Vec3,
}

/// The sound of `event`'s source that reaches `listener` (metres) at `time` (seconds).
///
/// The source moves on the straight line position + velocity (t - time), before and after the
/// event as well. The emission time solves t - e = |listener - source(e)| / c, in closed form
/// because the motion is straight. Sources faster than 0.9 c are slowed to that.
pub fn arrival(medium: &Medium, event: &SoundEvent, listener: Vec3, time: f64) -> Arrival {
    let sound_speed = f64::from(medium.sound_speed);
    let velocity = bounded_velocity(event.velocity, sound_speed);
    let since = time - event.time;
    let source = [0, 1, 2].map(|axis| f64::from(event.position[axis]) + velocity[axis] * since);
    let toward = [0, 1, 2].map(|axis| f64::from(listener[axis]) - source[axis]);
    let closing = dot(toward, velocity);
    let slowness = sound_speed * sound_speed - dot(velocity, velocity);
    let root = (closing * closing + slowness * dot(toward, toward)).sqrt();
    let travel = (closing + root) / slowness;
    let offset = [0, 1, 2].map(|axis| (-toward[axis] - velocity[axis] * travel) as f32);
    Arrival {
        emission_time: time - travel,
        distance: (travel * sound_speed) as f32,
        offset: Vec3::from_array(offset),
    }
}

fn bounded_velocity(velocity: Vec3, sound_speed: f64) -> [f64; 3] {
    let velocity = velocity.to_array().map(f64::from);
    let speed = dot(velocity, velocity).sqrt();
    let share = (FASTEST_SOURCE * sound_speed / speed.max(1e-12)).min(1.0);
    velocity.map(|component| component * share)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
