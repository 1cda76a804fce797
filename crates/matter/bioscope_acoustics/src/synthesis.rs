//! How noises are made: one file per family, all computed, nothing recorded.
//!
//! [`KINDS`] lists the words that [`SoundEvent::kind`](bioscope_core::SoundEvent) may carry. Each
//! noise is a mono clip whose peak is 1, to be scaled by the event's amplitude. Its randomness is
//! keyed by (seed, source, time, kind), so that two bites differ and every run is the same. A
//! `pitch` or `duration` of 0 means the natural one of the kind. [`water_bed::WaterBed`] is no
//! event but the continuous ground under all of them.

mod bite;
mod bubble;
mod click;
mod crackle;
mod cue;
pub(crate) mod filter;
mod rasp;
mod splash;
mod swish;
mod tone;
pub mod water_bed;

use bioscope_core::SoundEvent;
use cue::{Cue, Decay};

/// A word for a noise, and what is natural for it.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// The word, lower case.
    pub word: &'static str,
    /// What it is, in one sentence.
    pub meaning: &'static str,
    /// Main frequency in hertz if the event names none.
    pub pitch: f32,
    /// Duration in seconds if the event names none.
    pub duration: f32,
    /// Longest duration in seconds; longer events are cut to it.
    pub longest: f32,
    /// Amplitude at one metre that sits well above the water bed.
    pub amplitude: f32,
    synthesize: fn(&mut Cue) -> Vec<f32>,
}

/// All kinds of noise that can be synthesized.
pub const KINDS: [Kind; 7] = [
    Kind {
        word: "bubble",
        meaning: "A gas bubble ringing as it breaks away (Minnaert); longer, a stream of bubbles.",
        pitch: 900.0,
        duration: 0.12,
        longest: 8.0,
        amplitude: 0.2,
        synthesize: bubble::synthesize,
    },
    Kind {
        word: "bite",
        meaning: "Suction, then jaws closing on something brittle.",
        pitch: 900.0,
        duration: 0.13,
        longest: 1.0,
        amplitude: 0.35,
        synthesize: bite::synthesize,
    },
    Kind {
        word: "splash",
        meaning: "A body breaking the water surface, with a trail of bubbles.",
        pitch: 1_100.0,
        duration: 0.9,
        longest: 4.0,
        amplitude: 0.6,
        synthesize: splash::synthesize,
    },
    Kind {
        word: "crackle",
        meaning: "Snapping shrimps: a few tiny sharp clicks.",
        pitch: 4_500.0,
        duration: 0.2,
        longest: 8.0,
        amplitude: 0.15,
        synthesize: crackle::synthesize,
    },
    Kind {
        word: "swish",
        meaning: "The tail stroke of a large fish: water pushed aside.",
        pitch: 240.0,
        duration: 0.6,
        longest: 4.0,
        amplitude: 0.4,
        synthesize: swish::synthesize,
    },
    Kind {
        word: "rasp",
        meaning: "Teeth scraping over rock, as parrotfishes do.",
        pitch: 2_600.0,
        duration: 0.4,
        longest: 2.0,
        amplitude: 0.25,
        synthesize: rasp::synthesize,
    },
    Kind {
        word: "tone",
        meaning: "A steady pure tone: calls, beacons, measurements.",
        pitch: 440.0,
        duration: 0.5,
        longest: 8.0,
        amplitude: 0.2,
        synthesize: tone::synthesize,
    },
];

/// What stands in for a word that is not in [`KINDS`].
const NEUTRAL: Kind = Kind {
    word: "click",
    meaning: "A soft click.",
    pitch: 700.0,
    duration: 0.05,
    longest: 0.1,
    amplitude: 0.2,
    synthesize: click::synthesize,
};

/// The kind of this word, if it is known.
pub fn kind(word: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.word == word)
}

/// The noise of an event as mono samples, beginning and ending in silence, peak 1.
///
/// Words that are not known give a soft click.
pub fn synthesize(event: &SoundEvent, seed: u64, sample_rate: u32) -> Vec<f32> {
    let kind = kind_or_neutral(&event.kind);
    let mut cue = Cue::new(event, kind.word, seed, sample_rate);
    let mut clip = (kind.synthesize)(&mut cue);
    cue::finish(&mut clip, sample_rate as f32);
    clip
}

/// Duration of an event's noise in seconds, with the natural one filled in.
pub fn duration_of(event: &SoundEvent) -> f32 {
    let kind = kind_or_neutral(&event.kind);
    if event.duration > 0.0 { event.duration.min(kind.longest) } else { kind.duration }
}

/// Main frequency of an event's noise in hertz, with the natural one filled in.
pub fn pitch_of(event: &SoundEvent) -> f32 {
    if event.pitch > 0.0 { event.pitch } else { kind_or_neutral(&event.kind).pitch }
}

fn kind_or_neutral(word: &str) -> &'static Kind {
    kind(word).unwrap_or(&NEUTRAL)
}
