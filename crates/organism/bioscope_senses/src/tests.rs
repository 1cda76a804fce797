//! The senses without a folder of their own: hearing, lateral line, light.

use bioscope_core::{Percepts, Quat, SoundEvent, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::{Medium, Scene, Solids, Sun};

use crate::{
    Hearing, HearingParameters, LateralLine, Light, Memory, Outlook, Sense, Surroundings, restore,
};

const DT: f32 = 1.0 / 60.0;
/// No solid anywhere.
pub(crate) static OPEN: Solids = Solids::new();

/// Two metres under the surface, turned to +X.
fn surroundings<'a>(outlook: &'a Outlook<'a>, medium: &'a Medium) -> Surroundings<'a> {
    Surroundings {
        id: 1,
        position: Vec3::Y * -2.0,
        attitude: Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
        velocity: Vec3::X,
        body_length: 0.3,
        home: Vec3::ZERO,
        outlook,
        sounds: &[],
        influence: Influence::default(),
        obstacles: &OPEN,
        terrain: None,
        medium,
        sun: Sun { direction: Vec3::Y, ..Sun::default() },
        temperature: 20.0,
        time: 1.0,
        dt: DT,
    }
}

fn water() -> Medium {
    Medium { surface: Some(0.0), absorption: [0.3, 0.1, 0.05], ..Medium::default() }
}

fn bite(source: u32, position: Vec3) -> SoundEvent {
    SoundEvent {
        source,
        kind: "bite".into(),
        time: 1.0 - f64::from(DT),
        duration: 0.002,
        position,
        velocity: Vec3::ZERO,
        amplitude: 0.5,
        pitch: 800.0,
    }
}

#[test]
fn sounds_arrive_late_from_far_once_and_never_from_oneself() {
    let (scene, memory, medium) = (Scene::default(), Memory::default(), water());
    let outlook = Outlook::new(&scene, &memory);
    // 45 m of water take 30 ms: not this tick of 17 ms but the next.
    let sounds = [
        bite(2, Vec3::new(2.0, -2.0, 0.0)),
        bite(3, Vec3::new(0.0, -2.0, -45.0)),
        bite(1, Vec3::new(0.1, -2.0, 0.0)),
    ];
    let mut hearing =
        Hearing::new(HearingParameters { threshold: 0.0, ..HearingParameters::default() });
    let mut heard = Vec::new();
    for tick in 0..4 {
        let mut percepts = Percepts::default();
        let mut now = surroundings(&outlook, &medium);
        now.time += f64::from(tick) * f64::from(DT);
        now.sounds = if tick == 0 { &sounds } else { &[] };
        hearing = restore("hearing", &hearing.save().unwrap()).unwrap();
        hearing.sense(&now, &mut percepts).unwrap();
        heard.extend(percepts.heard.into_iter().map(|one| (tick, one)));
    }
    let whose: Vec<_> = heard.iter().map(|(tick, one)| (*tick, one.source)).collect();
    assert_eq!(whose, [(0, 2), (1, 3)]);
    assert!(heard[0].1.direction.distance(Vec3::Z) < 0.05, "ahead: {:?}", heard[0].1);
    assert!(heard[1].1.direction.distance(Vec3::X) < 0.05, "to the left: {:?}", heard[1].1);
    assert!(heard[0].1.amplitude > 5.0 * heard[1].1.amplitude);
}

#[test]
fn the_lateral_line_feels_the_flow_past_the_body() {
    let (scene, memory, medium) = (Scene::default(), Memory::default(), water());
    let outlook = Outlook::new(&scene, &memory);
    let mut percepts = Percepts::default();
    let mut now = surroundings(&outlook, &medium);
    now.influence.flow = Vec3::new(0.0, 0.0, 0.5);
    LateralLine.sense(&now, &mut percepts).unwrap();
    // It swims at 1 m/s along +X, so the water comes from ahead; +Z of the world is its right.
    assert!(percepts.flow.distance(Vec3::new(-0.5, 0.0, -1.0)) < 1e-5, "{}", percepts.flow);
}

#[test]
fn it_darkens_with_depth_and_lamps_and_springs_add_to_light_and_warmth() {
    let (scene, memory, medium) = (Scene::default(), Memory::default(), water());
    let outlook = Outlook::new(&scene, &memory);
    let bright = |depth: f32, lamp: f32| {
        let mut percepts = Percepts::default();
        let mut now = surroundings(&outlook, &medium);
        now.position.y = -depth;
        now.influence = Influence { light: lamp, temperature: 1.5, ..Influence::default() };
        Light.sense(&now, &mut percepts).unwrap();
        assert_eq!(percepts.temperature, 21.5);
        percepts.light
    };
    assert!((bright(0.0, 0.0) - 1.0).abs() < 1e-5);
    let expected: f32 = [(0.2126, 3.0, 0.3), (0.7152, 2.9, 0.1), (0.0722, 2.7, 0.05)]
        .map(|(weight, sun, absorbed): (f32, f32, f32)| weight * sun * (-absorbed * 4.0).exp())
        .iter()
        .sum();
    let full = 0.2126 * 3.0 + 0.7152 * 2.9 + 0.0722 * 2.7;
    assert!((bright(4.0, 0.0) - expected / full).abs() < 1e-5);
    assert!((bright(400.0, 0.25) - 0.25).abs() < 1e-5);
}
