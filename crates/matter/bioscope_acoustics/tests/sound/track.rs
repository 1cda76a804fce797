use bioscope_acoustics::synthesis::KINDS;
use bioscope_acoustics::{ListenerPath, ListenerPose, Medium, SoundTrack};
use bioscope_core::{Error, Purpose, Quat, Random, SoundEvent, Vec3};

use crate::measure::*;

/// Events of all kinds around the origin within `seconds`.
fn crowd(count: u32, seconds: f32) -> Vec<SoundEvent> {
    let mut random = Random::new(1, 0, 0, Purpose::new("crowd"));
    (0..count)
        .map(|source| SoundEvent {
            source,
            velocity: random.in_ball() * 4.0,
            ..event(
                KINDS[(source as usize) % KINDS.len()].word,
                f64::from(random.range(0.0, seconds)),
                random.direction() * random.range(0.3, 20.0),
            )
        })
        .collect()
}

/// A listener that drifts and turns, and cuts to another place at half a second.
fn wanderer() -> ListenerPath {
    let pose = |time: f64, x: f32| ListenerPose {
        time,
        position: Vec3::new(x, 0.0, -time as f32),
        rotation: Quat::from_rotation_y(time as f32),
    };
    let mut path = ListenerPath::starting(pose(0.0, 0.0)).expect("the pose is finite");
    for frame in 1..=45 {
        let time = f64::from(frame) / 30.0;
        let next = pose(time, if frame < 15 { 0.0 } else { 9.0 });
        path.push(next).expect("time goes on");
    }
    path
}

#[test]
fn the_division_into_blocks_changes_nothing() {
    let events = crowd(60, 1.0);
    let whole = render(Medium::WATER, &events, &wanderer(), 1.2);
    for size in [1_600, 777, 64, 1] {
        let mut track = SoundTrack::new(RATE, 7, Medium::WATER).expect("the rate is valid");
        track.add(&events).expect("the events are valid");
        let length = if size == 1 { 3_000 } else { whole.len() };
        let mut blocks = Vec::new();
        while blocks.len() < length {
            let from = blocks.len() as f64 / f64::from(RATE);
            let count = size.min(length - blocks.len());
            blocks.extend(track.render(&wanderer(), from, count).expect("the block is short"));
        }
        assert!(blocks == whole[..length], "blocks of {size}");
    }
}

#[test]
fn events_may_be_added_tick_by_tick() {
    let mut events = crowd(60, 1.0);
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    let whole = render(QUIET_WATER, &events, &wanderer(), 1.0);
    let mut track = SoundTrack::new(RATE, 7, QUIET_WATER).expect("the rate is valid");
    let mut blocks = Vec::new();
    for tick in 0..60 {
        let (from, to) = (f64::from(tick) / 60.0, f64::from(tick + 1) / 60.0);
        let new: Vec<SoundEvent> =
            events.iter().filter(|event| (from..to).contains(&event.time)).cloned().collect();
        track.add(&new).expect("the events are valid");
        blocks.extend(track.render(&wanderer(), from, 800).expect("the block is short"));
    }
    let apart = blocks.iter().zip(&whole).map(|(a, b)| [a[0] - b[0], a[1] - b[1]]);
    let apart: Vec<[f32; 2]> = apart.collect();
    assert!(peak(&apart) < 1e-4, "{}", peak(&apart));
}

#[test]
fn a_thousand_sounds_at_once_stay_below_one_decibel_under_full_scale() {
    let mut events = crowd(1_000, 0.02);
    events.iter_mut().for_each(|event| event.amplitude = 1.0);
    let heard = render(Medium::WATER, &events, &resting(), 1.0);
    assert!(peak(&heard) < 10.0_f32.powf(-1.0 / 20.0), "{}", peak(&heard));
    assert!(rms(&side(&heard, 0)) > 0.05, "the limiter does not choke the mix");
    let mean = side(&heard, 0).iter().sum::<f32>() / heard.len() as f32;
    assert!(mean.abs() < 0.003, "{mean}");
}

/// Slow tones have small steps between samples; a click would add a large one.
#[test]
fn nothing_clicks() {
    let low = |position, velocity| tone(120.0, 1.4, position, velocity);
    let steady = low(Vec3::new(0.0, 0.0, -2.0), Vec3::ZERO);
    let passing = low(Vec3::new(-8.0, 0.1, 0.0), Vec3::X * 12.0);
    let smooth_step = core::f32::consts::TAU * 120.0 / RATE as f32;
    let cases = [
        ("resting", vec![steady.clone()], resting()),
        ("cut and turn", vec![steady.clone()], wanderer()),
        ("passing close by", vec![passing], resting()),
    ];
    for (name, events, listener) in cases {
        let heard = render(QUIET_WATER, &events, &listener, 1.5);
        let bound = 1.3 * smooth_step * peak(&heard);
        assert!(largest_step(&heard) < bound, "{name}: {} {bound}", largest_step(&heard));
    }
    let mut late = SoundTrack::new(RATE, 7, QUIET_WATER).expect("the rate is valid");
    late.add(&[steady]).expect("the event is valid");
    let heard = late.render(&resting(), 0.7, 24_000).expect("the block is short");
    assert!(largest_step(&heard) < 1.3 * smooth_step * peak(&heard), "entering in the middle");
    assert!(peak(&heard) > 0.1);
}

#[test]
fn a_cut_is_no_flight() {
    let source = tone(1_000.0, 1.2, Vec3::new(0.0, 0.0, -3.0), Vec3::ZERO);
    let heard = side(&render(AIR, &[source], &wanderer(), 1.2), 0);
    for from in (4_800..48_000).step_by(2_400) {
        let pitch = frequency(&heard[from..from + 2_400]);
        assert!((pitch / 1_000.0 - 1.0).abs() < 0.02, "{from}: {pitch} Hz");
    }
}

#[test]
fn extreme_events_stay_finite() {
    let events = [
        event("bite", 0.1, Vec3::ZERO),
        SoundEvent { velocity: Vec3::X * 1e8, ..event("tone", 0.1, Vec3::new(-5.0, 0.0, 0.0)) },
        SoundEvent { amplitude: 100.0, ..event("splash", 0.1, Vec3::splat(1e-30)) },
        event("swish", 0.1, Vec3::splat(1e9)),
        SoundEvent { duration: 1e6, pitch: 1e6, ..event("crackle", 0.1, Vec3::Y) },
        event("bubble", -1e300, Vec3::X),
        event("bubble", 1e300, Vec3::X),
    ];
    let heard = render(AIR, &events, &resting(), 1.0);
    assert!(heard.iter().flatten().all(|sample| *sample == 0.0 || sample.is_normal()));
    assert!(peak(&heard) < 0.89);
}

#[test]
fn events_that_cannot_sound_are_refused_by_name() {
    let good = event("bite", 0.0, Vec3::Z);
    let bad = [
        ("position", SoundEvent { position: Vec3::new(0.0, f32::NAN, 0.0), ..good.clone() }),
        ("velocity", SoundEvent { velocity: Vec3::X * f32::INFINITY, ..good.clone() }),
        ("time", SoundEvent { time: f64::NAN, ..good.clone() }),
        ("amplitude", SoundEvent { amplitude: -1.0, ..good.clone() }),
        ("duration", SoundEvent { duration: f32::NAN, ..good.clone() }),
        ("pitch", SoundEvent { pitch: -3.0, ..good.clone() }),
    ];
    for (field, event) in bad {
        let mut track = SoundTrack::new(RATE, 7, QUIET_WATER).expect("the rate is valid");
        let error = track.add(&[good.clone(), event]).expect_err(field);
        assert!(error.to_string().contains(field), "{error}");
        let heard = track.render(&resting(), 0.0, 9_600).expect("the block is short");
        assert_eq!(peak(&heard), 0.0, "nothing of a refused batch is heard");
    }
}

#[test]
fn wrong_arguments_are_refused() {
    assert!(SoundTrack::new(44, 7, Medium::WATER).is_err());
    assert!(SoundTrack::new(RATE, 7, Medium { sound_speed: f32::NAN, ..Medium::AIR }).is_err());
    let mut track = SoundTrack::new(RATE, 7, Medium::WATER).expect("the rate is valid");
    assert!(track.render(&resting(), f64::NAN, 10).is_err());
    let error = track.render(&resting(), 0.0, usize::MAX).expect_err("too long");
    assert!(matches!(error, Error::Limit { .. }), "{error}");
    let nowhere = ListenerPose { time: 0.0, position: Vec3::NAN, rotation: Quat::IDENTITY };
    assert!(ListenerPath::starting(nowhere).is_err());
    let earlier = ListenerPose { time: -1.0, position: Vec3::ZERO, rotation: Quat::IDENTITY };
    assert!(resting().push(earlier).is_err());
}

#[test]
fn unknown_words_are_heard_and_reported_once() {
    let mut track = SoundTrack::new(RATE, 7, QUIET_WATER).expect("the rate is valid");
    let quack = |time| event("quack", time, Vec3::NEG_Z);
    track.add(&[quack(0.0), quack(0.02), event("bite", 0.0, Vec3::Z)]).expect("events are valid");
    let heard = track.render(&resting(), 0.0, 4_800).expect("the block is short");
    assert!(peak(&heard) > 0.05);
    assert_eq!(track.take_notices().unknown_kinds, ["quack"]);
    track.add(&[quack(0.2)]).expect("the event is valid");
    track.render(&resting(), 0.1, 9_600).expect("the block is short");
    assert!(track.take_notices().unknown_kinds.is_empty());
}
