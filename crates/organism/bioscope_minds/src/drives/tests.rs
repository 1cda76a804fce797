use bioscope_core::{Purpose, Random};
use proptest::prelude::*;

use super::*;
use crate::nature::Temper;

fn temper() -> Temper {
    Temper { stagger: 0.0, ..Temper::default() }
}

fn random() -> Random {
    Random::new(1, 1, 1, Purpose::new("test"))
}

fn after(stirrings: &[Stirring], temper: &Temper) -> Drives {
    let mut drives = Drives::default();
    for stirring in stirrings {
        drives.advance(stirring, temper, &mut random());
    }
    drives
}

#[test]
fn the_published_check_values_of_hunger_hold() {
    let meal = |fed: u32| Stirring { fed, food: Some(0.1), ..Stirring::default() };
    let hunger = |fed: u32| after(&[meal(fed)], &temper()).hunger;
    // n = a with food before the mouth, n = 2 a with food before the mouth.
    assert!((hunger(5) - 0.8).abs() < 1e-6);
    assert_eq!(hunger(10), 0.0);
    // Feeding stops at n >= (1.8 - r) a: 7.5 at r = 0.3.
    assert!(hunger(7) > 0.3 && hunger(8) < 0.3);
}

#[test]
fn digestion_is_complete_after_its_time_and_libido_saturates_after_its_own() {
    let wait = |steps: f32| Stirring { dt: steps / 30.0, ..Stirring::default() };
    let meal = Stirring { fed: 5, ..Stirring::default() };
    let later = |steps: f32| after(&[meal, wait(steps)], &temper());
    assert!((later(746.0).hunger - 0.5).abs() < 0.01);
    assert_eq!((later(1500.0).hunger, later(1500.0).eaten), (1.0, 0.0));
    let ravenous = Temper { digestion: 0.005, ..temper() };
    assert_eq!(after(&[meal, wait(201.0)], &ravenous).hunger, 1.0);
    // A sated fish: H stays near 0 while libido rises to 1 in 400 steps, in 100 with the mania.
    let feast = Stirring { fed: 9, ..Stirring::default() };
    assert!(after(&[feast, wait(395.0)], &temper()).libido < 1.0);
    assert!(after(&[feast, wait(405.0)], &temper()).libido > 0.999);
    let mania = Temper { libido_growth: 0.01, ..temper() };
    assert!(after(&[feast, wait(105.0)], &mania).libido > 0.999);
}

#[test]
fn hunger_drives_out_libido_and_mating_stills_it() {
    let wait = Stirring { dt: 20.0, ..Stirring::default() };
    let mut drives = after(&[wait], &temper());
    assert_eq!((drives.hunger, drives.libido), (1.0, 0.0));
    drives.advance(&Stirring { fed: 9, ..Stirring::default() }, &temper(), &mut random());
    assert_eq!(drives.libido, 1.0);
    drives.mated();
    drives.advance(&Stirring::default(), &temper(), &mut random());
    assert_eq!(drives.libido, 0.0);
}

#[test]
fn opportunities_pull_from_20_units_and_fully_at_5() {
    let pull = |units: f32| stimulus(units / 14.0, 0.35714, 1.4286);
    assert_eq!([pull(30.0), pull(20.01), pull(4.9)], [0.0, 0.0, 1.0]);
    assert!((pull(5.001) - 1.0).abs() < 1e-3);
    // (0.1 - 0.05) / (0.4 - 0.05 - 0.1)
    assert!((pull(10.0) - 0.2).abs() < 1e-3);
}

#[test]
fn fear_is_that_of_all_predators_in_view() {
    let temper = temper();
    let far = fear_of(2.0 * temper.fear_distance, &temper);
    assert!((far - 0.5).abs() < 1e-6 && fear_of(1.0, &temper) == 1.0);
    let seen = |fear: f32| Stirring { fear, ..Stirring::default() };
    assert_eq!(after(&[seen(far + far + far)], &temper).fear, 1.0);
    assert_eq!(after(&[seen(far)], &temper).fear, far);
}

proptest! {
    #[test]
    fn drives_stay_between_nothing_and_everything(
        steps in prop::collection::vec(
            (0u32..20, 0f32..100.0, 0f32..30.0, 0f32..30.0, 0f32..5.0), 1..30,
        )
    ) {
        let mut drives = Drives::default();
        for (fed, dt, food, mate, fear) in steps {
            let stirring = Stirring { dt, fed, food: Some(food), mate: Some(mate), fear };
            drives.advance(&stirring, &Temper::default(), &mut random());
            for drive in [drives.hunger, drives.libido, drives.fear] {
                prop_assert!((0.0..=1.0).contains(&drive), "{:?}", drives);
            }
        }
    }
}
