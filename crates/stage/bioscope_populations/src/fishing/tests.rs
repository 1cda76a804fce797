use std::sync::Arc;

use bioscope_core::{Event, Id, Vec3};
use bioscope_dynamics::{Current, CurrentParameters};
use bioscope_world::World;

use super::*;
use crate::animals::{Animals, AnimalsOptions, Kinds, Place};
use crate::bites::{BITTEN, EATEN, HOOKED};
use crate::fish::{BodyKind, FishSpecies, look, minded};
use crate::registry;

const DT: f64 = 1.0 / 30.0;

/// A line in water whose surface is at 0, with these numbers changed.
fn world(changes: &[(&str, f64)]) -> World {
    let mut world = World::new(5, DT).unwrap();
    world.environment.fill_with_water(0.0);
    let line = FishingLine::new(FishingLineOptions::default()).unwrap();
    world.add(Box::new(line), Some("line")).unwrap();
    for (name, value) in changes {
        world.set("line", name, *value).unwrap();
    }
    world
}

fn depth(world: &World) -> f64 {
    world.populations()[0].population.statistics()["depth_m"]
}

fn run(world: &mut World, seconds: f64) -> Vec<Event> {
    let ticks = (seconds / DT).round() as usize;
    (0..ticks).for_each(|_| world.tick().unwrap());
    world.drain_events()
}

/// Where the one thing of this species is, and its identity.
fn place(world: &World, species: &str) -> Option<(Vec3, Id)> {
    let batch = world.scene().batches.iter().find(|one| &*one.species == species)?;
    Some((batch.transforms[0].position, batch.ids[0]))
}

/// The same with a hungry fish before the hook.
fn with_fish(body: BodyKind) -> World {
    let mut world = world(&[("depth", 2.0), ("sinking", 2.0)]);
    let species = FishSpecies::named("parrotfish").unwrap();
    let request = serde_json::from_str(
        r#"{"kind": "intentions", "nature": {"role": "pacifist", "food": ["bait"]},
            "temper": {"stagger": 0.0}}"#,
    )
    .unwrap();
    let fish = minded(&species, &look(&species), &request, body).unwrap();
    let place = Some(Place { center: Vec3::new(0.0, -2.0, 1.2), radius: 0.1 });
    let options = AnimalsOptions { place, ..AnimalsOptions::default() };
    let fishes = Animals::new(vec![fish], options, Arc::new(Kinds::default())).unwrap();
    world.add(Box::new(fishes), Some("fish")).unwrap();
    world
}

#[test]
fn waits_then_sinks_to_its_depth_and_hides_its_bait_over_the_water() {
    let mut world = world(&[("start", 1.0), ("depth", 1.5), ("sinking", 0.5)]);
    run(&mut world, 0.9);
    assert!(depth(&world) < 0.0 && place(&world, "bait").is_none());
    run(&mut world, 2.1);
    let sunk = depth(&world);
    assert!((sunk - 0.6).abs() < 0.05, "{sunk}");
    let (hook, bait) = (place(&world, "fishing_line").unwrap(), place(&world, "bait").unwrap());
    assert_eq!((hook.0, hook.1 + 1), bait, "the bait is on the hook");
    assert!((f64::from(-hook.0.y) - sunk).abs() < 0.02);
    run(&mut world, 5.0);
    assert!((depth(&world) - 1.5).abs() < 1e-4);
}

#[test]
fn the_line_leans_with_the_current_but_not_without_end() {
    for (speed, least, most) in [(0.0, -1e-4, 1e-4), (0.2, 0.25, 0.5), (5.0, 0.9, 1.5)] {
        let mut world = world(&[("depth", 2.0), ("sinking", 2.0)]);
        let still = CurrentParameters { speed, surge: 0.0, turbulence: 0.0, ..Default::default() };
        world.add_field(Box::new(Current::new(Vec3::X, still)), None).unwrap();
        run(&mut world, 12.0);
        let aside = place(&world, "fishing_line").unwrap().0.x;
        assert!((least..most).contains(&aside), "{aside} m at {speed} m/s");
    }
}

#[test]
fn who_bites_first_is_hooked_hauled_by_the_mouth_and_landed() {
    for body in [BodyKind::Swimmer, BodyKind::MuscleSwimmer] {
        let mut world = with_fish(body);
        let (hook, bait) = (1, 2);
        let mut events = Vec::new();
        while !events.iter().any(|one: &Event| one.kind == HOOKED) {
            events.append(&mut run(&mut world, DT));
            assert!(world.time() < 30.0, "nobody bites");
        }
        let hooked = events.iter().find(|one| one.kind == HOOKED).unwrap().clone();
        assert_eq!(hooked.object, Some(hook));
        let eaten = events.iter().find(|one| one.kind == EATEN).unwrap();
        assert_eq!((eaten.subject, eaten.object), (bait, Some(hooked.subject)));
        assert!(place(&world, "bait").is_none());
        let before = depth(&world);
        events = run(&mut world, 1.0);
        assert!((before - depth(&world) - 0.5).abs() < 0.03, "hauls at its speed");
        for _ in 0..20 {
            events.append(&mut run(&mut world, DT));
            let batch = world.scene().batches.iter().find(|one| &*one.species == "parrotfish");
            let (fish, snout) = (batch.unwrap().transforms[0], batch.unwrap().poses[0]);
            let hook = place(&world, "fishing_line").unwrap().0;
            // The fish goes where the hook was heading a tick ago: a tug moves it by some millimetres since.
            let away = hook.distance(fish.point(snout.position));
            assert!(away < 0.012, "{away} m beside the mouth");
            let (ahead, length) = ((hook - fish.position).dot(fish.rotation() * Vec3::Z), 0.3);
            assert!(ahead > 0.3 * length, "{ahead} m before the middle");
        }
        events.append(&mut run(&mut world, 6.0));
        let landed = events.iter().find(|one| one.kind == BITTEN).expect("landed");
        assert_eq!((landed.subject, landed.object), (hooked.subject, Some(hook)));
        assert_eq!(world.populations()[1].population.count(), 0);
        assert_eq!(world.populations()[0].population.statistics()["caught"], 1.0);
    }
}

#[test]
fn continues_alike_after_a_restore() {
    let mut world = with_fish(BodyKind::Swimmer);
    run(&mut world, 3.0);
    let mut second = World::restore(&world.save().unwrap(), &registry()).unwrap();
    run(&mut world, 3.0);
    run(&mut second, 3.0);
    assert_eq!(world.state_hash().unwrap(), second.state_hash().unwrap());
}

#[test]
fn refuses_places_and_numbers_that_make_no_sense() {
    let place = [f32::NAN, 0.0];
    assert!(FishingLine::new(FishingLineOptions { place, ..Default::default() }).is_err());
    let parameters = FishingLineParameters { hauling: -1.0, ..Default::default() };
    assert!(FishingLine::new(FishingLineOptions { parameters, ..Default::default() }).is_err());
    assert!(FishingLine::from_saved(&[1, 2, 3]).is_err());
}
