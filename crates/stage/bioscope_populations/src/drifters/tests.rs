use bioscope_core::Vec3;
use bioscope_dynamics::{Current, CurrentParameters};
use bioscope_geometry::Terrain;
use bioscope_world::World;

use super::*;
use crate::placement::Area;
use crate::registry;

/// A box of water 8 m deep over gently sloping ground.
fn water(dt: f64) -> World {
    let mut world = World::new(11, dt).unwrap();
    world.environment.fill_with_water(0.0);
    let heights = (0..41 * 41).map(|index| -8.0 + 0.1 * (index % 41) as f32).collect();
    world.environment.terrain = Some(Terrain::new([-10.0; 2], 0.5, 41, heights).unwrap().into());
    let current = Current::new(Vec3::new(1.0, 0.0, 0.3), CurrentParameters::default());
    world.add_field(Box::new(current), None).unwrap();
    world
}

fn plankton(count: usize) -> Box<Plankton> {
    let (low, high) = (Vec3::new(-4.0, -3.5, -4.0), Vec3::new(4.0, -0.5, 4.0));
    let options = PlanktonOptions { count, low, high, ..PlanktonOptions::default() };
    Box::new(Plankton::new(options).unwrap())
}

fn bubbles(rate: f32) -> Box<Bubbles> {
    let area = Area::Disk { center: [0.0; 2], radius: 3.0 };
    let mut options = BubblesOptions { area, ..BubblesOptions::default() };
    options.parameters.rate = rate;
    Box::new(Bubbles::new(options).unwrap())
}

#[test]
fn plankton_stays_in_its_box_and_evenly_spread() {
    let mut world = water(0.1);
    // The swell is a pressure wave, so only the rest of the current is free of divergence.
    world.set("current", "surge", 0.0).unwrap();
    world.add(plankton(4000), None).unwrap();
    let mut octants = [0.0f64; 8];
    for tick in 1..=3000 {
        world.tick().unwrap();
        if tick > 600 && tick % 40 == 0 {
            for &point in &world.scene().points[0].positions {
                assert!(point.y > -3.6 && point.y < -0.4 && point.x.abs() < 4.1, "{point}");
                let side = |value: f32, middle: f32| usize::from(value > middle);
                octants[side(point.x, 0.0) + 2 * side(point.y, -2.0) + 4 * side(point.z, 0.0)] +=
                    1.0;
            }
        }
    }
    let mean = octants.iter().sum::<f64>() / 8.0;
    for octant in octants {
        assert!((octant / mean - 1.0).abs() < 0.12, "{octants:?}");
    }
}

#[test]
fn plankton_in_still_water_stays_even_too() {
    let mut world = World::new(3, 0.5).unwrap();
    world.environment.fill_with_water(0.0);
    world.add(plankton(4000), None).unwrap();
    world.set("plankton", "swimming", 0.3).unwrap();
    (0..1200).for_each(|_| world.tick().unwrap());
    let positions = &world.scene().points[0].positions;
    let middle = positions.iter().filter(|one| one.x.abs() < 2.0).count();
    assert!((middle as f32 / 2000.0 - 1.0).abs() < 0.12, "{middle} of 4000 in the middle half");
}

#[test]
fn plankton_goes_with_the_current() {
    let mut world = World::new(3, 0.05).unwrap();
    let calm = CurrentParameters { speed: 0.2, surge: 0.0, turbulence: 0.0, ..Default::default() };
    world.add_field(Box::new(Current::new(Vec3::X, calm)), None).unwrap();
    world.add(plankton(500), None).unwrap();
    world.set("plankton", "swimming", 0.0).unwrap();
    let before = world.scene().points[0].clone();
    (0..20).for_each(|_| world.tick().unwrap());
    let after = &world.scene().points[0];
    let stayed = (0..500).filter(|&index| before.ids[index] == after.ids[index]);
    for index in stayed {
        let way = after.positions[index] - before.positions[index];
        assert!((way - Vec3::X * 0.2).length() < 1e-2, "{way} in one second");
    }
}

#[test]
fn bubbles_rise_as_fast_as_their_size_says() {
    // Measured in water (Clift, Grace and Weber 1978, figure 7.3, contaminated to pure):
    // 0.11 to 0.12 m/s at 0.5 mm diameter, 0.2 to 0.25 at 5 mm, 0.3 to 0.35 at 20 mm.
    assert!((0.05..0.2).contains(&rise_speed(0.000_25)), "{}", rise_speed(0.000_25));
    assert!((0.2..0.27).contains(&rise_speed(0.0025)), "{}", rise_speed(0.0025));
    assert!((0.28..0.37).contains(&rise_speed(0.01)), "{}", rise_speed(0.01));
    let mut world = World::new(2, 0.02).unwrap();
    world.environment.fill_with_water(6.0);
    world.add(bubbles(4.0), None).unwrap();
    world.set("bubbles", "wobble", 0.0).unwrap();
    (0..200).for_each(|_| world.tick().unwrap());
    let before = world.scene().points[0].clone();
    world.tick().unwrap();
    let after = &world.scene().points[0];
    assert!(before.ids.len() > 10);
    for (index, id) in before.ids.iter().enumerate() {
        let Some(now) = after.ids.iter().position(|other| other == id) else { continue };
        let rise = (after.positions[now].y - before.positions[index].y) / 0.02;
        let expected = rise_speed(before.radii[index]);
        assert!((rise / expected - 1.0).abs() < 1e-3, "{rise} instead of {expected} m/s");
        assert!(after.radii[now] > before.radii[index], "a rising bubble grows");
    }
}

#[test]
fn bubbles_ring_by_size_and_depth() {
    assert!((minnaert_frequency(0.003, 0.0) - 1086.7).abs() < 1.0);
    let deeper = minnaert_frequency(0.003, 10.08) / minnaert_frequency(0.003, 0.0);
    assert!((deeper - 2.0f32.sqrt()).abs() < 0.01, "{deeper}");
    let mut world = water(0.02);
    world.add(bubbles(3.0), None).unwrap();
    let mut heard = 0;
    for _ in 0..500 {
        world.tick().unwrap();
        for sound in world.sounds() {
            assert_eq!(sound.kind, "bubble");
            assert!((20.0..30_000.0).contains(&sound.pitch), "{}", sound.pitch);
            heard += 1;
        }
    }
    assert!(heard > 50, "{heard}");
    assert!(world.events().iter().any(|event| event.kind == "bubbled"));
}

#[test]
fn bubbles_stay_between_ground_and_surface_and_few_for_hours() {
    let mut world = water(0.1);
    world.add(bubbles(1.0), None).unwrap();
    let mut most = 0;
    for tick in 0..72_000 {
        world.tick().unwrap();
        most = most.max(world.scene().points[0].ids.len());
        if tick % 100 == 0 {
            let ground = world.environment.terrain.clone().unwrap();
            for point in &world.scene().points[0].positions {
                assert!(point.y < 0.0 && point.y >= ground.height(point.x, point.z), "{point}");
            }
        }
        world.drain_events();
    }
    assert!((20..=400).contains(&most), "{most}");
}

#[test]
fn bubbles_need_water() {
    let mut world = World::new(2, 0.02).unwrap();
    let error = world.add(bubbles(1.0), None).unwrap_err().to_string();
    assert!(error.contains("water"), "{error}");
}

#[test]
fn continue_alike_after_a_restore_and_on_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut world = water(0.02);
            world.add(plankton(300), None).unwrap();
            world.add(bubbles(5.0), None).unwrap();
            (0..120).for_each(|_| world.tick().unwrap());
            let saved = world.save().unwrap();
            let mut second = World::restore(&saved, &registry()).unwrap();
            assert_eq!(second.scene().points[1].positions, world.scene().points[1].positions);
            assert_eq!(second.sounds(), world.sounds());
            for _ in 0..60 {
                world.tick().unwrap();
                second.tick().unwrap();
            }
            assert_eq!(world.state_hash().unwrap(), second.state_hash().unwrap());
            world.return_to(&saved).unwrap();
            (0..60).for_each(|_| world.tick().unwrap());
            assert_eq!(world.state_hash().unwrap(), second.state_hash().unwrap());
            world.state_hash().unwrap()
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn refuses_boxes_and_counts_that_make_no_sense() {
    let low = Vec3::new(5.0, 0.0, 0.0);
    assert!(Plankton::new(PlanktonOptions { low, high: low, ..Default::default() }).is_err());
    assert!(Plankton::new(PlanktonOptions { count: usize::MAX, ..Default::default() }).is_err());
    assert!(Plankton::new(PlanktonOptions { radius: [0.0, 1.0], ..Default::default() }).is_err());
    assert!(Bubbles::new(BubblesOptions { vents: usize::MAX, ..Default::default() }).is_err());
    assert!(Plankton::from_saved(&[1, 2, 3]).is_err());
}
