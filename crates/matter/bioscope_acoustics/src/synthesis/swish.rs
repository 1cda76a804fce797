use bioscope_core::math::{self, PI};

use super::Cue;
use super::filter::{BandPass, LowPass};

/// Low noise that swells, brightens and sinks back: faster up than down.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    let mut band = BandPass::new(cue.pitch, 0.9, cue.rate);
    let mut softness = LowPass::new((3.0 * cue.pitch).min(0.4 * cue.rate), cue.rate);
    let frames = clip.len() as f32;
    let mut arch = 0.0;
    for (index, sample) in clip.iter_mut().enumerate() {
        if index % 16 == 0 {
            arch = math::sin(PI * math::pow(index as f32 / frames, 0.7));
            band.move_to(cue.pitch * (0.55 + 0.9 * arch * arch));
        }
        // The arch changes in steps of 16 samples: too small and slow to be heard as such only
        // because the softness filter comes after it.
        *sample = softness.next(arch * arch * band.next(cue.noise()));
    }
    clip
}
