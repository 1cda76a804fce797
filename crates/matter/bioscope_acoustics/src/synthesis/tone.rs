use bioscope_core::math::{self, TAU};

use super::Cue;

/// Seconds over which the tone swells and dies away.
const EDGE: f32 = 0.012;

/// A sine of constant frequency.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    let edge = EDGE.min(cue.duration / 2.0);
    for (index, sample) in clip.iter_mut().enumerate() {
        let time = index as f32 / cue.rate;
        let swell = math::smoothstep(0.0, edge, time.min(cue.duration - time));
        // Cycles are counted in f64: in f32 the phase of a long tone would become grainy.
        let cycles = index as f64 * f64::from(cue.pitch) / f64::from(cue.rate);
        *sample = swell * math::sin(TAU * cycles.fract() as f32);
    }
    clip
}
