use bioscope_core::{Act, Display, Impact, NOTHING, Percepts, Sex, Sighting, Vec3};

use super::*;
use crate::drives::Drives;
use crate::nature::{Habits, Nature, Role, Temper};

fn sighting(id: u32, species: &str, position: Vec3) -> Sighting {
    let heading = Vec3::Z;
    Sighting { id, species: species.into(), position, heading, size: 0.1, ..Sighting::default() }
}

fn female(id: u32, position: Vec3) -> Sighting {
    let display = Display { sex: Sex::Female, ..Display::NONE };
    Sighting { display, ..sighting(id, "clownfish", position) }
}

fn nature() -> Nature {
    Nature {
        species: "clownfish".into(),
        enemies: vec!["shark".into()],
        food: vec!["plankton".into()],
        ..Nature::default()
    }
}

fn drives(hunger: f32, libido: f32, fear: f32) -> Drives {
    let mut drives = Drives::default();
    (drives.hunger, drives.libido, drives.fear) = (hunger, libido, fear);
    drives
}

fn percepts(seen: Vec<Sighting>) -> Percepts {
    Percepts { body_length: 0.1, seen, ..Percepts::default() }
}

#[test]
fn three_mates_and_a_predator_on_the_left_are_one_for_and_one_against() {
    let left = |angle: f32| Vec3::new(angle.sin(), 0.0, angle.cos());
    let mut seen: Vec<_> = (1..4).map(|id| female(id, left(0.5 + 0.3 * id as f32))).collect();
    seen.push(sighting(9, "shark", left(1.5)));
    let percepts = percepts(seen);
    let situation = Situation::new(&percepts, &nature(), &Temper::default());
    let strengths = Strengths { avoid: 1.0, escape: 0.4, eat: 0.0, mate: 0.7 };
    let focus = Focus { behavior: Behavior::Wander, target: NOTHING, threat: None };
    let preferences = preferences(&situation, &strengths, &focus);
    assert!((preferences.of(Skill::Left) - (0.7 - 0.4)).abs() < 1e-6);
    assert_eq!(preferences.of(Skill::Right), 0.0);
}

#[test]
fn while_avoiding_one_obstacle_another_warns_and_food_invites() {
    let mut percepts = percepts(Vec::new());
    percepts.smelled.push(sighting(5, "plankton", Vec3::NEG_X));
    percepts.solids = vec![Vec3::Z * 0.1, Vec3::X * 0.12];
    percepts.ahead = Some(Impact { distance: 0.1, aim: Vec3::X });
    let situation = Situation::new(&percepts, &nature(), &Temper::default());
    let drives = drives(0.6, 0.0, 0.0);
    let strengths = Strengths::beside(Behavior::Avoid, &drives);
    let threat =
        Threat::worst(&situation, &Region::new(&Temper::default(), 1.0, 0), &Temper::default());
    let focus = Focus { behavior: Behavior::Avoid, target: NOTHING, threat: threat.as_ref() };
    let preferences = preferences(&situation, &strengths, &focus);
    assert_eq!(preferences.of(Skill::Left), -1.0);
    assert!((preferences.of(Skill::Right) - 0.6).abs() < 1e-6);
    assert_eq!(preferences.of(Skill::Forward), 0.0, "the avoided one is the focus");
}

#[test]
fn discouraged_actions_are_weakened_by_half_at_most() {
    for (strength, factor) in [(0.3, 1.0), (-0.3, 1.0), (-0.5, 1.0), (-0.75, 0.75), (-1.0, 0.5)] {
        let mut preferences = Preferences::default();
        preferences.add(Skill::Left, strength);
        assert!((preferences.compromise(Skill::Left) - factor).abs() < 1e-6, "{strength}");
    }
}

#[test]
fn strengths_are_relative_to_the_intention_and_at_most_one() {
    let drives = drives(0.5, 0.8, 0.2);
    let eating = Strengths::beside(Behavior::Eat, &drives);
    assert_eq!((eating.avoid, eating.eat, eating.mate), (1.0, 1.0, 1.0));
    assert!((eating.escape - 0.4).abs() < 1e-6);
    let avoiding = Strengths::beside(Behavior::Avoid, &drives);
    assert_eq!((avoiding.escape, avoiding.eat, avoiding.mate), (0.2, 0.5, 0.8));
}

#[test]
fn food_towards_the_mate_is_taken_though_a_little_farther() {
    let ahead = Candidate { id: 1, position: Vec3::Z, desirability: 0.9, cost: 2.0 };
    let left = Candidate { id: 2, position: Vec3::X * 1.3, desirability: 0.8, cost: 2.6 };
    let chosen = |mate: f32, current: u32, persistence: f32| {
        let mut preferences = Preferences::default();
        preferences.add(Skill::Left, mate);
        choose(&mut [left, ahead], &preferences, current, (0.2, persistence)).unwrap().id
    };
    assert_eq!([chosen(0.0, 0, 0.5), chosen(0.9, 0, 0.5)], [1, 2]);
    // The devoted keep what they have, the fickle take what is nearer.
    assert_eq!([chosen(0.0, 2, 5.0), chosen(0.0, 2, 0.5)], [2, 1]);
    assert_eq!(choose(&mut [], &Preferences::default(), 0, (0.2, 0.5)), None);
}

#[test]
fn prey_is_dearer_in_a_school_and_behind() {
    let nature = Nature { role: Role::Predator, food: vec!["prey".into()], ..Nature::default() };
    let temper = Temper::default();
    let cost = |place: Vec3, act: Act| {
        let display = Display { act, ..Display::NONE };
        let mouth = Vec3::Z * 0.048;
        let percepts = percepts(vec![Sighting { display, ..sighting(1, "prey", mouth + place) }]);
        Situation::new(&percepts, &nature, &temper).food[0].cost
    };
    let ten = Vec3::Z * 10.0;
    for (place, act, expected) in [
        (ten, Act::Other, 10.0),
        (ten, Act::Schooling, 15.0),
        (-ten, Act::Other, 12.0),
        (-ten, Act::Schooling, 17.0),
    ] {
        assert!((cost(place, act) - expected).abs() < 1e-3, "{place} {act:?}");
    }
}

#[test]
fn whoever_is_most_in_the_box_threatens_most_and_the_timid_mind_sooner() {
    let temper = Temper::default();
    let crossing = |id: u32, place: Vec3, heading: Vec3| Sighting {
        heading,
        ..sighting(id, "clownfish", place)
    };
    let percepts = percepts(vec![
        crossing(1, Vec3::new(0.06, 0.0, 0.05), Vec3::X),
        crossing(2, Vec3::new(0.01, 0.0, 0.06), Vec3::Z),
        crossing(3, Vec3::new(0.0, 0.0, 0.17), Vec3::X),
    ]);
    let situation = Situation::new(&percepts, &nature(), &temper);
    let worst = |region: Region, temper: &Temper| match Threat::worst(&situation, &region, temper) {
        Some(Threat::Animal(one)) => one.id,
        _ => 0,
    };
    assert_eq!(worst(Region::new(&temper, 1.0, 0), &temper), 2);
    assert_eq!(worst(Region::new(&temper, 1.0, 2), &temper), 1, "towards a partner it is small");
    let timid = Temper { timidity: 2.0, ..Temper::default() };
    assert!(Region::new(&timid, 1.0, 0).share(&percepts.seen[2], 0.1) > 0.0);
    assert_eq!(Region::new(&temper, 1.0, 0).share(&percepts.seen[2], 0.1), 0.0);
}

#[test]
fn comfort_is_what_the_habits_like() {
    let temper = Temper::default();
    let discomfort = |habits: Habits, light: f32, temperature: f32| {
        let percepts = Percepts { light, temperature, ..percepts(Vec::new()) };
        let nature = Nature { habits, ..nature() };
        Situation::new(&percepts, &nature, &temper).discomfort(&nature, &temper)
    };
    let dark = Habits { dark: true, ..Habits::default() };
    assert!(discomfort(dark, 0.9, 24.0) > 0.5 && discomfort(dark, 0.2, 24.0) == 0.0);
    let warm = Habits { warm: true, ..Habits::default() };
    assert!(discomfort(warm, 0.9, 15.0) > discomfort(warm, 0.9, 20.0));
    let both = Habits { bright: true, dark: true, ..Habits::default() };
    assert_eq!(discomfort(both, 0.9, 5.0), 0.0, "both of a pair is indifference");
}
