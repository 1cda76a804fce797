use std::time::Instant;

use bioscope_core::Vec3;
use bioscope_dynamics::{Current, CurrentParameters};
use bioscope_world::World;

use super::*;
use crate::placement::{Area, Habitat};
use crate::registry;

const FERN: &str = "#define SIDES 3
lsystem: fern
derivation length: 7
axiom: !(0.02)A(0)
A(n) : n < 6 --> F(0.1)[+(40+ran(20))!(0.008)F(0.12)F(0.08)][-(40+ran(20))!(0.008)F(0.12)F(0.08)]/(137)A(n+1)
endlsystem
";

fn ferns(count: usize, area: Area) -> PlantsOptions {
    PlantsOptions {
        species: String::from("fern"),
        source: FERN.to_owned(),
        file_name: String::from("fern.l"),
        count,
        habitat: Habitat { area, ..Habitat::default() },
        variants: 3,
        ..PlantsOptions::default()
    }
}

fn meadow(options: PlantsOptions, current: CurrentParameters) -> World {
    let mut world = World::new(9, 1.0 / 60.0).unwrap();
    world.environment.fill_with_water(4.0);
    world.add_field(Box::new(Current::new(Vec3::X, current)), None).unwrap();
    world.add(Box::new(Plants::new(options).unwrap()), None).unwrap();
    world
}

fn square() -> Area {
    Area::Rectangle { low: [-4.0; 2], high: [4.0; 2] }
}

fn lean(world: &World, index: usize) -> f64 {
    let id = *world.scene().batches.iter().flat_map(|one| &one.ids).min().unwrap() + index as u32;
    match world.inspect(id).unwrap().1.values["lean_deg"] {
        bioscope_core::Value::Number(lean) => lean,
        ref other => panic!("{other:?}"),
    }
}

#[test]
fn grow_where_and_as_many_as_they_should_and_no_two_alike() {
    let world = meadow(ferns(50, square()), CurrentParameters::default());
    let batches = &world.scene().batches;
    assert_eq!(batches.len(), 3);
    let mut ids: Vec<_> = batches.iter().flat_map(|one| one.ids.clone()).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), 50);
    let places: Vec<_> = batches.iter().flat_map(|one| &one.transforms).collect();
    for (index, place) in places.iter().enumerate() {
        assert!(square().contains(place.position.x, place.position.z));
        assert!(places[..index].iter().all(|other| other.scale != place.scale));
    }
    let heights = batches.iter().map(|one| one.mesh.bounds().1.y).collect::<Vec<_>>();
    assert!(heights.iter().all(|height| (0.3..0.9).contains(height)), "{heights:?}");
    for batch in batches {
        let joints = batch.mesh.skin.as_ref().unwrap().joints.len();
        assert_eq!(batch.poses.len(), joints * batch.ids.len());
        assert!(batch.alive);
    }
}

#[test]
fn rest_without_a_current_and_lean_with_it() {
    let still = CurrentParameters { speed: 0.0, surge: 0.0, turbulence: 0.0, ..Default::default() };
    let mut world = meadow(ferns(10, square()), still);
    world.set("current", "speed", 0.6).unwrap();
    (0..300).for_each(|_| world.tick().unwrap());
    let leaning = lean(&world, 3);
    assert!((25.0..100.0).contains(&leaning), "{leaning} degrees");
    let batch = &world.scene().batches[0];
    let (tip, rest) = (batch.joint_count() - 1, &batch.mesh.skin.as_ref().unwrap().joints);
    let moved = batch.transforms[0].vector(batch.pose(0)[tip].position - rest[tip].rest.position);
    assert!(moved.x > 0.03 && moved.x > moved.z.abs(), "with the current: {moved}");
    world.set("current", "speed", 0.0).unwrap();
    (0..1800).for_each(|_| world.tick().unwrap());
    assert!(lean(&world, 3) < 0.1, "{}", lean(&world, 3));
    let batch = &world.scene().batches[0];
    let skin = batch.mesh.skin.as_ref().unwrap();
    for (pose, joint) in batch.pose(0).iter().zip(&skin.joints) {
        assert!((pose.position - joint.rest.position).length() < 2e-3);
    }
}

#[test]
fn a_gust_travels_through_the_meadow() {
    let places = Area::Points(vec![[-3.0, 0.0], [3.0, 0.0]]);
    let mut options = ferns(2, places);
    options.size = [1.0, 1.0];
    options.variants = 1;
    let swell = CurrentParameters { speed: 0.0, surge: 0.3, turbulence: 0.0, ..Default::default() };
    let mut world = meadow(options, swell);
    let mut crests = [Vec::new(), Vec::new()];
    let mut before = [[0.0; 2]; 2];
    for tick in 0..3600 {
        world.tick().unwrap();
        for plant in 0..2 {
            let now = lean(&world, plant);
            let [older, old] = before[plant];
            if tick > 600 && old > older && old > now {
                crests[plant].push(tick as f64 / 60.0);
            }
            before[plant] = [old, now];
        }
    }
    // The swell comes with a phase of 0.35 rad per metre: 2.1 rad over 6 m, a third of 5.5 s.
    // Lean has two crests per period, so lags count modulo half a period.
    let lag = crests[0].iter().zip(&crests[1]).map(|(a, b)| (b - a).rem_euclid(2.75)).sum::<f64>()
        / crests[0].len().min(crests[1].len()) as f64;
    assert!((lag - 1.84).abs() < 0.25, "{lag} s");
}

#[test]
fn continue_alike_after_a_restore_and_on_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut world = meadow(ferns(200, square()), CurrentParameters::default());
            (0..60).for_each(|_| world.tick().unwrap());
            let saved = world.save().unwrap();
            let mut second = World::restore(&saved, &registry()).unwrap();
            for (a, b) in world.scene().batches.iter().zip(&second.scene().batches) {
                assert_eq!((&a.poses, &a.tints), (&b.poses, &b.tints));
                assert_eq!(a.mesh.positions, b.mesh.positions);
            }
            (0..30).for_each(|_| second.tick().unwrap());
            let shapes: Vec<_> =
                world.scene().batches.iter().map(|one| one.mesh.key.number()).collect();
            world.return_to(&saved).unwrap();
            let kept: Vec<_> =
                world.scene().batches.iter().map(|one| one.mesh.key.number()).collect();
            assert_eq!(shapes, kept, "shapes are kept");
            (0..30).for_each(|_| world.tick().unwrap());
            assert_eq!(world.state_hash().unwrap(), second.state_hash().unwrap());
            world.state_hash().unwrap()
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn a_hundred_plants_are_quick() {
    let mut world = meadow(ferns(100, square()), CurrentParameters::default());
    (0..20).for_each(|_| world.tick().unwrap());
    let quickest = (0..60).map(|_| {
        let start = Instant::now();
        world.tick().unwrap();
        start.elapsed().as_secs_f64()
    });
    // Ten times what an unhurried machine needs, so that only a change of order is caught.
    let quickest = quickest.fold(f64::INFINITY, f64::min);
    assert!(quickest < 5e-3, "{quickest} s per tick");
}

#[test]
fn errors_in_the_text_name_file_and_line() {
    let source = String::from("lsystem: x\naxiom: A(\nendlsystem\n");
    let file_name = String::from("broken.l");
    let options = PlantsOptions { source, file_name, ..PlantsOptions::default() };
    let error = Plants::new(options).err().unwrap().to_string();
    assert!(error.contains("broken.l:"), "{error}");
    let endless = "lsystem: x\nderivation length: 60\naxiom: A\nA --> AA\nendlsystem\n";
    let options = PlantsOptions { source: endless.to_owned(), ..ferns(1, square()) };
    let mut world = World::new(1, 0.1).unwrap();
    assert!(world.add(Box::new(Plants::new(options).unwrap()), None).is_err());
}
