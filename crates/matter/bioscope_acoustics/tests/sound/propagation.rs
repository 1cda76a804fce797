use bioscope_acoustics::synthesis::synthesize;
use bioscope_acoustics::{Medium, arrival};
use bioscope_core::{Quat, Vec3};

use crate::measure::*;

#[test]
fn sound_arrives_after_distance_over_speed() {
    for (medium, distance) in [(QUIET_WATER, 75.0), (AIR, 34.3), (QUIET_WATER, 3.0)] {
        let click = event("crackle", 0.05, Vec3::new(0.0, 0.0, -distance));
        let heard = side(&render(medium, std::slice::from_ref(&click), &resting(), 0.5), 0);
        let clip = synthesize(&click, 7, RATE);
        let expected = (0.05 + f64::from(distance / medium.sound_speed)) * f64::from(RATE);
        let measured = lag(&clip, &heard) as f64;
        assert!((measured - expected).abs() <= 1.0, "{distance} m: {measured}, not {expected}");
    }
}

#[test]
fn emission_time_solves_the_equation_of_travel() {
    for velocity in [Vec3::ZERO, Vec3::new(-30.0, 0.0, 0.0), Vec3::new(10.0, 250.0, -90.0)] {
        let source = tone(440.0, 1.0, Vec3::new(100.0, 4.0, -7.0), velocity);
        for time in [0.0, 0.7, 3.0] {
            let place = Vec3::new(1.0, 2.0, 3.0);
            let found = arrival(&AIR, &source, place, time);
            let origin = source.position + velocity * found.emission_time as f32;
            let travel = (time - found.emission_time) * 343.0;
            assert!((f64::from(origin.distance(place)) - travel).abs() < 1e-3);
            assert!((found.offset - (origin - place)).length() < 1e-3);
        }
    }
}

/// A source at 100 - 30 t m is heard at t = 1 s from 77 m where sound travels at 330 m/s.
#[test]
fn worked_example_of_a_source_on_a_line() {
    let medium = Medium { sound_speed: 330.0, ..AIR };
    let source = tone(440.0, 1.0, Vec3::X * 100.0, Vec3::X * -30.0);
    let found = arrival(&medium, &source, Vec3::ZERO, 1.0);
    assert!((found.distance - 77.0).abs() < 0.25, "{}", found.distance);
    let exact = 70.0 / (1.0 - 30.0 / 330.0);
    assert!((found.distance - exact).abs() < 1e-3, "{}", found.distance);
}

#[test]
fn level_falls_six_decibels_per_doubling() {
    let level = |distance: f32| {
        let source = tone(200.0, 0.4, Vec3::Z * -distance, Vec3::ZERO);
        let heard = side(&render(QUIET_WATER, &[source], &resting(), 0.4), 0);
        rms(&heard[9_600..16_800])
    };
    for distance in [1.0, 2.0, 4.0, 8.0] {
        let fall = decibels(level(distance) / level(2.0 * distance));
        assert!((fall - 6.02).abs() < 0.1, "{distance} m: {fall} dB");
    }
    let near = decibels(level(0.2) / level(0.3));
    assert!(near.abs() < 0.01, "within the reference distance: {near} dB");
}

#[test]
fn far_sounds_are_duller() {
    let share = |pitch: f32, distance: f32| {
        let source = tone(pitch, 0.3, Vec3::Z * -distance, Vec3::ZERO);
        rms(&side(&render(QUIET_WATER, &[source], &resting(), 0.3), 0)[4_800..12_000]) * distance
    };
    let loss = |distance| decibels(share(200.0, distance) / share(6_000.0, distance));
    assert!(loss(1.0) < 1.0 && loss(40.0) > 3.0, "{} {}", loss(1.0), loss(40.0));
}

/// Received frequency over sent one: (c - listener) / (c - source), speeds along the way of sound.
#[test]
fn doppler_ratio_of_moving_sources_and_listeners() {
    let away = Vec3::NEG_Z;
    let cases = [
        (QUIET_WATER, -30.0, 0.0, 1500.0 / 1470.0),
        (QUIET_WATER, 30.0, 0.0, 1500.0 / 1530.0),
        (AIR, -30.0, 0.0, 343.0 / 313.0),
        (AIR, 30.0, 0.0, 343.0 / 373.0),
        (AIR, 0.0, 30.0, 373.0 / 343.0),
        (AIR, 0.0, -30.0, 313.0 / 343.0),
        (AIR, -20.0, 20.0, 363.0 / 323.0),
    ];
    for (medium, source_speed, listener_speed, expected) in cases {
        let source = tone(1_000.0, 1.0, away * 60.0, away * source_speed);
        let listener = moving(away * listener_speed, 1.5);
        let heard = side(&render(medium, &[source], &listener, 1.0), 0);
        let ratio = frequency(&heard[16_000..40_000]) / 1_000.0;
        assert!(
            (ratio / expected - 1.0).abs() < 0.001,
            "source {source_speed}, listener {listener_speed}: {ratio}, not {expected}"
        );
    }
}

#[test]
fn sounds_come_from_their_side_with_the_same_energy() {
    let place = |degrees: f32| {
        let angle = degrees.to_radians();
        Vec3::new(angle.sin(), 0.0, -angle.cos()) * 4.0
    };
    let levels = |degrees: f32| {
        let source = tone(200.0, 0.3, place(degrees), Vec3::ZERO);
        let heard = render(QUIET_WATER, &[source], &resting(), 0.3);
        [0, 1].map(|ear| rms(&side(&heard, ear)[4_800..12_000]))
    };
    let [left, right] = levels(-60.0);
    assert!(left > 1.5 * right, "{left} {right}");
    let [left, right] = levels(60.0);
    assert!(right > 1.5 * left, "{left} {right}");
    let ahead = levels(0.0);
    assert!((ahead[0] - ahead[1]).abs() < 1e-6);
    let energy = |[left, right]: [f32; 2]| left * left + right * right;
    for degrees in [-150.0, -90.0, -45.0, 10.0, 70.0, 90.0, 180.0] {
        let ratio = decibels(energy(levels(degrees)) / energy(ahead)) / 2.0;
        assert!(ratio.abs() < 0.1, "{degrees} degrees: {ratio} dB");
    }
}

#[test]
fn turning_the_listener_turns_the_sounds() {
    let source = tone(300.0, 0.3, Vec3::new(0.0, 0.0, -4.0), Vec3::ZERO);
    let turned_left = turned(Quat::from_rotation_y(core::f32::consts::FRAC_PI_2));
    let heard = render(QUIET_WATER, &[source], &turned_left, 0.3);
    assert!(rms(&side(&heard, 1)) > 1.5 * rms(&side(&heard, 0)));
}

#[test]
fn the_nearer_ear_hears_first() {
    let click = event("crackle", 0.1, Vec3::X * 5.0);
    let clip = synthesize(&click, 7, RATE);
    let heard = render(AIR, &[click], &resting(), 0.5);
    let [left, right] = [0, 1].map(|ear| lag(&clip, &side(&heard, ear)));
    let between = (left - right) as f32 / RATE as f32;
    assert!((0.0004..0.0007).contains(&between), "{between} s");
}
