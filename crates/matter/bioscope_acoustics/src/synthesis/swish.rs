use super::Cue;
use super::filter::{BandPass, LowPass};

/// Low noise that swells, brightens and sinks back: faster up than down.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    let mut band = BandPass::new(cue.pitch, 0.9, cue.rate);
    let mut softness = LowPass::new((3.0 * cue.pitch).min(0.4 * cue.rate), cue.rate);
    let frames = clip.len() as f32;
    for (index, sample) in clip.iter_mut().enumerate() {
        let place = index as f32 / frames;
        // An arch of height 1 that culminates after a third of the time.
        let arch = 6.75 * place * (1.0 - place) * (1.0 - place);
        if index % 16 == 0 {
            band.move_to(cue.pitch * (0.55 + 0.9 * arch * arch));
        }
        *sample = softness.next(arch * arch * band.next(cue.noise()));
    }
    clip
}
