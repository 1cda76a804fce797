use std::sync::Arc;

use bioscope_core::{Percepts, Quat, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::{
    Batch, Material, Medium, Mesh, Obstacle, Scene, Solids, Sun, Terrain, Transform,
};
use proptest::prelude::*;

use super::*;
use crate::{Memory, Outlook, Sense, Surroundings, restore};

/// A scene with one living thing 0.2 m long at each place, identities from 10 on.
fn scene(places: &[Vec3]) -> Scene {
    let positions = vec![Vec3::new(0.0, 0.0, -0.1), Vec3::new(0.0, 0.0, 0.1)];
    let mesh = Arc::new(Mesh { positions, ..Mesh::default() });
    let mut batch = Batch::new("prey", "prey", mesh, Arc::new(Material::default()));
    batch.alive = true;
    batch.ids = (10..10 + places.len() as u32).collect();
    batch.transforms = places.iter().map(|&place| Transform::at(place)).collect();
    batch.velocities = vec![Vec3::X; places.len()];
    Scene { batches: vec![batch], ..Scene::default() }
}

fn surroundings<'a>(outlook: &'a Outlook<'a>, medium: &'a Medium) -> Surroundings<'a> {
    Surroundings {
        id: 1,
        position: Vec3::ZERO,
        attitude: Quat::IDENTITY,
        velocity: Vec3::ZERO,
        body_length: 0.0,
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

fn seen(surroundings: &Surroundings) -> Vec<u32> {
    let mut percepts = Percepts::default();
    Sight::default().sense(surroundings, &mut percepts).unwrap();
    percepts.seen.iter().map(|one| one.id).collect()
}

fn at_angle(degrees: f32, distance: f32) -> Vec3 {
    let angle = degrees.to_radians();
    Vec3::new(angle.sin(), 0.0, angle.cos()) * distance
}

#[test]
fn the_field_of_view_is_300_degrees() {
    let scene = scene(&[at_angle(149.0, 2.0), at_angle(151.0, 2.0), at_angle(-149.0, 3.0)]);
    let memory = Memory::default();
    let outlook = Outlook::new(&scene, &memory);
    assert_eq!(seen(&surroundings(&outlook, &Medium::default())), [10, 12]);
}

#[test]
fn the_nearest_are_seen_first_and_only_so_many() {
    let scene = scene(&[at_angle(0.0, 4.0), at_angle(90.0, 2.0), at_angle(20.0, 3.0)]);
    let memory = Memory::default();
    let outlook = Outlook::new(&scene, &memory);
    let (medium, mut percepts) = (Medium::default(), Percepts::default());
    let parameters = SightParameters { attention: 2.0, ..SightParameters::default() };
    Sight::new(parameters).sense(&surroundings(&outlook, &medium), &mut percepts).unwrap();
    assert_eq!(percepts.seen.iter().map(|one| one.id).collect::<Vec<_>>(), [11, 12]);
}

#[test]
fn what_is_far_small_or_lost_in_haze_is_not_seen() {
    let scene = scene(&[Vec3::Z * 29.0, Vec3::Z * 31.0]);
    let memory = Memory::default();
    let outlook = Outlook::new(&scene, &memory);
    let murky = Medium { absorption: [0.3; 3], scattering: [0.1; 3], ..Medium::default() };
    assert_eq!(seen(&surroundings(&outlook, &Medium::default())), [10]);
    assert_eq!(seen(&surroundings(&outlook, &murky)), [0u32; 0]);
    let sharp = SightParameters { acuity: 1.0, ..SightParameters::default() };
    let (medium, mut percepts) = (Medium::default(), Percepts::default());
    Sight::new(sharp).sense(&surroundings(&outlook, &medium), &mut percepts).unwrap();
    assert!(percepts.seen.is_empty(), "0.2 m in 29 m is 0.4 degrees");
}

#[test]
fn nobody_sees_itself_nor_what_does_not_live() {
    let mut scene = scene(&[Vec3::Z]);
    let memory = Memory::default();
    let outlook = Outlook::new(&scene, &memory);
    let medium = Medium::default();
    let mut own = surroundings(&outlook, &medium);
    own.id = 10;
    assert!(seen(&own).is_empty());
    scene.batches[0].alive = false;
    let lifeless = Outlook::new(&scene, &memory);
    assert!(seen(&surroundings(&lifeless, &medium)).is_empty());
}

#[test]
fn rocks_and_ground_hide_what_is_behind_them() {
    let scene = scene(&[Vec3::Z * 10.0, Vec3::new(4.0, 0.0, 10.0)]);
    let memory = Memory::default();
    let outlook = Outlook::new(&scene, &memory);
    let (medium, rock) = (Medium::default(), Vec3::Z * 5.0);
    let rocks = Solids::from(vec![Obstacle::Sphere { center: rock, radius: 1.0 }]);
    let behind_rock = Surroundings { obstacles: &rocks, ..surroundings(&outlook, &medium) };
    assert_eq!(seen(&behind_rock), [11]);
    let on_top = Solids::from(vec![Obstacle::Sphere { center: Vec3::Z * 10.0, radius: 0.05 }]);
    let on_rock = Surroundings { obstacles: &on_top, ..surroundings(&outlook, &medium) };
    assert_eq!(seen(&on_rock), [10, 11], "what sits on a small rock is seen");
    // A ridge along x at z = 4, two metres high.
    let heights = (0..16 * 16).map(|index| if index / 16 == 4 { 2.0 } else { -1.0 }).collect();
    let ridge = Terrain::new([-8.0, 0.0], 1.0, 16, heights).unwrap();
    let behind_ridge = Surroundings { terrain: Some(&ridge), ..surroundings(&outlook, &medium) };
    assert_eq!(seen(&behind_ridge), [0u32; 0]);
}

#[test]
fn comes_back_from_its_bytes_and_refuses_senseless_ones() {
    let parameters = SightParameters { range: 12.0, ..SightParameters::default() };
    let sight = Sight::new(parameters);
    assert_eq!(
        restore::<Sight>("sight", &sight.save().unwrap()).unwrap().save().unwrap(),
        sight.save().unwrap()
    );
    let blind = Sight::new(SightParameters { range: -1.0, ..SightParameters::default() });
    let error = restore::<Sight>("sight", &blind.save().unwrap()).unwrap_err();
    assert!(error.to_string().contains("range"), "{error}");
}

proptest! {
    #[test]
    fn percepts_are_in_the_own_frame_however_the_animal_is_turned(
        yaw in -3f32..3.0, pitch in -1.5f32..1.5, roll in -3f32..3.0,
        x in -3f32..3.0, y in -3f32..3.0, z in 1f32..4.0,
    ) {
        let attitude = Quat::from_euler(glam_order(), yaw, pitch, roll);
        let place = Vec3::new(7.0, -3.0, 2.0);
        let own = Vec3::new(x, y, z);
        let scene = scene(&[place + attitude * own]);
        let memory = Memory::default();
        let outlook = Outlook::new(&scene, &memory);
        let medium = Medium::default();
        let turned = Surroundings {
            position: place, attitude, velocity: attitude * Vec3::Z, home: place + attitude * Vec3::Y,
            ..surroundings(&outlook, &medium)
        };
        let mut percepts = Percepts::default();
        turned.begin(&mut percepts);
        Sight::default().sense(&turned, &mut percepts).unwrap();
        let sighting = &percepts.seen[0];
        prop_assert!((sighting.position - own).length() < 1e-4);
        prop_assert!((attitude * sighting.velocity - Vec3::X).length() < 1e-4);
        prop_assert!((percepts.velocity - Vec3::Z).length() < 1e-5);
        prop_assert!((percepts.home - Vec3::Y).length() < 1e-4);
    }
}

fn glam_order() -> glam::EulerRot {
    glam::EulerRot::YXZ
}

#[test]
fn the_distance_of_detection_is_fifteen_times_the_targets_size() {
    let parameters = SightParameters::fish();
    let seen_at = |size: f32, distance: f32| {
        let mut scene = scene(&[Vec3::Z * distance]);
        scene.batches[0].transforms[0].scale = size / 0.2;
        let (memory, medium, mut percepts) =
            (Memory::default(), Medium::default(), Percepts::default());
        let outlook = Outlook::new(&scene, &memory);
        let surroundings = surroundings(&outlook, &medium);
        Sight::new(parameters.clone()).sense(&surroundings, &mut percepts).unwrap();
        !percepts.seen.is_empty()
    };
    for size in [0.05, 0.2, 1.0] {
        assert!(seen_at(size, 14.9 * size) && !seen_at(size, 15.1 * size), "{size} m");
    }
}

#[test]
fn one_part_that_shows_is_enough() {
    // Ten metres long, looking at us from the side, with a pillar before its middle.
    let mut scene = scene(&[Vec3::Z * 8.0]);
    scene.batches[0].transforms[0] =
        Transform::new(Vec3::Z * 8.0, Quat::from_rotation_y(std::f32::consts::FRAC_PI_2), 20.0);
    let (medium, memory) = (Medium::default(), Memory::default());
    let outlook = Outlook::new(&scene, &memory);
    let pillar = |radius: f32| {
        let (base, top) = (Vec3::new(0.0, -9.0, 3.0), Vec3::new(0.0, 9.0, 3.0));
        Solids::from(vec![Obstacle::Cylinder { base, top, radius }])
    };
    let behind = |pillars: &Solids| {
        seen(&Surroundings { obstacles: pillars, ..surroundings(&outlook, &medium) })
    };
    assert_eq!(behind(&pillar(0.5)), [10]);
    assert_eq!(behind(&pillar(2.9)), [0u32; 0]);
}

#[test]
fn sizes_colors_headings_and_displays_are_seen_and_solids_noticed() {
    let mut scene = scene(&[Vec3::Z * 2.0]);
    let display = bioscope_core::Display { partner: 7, ..bioscope_core::Display::NONE };
    scene.batches[0].tints = vec![[0.5, 1.0, 2.0]];
    scene.batches[0].displays = vec![display];
    scene.batches[0].transforms[0] =
        Transform::new(Vec3::Z * 2.0, Quat::from_rotation_y(std::f32::consts::FRAC_PI_2), 0.5);
    let (medium, memory, mut percepts) =
        (Medium::default(), Memory::default(), Percepts::default());
    let outlook = Outlook::new(&scene, &memory);
    let centers = [(-3.0, 0.0, 0.0), (1.5, 0.0, 0.0), (0.0, 40.0, 0.0)].map(Vec3::from);
    let balls = centers.map(|center| Obstacle::Sphere { center, radius: 1.0 });
    let solids = Solids::from(balls.to_vec());
    let place = surroundings(&outlook, &medium);
    let surroundings = Surroundings { obstacles: &solids, body_length: 0.5, ..place };
    Sight::default().sense(&surroundings, &mut percepts).unwrap();
    let one = &percepts.seen[0];
    assert!((one.size - 0.1).abs() < 1e-6 && one.heading.distance(Vec3::X) < 1e-4, "{one:?}");
    assert_eq!((one.color, one.display), ([0.4, 0.8, 1.6], display));
    assert_eq!(percepts.solids.len(), 2);
    assert!(
        percepts.solids[0].distance(Vec3::new(0.51, 0.0, 0.145)) < 0.01,
        "{:?}",
        percepts.solids
    );
}

#[test]
fn what_moves_is_attended_to_before_what_stays() {
    let places = [Vec3::Z, Vec3::Z * 2.0, Vec3::Z * 3.0];
    let mut all = scene(&places);
    let mut plants = scene(&places[..2]).batches.remove(0);
    plants.velocities.clear();
    plants.ids = vec![20, 21];
    all.batches.push(plants);
    let (medium, memory) = (Medium::default(), Memory::default());
    let outlook = Outlook::new(&all, &memory);
    let parameters = SightParameters { attention: 4.0, ..SightParameters::default() };
    let mut percepts = Percepts::default();
    Sight::new(parameters).sense(&surroundings(&outlook, &medium), &mut percepts).unwrap();
    let ids: Vec<u32> = percepts.seen.iter().map(|one| one.id).collect();
    assert_eq!(ids, [10, 20, 11, 12]);
}

#[test]
fn whoever_looks_on_sees_what_one_who_looks_first_sees() {
    let mut places: Vec<Vec3> = (0..300)
        .map(|index| {
            let turn = index as f32 * 2.4;
            Vec3::new(turn.sin(), (turn * 0.37).sin(), turn.cos()) * (0.3 + 0.02 * index as f32)
        })
        .collect();
    let (medium, memory) = (Medium::default(), Memory::default());
    let parameters = SightParameters { attention: 200.0, ..SightParameters::fish() };
    let mut sight = Sight::new(parameters.clone());
    for tick in 0..80usize {
        for (index, place) in places.iter_mut().enumerate() {
            *place += Vec3::new((index as f32).sin(), 0.2, (index as f32).cos()) * 0.02;
        }
        match tick % 20 {
            7 => places.push(Vec3::splat(0.5)),
            11 => drop(places.remove(tick)),
            15 => places[tick] = Vec3::new(0.2, 0.0, 1.0),
            _ => {}
        }
        let scene = scene(&places);
        let outlook = Outlook::new(&scene, &memory);
        let position = Vec3::new(0.0, 0.0, 0.03 * tick as f32);
        let place = Surroundings { position, ..surroundings(&outlook, &medium) };
        let look = |sight: &mut Sight| {
            let mut percepts = Percepts::default();
            sight.sense(&place, &mut percepts).unwrap();
            percepts.seen
        };
        let seen = look(&mut sight);
        assert!(seen.len() > 20);
        assert_eq!(seen, look(&mut Sight::new(parameters.clone())), "tick {tick}");
    }
}
