use std::sync::Arc;

use bioscope_core::SoundEvent;

use crate::limiter::without_denormals;
use crate::listener::ListenerPose;
use crate::panning::pan;
use crate::synthesis::filter::openness;
use crate::{Medium, arrival};

/// Samples from one exact solution of the propagation to the next, between which delay, gain and
/// filter are interpolated. Spans lie on a fixed grid in time.
pub const SPAN: usize = 64;
/// Samples over which a voice fades in or out at cuts and late entries.
const FADE: i32 = 384;
/// Zero samples before and after a clip, so that interpolation may read beyond its ends.
const MARGIN: usize = 4;

/// What is the same for all voices of a track.
#[derive(Clone, Copy, Debug)]
pub struct Bus {
    pub medium: Medium,
    pub sample_rate: f32,
}

impl Bus {
    /// World time in seconds of a frame.
    pub fn time_of(&self, frame: i64) -> f64 {
        frame as f64 / f64::from(self.sample_rate)
    }
}

/// One event while it is being heard.
#[derive(Clone, Debug)]
pub struct Voice {
    event: SoundEvent,
    clip: Arc<[f32]>,
    /// The shot of the listener's path from which it is heard.
    pub shot: usize,
    fade: Fade,
    /// Number of the span for which the ears are set.
    span: Option<i64>,
    ears: [EarState; 2],
}

/// Loudness of a voice that enters late or leaves early, in steps of 1 / `FADE` per sample.
#[derive(Clone, Copy, Debug)]
struct Fade {
    step: i32,
    direction: i32,
}

/// One ear's way through the clip during a span.
#[derive(Clone, Copy, Debug, Default)]
struct EarState {
    from: Point,
    to: Point,
    /// State of the low-pass.
    filtered: f32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Point {
    /// Place in the clip, in samples.
    position: f64,
    gain: f32,
    /// Share of the way that the low-pass goes in one sample.
    openness: f32,
}

impl Voice {
    /// A voice for this noise, heard from this shot.
    pub fn new(event: SoundEvent, samples: &[f32], shot: usize) -> Self {
        let margin = [0.0; MARGIN];
        let clip = [&margin[..], samples, &margin[..]].concat().into();
        let fade = Fade { step: FADE, direction: 0 };
        Self { event, clip, shot, fade, span: None, ears: Default::default() }
    }

    /// Number of samples that its clip keeps in memory.
    pub fn size(&self) -> usize {
        self.clip.len()
    }

    /// At a cut: fades this voice out of its old shot and returns one that fades into the new.
    pub fn cut_to(&mut self, shot: usize) -> Self {
        self.fade.direction = -1;
        let fade = Fade { step: 0, direction: 1 };
        Self { shot, fade, span: None, ears: Default::default(), ..self.clone() }
    }

    pub fn is_fading_out(&self) -> bool {
        self.fade.direction < 0
    }

    /// Whether nothing more will come of it.
    pub fn is_over(&self) -> bool {
        let end = self.clip.len() as f64;
        let past = self.ears.iter().all(|ear| ear.from.position > end && ear.to.position > end);
        (self.fade.step == 0 && self.fade.direction < 0) || (self.span.is_some() && past)
    }

    /// Adds to `out` the samples of span number `span` from its sample `offset` on.
    /// `listener` are the poses at the span's beginning and end.
    pub fn add(
        &mut self,
        bus: &Bus,
        listener: &[ListenerPose; 2],
        (span, offset): (i64, usize),
        out: &mut [[f32; 2]],
    ) {
        self.prepare(bus, listener, (span, offset));
        let fade = self.fade;
        let [mut left, mut right] = self.ears;
        let [at_left, at_right] = self.ears.map(|ear| ear.reading(&self.clip));
        for (index, frame) in out.iter_mut().enumerate() {
            let (share, level) = ((offset + index) as f32 / SPAN as f32, fade.level(index));
            frame[0] += level * left.next(&at_left, share);
            frame[1] += level * right.next(&at_right, share);
        }
        self.ears = [left, right];
        if offset + out.len() == SPAN {
            self.ears.iter_mut().for_each(|ear| ear.filtered = without_denormals(ear.filtered));
        }
        self.fade = fade.after(out.len());
    }

    /// Sets the ears for a span: on from the last one, or afresh.
    fn prepare(&mut self, bus: &Bus, listener: &[ListenerPose; 2], (span, offset): (i64, usize)) {
        if self.span == Some(span) {
            return;
        }
        let follows = self.span == Some(span - 1);
        let to = self.points(bus, &listener[1]);
        let from =
            if follows { self.ears.map(|ear| ear.to) } else { self.points(bus, &listener[0]) };
        if !follows {
            self.ears = Default::default();
            let share = offset as f64 / SPAN as f64;
            let place = |side: usize| {
                from[side].position + share * (to[side].position - from[side].position)
            };
            let is_late = place(0).max(place(1)) > MARGIN as f64 + 1.0;
            if is_late && self.fade.direction == 0 {
                self.fade = Fade { step: 0, direction: 1 };
            }
        }
        for (side, ear) in self.ears.iter_mut().enumerate() {
            ear.from = from[side];
            ear.to = to[side];
        }
        self.span = Some(span);
    }

    /// What both ears of a listener at this pose read of the clip.
    fn points(&self, bus: &Bus, listener: &ListenerPose) -> [Point; 2] {
        let arriving = arrival(&bus.medium, &self.event, listener.position, listener.time);
        let since = arriving.emission_time - self.event.time;
        let loudness = self.event.amplitude * bus.medium.gain(arriving.distance);
        let sides = pan(arriving.offset, listener.rotation, bus.medium.sound_speed);
        sides.map(|side| {
            let cutoff = 1.0 / (1.0 / bus.medium.cutoff(arriving.distance) + side.shadow);
            let seconds = since - f64::from(side.delay);
            Point {
                position: seconds * f64::from(bus.sample_rate) + MARGIN as f64,
                gain: loudness * side.gain,
                openness: openness(cutoff, bus.sample_rate),
            }
        })
    }
}

impl Fade {
    fn level(self, samples: usize) -> f32 {
        if self.direction == 0 {
            return 1.0;
        }
        self.after(samples).step as f32 / FADE as f32
    }

    fn after(self, samples: usize) -> Self {
        let step = (self.step + self.direction * samples as i32).clamp(0, FADE);
        let has_arrived = step == FADE && self.direction > 0;
        Self { step, direction: if has_arrived { 0 } else { self.direction } }
    }
}

impl EarState {
    /// The sample after this share of the span.
    #[inline]
    fn next(&mut self, reading: &Reading, share: f32) -> f32 {
        let gain = self.from.gain + (self.to.gain - self.from.gain) * share;
        let openness = self.from.openness + (self.to.openness - self.from.openness) * share;
        self.filtered += openness * (gain * reading.sample(share) - self.filtered);
        self.filtered
    }

    /// How this ear reads the clip during its span.
    fn reading<'a>(&self, clip: &'a [f32]) -> Reading<'a> {
        let last = (clip.len() - MARGIN) as f64;
        let base = self.from.position.min(self.to.position).clamp(1.0, last).floor();
        Reading {
            clip: &clip[base as usize - 1..],
            start: (self.from.position - base) as f32,
            way: (self.to.position - self.from.position) as f32,
            end: (last - base) as f32,
        }
    }
}

/// A stretch of a clip with places in it counted from its second sample, so that f32 is precise.
struct Reading<'a> {
    clip: &'a [f32],
    /// Place at the beginning of the span.
    start: f32,
    /// Samples of the clip that the span covers; differs from its length by the Doppler shift.
    way: f32,
    /// Last place to read from; only silence comes after it.
    end: f32,
}

impl Reading<'_> {
    /// The clip between its samples: Catmull-Rom through four of them; silence outside.
    #[inline]
    fn sample(&self, share: f32) -> f32 {
        let place = (self.start + self.way * share).clamp(0.0, self.end);
        let index = place as i32;
        let t = place - index as f32;
        let Some(&[a, b, c, d]) = self.clip[index as usize..].first_chunk() else {
            return 0.0;
        };
        let slope = 0.5 * (c - a);
        let bend = a - 2.5 * b + 2.0 * c - 0.5 * d;
        let twist = 0.5 * (d - a) + 1.5 * (b - c);
        ((twist * t + bend) * t + slope) * t + b
    }
}
