use bioscope_core::math::{self, PI};
use bioscope_core::{Purpose, Random, SoundEvent};

use crate::limiter::without_denormals;

use super::{duration_of, pitch_of};

/// Lowest and, as a share of the sample rate, highest main frequency.
const PITCHES: (f32, f32) = (20.0, 0.4);
/// Shortest clip in seconds.
const SHORTEST: f32 = 0.005;
/// Longest fade to silence at the end of a clip, in seconds.
const FADE: f32 = 0.012;

/// What a synthesizer is asked for.
pub struct Cue {
    /// Main frequency in hertz.
    pub pitch: f32,
    /// Duration in seconds.
    pub duration: f32,
    /// Samples per second.
    pub rate: f32,
    /// Randomness of this one noise.
    pub random: Random,
}

impl Cue {
    pub fn new(event: &SoundEvent, word: &str, seed: u64, sample_rate: u32) -> Self {
        let rate = sample_rate as f32;
        Self {
            pitch: pitch_of(event).clamp(PITCHES.0, PITCHES.1 * rate),
            duration: duration_of(event).max(SHORTEST),
            rate,
            random: Random::new(seed, event.source, folded(event.time), Purpose::new(word)),
        }
    }

    /// Silence of the cue's duration, to be filled.
    pub fn silence(&self) -> Vec<f32> {
        vec![0.0; self.frames(self.duration)]
    }

    /// Number of samples in so many seconds.
    pub fn frames(&self, seconds: f32) -> usize {
        (seconds * self.rate) as usize
    }

    /// White noise in -1 to 1.
    pub fn noise(&mut self) -> f32 {
        self.random.range(-1.0, 1.0)
    }
}

/// The 48 bits of a time that random streams take: its upper bits folded into its lower ones,
/// because round times differ in the upper bits only.
fn folded(time: f64) -> u64 {
    let bits = time.to_bits();
    (bits ^ (bits >> 16)) & 0xFFFF_FFFF_FFFF
}

/// An exponential decay from 1, sample by sample.
pub struct Decay {
    level: f32,
    factor: f32,
}

impl Decay {
    /// A decay that falls to 1/e in `seconds`.
    pub fn new(seconds: f32, rate: f32) -> Self {
        Self { level: 1.0, factor: math::exp(-1.0 / (seconds * rate)) }
    }

    pub fn next(&mut self) -> f32 {
        let level = self.level;
        self.level = without_denormals(level * self.factor);
        level
    }
}

/// Fades the end of a clip to silence, takes out its mean, and scales its peak to 1.
pub fn finish(clip: &mut [f32], rate: f32) {
    let fade = ((FADE * rate) as usize).min(clip.len() / 4).max(1);
    for (index, sample) in clip.iter_mut().rev().take(fade).enumerate() {
        *sample *= 0.5 - 0.5 * math::cos(PI * index as f32 / fade as f32);
    }
    remove_mean(clip);
    let peak = clip.iter().fold(0.0, |peak: f32, sample| peak.max(sample.abs()));
    if peak > 0.0 {
        clip.iter_mut().for_each(|sample| *sample /= peak);
    }
}

/// Takes out the mean by an arch that leaves the ends alone.
fn remove_mean(clip: &mut [f32]) {
    let length = clip.len() as f32;
    let arch = |index: usize| {
        let place = (index as f32 + 0.5) / length;
        (place * (1.0 - place)).powi(2)
    };
    let sum: f32 = clip.iter().sum();
    let weight: f32 = (0..clip.len()).map(arch).sum();
    for (index, sample) in clip.iter_mut().enumerate() {
        *sample -= sum / weight * arch(index);
    }
}
