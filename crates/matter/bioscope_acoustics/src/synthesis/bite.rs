use bioscope_core::math::{self, TAU};

use super::filter::BandPass;
use super::{Cue, Decay};

/// Share of the duration at which the jaws close.
const CLOSING: f32 = 0.3;
/// How many little fractures make the crunch.
const FRACTURES: usize = 7;

/// A breath of suction that stops short, then a crunch of small fractures over a dull thump.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    let closing = CLOSING * cue.duration;
    suck(&mut clip, cue, closing);
    thump(&mut clip, cue, 0.9 * closing);
    for fracture in 0..FRACTURES {
        let late = cue.random.uniform();
        let spread = if fracture == 0 { 0.0 } else { 0.45 * cue.duration * late };
        let level = if fracture == 0 { 1.0 } else { cue.random.range(0.25, 0.7) * (1.0 - late) };
        crack(&mut clip, cue, closing + spread, level);
    }
    clip
}

/// Noise that swells and rises until the mouth shuts.
fn suck(clip: &mut [f32], cue: &mut Cue, closing: f32) {
    let mut band = BandPass::new(cue.pitch, 1.3, cue.rate);
    let mut decay = Decay::new(0.004, cue.rate);
    for (index, sample) in clip.iter_mut().enumerate() {
        let time = index as f32 / cue.rate;
        let swell = (time / closing).min(1.0);
        if index % 16 == 0 {
            band.move_to(cue.pitch * (0.6 + 1.1 * swell));
        }
        let shut = if time < closing { 1.0 } else { decay.next() };
        *sample += 1.1 * swell * swell * shut * band.next(cue.noise());
    }
}

/// The knock of closing jaws, low and short.
fn thump(clip: &mut [f32], cue: &Cue, start: f32) {
    let pitch = 0.25 * cue.pitch;
    let mut decay = Decay::new(0.012, cue.rate);
    let first = cue.frames(start).min(clip.len());
    for (index, sample) in clip[first..].iter_mut().enumerate() {
        let time = index as f32 / cue.rate;
        let envelope = math::smoothstep(0.0, 0.003, time) * decay.next();
        *sample += 0.28 * envelope * math::sin(TAU * pitch * time);
    }
}

/// One fracture: a few milliseconds of noise around twice the pitch.
fn crack(clip: &mut [f32], cue: &mut Cue, start: f32, level: f32) {
    let center = cue.pitch * cue.random.range(1.2, 2.4);
    let seconds = cue.random.range(0.004, 0.009);
    let mut decay = Decay::new(seconds, cue.rate);
    let mut band = BandPass::new(center, 1.1, cue.rate);
    let first = cue.frames(start).min(clip.len());
    let frames = cue.frames(7.0 * seconds);
    for (index, sample) in clip[first..].iter_mut().take(frames).enumerate() {
        let time = index as f32 / cue.rate;
        let envelope = math::smoothstep(0.0, 0.0008, time) * decay.next();
        *sample += level * envelope * band.next(cue.noise());
    }
}
