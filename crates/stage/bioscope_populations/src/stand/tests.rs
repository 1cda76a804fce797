use bioscope_core::{Value, Vec3};
use bioscope_dynamics::{Current, CurrentParameters};
use bioscope_world::World;

use super::*;
use crate::placement::{Area, Habitat};
use crate::registry;

/// A stem that grows a piece and two leaves a step, asks for light, and sheds a seed after five steps.
const SPROUT: &str = "lsystem: sprout
derivation length: 40
environment: sky_light tau=0.1
consider: ?E
axiom: A(0)?E(0.4)
p1: A(n) > ?E(r) : r > 0.6 && n == 5 --> !(0.05)F(0.2)[+(50)~l(0.3)][-(50)~l(0.3)]S/(137)A(n+1)
p2: A(n) > ?E(r) : r > 0.6 --> !(0.05)F(0.2)[+(50)~l(0.3)][-(50)~l(0.3)]/(137)A(n+1)
p3: A(n) --> A(n)
p4: ?E(r) --> ?E(0.4)
endlsystem
";

fn sprouts(places: Vec<[f32; 2]>) -> StandOptions {
    StandOptions {
        species: String::from("sprout"),
        sources: vec![SPROUT.to_owned()],
        count: places.len(),
        habitat: Habitat { area: Area::Points(places), ..Habitat::default() },
        seeds: String::from("S"),
        ..StandOptions::default()
    }
}

fn world(options: StandOptions) -> World {
    let mut world = World::new(5, 1.0 / 30.0).unwrap();
    let wind = CurrentParameters { speed: 2.0, ..CurrentParameters::default() };
    world.add_field(Box::new(Current::new(Vec3::X, wind)), None).unwrap();
    world.add(Box::new(Stand::new(options).unwrap()), None).unwrap();
    world
}

fn numbers(world: &World, name: &str) -> Vec<f64> {
    let values = world.populations()[0].population.values(name).unwrap();
    let number = |value: &Value| match value {
        Value::Number(number) => *number,
        other => panic!("{other:?}"),
    };
    values.iter().map(number).collect()
}

fn step(world: &mut World, ticks: usize) {
    (0..ticks).for_each(|_| world.tick().unwrap());
}

#[test]
fn plants_in_the_open_grow_and_crowded_ones_shade_each_other() {
    let childless = |places| StandOptions { seeds: String::new(), ..sprouts(places) };
    let mut open = world(childless(vec![[0.0, 0.0], [20.0, 0.0]]));
    step(&mut open, 60);
    assert_eq!(numbers(&open, "segments"), [20.0, 20.0], "10 steps a second for two seconds");
    let heights = numbers(&open, "height_m");
    assert!((heights[0] - heights[1]).abs() < 1e-3 && heights[0] > 3.9, "{heights:?}");
    let mut head_start = childless(vec![[0.0, 0.0], [0.05, 0.0]]);
    head_start.sources.push(SPROUT.replace("F(0.2)", "F(0.15)"));
    let mut crowd = world(head_start);
    step(&mut crowd, 60);
    let segments = numbers(&crowd, "segments");
    // The lower one waits while the leaf of the other is close above it.
    assert!(segments[0] == 20.0 && segments[1] < 18.0, "{segments:?}");
}

#[test]
fn continues_from_a_saved_world_to_the_bit_in_the_middle_of_a_step() {
    let mut options = sprouts(vec![[0.0, 0.0], [0.3, 0.0], [0.6, 0.3]]);
    options.parameters.rate = 7.0;
    let mut first = world(options);
    step(&mut first, 40);
    let bytes = first.save().unwrap();
    let mut second = World::restore(&bytes, &registry()).unwrap();
    let shown = |world: &World| {
        let batches = &world.scene().batches;
        batches.iter().map(|one| (one.name.clone(), one.transforms.clone())).collect::<Vec<_>>()
    };
    assert_eq!(shown(&first), shown(&second));
    step(&mut first, 45);
    step(&mut second, 45);
    assert_eq!(first.state_hash().unwrap(), second.state_hash().unwrap());
    assert_eq!(shown(&first), shown(&second));
}

#[test]
fn seeds_fall_and_germinate() {
    let mut options = sprouts(vec![[0.0, 0.0]]);
    options.habitat.area = Area::Disk { center: [0.0, 0.0], radius: 30.0 };
    options.parameters.germination = 1.0;
    options.room = 0.2;
    let mut world = world(options);
    step(&mut world, 30);
    assert_eq!(world.scene().points.len(), 1, "a seed is on its way");
    step(&mut world, 200);
    let germinated = world.events().iter().filter(|event| event.kind == "germinated").count();
    assert!(germinated >= 1, "no seed germinated");
    assert_eq!(world.populations()[0].population.count(), 1 + germinated);
    let strings = world.populations()[0].population.values("string").unwrap();
    assert!(strings.iter().all(|one| !format!("{one:?}").contains('S')), "{strings:?}");
}

#[test]
fn a_clipped_plant_stays_in_its_shape() {
    let mut options = sprouts(vec![[0.0, 0.0]]);
    options.seeds = String::new();
    options.clip = vec![(String::from("box"), String::from("-1 -1 -1 1 1.1 1"))];
    let mut world = world(options);
    step(&mut world, 120);
    let height = numbers(&world, "height_m")[0];
    assert!(height > 0.8 && height < 1.4, "{height}");
    assert!(world.events().iter().any(|event| event.kind == "pruned"));
}

#[test]
fn refuses_what_makes_no_sense() {
    assert!(Stand::new(StandOptions::default()).is_err(), "no text");
    let wrong = StandOptions { season: 0, ..sprouts(vec![[0.0, 0.0]]) };
    assert!(Stand::new(wrong).is_err());
    let broken = StandOptions { sources: vec![String::from("axiom")], ..sprouts(vec![]) };
    assert!(Stand::new(broken).is_err());
    let mut strange = sprouts(vec![[0.0, 0.0]]);
    strange.environment =
        Some(Surroundings { name: String::from("moon"), ..Surroundings::default() });
    assert!(Stand::new(strange).is_err());
    let mut world = world(sprouts(vec![[0.0, 0.0], [1.0, 0.0]]));
    step(&mut world, 4);
    let bytes = world.populations()[0].population.save().unwrap();
    for cut in [0, 1, bytes.len() / 2, bytes.len() - 1] {
        assert!(
            Stand::from_saved(&bytes[..cut], |name| Err(crate::stand::model::missing(name)))
                .is_err()
        );
    }
}
