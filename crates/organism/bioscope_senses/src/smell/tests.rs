use bioscope_core::{Percepts, Quat, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::{Medium, Obstacle, Points, Scene, Solids, Sun};

use super::*;
use crate::{Memory, Outlook, Sense, Surroundings, restore};

/// Morsels of plankton at these places, identities from 10 on, before a bubble.
fn scene(places: &[Vec3]) -> Scene {
    let points = |species: &str, first: u32, places: &[Vec3]| Points {
        name: species.into(),
        species: species.into(),
        ids: (first..first + places.len() as u32).collect(),
        positions: places.to_vec(),
        radii: vec![0.002; places.len()],
        color: [1.0; 3],
        opacity: 1.0,
        glassy: false,
    };
    let points = vec![points("plankton", 10, places), points("bubble", 90, &[Vec3::Z * 0.1])];
    Scene { points, ..Scene::default() }
}

fn smelled(smell: &mut Smell, places: &[Vec3], obstacles: &[Obstacle]) -> Vec<u32> {
    let (scene, memory, medium) = (scene(places), Memory::default(), Medium::default());
    let outlook = Outlook::new(&scene, &memory);
    let obstacles = Solids::from(obstacles.to_vec());
    let surroundings = Surroundings {
        id: 1,
        position: Vec3::ZERO,
        attitude: Quat::IDENTITY,
        velocity: Vec3::ZERO,
        body_length: 0.1,
        home: Vec3::ZERO,
        outlook: &outlook,
        sounds: &[],
        influence: Influence::default(),
        obstacles: &obstacles,
        terrain: None,
        medium: &medium,
        sun: Sun::default(),
        temperature: 20.0,
        time: 0.0,
        dt: 1.0 / 60.0,
    };
    let mut percepts = Percepts::default();
    smell.sense(&surroundings, &mut percepts).unwrap();
    assert!(percepts.seen.is_empty());
    percepts.smelled.iter().map(|one| one.id).collect()
}

#[test]
fn food_is_smelled_behind_and_through_rocks_within_the_range_nearest_first() {
    let mut smell = Smell::new(vec!["plankton".into()], SmellParameters::default());
    let places = [Vec3::Z * -1.9, Vec3::Z * 1.5, Vec3::Z * -2.1, Vec3::X * 0.3];
    let rock = [Obstacle::Sphere { center: Vec3::Z * 0.8, radius: 0.3 }];
    assert_eq!(smelled(&mut smell, &places, &rock), [13, 11, 10]);
    assert_eq!(smelled(&mut Smell::default(), &places, &[]), [0u32; 0]);
}

#[test]
fn only_the_nearest_are_attended_to_and_the_nose_is_saved() {
    let places: Vec<Vec3> = (1..20).map(|index| Vec3::Y * (0.1 * index as f32)).collect();
    let parameters = SmellParameters { attention: 3.0, ..SmellParameters::default() };
    let smell = Smell::new(vec!["plankton".into()], parameters);
    let mut smell: Smell = restore("smell", &smell.save().unwrap()).unwrap();
    assert_eq!(smelled(&mut smell, &places, &[]), [10, 11, 12]);
}
