//! What the tests measure sounds with.

use bioscope_acoustics::{ListenerPath, ListenerPose, Medium, SoundTrack};
use bioscope_core::{Quat, SoundEvent, Vec3};

pub const RATE: u32 = 48_000;
/// Water without its bed, so that only the event is heard.
pub const QUIET_WATER: Medium = Medium { bed: 0.0, ..Medium::WATER };
pub const AIR: Medium = Medium::AIR;

pub fn event(kind: &'static str, time: f64, position: Vec3) -> SoundEvent {
    SoundEvent {
        source: 5,
        kind: kind.into(),
        time,
        duration: 0.0,
        position,
        velocity: Vec3::ZERO,
        amplitude: 0.3,
        pitch: 0.0,
    }
}

pub fn tone(pitch: f32, duration: f32, position: Vec3, velocity: Vec3) -> SoundEvent {
    SoundEvent { duration, velocity, pitch, ..event("tone", 0.0, position) }
}

pub fn resting() -> ListenerPath {
    turned(Quat::IDENTITY)
}

pub fn turned(rotation: Quat) -> ListenerPath {
    ListenerPath::starting(ListenerPose { time: 0.0, position: Vec3::ZERO, rotation })
        .expect("the pose is finite")
}

/// A listener that moves at constant velocity through the origin at time 0.
pub fn moving(velocity: Vec3, seconds: f64) -> ListenerPath {
    let pose = |time: f64| ListenerPose {
        time,
        position: velocity * time as f32,
        rotation: Quat::IDENTITY,
    };
    let mut path = ListenerPath::starting(pose(0.0)).expect("the pose is finite");
    let frames = (seconds * 30.0).ceil() as i32;
    (1..=frames).for_each(|frame| path.push(pose(f64::from(frame) / 30.0)).expect("time goes on"));
    path
}

pub fn render(
    medium: Medium,
    events: &[SoundEvent],
    listener: &ListenerPath,
    seconds: f64,
) -> Vec<[f32; 2]> {
    let mut track = SoundTrack::new(RATE, 7, medium).expect("the rate is valid");
    track.add(events).expect("the events are valid");
    track.render(listener, 0.0, (seconds * f64::from(RATE)) as usize).expect("the block is short")
}

pub fn side(frames: &[[f32; 2]], side: usize) -> Vec<f32> {
    frames.iter().map(|frame| frame[side]).collect()
}

pub fn rms(samples: &[f32]) -> f32 {
    let square: f64 = samples.iter().map(|&sample| f64::from(sample * sample)).sum();
    (square / samples.len().max(1) as f64).sqrt() as f32
}

pub fn peak(frames: &[[f32; 2]]) -> f32 {
    frames.iter().flatten().fold(0.0, |top: f32, sample| top.max(sample.abs()))
}

/// Largest step from one sample to the next.
pub fn largest_step(frames: &[[f32; 2]]) -> f32 {
    let steps = frames.windows(2).flat_map(|pair| [0, 1].map(|s: usize| pair[1][s] - pair[0][s]));
    steps.fold(0.0, |top: f32, step| top.max(step.abs()))
}

pub fn decibels(ratio: f32) -> f32 {
    20.0 * ratio.log10()
}

/// Frequency of a tone in hertz, from its first to its last upward zero crossing.
pub fn frequency(samples: &[f32]) -> f64 {
    let crossings: Vec<f64> = samples
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
        .map(|(index, pair)| index as f64 + f64::from(pair[0] / (pair[0] - pair[1])))
        .collect();
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    (crossings.len() - 1) as f64 * f64::from(RATE) / (last - first)
}

/// Lag in samples at which the first hundredth of a second of `clip` is best found in `heard`.
pub fn lag(clip: &[f32], heard: &[f32]) -> usize {
    let clip = &clip[..480];
    let match_at = |lag: usize| -> f32 {
        clip.iter().zip(&heard[lag..]).map(|(clip, heard)| clip * heard).sum()
    };
    (0..heard.len() - clip.len())
        .max_by(|&a, &b| match_at(a).total_cmp(&match_at(b)))
        .expect("the clip is shorter than what is heard")
}

/// Power at `hertz` (plain Fourier sum).
pub fn power(samples: &[f32], hertz: f64) -> f64 {
    let turn = core::f64::consts::TAU * hertz / f64::from(RATE);
    let (step_cos, step_sin) = (turn.cos(), turn.sin());
    let (mut cos, mut sin, mut real, mut imaginary) = (1.0, 0.0, 0.0, 0.0);
    for &sample in samples {
        real += f64::from(sample) * cos;
        imaginary += f64::from(sample) * sin;
        (cos, sin) = (cos * step_cos - sin * step_sin, sin * step_cos + cos * step_sin);
    }
    real * real + imaginary * imaginary
}

/// Frequency in hertz on both sides of which lies half the power, in steps of 50 Hz.
pub fn middle_frequency(samples: &[f32]) -> f64 {
    let spectrum: Vec<(f64, f64)> = (1..320)
        .map(|step| 50.0 * f64::from(step))
        .map(|hertz| (hertz, power(samples, hertz)))
        .collect();
    let half = 0.5 * spectrum.iter().map(|(_, power)| power).sum::<f64>();
    let mut below = 0.0;
    for (hertz, power) in spectrum {
        below += power;
        if below >= half {
            return hertz;
        }
    }
    unreachable!("all of the power is more than half of it")
}
