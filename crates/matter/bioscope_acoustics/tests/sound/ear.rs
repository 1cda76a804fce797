use bioscope_acoustics::{Ear, Medium, has_passed, hear};
use bioscope_core::{Hearing, NOTHING, Quat, SoundEvent, Vec3};

use crate::measure::event;

const TICK: f32 = 1.0 / 60.0;
const WATER: Medium = Medium::WATER;

fn ear() -> Ear {
    Ear {
        owner: 9,
        position: Vec3::ZERO,
        velocity: Vec3::ZERO,
        rotation: Quat::IDENTITY,
        threshold: 0.001,
    }
}

fn snap(time: f64, position: Vec3) -> SoundEvent {
    SoundEvent { duration: 1e-4, ..event("crackle", time, position) }
}

fn hear_at(ear: &Ear, events: &[SoundEvent], tick: i32) -> Vec<Hearing> {
    hear(ear, &WATER, events, f64::from(tick) * f64::from(TICK), TICK)
}

#[test]
fn a_snap_is_heard_once_when_its_sound_arrives() {
    let snaps = [snap(1.0, Vec3::Z * 157.5)];
    let sensitive = Ear { threshold: 0.0, ..ear() };
    let ticks: Vec<i32> =
        (0..120).filter(|&tick| !hear_at(&sensitive, &snaps, tick).is_empty()).collect();
    // 1 s + 157.5 m / (1500 m/s) = 1.105 s, within the 67th tick (1.1 s to 1.1167 s).
    assert_eq!(ticks, [67]);
}

#[test]
fn a_long_noise_is_heard_while_it_lasts() {
    let call = SoundEvent { duration: 0.5, ..event("tone", 0.2, Vec3::X * 3.0) };
    let ticks =
        (0..120).filter(|&tick| !hear_at(&ear(), std::slice::from_ref(&call), tick).is_empty());
    let ticks: Vec<i32> = ticks.collect();
    assert!(ticks.len().abs_diff(31) <= 1, "{ticks:?}");
}

#[test]
fn directions_are_in_the_animals_own_frame() {
    // Turned a quarter to its left, an animal that looked along +Z looks along +X.
    let turned = Ear { rotation: Quat::from_rotation_y(core::f32::consts::FRAC_PI_2), ..ear() };
    let heard = hear_at(&turned, &[snap(0.5, Vec3::X * 5.0)], 31);
    assert!((heard[0].direction - Vec3::Z).length() < 1e-5, "{heard:?}");
    let heard = hear_at(&turned, &[snap(0.5, Vec3::Z * -5.0)], 31);
    assert!((heard[0].direction - Vec3::X).length() < 1e-5, "{heard:?}");
    let heard = hear_at(&ear(), &[snap(0.5, Vec3::ZERO)], 31);
    assert_eq!(heard[0].direction, Vec3::Z, "a sound in the ear itself has a direction too");
}

#[test]
fn a_moving_source_is_heard_where_it_was() {
    let call = SoundEvent {
        duration: 2.0,
        velocity: Vec3::X * 150.0,
        ..event("tone", 0.0, Vec3::new(-150.0, 0.0, 150.0))
    };
    let heard = hear(&Ear { threshold: 0.0, ..ear() }, &WATER, &[call], 1.0, TICK);
    assert!(heard[0].direction.x < -0.08, "{heard:?}");
}

#[test]
fn loudest_first_and_own_and_faint_noises_not_at_all() {
    let own = SoundEvent { source: 9, ..snap(0.5, Vec3::Z * 2.0) };
    let events = [snap(0.5, Vec3::Z * 4.0), own, snap(0.5, Vec3::Z), snap(0.5, Vec3::X * 8.0)];
    let deaf = Ear { threshold: 0.05, ..ear() };
    let heard = hear_at(&deaf, &events, 31);
    assert_eq!(heard.len(), 2);
    assert!(heard[0].amplitude > heard[1].amplitude && heard[0].amplitude <= 0.3);
    assert_eq!(hear_at(&Ear { owner: NOTHING, ..deaf }, &events, 31).len(), 3);
}

#[test]
fn numbers_that_are_not_finite_are_not_heard() {
    let broken = SoundEvent { position: Vec3::NAN, ..snap(0.5, Vec3::Z) };
    assert!(hear_at(&ear(), &[broken], 31).is_empty());
    assert!(hear_at(&Ear { position: Vec3::NAN, ..ear() }, &[snap(0.5, Vec3::Z)], 31).is_empty());
}

#[test]
fn events_may_be_forgotten_once_they_have_passed() {
    let call = SoundEvent { duration: 0.5, ..event("tone", 1.0, Vec3::X * 30.0) };
    assert!(!has_passed(&call, &WATER, 30.0, 1.5));
    assert!(has_passed(&call, &WATER, 30.0, 1.6));
    assert!(has_passed(&SoundEvent { time: f64::NAN, ..call }, &WATER, 30.0, 0.0));
}
