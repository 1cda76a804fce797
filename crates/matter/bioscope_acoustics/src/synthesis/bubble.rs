use bioscope_core::Vec2;
use bioscope_core::math::{self, TAU};

use super::Cue;

/// How fast the pitch rises, in shares of the damping: a bubble near the surface rings higher as
/// it rises (van den Doel, "Physically based models for liquid sounds", 2005).
const RISE: f32 = 0.1;
/// Decay after which a bubble is silent, in units of the damping time: 60 dB.
const SILENCE: f32 = 7.0;
/// Cycles in which a bubble comes to full strength.
const ATTACK: f32 = 0.6;
/// Seconds of faint noise as it breaks away.
const BREAKING: f32 = 0.006;
/// Level of that noise.
const BREATH: f32 = 0.08;
/// Bubbles per second in a stream.
const STREAM: f32 = 16.0;

/// One bubble, or a stream of them if the cue is longer than one takes to ring out.
pub fn synthesize(cue: &mut Cue) -> Vec<f32> {
    let mut clip = cue.silence();
    let ringing = SILENCE / damping(cue.pitch);
    ring(&mut clip, cue, 0.0, cue.pitch, 1.0);
    let beyond = cue.duration - 2.0 * ringing;
    let others = (beyond.max(0.0) * STREAM) as usize;
    for _ in 0..others {
        let start = cue.random.uniform() * (cue.duration - ringing);
        let pitch = cue.pitch * math::exp(0.3 * cue.random.normal());
        let level = cue.random.range(0.15, 0.9);
        ring(&mut clip, cue, start, pitch, level);
    }
    clip
}

/// Adds one ringing bubble that begins `start` seconds into the clip.
pub fn ring(clip: &mut [f32], cue: &mut Cue, start: f32, pitch: f32, level: f32) {
    let pitch = pitch.clamp(20.0, 0.3 * cue.rate);
    let damping = damping(pitch);
    let shrinking = math::exp(-damping / cue.rate);
    let rising = ATTACK / pitch;
    let first = cue.frames(start).min(clip.len());
    let frames = cue.frames(SILENCE / damping);
    // The oscillation is a shrinking pointer that turns by a nearly constant angle per sample.
    let (mut pointer, mut turn) = (Vec2::new(level, 0.0), Vec2::X);
    for (index, sample) in clip[first..].iter_mut().take(frames).enumerate() {
        let time = index as f32 / cue.rate;
        if index % 16 == 0 {
            let angle = TAU * pitch * (1.0 + RISE * damping * time) / cue.rate;
            turn = shrinking * Vec2::new(math::cos(angle), math::sin(angle));
        }
        let attack = if time < rising { math::smoothstep(0.0, rising, time) } else { 1.0 };
        *sample += attack * pointer.y;
        if time < BREAKING {
            *sample += BREATH * level * attack * (1.0 - time / BREAKING) * cue.noise();
        }
        pointer = turn.rotate(pointer);
    }
}

/// Damping per second of a bubble of this pitch, by radiation and heat: 0.13 / r + 0.0072 r^-1.5
/// for the radius r = 3 / pitch in metres (van den Doel 2005).
fn damping(pitch: f32) -> f32 {
    let radius = 3.0 / pitch;
    0.13 / radius + 0.0072 / (radius * math::sqrt(radius))
}
