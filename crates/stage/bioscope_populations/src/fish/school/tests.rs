use std::sync::Arc;

use bioscope_core::{Id, Parameters, Quat, Random, Result, Value, Vec3};
use bioscope_dynamics::{Current, CurrentParameters};
use bioscope_geometry::{Batch, Mesh, Obstacle, Terrain, Transform};
use bioscope_world::{Growth, Population, Publication, View, World};
use proptest::prelude::*;
use rayon::ThreadPoolBuilder;

use super::fish::{Fish, Step};
use super::*;
use crate::animals::{Animals, AnimalsOptions, Place};
use crate::fish::{BodyKind, FishSpecies, look, roaming};

const DT: f64 = 1.0 / 60.0;

/// Rolling ground between 4.5 and 6 m below the surface, two rocks, a current.
fn reef() -> World {
    let mut world = World::new(5, DT).unwrap();
    world.environment.fill_with_water(0.0);
    let height = |index: usize| {
        let (x, z) = ((index % 40) as f32, (index / 40) as f32);
        -5.2 + 0.7 * (0.5 * x).sin() * (0.4 * z).cos()
    };
    let ground = Terrain::new([-20.0; 2], 1.0, 40, (0..1600).map(height).collect()).unwrap();
    world.environment.terrain = Some(Arc::new(ground));
    *world.environment.obstacles.edit() = vec![
        Obstacle::Sphere { center: Vec3::new(1.5, -3.5, 1.5), radius: 0.8 },
        Obstacle::Cylinder {
            base: Vec3::new(-2.0, -6.0, 0.0),
            top: Vec3::new(-2.0, -2.0, 0.0),
            radius: 0.5,
        },
    ];
    let current = Current::new(Vec3::X, CurrentParameters::default());
    world.add_field(Box::new(current), None).unwrap();
    world
}

fn school(count: usize) -> FishSchool {
    let species = FishSpecies::named("anchovy").unwrap();
    FishSchool::new(FishSchoolOptions::new(species, count, Vec3::Y * -3.0)).unwrap()
}

fn predator() -> Animals {
    let species = FishSpecies::named("barracuda").unwrap();
    let animal = roaming(&species, &look(&species), None, &[], BodyKind::Swimmer).unwrap();
    let place = Some(Place { center: Vec3::new(0.0, -3.0, 3.0), radius: 1.0 });
    let options = AnimalsOptions { place, ..AnimalsOptions::default() };
    Animals::new(vec![animal], options, Arc::default()).unwrap()
}

fn run(world: &mut World, ticks: usize) {
    for _ in 0..ticks {
        world.tick().unwrap();
    }
}

fn places(world: &World) -> Vec<Vec3> {
    let batch = world.scene().batches.iter().find(|one| &*one.species == "anchovy").unwrap();
    batch.transforms.iter().map(|one| one.position).collect()
}

/// A shark's worth of threat that swims straight through the school and on, as a script wants.
struct Puppet {
    id: Id,
    place: Vec3,
    velocity: Vec3,
}

impl Population for Puppet {
    fn kind(&self) -> &str {
        "puppet"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        self.id = growth.identities(1)?[0];
        Ok(())
    }

    fn advance(&mut self, view: &View) -> Result<()> {
        self.place += self.velocity * view.moment.dt;
        Ok(())
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        let positions = vec![Vec3::Z * -0.6, Vec3::Z * 0.6];
        let mesh = Mesh { positions, ..Mesh::default() };
        let mut batch = Batch::new("puppet", "puppet", Arc::new(mesh), Arc::default());
        batch.alive = true;
        batch.ids = vec![self.id];
        batch.transforms = vec![Transform::at(self.place)];
        batch.velocities = vec![self.velocity];
        publication.scene.batches.push(batch);
        Ok(())
    }

    fn count(&self) -> usize {
        1
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(Vec::new())
    }

    fn restore(&mut self, _bytes: &[u8]) -> Result<()> {
        Ok(())
    }
}

#[test]
fn for_half_a_minute_nobody_enters_rock_ground_or_air_and_the_school_holds_together() {
    let mut world = reef();
    world.add(Box::new(school(150)), None).unwrap();
    let ground = world.environment.terrain.clone().unwrap();
    for _ in 0..1800 {
        world.tick().unwrap();
        for place in places(&world) {
            assert!(place.y < -0.1, "{place} is in the air");
            let height = place.y - ground.height(place.x, place.z);
            assert!(height > 0.1, "{place} is {height} m above the ground");
            for rock in world.environment.obstacles.iter() {
                let distance = rock.distance(place);
                assert!(distance > 0.06, "{place} is {distance} m from {rock:?}");
            }
        }
    }
    let figures = world.statistics();
    assert_eq!(figures["anchovy.groups"], 1.0);
    assert!(figures["anchovy.polarization"] > 0.7, "{figures:?}");
    let spacing = figures["anchovy.nearest_neighbor_m"] / 0.13;
    assert!((0.7..2.0).contains(&spacing), "{spacing} body lengths");
    let pace = figures["anchovy.mean_speed_m_per_s"] / 0.13;
    assert!((1.0..4.0).contains(&pace), "{pace} body lengths per second");
}

#[test]
fn splits_round_a_pillar_and_closes_behind_it() {
    let mut world = World::new(4, DT).unwrap();
    let pillar = Obstacle::Cylinder {
        base: Vec3::new(0.0, -30.0, 2.5),
        top: Vec3::new(0.0, 20.0, 2.5),
        radius: 0.4,
    };
    world.environment.obstacles.edit().push(pillar);
    let mut options = FishSchoolOptions {
        home: Some(Vec3::new(0.0, -3.0, 6.0)),
        ..FishSchoolOptions::new(FishSpecies::named("anchovy").unwrap(), 120, Vec3::Y * -3.0)
    };
    options.parameters.home_radius = 0.5;
    world.add(Box::new(FishSchool::new(options).unwrap()), None).unwrap();
    let mut beside = [0, 0];
    for _ in 0..2400 {
        world.tick().unwrap();
        for place in places(&world) {
            assert!(pillar.distance(place) > 0.06, "{place}");
            if (place.z - 2.5).abs() < 0.05 && place.x.abs() < 2.0 {
                beside[usize::from(place.x > 0.0)] += 1;
            }
        }
    }
    assert!(beside.iter().all(|&fishes| fishes > 20), "{beside:?} right and left of it");
    let behind = places(&world).iter().filter(|place| place.z > 3.0).count();
    assert!(behind > 110, "{behind} of 120 have passed");
    assert_eq!(world.statistics()["anchovy.groups"], 1.0);
}

#[test]
fn flees_from_a_large_animal_and_closes_again() {
    let mut world = World::new(3, DT).unwrap();
    world.add(Box::new(school(120)), None).unwrap();
    run(&mut world, 600);
    let middle = places(&world).iter().sum::<Vec3>() / 120.0;
    let velocity = Vec3::Z * 1.2;
    let puppet = Puppet { id: 0, place: middle - Vec3::Z * 4.0, velocity };
    world.add(Box::new(puppet), None).unwrap();
    let (mut nearest, mut alarm) = (f32::INFINITY, 0.0);
    for _ in 0..400 {
        world.tick().unwrap();
        let hunter = world.scene().batches[1].transforms[0].position;
        let closest = places(&world).iter().map(|one| one.distance(hunter)).fold(9.0, f32::min);
        nearest = nearest.min(closest);
        alarm = world.statistics()["anchovy.alarm"].max(alarm);
    }
    assert!(nearest > 0.15 && alarm > 0.5, "{nearest} m, alarm {alarm}");
    let startled = world.events().iter().filter(|event| event.kind == "startled");
    let startled: Vec<_> = startled.map(|event| (event.subject, event.object)).collect();
    assert!(startled.len() > 30, "{startled:?}");
    assert!(startled.iter().all(|(_, object)| *object == Some(121)), "{startled:?}");
    run(&mut world, 900);
    let figures = world.statistics();
    assert!(figures["anchovy.alarm"] < 0.05 && figures["anchovy.groups"] == 1.0, "{figures:?}");
}

#[test]
fn nothing_is_fled_from_that_is_small_or_stays() {
    let mut world = World::new(3, DT).unwrap();
    world.add(Box::new(school(60)), None).unwrap();
    let puppet = Puppet { id: 0, place: Vec3::Y * -3.0, velocity: Vec3::Z * 0.1 };
    world.add(Box::new(puppet), None).unwrap();
    world.set("anchovy", "threat_ratio", 12.0).unwrap();
    run(&mut world, 60);
    assert_eq!(world.statistics()["anchovy.alarm"], 0.0);
    world.set("anchovy", "threat_ratio", 4.0).unwrap();
    run(&mut world, 60);
    assert!(world.statistics()["anchovy.alarm"] > 0.1);
}

#[test]
fn tails_beat_faster_in_flight_and_nobody_in_step() {
    let mut fish = fish();
    let gait = FishSpecies::named("anchovy").unwrap().gait();
    let mut turned = |speed: f32| {
        let begin = fish.swim.phase;
        let step = |dt| Step { before: Quat::IDENTITY, heading: Vec3::Z, speeds: [speed; 2], dt };
        fish.swim(gait, &step(0.01));
        (fish.swim.phase - begin).rem_euclid(std::f32::consts::TAU)
    };
    let (calm, flight) = (turned(2.0), turned(8.0));
    assert!(flight > 2.0 * calm && calm > 0.0, "{calm} {flight}");

    let mut world = reef();
    world.add(Box::new(school(40)), None).unwrap();
    run(&mut world, 120);
    let batch = &world.scene().batches[0];
    let mesh_joints = batch.mesh.skin.as_ref().unwrap().joints.len();
    assert_eq!(batch.joint_count(), mesh_joints);
    for other in 1..40 {
        assert_ne!(batch.pose(0), batch.pose(other));
        assert_ne!(batch.tints[0], batch.tints[other]);
        assert_ne!(batch.transforms[0].scale, batch.transforms[other].scale);
    }
}

fn fish() -> Fish {
    let mut random = Random::new(1, 1, 1, bioscope_core::Purpose::new("test"));
    Fish::born(0.1, Vec3::Z, &mut random)
}

#[test]
fn a_startle_is_reported_once_in_a_while() {
    let mut fish = fish();
    let mut reports = Vec::new();
    for tick in 0..600 {
        let alarm = if tick % 100 < 50 { 0.8 } else { 0.0 };
        fish.feel(alarm, "flee", 9, 1.0 / 60.0);
        if fish.startled_by == 9 {
            reports.push(tick);
        }
    }
    assert_eq!(reports, [0, 300]);
}

#[test]
fn bursts_and_glides_keep_the_mean_pace() {
    let mut fish = fish();
    let mean = |fish: &mut Fish| {
        (0..3000)
            .map(|_| {
                fish.beat(0.01, 1.0);
                fish.pace_now(0.5)
            })
            .sum::<f32>()
            / 3000.0
    };
    let pace = mean(&mut fish);
    assert!((pace - fish.pace).abs() < 0.02, "{pace} {}", fish.pace);
    fish.feel(0.9, "flee", 9, 0.01);
    assert_eq!(fish.pace_now(0.5), fish.pace);
}

#[test]
fn parameters_of_flock_and_school_are_one_set_that_stays_sensible() {
    let mut school = school(3);
    school.set("separation", 0.7).unwrap();
    school.set("home_radius", 9.0).unwrap();
    assert_eq!(
        (school.get("separation"), school.get("home_radius")),
        (Some(0.7f32.into()), Some(9.0))
    );
    assert!(school.set("minimum_speed", 50.0).is_err(), "faster than the fastest");
    assert!(school.set("colour", 1.0).unwrap_err().to_string().contains("home_radius"));
    let names: Vec<_> = school.descriptions().into_iter().map(|one| one.name).collect();
    let unique: std::collections::BTreeSet<_> = names.iter().collect();
    assert_eq!(names.len(), unique.len());
}

#[test]
fn a_fish_can_be_inspected() {
    let mut world = reef();
    world.add(Box::new(school(50)), None).unwrap();
    run(&mut world, 60);
    let (_, inspection) = world.inspect(7).unwrap();
    assert_eq!(inspection.behavior.as_deref(), Some("school"));
    let neighbors = &inspection.percepts["neighbors"];
    assert!(matches!(neighbors, Value::Number(number) if *number > 3.0), "{neighbors:?}");
    assert!(inspection.eye.is_some() && inspection.values.contains_key("tail_beat_hz"));
}

#[test]
fn refuses_schools_that_make_no_sense() {
    let species = FishSpecies::named("anchovy").unwrap();
    let options = FishSchoolOptions::new(species, 10, Vec3::ZERO);
    let refused = |options: FishSchoolOptions| FishSchool::new(options).err().unwrap().to_string();
    let many = FishSchoolOptions { count: usize::MAX, ..options.clone() };
    assert!(refused(many).contains("count"));
    let nowhere = FishSchoolOptions { center: Vec3::NAN, ..options.clone() };
    assert!(refused(nowhere).contains("center"));
    let flat = FishSchoolOptions { half: Vec3::NEG_ONE, ..options };
    assert!(refused(flat).contains("half"));
}

fn hunted() -> World {
    let mut world = reef();
    world.add(Box::new(school(40)), None).unwrap();
    world.add(Box::new(predator()), None).unwrap();
    world
}

#[test]
fn one_thread_and_two_give_the_same_state() {
    let hash = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut world = reef();
            world.add(Box::new(school(300)), None).unwrap();
            world.add(Box::new(predator()), None).unwrap();
            run(&mut world, 120);
            world.state_hash().unwrap()
        })
    };
    assert_eq!(hash(1), hash(2));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10))]
    #[test]
    fn continues_from_a_save_at_any_tick_as_if_nothing_had_happened(ticks in 0usize..100) {
        let mut one = hunted();
        run(&mut one, ticks);
        let bytes = one.save().unwrap();
        let mut two = World::restore(&bytes, &crate::registry()).unwrap();
        prop_assert_eq!(one.state_hash().unwrap(), two.state_hash().unwrap());
        prop_assert_eq!(&one.scene().annotations, &two.scene().annotations);
        let (a, b) = (&one.scene().batches[0], &two.scene().batches[0]);
        prop_assert!(a.poses == b.poses && a.transforms == b.transforms && a.tints == b.tints);
        run(&mut one, 40);
        run(&mut two, 40);
        prop_assert_eq!(one.state_hash().unwrap(), two.state_hash().unwrap());
    }

    #[test]
    fn damaged_bytes_never_panic(position in 0usize..100_000, value: u8) {
        let mut world = reef();
        world.add(Box::new(school(5)), None).unwrap();
        let mut bytes = world.populations()[0].population.save().unwrap();
        let position = position % bytes.len();
        bytes[position] = value;
        if let Ok(mut school) = FishSchool::from_saved(&bytes) {
            prop_assert_eq!(school.count(), 5);
            prop_assert!(school.set("separation", 0.5).is_ok());
        }
    }
}
