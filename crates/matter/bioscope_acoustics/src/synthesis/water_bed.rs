//! The continuous sound of the sea: a deep rumble, a slow swell, a trace of distant sparkle.

use bioscope_core::math::{self, PI};
use bioscope_core::{Purpose, Random};

use super::filter::{BandPass, LowPass};

const RUMBLE: Purpose = Purpose::new("water bed noise");
const SWELL: Purpose = Purpose::new("water bed swell");

/// Seconds from grain to grain; each grain lasts twice as long and is cross-faded with the next.
const HOP: f32 = 2.0;
/// Seconds that filters are given to settle before a grain begins.
const SETTLING: f32 = 0.1;
/// Seconds between the random levels through which the swells of rumble and wash pass.
const SWELL_PERIODS: [f64; 2] = [3.1, 1.9];
/// Share of the noise that both sides have in common.
const COMMON: f32 = 0.45;

/// Endless ambience, computed in overlapping grains that depend only on the seed and their place
/// in time, so that it can begin anywhere and never repeats.
#[derive(Clone, Debug)]
pub struct WaterBed {
    seed: u64,
    rate: f32,
    /// Frames from grain to grain.
    hop: usize,
    /// The grains sounding now, with their numbers: at most two.
    grains: Vec<(i64, Vec<[f32; 2]>)>,
}

impl WaterBed {
    /// The bed of this seed at `sample_rate` samples per second.
    pub fn new(seed: u64, sample_rate: u32) -> Self {
        let rate = sample_rate as f32;
        Self { seed, rate, hop: (HOP * rate) as usize, grains: Vec::new() }
    }

    /// Adds the bed to frames that begin at frame number `start`, with a root mean square of
    /// about `level` on each side.
    pub fn add(&mut self, level: f32, start: i64, frames: &mut [[f32; 2]]) {
        let hop = self.hop as i64;
        let mut done = 0;
        while done < frames.len() {
            let frame = start + done as i64;
            let (number, place) = (frame.div_euclid(hop), frame.rem_euclid(hop) as usize);
            let count = (self.hop - place).min(frames.len() - done);
            self.prepare(number);
            let [(_, ending), (_, beginning)] = self.grains.as_slice() else {
                unreachable!("prepare leaves two grains")
            };
            let ending = &ending[self.hop + place..];
            let grains = ending.iter().zip(&beginning[place..]);
            for (out, (old, new)) in frames[done..done + count].iter_mut().zip(grains) {
                out[0] += level * (old[0] + new[0]);
                out[1] += level * (old[1] + new[1]);
            }
            done += count;
        }
    }

    /// Has the grain of this number and the one before it ready, in order.
    fn prepare(&mut self, number: i64) {
        self.grains.retain(|&(known, _)| known == number - 1 || known == number);
        for wanted in [number - 1, number] {
            if !self.grains.iter().any(|&(known, _)| known == wanted) {
                let grain = self.grain(wanted);
                self.grains.push((wanted, grain));
            }
        }
        self.grains.sort_by_key(|&(known, _)| known);
    }

    /// One grain: windowed noise for both sides.
    fn grain(&self, number: i64) -> Vec<[f32; 2]> {
        let mut random = Random::new(self.seed, 0, number as u64, RUMBLE);
        let mut sides = [Timbre::new(self.rate), Timbre::new(self.rate)];
        let settling = (SETTLING * self.rate) as usize;
        let length = 2 * self.hop;
        let own = math::sqrt(1.0 - COMMON * COMMON);
        let first = number * self.hop as i64 - settling as i64;
        let mut swell = [1.0; 2];
        let mut grain = Vec::with_capacity(length);
        for index in 0..settling + length {
            if index % 32 == 0 {
                swell = self.swell(first + index as i64);
            }
            let common = COMMON * random.range(-1.0, 1.0);
            let frame = [0, 1]
                .map(|side: usize| sides[side].next(common + own * random.range(-1.0, 1.0), swell));
            if let Some(place) = index.checked_sub(settling) {
                let window = math::sin(PI * (place as f32 + 0.5) / length as f32);
                grain.push(frame.map(|sample| sample * window));
            }
        }
        grain
    }

    /// Slow rise and fall around 1 of rumble and wash: smooth curves through random levels.
    fn swell(&self, frame: i64) -> [f32; 2] {
        let seconds = frame as f64 / f64::from(self.rate);
        [(0, 0.6), (1, 0.25)].map(|(layer, least)| {
            let time = seconds / SWELL_PERIODS[layer as usize];
            let number = time.floor();
            let level = |step: i64| {
                let key = (number as i64 + step) as u64;
                Random::new(self.seed, layer, key, SWELL).range(least, 2.0 - least)
            };
            math::mix(level(0), level(1), math::smoothstep(0.0, 1.0, (time - number) as f32))
        })
    }
}

/// The color of the bed on one side: what turns white noise into sea.
#[derive(Clone, Debug)]
struct Timbre {
    rumble: [LowPass; 2],
    floor: LowPass,
    wash: (BandPass, LowPass),
    sparkle: BandPass,
    gain: f32,
}

impl Timbre {
    fn new(rate: f32) -> Self {
        Self {
            rumble: [LowPass::new(110.0, rate), LowPass::new(600.0, rate)],
            floor: LowPass::new(55.0, rate),
            wash: (BandPass::new(420.0, 0.8, rate), LowPass::new(900.0, rate)),
            sparkle: BandPass::new(3_600.0_f32.min(0.4 * rate), 0.8, rate),
            // White noise keeps the less of its power the smaller the share of its band.
            gain: math::sqrt(rate / 48_000.0),
        }
    }

    fn next(&mut self, noise: f32, [deep, near]: [f32; 2]) -> f32 {
        let [first, second] = &mut self.rumble;
        let rumble = second.next(first.next(noise));
        let rumble = rumble - self.floor.next(rumble);
        let (band, dark) = &mut self.wash;
        let wash = dark.next(band.next(noise));
        self.gain * (26.0 * deep * rumble + 3.1 * near * wash + 0.06 * self.sparkle.next(noise))
    }
}
