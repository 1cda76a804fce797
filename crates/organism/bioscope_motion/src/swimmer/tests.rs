use std::sync::Arc;

use bioscope_core::{Intention, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::Transform;
use proptest::prelude::*;

use super::*;
use crate::Body;
use crate::undulation::{Gait, Spine, Style};

const DT: f32 = 1.0 / 60.0;

/// Half a metre long.
fn swimmer() -> Swimmer {
    let gait = Gait { style: Style::Mackerel, waves: 1.0, cruise: 1.2 };
    let cuts = Spine::even_cuts(6);
    let spine = Spine::new(0.25, gait, cuts, vec![1.0; 6], Vec::new()).unwrap();
    Swimmer::new(Arc::new(spine), 2.0, SwimmerParameters::default()).unwrap()
}

fn going(heading: Vec3, speed: f32, urgency: f32) -> Intention {
    Intention { heading, speed, urgency, ..Intention::default() }
}

fn run(swimmer: &mut Swimmer, intention: &Intention, influence: &Influence, seconds: f32) {
    for _ in 0..(seconds / DT) as usize {
        swimmer.advance(intention, influence, DT).unwrap();
    }
}

fn own_heading(swimmer: &Swimmer, world: Vec3) -> Vec3 {
    swimmer.placement().rotation().inverse() * world
}

#[test]
fn reaches_the_speed_wanted_and_alternates_bursts_and_glides_about_it() {
    let (mut swimmer, still) = (swimmer(), Influence::default());
    run(&mut swimmer, &going(Vec3::Z, 1.5, 0.3), &still, 4.0);
    let (mut speeds, mut glides, mut was) = (Vec::new(), 0, true);
    for _ in 0..1200 {
        run(&mut swimmer, &going(Vec3::Z, 1.5, 0.3), &still, 1.01 * DT);
        speeds.push(swimmer.velocity().length() / swimmer.length());
        let gliding = swimmer.values()["gliding"] == true.into();
        glides += usize::from(gliding && !was);
        was = gliding;
    }
    let mean = speeds.iter().sum::<f32>() / speeds.len() as f32;
    assert!((mean - 1.5).abs() < 0.1, "{mean}");
    let range = speeds.iter().fold((9f32, 0f32), |(low, high), &one| (low.min(one), high.max(one)));
    assert!(range.0 > 1.25 && range.1 < 1.75 && range.1 - range.0 > 0.2, "{range:?}");
    assert!((5..40).contains(&glides), "{glides} glides in 20 s");
}

#[test]
fn stays_within_its_limits_whatever_it_is_asked() {
    let mut swimmer = swimmer();
    let limits = SwimmerParameters::default();
    let mad = [
        going(Vec3::new(f32::NAN, 0.0, 1.0), f32::INFINITY, f32::NAN),
        going(Vec3::NEG_Z, 1e30, 9.0),
        going(Vec3::Y * 1e-30, -4.0, -1.0),
        going(Vec3::Y, 30.0, 1.0),
    ];
    let mut before = swimmer.placement();
    for tick in 0..1000 {
        run(&mut swimmer, &mad[tick / 30 % mad.len()], &Influence::default(), 1.01 * DT);
        let now = swimmer.placement();
        let turned = before.rotation().angle_between(now.rotation()) / DT;
        assert!(now.position.is_finite() && now.rotation().is_finite());
        assert!(turned < 1.8 * limits.turn_rate, "{turned} rad/s");
        assert!(swimmer.velocity().length() <= limits.top_speed * swimmer.length() + 1e-4);
        let climb = (now.rotation() * Vec3::Z).y;
        assert!(climb.abs() <= limits.steepness.to_radians().sin() + 1e-3, "{climb}");
        before = now;
    }
}

#[test]
fn turns_wider_when_slow_than_its_rate_alone_allows_and_faster_when_it_swims() {
    let rate = |speed: f32| {
        let mut swimmer = swimmer();
        let still = Influence::default();
        run(&mut swimmer, &going(Vec3::Z, speed, 1.0), &still, 3.0);
        run(&mut swimmer, &going(Vec3::X, speed, 1.0), &still, 0.4);
        let ahead = swimmer.placement().rotation() * Vec3::Z;
        ahead.x.atan2(ahead.z)
    };
    let (slow, fast) = (rate(0.0), rate(2.0));
    assert!(slow > 0.1 && fast > 2.5 * slow, "{slow} {fast}");
}

#[test]
fn the_head_leads_the_turn_and_the_body_banks_into_it() {
    let (mut swimmer, still) = (swimmer(), Influence::default());
    run(&mut swimmer, &going(Vec3::Z, 2.0, 0.5), &still, 3.0);
    run(&mut swimmer, &going(Vec3::X, 2.0, 0.8), &still, 0.15);
    let bend = swimmer.motion.swim.bend;
    assert!(bend[0] > 0.03 && bend[0] > bend[1], "{bend:?}");
    run(&mut swimmer, &going(Vec3::X, 2.0, 0.8), &still, 0.4);
    assert!((swimmer.placement().rotation() * Vec3::X).y < -0.01, "the left side is lower");
}

#[test]
fn the_current_carries_it() {
    let mut swimmer = swimmer();
    let current = Influence { flow: Vec3::X * 0.3, ..Influence::default() };
    run(&mut swimmer, &going(Vec3::Z, 0.0, 0.0), &current, 10.0);
    let place = swimmer.placement().position;
    assert!((place.x - 2.9).abs() < 0.1 && place.z.abs() < 1e-3, "{place}");
}

#[test]
fn strong_strokes_are_heard_and_cost_energy() {
    let count = |urgency: f32, speed: f32| {
        let (mut swimmer, mut sounds) = (swimmer(), Vec::new());
        for _ in 0..120 {
            run(&mut swimmer, &going(Vec3::Z, speed, urgency), &Influence::default(), 1.01 * DT);
            swimmer.sounds(&mut sounds);
        }
        (sounds.len(), swimmer.energy_spent())
    };
    let (dash, cruise) = (count(1.0, 4.0), count(0.2, 1.0));
    assert!(dash.0 >= 1 && cruise.0 == 0, "{dash:?} {cruise:?}");
    assert!(dash.1 > 5.0 * cruise.1, "{dash:?} {cruise:?}");
}

proptest! {
    #[test]
    fn arrives_at_any_heading_it_can_climb(yaw in -3f32..3.0, climb in -0.8f32..0.8) {
        let wanted = Vec3::new(yaw.sin() * climb.cos(), climb.sin(), yaw.cos() * climb.cos());
        let mut swimmer = swimmer();
        for _ in 0..400 {
            let own = own_heading(&swimmer, wanted);
            swimmer.advance(&going(own, 1.5, 0.6), &Influence::default(), DT).unwrap();
        }
        let ahead = swimmer.placement().rotation() * Vec3::Z;
        prop_assert!(ahead.angle_between(wanted) < 0.05, "{} {}", ahead, wanted);
    }

    #[test]
    fn continues_from_its_bytes_as_if_nothing_had_happened(ticks in 0usize..200, turn in -1f32..1.0) {
        let mut one = swimmer();
        let influence = Influence { flow: Vec3::new(0.1, 0.0, -0.2), ..Influence::default() };
        let intention = going(Vec3::new(turn, 0.2, 1.0), 2.0, 0.5);
        for _ in 0..ticks {
            one.advance(&intention, &influence, DT).unwrap();
        }
        let mut two = Swimmer::restore(one.spine.clone(), &one.save().unwrap()).unwrap();
        for _ in 0..50 {
            one.advance(&intention, &influence, DT).unwrap();
            two.advance(&intention, &influence, DT).unwrap();
        }
        prop_assert_eq!(one.save().unwrap(), two.save().unwrap());
        let mut poses = vec![[Transform::IDENTITY; 6]; 2];
        one.pose(&mut poses[0]);
        two.pose(&mut poses[1]);
        prop_assert_eq!(poses[0], poses[1]);
    }
}
