use super::Cue;
use super::bubble::ring;

/// One short knock, dull enough not to startle.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    ring(&mut clip, cue, 0.0, cue.pitch, 1.0);
    clip
}
