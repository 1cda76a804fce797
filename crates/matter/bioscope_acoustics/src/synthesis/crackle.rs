use bioscope_core::math::{self, TAU};

use super::{Cue, Decay};

/// Snaps per second after the first.
const SNAPS: f32 = 22.0;

/// Sharp clicks at random moments, the first at once and loudest.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    snap(&mut clip, cue, 0.0, 1.0);
    for _ in 0..(SNAPS * cue.duration) as usize {
        let start = 0.95 * cue.random.uniform() * cue.duration;
        let level = math::exp(-0.6 - 0.9 * cue.random.normal().abs());
        snap(&mut clip, cue, start, level);
    }
    clip
}

/// The collapse of one cavitation bubble: about a millisecond of damped ringing and noise.
fn snap(clip: &mut [f32], cue: &mut Cue, start: f32, level: f32) {
    let pitch = (cue.pitch * cue.random.range(0.7, 1.5)).min(0.45 * cue.rate);
    let seconds = cue.random.range(0.3, 0.7) * 1e-3;
    let mut decay = Decay::new(seconds, cue.rate);
    let first = cue.frames(start).min(clip.len());
    let frames = cue.frames(9.0 * seconds);
    for (index, sample) in clip[first..].iter_mut().take(frames).enumerate() {
        let time = index as f32 / cue.rate;
        let envelope = math::smoothstep(0.0, 1e-4, time) * decay.next();
        let ringing = math::sin(TAU * pitch * time);
        *sample += level * envelope * (0.7 * ringing + 0.3 * cue.noise());
    }
}
