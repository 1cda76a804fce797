use std::sync::Arc;

use bioscope_core::{Intention, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::Transform;

use super::MuscleSwimmer;
use crate::Body;
use crate::undulation::{Gait, Spine, Style};

const DT: f32 = 1.0 / 30.0;

fn spine() -> Arc<Spine> {
    let gait = Gait { style: Style::Mackerel, waves: 1.0, cruise: 1.5 };
    let cuts = Spine::even_cuts(6);
    let masses = vec![1.0; 6];
    Arc::new(Spine::new(0.3, gait, cuts, masses, Vec::new()).unwrap())
}

fn swimming(turn: f32) -> Intention {
    Intention {
        heading: Vec3::new(turn.sin(), 0.0, turn.cos()),
        speed: 1.5,
        urgency: 0.5,
        ..Intention::default()
    }
}

#[test]
fn it_swims_ahead_and_turns_to_where_the_mind_looks() {
    let mut fish = MuscleSwimmer::new(spine(), "calibrated").unwrap();
    let still = Influence::default();
    for _ in 0..240 {
        fish.advance(&swimming(0.0), &still, DT).unwrap();
    }
    let speed = fish.velocity().length() / fish.length();
    assert!((0.8..2.5).contains(&speed), "{speed} body lengths per second");
    let before = fish.placement().rotation() * Vec3::Z;
    fish.advance(&swimming(1.0), &still, DT).unwrap();
    for _ in 0..240 {
        // Points on to the same direction of the world.
        let goal = Vec3::new(1f32.sin(), 0.0, 1f32.cos());
        let own = fish.placement().rotation().inverse() * goal;
        fish.advance(&swimming(own.x.atan2(own.z)), &still, DT).unwrap();
    }
    let after = fish.placement().rotation() * Vec3::Z;
    assert!(before.z > 0.9 && after.x > 0.6, "{before} {after}");
}

#[test]
fn many_together_swim_as_each_would_alone() {
    let mut alone: Vec<_> = (0..11)
        .map(|number| {
            let mut fish = MuscleSwimmer::new(spine(), "calibrated").unwrap();
            fish.put(Vec3::X * number as f32, Vec3::new(0.1 * number as f32, 0.0, 1.0));
            fish
        })
        .collect();
    let mut together = alone.clone();
    for tick in 0..40 {
        for (number, (one, other)) in alone.iter_mut().zip(&mut together).enumerate() {
            let intention = swimming(0.1 * (number as f32 - 5.0) * (tick % 3) as f32);
            let flow = Influence { flow: Vec3::X * 0.1, ..Influence::default() };
            one.advance(&intention, &flow, DT).unwrap();
            other.obey(&intention, &flow, DT).unwrap();
        }
        MuscleSwimmer::advance_together(&mut together.iter_mut().collect::<Vec<_>>(), DT);
    }
    for (one, other) in alone.iter().zip(&together) {
        assert!(one.save().unwrap() == other.save().unwrap(), "other bits");
    }
}

#[test]
fn the_form_follows_the_nodes_without_stretching_much() {
    let spine = spine();
    let mut fish = MuscleSwimmer::new(spine.clone(), "calibrated").unwrap();
    let mut poses = vec![Transform::IDENTITY; fish.joint_count()];
    fish.pose(&mut poses);
    for (pose, joint) in poses.iter().zip(spine.joints()) {
        assert!((pose.position - joint.rest.position).length() < 0.01 * spine.length());
        assert!((pose.rotation() * Vec3::Z).z > 0.999);
    }
    let mut widest = 0f32;
    for _ in 0..120 {
        fish.advance(&swimming(0.0), &Influence::default(), DT).unwrap();
        fish.pose(&mut poses);
        let tail = poses[poses.len() - 1];
        widest = widest.max(tail.position.x.abs() / spine.length());
        for (two, cuts) in poses.windows(2).zip(spine.cuts().windows(2)) {
            let link = (two[0].position - two[1].position).length() / spine.length();
            assert!((link / (cuts[1] - cuts[0]) - 1.0).abs() < 0.3, "{link}");
        }
    }
    assert!((0.01..0.25).contains(&widest), "the tail swings by {widest} body lengths");
}

#[test]
fn saved_fishes_go_on_as_they_were() {
    let mut fish = MuscleSwimmer::new(spine(), "calibrated").unwrap();
    let go = |fish: &mut MuscleSwimmer| {
        (0..20).for_each(|_| fish.advance(&swimming(0.4), &Influence::default(), DT).unwrap());
        fish.save().unwrap()
    };
    go(&mut fish);
    let mut again = MuscleSwimmer::restore(spine(), &fish.save().unwrap()).unwrap();
    assert_eq!(go(&mut fish), go(&mut again));
    assert!(MuscleSwimmer::restore(spine(), &[1, 2, 3]).is_err());
}

#[test]
fn what_draws_the_snout_does_not_draw_the_tail() {
    let mut fish = MuscleSwimmer::new(spine(), "calibrated").unwrap();
    let front = fish.placement().position.z + 0.1 * fish.length();
    fish.draw(|node| if node.z > front { Vec3::Z } else { Vec3::ZERO });
    let share = fish.velocity().z;
    assert!((0.01..0.6).contains(&share), "the share of the mass that is before: {share}");
    let before = fish.local_nodes();
    fish.advance(&Intention::default(), &Influence::default(), 0.01).unwrap();
    let after = fish.local_nodes();
    let length = |nodes: &[Vec3]| nodes[0].z - 0.5 * (nodes[21].z + nodes[22].z);
    assert!(length(&after) > length(&before), "it is stretched");
    fish.draw(|_| Vec3::Y);
    assert!((fish.velocity().y - 1.0).abs() < 0.05, "drawn as a whole it moves as a whole");
}
