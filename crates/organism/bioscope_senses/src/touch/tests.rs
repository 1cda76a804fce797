use bioscope_core::{Quat, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::{Medium, Obstacle, Scene, Solids, Sun, Terrain};

use super::*;
use crate::{Memory, Outlook, Surroundings};

const CLEAR: Medium = Medium {
    surface: None,
    absorption: [0.0; 3],
    scattering: [0.0; 3],
    glow: [0.0; 3],
    caustics: 0.0,
    caustic_scale: 1.0,
    shafts: 0.0,
};

fn at<'a>(
    position: Vec3,
    heading: Vec3,
    outlook: &'a Outlook<'a>,
    medium: &'a Medium,
) -> Surroundings<'a> {
    Surroundings {
        id: 1,
        position,
        attitude: Quat::from_rotation_arc(Vec3::Z, heading.normalize()),
        velocity: heading,
        body_length: 0.5,
        home: Vec3::ZERO,
        outlook,
        sounds: &[],
        influence: Influence::default(),
        obstacles: &crate::tests::OPEN,
        terrain: None,
        medium,
        sun: Sun::default(),
        temperature: 20.0,
        time: 0.0,
        dt: 1.0 / 60.0,
    }
}

#[test]
fn a_rock_ahead_is_felt_at_its_distance_and_passed_on_the_nearer_side() {
    let (scene, memory) = (Scene::default(), Memory::default());
    let outlook = Outlook::new(&scene, &memory);
    let rock = Obstacle::Sphere { center: Vec3::new(0.2, 0.0, 2.5), radius: 1.0 };
    let rocks = Solids::from(vec![rock]);
    let ahead = Surroundings { obstacles: &rocks, ..at(Vec3::ZERO, Vec3::Z, &outlook, &CLEAR) };
    let impact = impact_ahead(&ahead, &TouchParameters::default()).expect("a rock ahead");
    assert!((impact.distance - 1.34).abs() < 0.03, "{impact:?}");
    assert!(impact.aim.x < -1.0 && impact.aim.z > 2.0, "{impact:?}");
    let past = Surroundings { obstacles: &rocks, ..at(Vec3::X * 3.0, Vec3::Z, &outlook, &CLEAR) };
    assert_eq!(impact_ahead(&past, &TouchParameters::default()), None);
}

#[test]
fn walls_alongside_and_rocks_already_grazed_are_not_felt() {
    let (scene, memory) = (Scene::default(), Memory::default());
    let outlook = Outlook::new(&scene, &memory);
    let wall = Solids::from(vec![Obstacle::Plane { point: Vec3::X * 0.1, normal: Vec3::NEG_X }]);
    for (heading, felt) in
        [(Vec3::Z, false), (Vec3::new(-0.3, 0.0, 1.0), false), (Vec3::new(0.5, 0.0, 1.0), true)]
    {
        let along = Surroundings { obstacles: &wall, ..at(Vec3::ZERO, heading, &outlook, &CLEAR) };
        let impact = impact_ahead(&along, &TouchParameters::default());
        assert_eq!(impact.is_some(), felt, "{heading} {impact:?}");
    }
}

#[test]
fn the_surface_is_felt_from_below_and_the_ground_from_above() {
    let (scene, memory) = (Scene::default(), Memory::default());
    let outlook = Outlook::new(&scene, &memory);
    let water = Medium { surface: Some(0.0), ..CLEAR };
    let rising = at(Vec3::NEG_Y, Vec3::new(0.0, 1.0, 1.0), &outlook, &water);
    let impact = impact_ahead(&rising, &TouchParameters::default()).expect("the surface");
    assert!((rising.position + rising.attitude * impact.aim).y < -0.4, "{impact:?}");

    let slope = (0..400).map(|index| (index / 20) as f32 * 0.5 - 10.0).collect();
    let slope = Terrain::new([-10.0, -10.0], 1.0, 20, slope).unwrap();
    let level =
        Surroundings { terrain: Some(&slope), ..at(Vec3::Y * -4.0, Vec3::Z, &outlook, &water) };
    let impact = impact_ahead(&level, &TouchParameters::default()).expect("rising ground");
    let aim = level.position + level.attitude * impact.aim;
    assert!(aim.y > slope.height(aim.x, aim.z) + 0.2, "{aim}");
    let away = Surroundings { attitude: Quat::from_rotation_y(3.1), ..level };
    assert_eq!(impact_ahead(&away, &TouchParameters::default()), None);
}
