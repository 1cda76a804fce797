use std::collections::{BTreeSet, VecDeque};

use bioscope_core::{Error, Result, SoundEvent};

use crate::limiter::Limiter;
use crate::listener::{ListenerPath, ListenerPose};
use crate::synthesis::{self, water_bed::WaterBed};
use crate::voice::{Bus, SPAN, Voice};
use crate::{Medium, arrival, check};

/// Sample rates in hertz that are accepted.
const RATES: core::ops::RangeInclusive<u32> = 8_000..=192_000;
/// Frames that one call renders at most.
const MOST_FRAMES: usize = 1 << 24;
/// Events that may wait to be heard.
const MOST_WAITING: usize = 1 << 20;
/// Samples of clips that may sound at once: 256 MB.
const MOST_SAMPLES: usize = 1 << 26;
/// Amplitude at the listener below which an event is left out.
const INAUDIBLE: f32 = 1e-5;
/// Words reported as unknown, at most.
const MOST_UNKNOWN: usize = 100;

/// A stereo sound track that is rendered block by block from the events of a world.
///
/// Events are added as they happen, at the latest before the block in which they are heard; a
/// film adds those of a tick, then renders up to the end of the tick. Memory is bounded by what
/// sounds at one time. The samples do not depend on how they are divided into blocks.
#[derive(Clone, Debug)]
pub struct SoundTrack {
    seed: u64,
    sample_rate: u32,
    bus: Bus,
    bed: WaterBed,
    limiter: Limiter,
    /// Events of the future, in order of time.
    waiting: VecDeque<SoundEvent>,
    /// Events on their way to the listener.
    travelling: Vec<SoundEvent>,
    voices: Vec<Voice>,
    /// The frame with which the next block continues.
    next: Option<i64>,
    unknown: BTreeSet<String>,
    notices: Notices,
}

/// What a track could not render as asked.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notices {
    /// Words for noises that no synthesizer knows; a soft click was heard instead.
    pub unknown_kinds: Vec<String>,
    /// Number of events left out because too many sounded at once.
    pub dropped: usize,
}

impl SoundTrack {
    /// An empty track of `sample_rate` samples per second (8,000 to 192,000).
    pub fn new(sample_rate: u32, seed: u64, medium: Medium) -> Result<Self> {
        if !RATES.contains(&sample_rate) {
            return Err(Error::value("sample_rate", sample_rate, "8000 to 192000 Hz"));
        }
        medium.check()?;
        let rate = sample_rate as f32;
        Ok(Self {
            seed,
            sample_rate,
            bus: Bus { medium, sample_rate: rate },
            bed: WaterBed::new(seed, sample_rate),
            limiter: Limiter::new(rate),
            waiting: VecDeque::new(),
            travelling: Vec::new(),
            voices: Vec::new(),
            next: None,
            unknown: BTreeSet::new(),
            notices: Notices::default(),
        })
    }

    /// Adds events, in any order. All or none: an event that cannot sound (see
    /// [`check`](crate::check)) refuses the whole batch.
    pub fn add(&mut self, events: &[SoundEvent]) -> Result<()> {
        events.iter().try_for_each(check)?;
        if self.waiting.len() + self.travelling.len() + events.len() > MOST_WAITING {
            let what = "number of sounds waiting to be heard".to_owned();
            return Err(Error::Limit { what, limit: format!("{MOST_WAITING} events") });
        }
        self.waiting.extend(events.iter().cloned());
        self.waiting.make_contiguous().sort_by(|a, b| a.time.total_cmp(&b.time));
        Ok(())
    }

    /// Renders `frames` frames (left, right; 1 is full scale) from world time `from_time` in
    /// seconds on, as heard by `listener`. Peaks stay below -1 dBFS.
    ///
    /// Blocks usually follow one another. A jump forward takes up sounds in their middle; a jump
    /// back does not bring back sounds that have passed.
    pub fn render(
        &mut self,
        listener: &ListenerPath,
        from_time: f64,
        frames: usize,
    ) -> Result<Vec<[f32; 2]>> {
        let start = self.frame_of(from_time)?;
        if frames > MOST_FRAMES {
            let what = "length of one block of sound".to_owned();
            return Err(Error::Limit { what, limit: format!("{MOST_FRAMES} frames") });
        }
        if self.next != Some(start) {
            self.limiter = Limiter::new(self.bus.sample_rate);
        }
        let mut block = vec![[0.0; 2]; frames];
        if self.bus.medium.bed > 0.0 {
            self.bed.add(self.bus.medium.bed, start, &mut block);
        }
        let mut done = 0;
        while done < frames {
            let frame = start + done as i64;
            let (span, offset) = (frame.div_euclid(SPAN as i64), frame.rem_euclid(SPAN as i64));
            let count = (SPAN - offset as usize).min(frames - done);
            let out = &mut block[done..done + count];
            self.add_voices(listener, (span, offset as usize), out);
            done += count;
        }
        self.limiter.process(&mut block);
        self.next = Some(start + frames as i64);
        Ok(block)
    }

    /// What could not be rendered as asked since this was last called; each unknown word is
    /// reported once in the life of a track.
    pub fn take_notices(&mut self) -> Notices {
        core::mem::take(&mut self.notices)
    }

    fn frame_of(&self, time: f64) -> Result<i64> {
        let frame = (time * f64::from(self.sample_rate)).round();
        if frame.abs() < 1e15 {
            Ok(frame as i64)
        } else {
            Err(Error::value("from_time", time, "a finite number of seconds"))
        }
    }

    /// Adds all voices to `out`, which begins at sample `offset` of span number `span`.
    fn add_voices(
        &mut self,
        listener: &ListenerPath,
        (span, offset): (i64, usize),
        out: &mut [[f32; 2]],
    ) {
        let times = [span, span + 1].map(|number| self.bus.time_of(number * SPAN as i64));
        let shot = listener.shot_at(times[1]);
        let poses = times.map(|time| listener.pose_in(shot, time));
        self.follow_cut(shot);
        self.begin_voices(shot, &poses);
        for voice in &mut self.voices {
            if voice.shot == shot {
                voice.add(&self.bus, &poses, (span, offset), out);
            } else {
                let poses = times.map(|time| listener.pose_in(voice.shot, time));
                voice.add(&self.bus, &poses, (span, offset), out);
            }
        }
        self.voices.retain(|voice| !voice.is_over());
    }

    /// Cross-fades the voices of an earlier shot into this one.
    fn follow_cut(&mut self, shot: usize) {
        let is_left_behind = |voice: &&mut Voice| voice.shot != shot && !voice.is_fading_out();
        let arriving: Vec<Voice> =
            self.voices.iter_mut().filter(is_left_behind).map(|voice| voice.cut_to(shot)).collect();
        self.voices.extend(arriving);
    }

    /// Turns events whose first sound arrives before the end of this span into voices.
    fn begin_voices(&mut self, shot: usize, poses: &[ListenerPose; 2]) {
        let [_, end] = poses;
        // The nearer ear hears a little earlier than the middle of the head does.
        let lead = SPAN as f64 / f64::from(self.bus.sample_rate);
        let emitted = self.waiting.partition_point(|event| event.time <= end.time);
        self.travelling.extend(self.waiting.drain(..emitted));
        let travelling = core::mem::take(&mut self.travelling);
        for event in travelling {
            let arriving = arrival(&self.bus.medium, &event, end.position, end.time);
            let level = event.amplitude * self.bus.medium.gain(arriving.distance);
            let duration = f64::from(synthesis::duration_of(&event));
            let is_past = arriving.emission_time > event.time + duration + 0.01;
            if level < INAUDIBLE || is_past {
                continue;
            }
            if arriving.emission_time + lead < event.time {
                self.travelling.push(event);
            } else {
                self.begin_voice(event, shot);
            }
        }
    }

    fn begin_voice(&mut self, event: SoundEvent, shot: usize) {
        let duration = synthesis::duration_of(&event);
        let sounding: usize = self.voices.iter().map(Voice::size).sum();
        if sounding + (duration * self.bus.sample_rate) as usize > MOST_SAMPLES {
            self.notices.dropped += 1;
            return;
        }
        if synthesis::kind(&event.kind).is_none()
            && self.unknown.len() < MOST_UNKNOWN
            && self.unknown.insert(event.kind.clone().into_owned())
        {
            self.notices.unknown_kinds.push(event.kind.clone().into_owned());
        }
        let clip = synthesis::synthesize(&event, self.seed, self.sample_rate);
        self.voices.push(Voice::new(event, &clip, shot));
    }
}
