use std::f32::consts::{FRAC_PI_2, PI};

use bioscope_core::{Impact, Percepts, Purpose, Quat, Random, Sighting, Vec3};

use super::*;
use crate::attention::{Preferences, Situation, Skill, Threat};
use crate::nature::{Nature, Role, Temper};

const LENGTH: f32 = 0.1;

fn random() -> Random {
    Random::new(3, 1, 1, Purpose::new("test"))
}

fn sighting(species: &str, position: Vec3, velocity: Vec3) -> Sighting {
    let heading = velocity.normalize_or(Vec3::Z);
    Sighting {
        id: 7,
        species: species.into(),
        position,
        velocity,
        heading,
        size: 0.1,
        ..Sighting::default()
    }
}

fn percepts(seen: Vec<Sighting>) -> Percepts {
    Percepts { id: 1, dt: 1.0 / 30.0, body_length: LENGTH, depth: 3.0, seen, ..Percepts::default() }
}

fn nature(role: Role) -> Nature {
    Nature {
        role,
        species: "fish".into(),
        food: vec!["plankton".into()],
        enemies: vec!["shark".into()],
        ..Nature::default()
    }
}

/// A place at an azimuth in degrees (positive to the left).
fn at(degrees: f32, distance: f32) -> Vec3 {
    let angle = degrees.to_radians();
    Vec3::new(angle.sin(), 0.0, angle.cos()) * distance
}

#[test]
fn the_table_of_escape_is_complete() {
    use Evasion::{About, Left, Proceed, Right};
    let (same, opposite, leftward, rightward) = (Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X);
    let own = Vec3::Z * 0.1;
    // distance, bearing in degrees, its course, own velocity, rule
    let table = [
        (false, 10.0, opposite, About),
        (false, 170.0, same, Proceed),
        (false, 90.0, same, Right),
        (false, -90.0, same, Left),
        (true, 0.0, leftward, Right),
        (true, 0.0, rightward, Left),
        (true, 0.0, opposite, About),
        (true, 170.0, same, Right),
        (true, -170.0, same, Left),
        (true, 180.0, leftward, Right),
        (true, 180.0, rightward, Left),
        (true, 180.0, opposite, Proceed),
        (true, 90.0, opposite, Right),
        (true, -90.0, opposite, Left),
    ];
    for (close, bearing, course, expected) in table {
        let predator = sighting("shark", at(bearing, 0.3), course * 0.5);
        assert_eq!(evasion(&predator, own, close), expected, "{close} {bearing} {course}");
    }
    // Behind, with my heading, but falling behind: no reason to turn.
    let slow = sighting("shark", at(170.0, 0.3), Vec3::Z * 0.05);
    assert_eq!(evasion(&slow, own, true), Proceed);
}

#[test]
fn escapes_are_at_full_speed_and_turn_about_over_one_side() {
    let (temper, nature) = (Temper::default(), nature(Role::Prey));
    let mut escape = Escape::default();
    for bearing in [5.0, -5.0, 5.0] {
        let percepts = percepts(vec![sighting("shark", at(bearing, 0.3), Vec3::NEG_Z)]);
        let situation = Situation::new(&percepts, &nature, &temper);
        let command =
            escape.command(&percepts.seen[0], &situation, &Preferences::default(), &temper);
        assert_eq!(command.speed, temper.full_speed);
        assert!(command.turn < -3.0, "away from the left side, and then on: {}", command.turn);
    }
}

#[test]
fn a_chase_turns_only_beyond_its_tolerance_and_slows_down_near_its_end() {
    let temper = Temper::default();
    let goal = |target: Vec3| Chase {
        target,
        velocity: Vec3::ZERO,
        tolerance: PI / 5.0,
        lead: 0.0,
        stop: 0.0,
    };
    let command = |target: Vec3| chase(&goal(target), LENGTH, 0.1, &temper);
    assert_eq!(command(at(30.0, 1.0)).turn, 0.0);
    assert!((command(at(50.0, 1.0)).turn - 50f32.to_radians()).abs() < 1e-4);
    assert!(command(at(-120.0, 1.0)).turn < -2.0);
    assert!(command(Vec3::Z * 2.0).speed > 2.5 * command(Vec3::Z * 0.05).speed);
    assert!(command(Vec3::new(0.0, 0.5, 0.5)).pitch > 0.7);
}

#[test]
fn a_hunter_turns_beyond_what_flees_to_its_side_and_not_beyond_what_comes_back() {
    let temper = Temper::default();
    let turn = |velocity: Vec3, lead: f32| {
        let goal = Chase { target: at(60.0, 0.5), velocity, tolerance: 0.2, lead, stop: 0.0 };
        chase(&goal, LENGTH, 0.2, &temper).turn
    };
    let away = at(150.0, 0.15);
    let plain = turn(away, 0.0);
    assert!(turn(away, 0.5) > plain + 0.05 && turn(away, 0.5) <= plain + PI / 6.0 + 1e-5);
    assert_eq!(turn(-away, 0.5), plain);
}

#[test]
fn a_chase_with_a_stop_brakes_rather_than_overshoot() {
    let temper = Temper::default();
    let goal = Chase {
        target: Vec3::Z * 0.12,
        velocity: Vec3::ZERO,
        tolerance: 0.5,
        lead: 0.0,
        stop: LENGTH,
    };
    assert!(chase(&goal, LENGTH, 0.3, &temper).brake > 0.5);
    assert_eq!(chase(&goal, LENGTH, 0.01, &temper).brake, 0.0);
}

fn avoid(percepts: &Percepts, preferences: &Preferences, seed: u64) -> Command {
    let (temper, nature) = (Temper::default(), nature(Role::Pacifist));
    let situation = Situation::new(percepts, &nature, &temper);
    let threat = Threat::Solid(percepts.ahead.unwrap());
    let mut random = Random::new(seed, 1, 1, Purpose::new("test"));
    Avoidance::default().command(&threat, &situation, preferences, &temper, &mut random)
}

#[test]
fn obstacles_are_passed_on_the_nearer_side_unless_it_is_barred() {
    let aim = |x: f32| {
        let ahead = Some(Impact { distance: 0.1, aim: Vec3::new(x, 0.0, 0.12) });
        Percepts { ahead, ..percepts(Vec::new()) }
    };
    let free = Preferences::default();
    assert!(avoid(&aim(0.08), &free, 1).turn > 0.4 && avoid(&aim(-0.08), &free, 1).turn < -0.4);
    let mut barred = Preferences::default();
    barred.add(Skill::Left, -1.0);
    barred.add(Skill::Right, 0.6);
    for seed in 0..20 {
        assert!(avoid(&aim(0.08), &barred, seed).turn < -0.4);
        assert!(avoid(&aim(0.001), &barred, seed).turn < -0.4);
    }
    // Nothing to choose between the sides: both occur.
    let sides: Vec<bool> = (0..20).map(|seed| avoid(&aim(0.001), &free, seed).turn > 0.0).collect();
    assert!(sides.contains(&true) && sides.contains(&false));
    barred.add(Skill::Right, -1.0);
    barred.add(Skill::Right, -1.0);
    let mut walls = Preferences::default();
    walls.add(Skill::Left, -1.0);
    walls.add(Skill::Right, -1.0);
    let mut close = aim(0.001);
    close.ahead.as_mut().unwrap().distance = 0.03;
    let stuck = avoid(&close, &walls, 1);
    assert!(stuck.speed < 0.0 && stuck.brake == 1.0, "{stuck:?}");
}

#[test]
fn a_low_obstacle_is_passed_above() {
    let ahead = Some(Impact { distance: 0.1, aim: Vec3::new(0.01, 0.1, 0.1) });
    let command = avoid(&Percepts { ahead, ..percepts(Vec::new()) }, &Preferences::default(), 1);
    assert!(command.pitch > 0.6 && command.turn == 0.0, "{command:?}");
}

#[test]
fn the_mouth_opens_when_food_is_before_it() {
    let temper = Temper::default();
    let command = |distance: f32| {
        let mut percepts = percepts(Vec::new());
        percepts.smelled.push(sighting("plankton", Vec3::Z * (0.048 + distance), Vec3::ZERO));
        let nature = nature(Role::Pacifist);
        let situation = Situation::new(&percepts, &nature, &temper);
        let none = Preferences::default();
        let morsel = choose_food(&situation, &none, 0, (nature.role, &temper)).unwrap();
        eat(&morsel, &situation, &temper)
    };
    assert_eq!((command(0.2).mouth, command(0.005).mouth), (0.0, 1.0));
    assert!(command(0.3).speed > command(0.01).speed);
}

#[test]
fn wanderers_go_straight_between_whims_and_leavers_turn_when_it_gets_worse() {
    let (temper, nature) = (Temper::default(), nature(Role::Pacifist));
    let mut random = random();
    let mut now = percepts(Vec::new());
    now.attitude = Quat::IDENTITY;
    let mut wandering = Wandering::default();
    let turns: Vec<f32> = (0..300)
        .map(|tick| {
            now.time = f64::from(tick) / 30.0;
            let situation = Situation::new(&now, &nature, &temper);
            wandering.wander(&situation, &temper, &mut random).turn
        })
        .collect();
    let changes = turns.windows(2).filter(|pair| (pair[0] - pair[1]).abs() > 0.05).count();
    assert!((3..=16).contains(&changes), "{changes} whims in 10 s");
    let leaving = |rate: f32| {
        let mut random = Random::new(5, 1, 1, Purpose::new("test"));
        let mut wandering = Wandering::default();
        let mut now = percepts(Vec::new());
        let mut turned = 0;
        for tick in 0..90 {
            now.time = f64::from(tick) / 30.0;
            let situation = Situation::new(&now, &nature, &temper);
            let discomfort = 1.0 + rate * tick as f32 / 30.0;
            let turn = wandering.leave(discomfort, &situation, &temper, &mut random).turn;
            turned += i32::from(turn.abs() > 0.8);
        }
        turned
    };
    assert_eq!(leaving(-0.2), 0);
    assert!(leaving(0.2) > 20);
}

#[test]
fn a_school_matches_course_closes_gaps_and_opens_crowds() {
    let (temper, nature) = (Temper::default(), nature(Role::Prey));
    let swim = |place: Vec3, course: Vec3| sighting("fish", place, course * 0.1);
    let command = |seen: Vec<Sighting>| {
        let percepts = Percepts { velocity: Vec3::Z * 0.1, ..percepts(seen) };
        school(&Situation::new(&percepts, &nature, &temper), &temper)
    };
    assert_eq!(command(Vec::new()), None);
    let spaced =
        command(vec![swim(at(90.0, 0.1), at(40.0, 1.0)), swim(at(-90.0, 0.1), at(40.0, 1.0))]);
    // Towards the common course, gently.
    assert!((0.3..40f32.to_radians()).contains(&spaced.unwrap().turn), "{spaced:?}");
    let gap = command(vec![swim(at(90.0, 0.25), Vec3::Z)]).unwrap();
    let crowd = command(vec![swim(at(90.0, 0.04), Vec3::Z)]).unwrap();
    assert!(gap.turn > 0.1 && crowd.turn < -0.2, "{gap:?} {crowd:?}");
    let behind = command(vec![swim(Vec3::Z * 0.25, Vec3::Z)]).unwrap();
    let ahead = command(vec![swim(Vec3::Z * -0.2, Vec3::Z)]).unwrap();
    assert!(behind.speed > 1.2 && ahead.speed < 0.8, "{behind:?} {ahead:?}");
    // Far off: hurries.
    let lost = command(vec![swim(at(90.0, 0.45), Vec3::Z)]).unwrap();
    assert!((lost.turn - FRAC_PI_2).abs() < 0.05 && lost.speed > 1.5, "{lost:?}");
}
