use bioscope_core::math;

use super::bubble::ring;
use super::filter::{BandPass, LowPass};
use super::{Cue, Decay};

/// Bubbles per second of duration in the trail.
const BUBBLES: f32 = 28.0;

/// A burst of noise that darkens as it dies away, and the bubbles it leaves behind.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    let mut decay = Decay::new(0.15 * cue.duration, cue.rate);
    let mut body = BandPass::new(cue.pitch, 0.6, cue.rate);
    let mut softness = LowPass::new((1.5 * cue.pitch).min(0.4 * cue.rate), cue.rate);
    for (index, sample) in clip.iter_mut().enumerate() {
        let time = index as f32 / cue.rate;
        if index % 16 == 0 {
            body.move_to(cue.pitch * (0.5 + 1.3 * math::exp(-3.0 * time / cue.duration)));
        }
        let envelope = math::smoothstep(0.0, 0.012, time) * decay.next();
        *sample = envelope * softness.next(body.next(cue.noise()));
    }
    for _ in 0..(BUBBLES * cue.duration) as usize {
        let late = math::sqrt(cue.random.uniform());
        let pitch = cue.pitch * math::exp(0.35 * cue.random.normal());
        let level = cue.random.range(0.05, 0.2) * (1.1 - late);
        ring(&mut clip, cue, (0.04 + 0.7 * late) * cue.duration, pitch, level);
    }
    clip
}
