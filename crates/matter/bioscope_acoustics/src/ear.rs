use bioscope_core::{Hearing, Id, Quat, SoundEvent, Vec3};

use crate::{Medium, arrival, synthesis};

/// An animal's ear at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ear {
    /// Whose ear it is: its own noises are not heard. [`NOTHING`](bioscope_core::NOTHING) hears all.
    pub owner: Id,
    /// Position in metres.
    pub position: Vec3,
    /// Velocity in metres per second.
    pub velocity: Vec3,
    /// Rotation from the animal's frame (X left, Y up, Z ahead) to the world's.
    pub rotation: Quat,
    /// Least amplitude that is heard, 1 being full scale.
    pub threshold: f32,
}

/// What reaches an ear in the tick of `dt` seconds that ends at `now`, loudest first.
///
/// A noise is heard in every tick in which some part of it arrives, so that even the shortest is
/// heard. The direction is that to where the source was when the
/// sound left it. The amplitude has fallen with distance and with the absorption of the noise's
/// main frequency. Events with numbers that are not finite are not heard.
pub fn hear(ear: &Ear, medium: &Medium, events: &[SoundEvent], now: f64, dt: f32) -> Vec<Hearing> {
    let mut heard: Vec<Hearing> =
        events.iter().filter_map(|event| hear_one(ear, medium, event, now, dt)).collect();
    heard.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    heard
}

fn hear_one(ear: &Ear, medium: &Medium, event: &SoundEvent, now: f64, dt: f32) -> Option<Hearing> {
    let is_own = event.source == ear.owner && ear.owner != bioscope_core::NOTHING;
    if is_own || event.time > now || crate::check(event).is_err() {
        return None;
    }
    let arriving = arrival(medium, event, ear.position, now);
    let earlier_place = ear.position - ear.velocity * dt;
    let earlier = arrival(medium, event, earlier_place, now - f64::from(dt));
    let has_begun = event.time <= arriving.emission_time;
    let end = event.time + f64::from(synthesis::duration_of(event));
    let has_ended = end <= earlier.emission_time;
    if !has_begun || has_ended {
        return None;
    }
    let amplitude = event.amplitude
        * medium.gain(arriving.distance)
        * medium.transmission(arriving.distance, synthesis::pitch_of(event));
    let direction = (ear.rotation.inverse() * arriving.offset).normalize_or(Vec3::Z);
    (amplitude >= ear.threshold).then(|| Hearing {
        source: event.source,
        kind: event.kind.clone(),
        direction,
        amplitude,
    })
}

/// Whether all of an event's sound has passed everybody within `range` metres of where its source
/// was, so that it may be forgotten. Ears and sources slower than half the speed of sound are
/// allowed for.
pub fn has_passed(event: &SoundEvent, medium: &Medium, range: f32, now: f64) -> bool {
    let travel = f64::from(range) / (0.5 * f64::from(medium.sound_speed));
    let age = now - event.time - f64::from(synthesis::duration_of(event));
    age.is_nan() || age > travel
}
