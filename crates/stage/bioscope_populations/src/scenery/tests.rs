use bioscope_core::Vec3;
use bioscope_geometry::{Mesh, Obstacle, ReefRelief, Transform};
use bioscope_world::World;

use super::*;
use crate::placement::{Area, Habitat};
use crate::registry;

fn relief() -> ReefRelief {
    ReefRelief { size: [20.0, 20.0], wall: -3.0, spacing: 0.25, ..ReefRelief::default() }
}

fn reef() -> World {
    let mut world = World::new(5, 0.02).unwrap();
    world.environment.fill_with_water(0.0);
    let ground = GroundOptions { relief: Some(relief()), ..GroundOptions::default() };
    world.add(Box::new(Ground::new(ground).unwrap()), None).unwrap();
    world
}

fn habitat() -> Habitat {
    Habitat { area: Area::Disk { center: [0.0, 1.0], radius: 6.0 }, ..Habitat::default() }
}

fn rocks() -> Rocks {
    let options =
        RocksOptions { count: 25, habitat: habitat(), shapes: 2, ..RocksOptions::default() };
    Rocks::new(options).unwrap()
}

fn corals() -> Corals {
    let colonies = CoralKind::ALL.map(|kind| (kind, 4)).to_vec();
    let options =
        CoralsOptions { colonies, habitat: habitat(), variants: 1, ..CoralsOptions::default() };
    Corals::new(options).unwrap()
}

/// Whether all of a mesh can be drawn: numbers in range, finite, normals of length one.
fn check_mesh(mesh: &Mesh, name: &str) {
    let count = mesh.positions.len();
    assert!(!mesh.triangles.is_empty(), "{name} is empty");
    assert!(mesh.triangles.iter().flatten().all(|&index| (index as usize) < count), "{name}");
    assert_eq!(mesh.normals.len(), count, "{name}");
    assert!(mesh.colors.len() == count || mesh.colors.is_empty(), "{name}");
    assert!(mesh.uvs.len() == count || mesh.uvs.is_empty(), "{name}");
    assert!(mesh.positions.iter().all(|one| one.is_finite()), "{name}");
    assert!(mesh.normals.iter().all(|one| (one.length() - 1.0).abs() < 1e-3), "{name}");
    assert!(mesh.colors.iter().flatten().all(|one| (0.0..=2.0).contains(one)), "{name}");
}

#[test]
fn every_mesh_and_every_coarser_version_can_be_drawn() {
    let mut world = reef();
    world.add(Box::new(rocks()), None).unwrap();
    world.add(Box::new(corals()), None).unwrap();
    let scene = world.scene();
    let mut names: Vec<&str> = scene.batches.iter().map(|one| one.name.as_str()).collect();
    for batch in &scene.batches {
        check_mesh(&batch.mesh, &batch.name);
        let mut last = (f32::MAX, batch.mesh.triangles.len());
        for (size, level) in &batch.mesh.levels {
            check_mesh(level, &batch.name);
            assert!(*size < last.0 && level.triangles.len() < last.1, "{}", batch.name);
            last = (*size, level.triangles.len());
        }
        assert!(batch.mesh.levels.len() >= 2, "{}", batch.name);
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), scene.batches.len(), "names are unique");
}

#[test]
fn the_ground_looks_like_the_terrain_it_is() {
    let world = reef();
    let terrain = world.environment.terrain.clone().unwrap();
    let points: Vec<Vec3> = world
        .scene()
        .batches
        .iter()
        .flat_map(|batch| batch.mesh.positions.iter().copied())
        .collect();
    assert!(points.len() > 5000);
    let near = |point: &&Vec3| (point.y - terrain.height(point.x, point.z)).abs() < 0.45;
    let share = points.iter().filter(near).count() as f32 / points.len() as f32;
    assert!(share > 0.85, "{share} of the vertices are near the terrain");
    let species = |name: &str| world.scene().batches.iter().any(|one| &*one.species == name);
    assert!(species("seabed_sand") && species("seabed_rock"));
}

#[test]
fn rocks_and_corals_stand_on_the_ground_in_their_area_and_are_obstacles() {
    let mut world = reef();
    let ground_batches = world.scene().batches.len();
    world.add(Box::new(rocks()), None).unwrap();
    world.add(Box::new(corals()), None).unwrap();
    let terrain = world.environment.terrain.clone().unwrap();
    let mut count = 0;
    for batch in &world.scene().batches[ground_batches..] {
        assert_eq!(batch.alive, &*batch.species != "rock");
        for place in &batch.transforms {
            let Vec3 { x, y, z } = place.position;
            assert!(habitat().area.contains(x, z), "{} at {x}, {z}", batch.name);
            let height = y - terrain.height(x, z);
            assert!((-0.8..0.5).contains(&height), "{} {height} m above ground", batch.name);
            count += 1;
        }
    }
    assert_eq!(count, 25 + 28);
    // Rocks and five of the seven kinds of coral are solid.
    assert_eq!(world.environment.obstacles.len(), 25 + 20);
}

#[test]
fn corals_keep_to_the_slopes_they_favor() {
    let mut world = reef();
    let area = Area::Rectangle { low: [-8.0; 2], high: [8.0; 2] };
    let steep = Habitat { area, slope: [20.0, 60.0], ..Habitat::default() };
    let colonies = vec![(CoralKind::Bush, 60)];
    let options = CoralsOptions { colonies, habitat: steep, variants: 1, ..Default::default() };
    world.add(Box::new(Corals::new(options).unwrap()), None).unwrap();
    let terrain = world.environment.terrain.clone().unwrap();
    let batch = world.scene().batches.last().unwrap();
    let on_slope = batch.transforms.iter().filter(|place| {
        let normal = terrain.normal(place.position.x, place.position.z);
        (14.0..66.0).contains(&normal.y.acos().to_degrees())
    });
    assert!(on_slope.count() >= 54);
}

#[test]
fn shrimps_crackle_as_often_as_they_should() {
    let mut world = reef();
    world.add(Box::new(corals()), None).unwrap();
    world.set("corals", "crackle", 12.0).unwrap();
    let mut snaps = 0;
    for _ in 0..3000 {
        world.tick().unwrap();
        snaps += world.sounds().len();
        for sound in world.sounds() {
            assert_eq!(sound.kind, "crackle");
            assert!(sound.time > world.time() - 0.021 && sound.time <= world.time());
        }
    }
    // 720 expected in a minute, with a standard deviation of 27.
    assert!((620..820).contains(&snaps), "{snaps}");
}

#[test]
fn continue_alike_after_a_restore_and_on_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut world = reef();
            world.add(Box::new(rocks()), None).unwrap();
            world.add(Box::new(corals()), None).unwrap();
            (0..50).for_each(|_| world.tick().unwrap());
            let saved = world.save().unwrap();
            let second = World::restore(&saved, &registry()).unwrap();
            assert_eq!(second.sounds(), world.sounds());
            for (a, b) in world.scene().batches.iter().zip(&second.scene().batches) {
                assert_eq!((&a.name, &a.ids, &a.transforms), (&b.name, &b.ids, &b.transforms));
                assert_eq!(a.mesh.positions, b.mesh.positions, "{}", a.name);
                assert_eq!(a.mesh.colors, b.mesh.colors, "{}", a.name);
            }
            let key = |world: &World| world.scene().batches[0].mesh.key.number();
            let before = key(&world);
            world.return_to(&saved).unwrap();
            assert_eq!(key(&world), before, "shapes are kept");
            assert_eq!(world.state_hash().unwrap(), second.state_hash().unwrap());
            let positions: Vec<Vec3> = second
                .scene()
                .batches
                .iter()
                .flat_map(|one| one.mesh.positions.iter().copied())
                .collect();
            (world.state_hash().unwrap(), positions)
        })
    };
    assert!(run(1) == run(2));
}

fn tent() -> PropsOptions {
    PropsOptions {
        species: String::from("tent"),
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        color: [0.5; 3],
        places: vec![Transform::at(Vec3::new(1.0, 2.0, 3.0)); 2],
        obstacles: vec![Obstacle::Sphere { center: Vec3::ZERO, radius: 1.0 }],
        ..PropsOptions::default()
    }
}

#[test]
fn props_are_shown_saved_and_steered_round() {
    let mut world = World::new(5, 0.02).unwrap();
    world.add(Box::new(Props::new(tent()).unwrap()), None).unwrap();
    assert_eq!(world.environment.obstacles.len(), 1);
    let batch = &world.scene().batches[0];
    check_mesh(&batch.mesh, "tent");
    assert_eq!((batch.ids.len(), batch.transforms[1].position.z), (2, 3.0));
    let second = World::restore(&world.save().unwrap(), &registry()).unwrap();
    assert_eq!(second.state_hash().unwrap(), world.state_hash().unwrap());
    assert_eq!(second.scene().batches[0].mesh.positions, batch.mesh.positions);
}

#[test]
fn refuses_what_cannot_be_shown() {
    let refused = |change: fn(&mut PropsOptions)| {
        let mut options = tent();
        change(&mut options);
        Props::new(options).is_err()
    };
    assert!(refused(|one| one.triangles.push([0, 1, 4])));
    assert!(refused(|one| one.positions[0].x = f32::NAN));
    assert!(refused(|one| one.uvs = vec![[0.0; 2]; 3]));
    assert!(refused(|one| one.texture = Some(Picture { width: 0, pixels: vec![[0; 4]] })));
    assert!(refused(|one| one.places[0].scale = f32::INFINITY));
    assert!(Rocks::new(RocksOptions { shapes: 0, ..RocksOptions::default() }).is_err());
    assert!(Rocks::new(RocksOptions { count: usize::MAX, ..RocksOptions::default() }).is_err());
    let endless = vec![(CoralKind::Fan, usize::MAX), (CoralKind::Fan, 2)];
    assert!(Corals::new(CoralsOptions { colonies: endless, ..Default::default() }).is_err());
    assert!(Ground::new(GroundOptions { texture_size: 0.0, ..Default::default() }).is_err());
    let mut world = World::new(1, 0.1).unwrap();
    let bare = GroundOptions { relief: None, ..GroundOptions::default() };
    assert!(world.add(Box::new(Ground::new(bare).unwrap()), None).is_err());
    assert!(CoralKind::named("lettuce").unwrap_err().to_string().contains("brain_coral"));
}
