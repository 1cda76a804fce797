use bioscope_core::math::{self, PI};

use super::filter::BandPass;
use super::{Cue, Decay};

/// Strokes of single teeth per second.
const STROKES: f32 = 48.0;

/// A run of short scrapes, uneven in time, strength and color.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    let strokes = (STROKES * cue.duration).max(1.0) as usize;
    for stroke in 0..strokes {
        let place = (stroke as f32 + cue.random.range(0.1, 0.8)) / strokes as f32;
        let level = math::sin(PI * place) * cue.random.range(0.4, 1.0);
        scrape(&mut clip, cue, 0.97 * place * cue.duration, level);
    }
    clip
}

fn scrape(clip: &mut [f32], cue: &mut Cue, start: f32, level: f32) {
    let mut band = BandPass::new(cue.pitch * cue.random.range(0.75, 1.25), 1.6, cue.rate);
    let seconds = cue.random.range(0.004, 0.009);
    let mut decay = Decay::new(seconds, cue.rate);
    let first = cue.frames(start).min(clip.len());
    let frames = cue.frames(7.0 * seconds);
    for (index, sample) in clip[first..].iter_mut().take(frames).enumerate() {
        let time = index as f32 / cue.rate;
        let envelope = math::smoothstep(0.0, 0.002, time) * decay.next();
        *sample += level * envelope * band.next(cue.noise());
    }
}
