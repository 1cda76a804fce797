use std::sync::Arc;

use bioscope_core::{Quat, Vec3};
use bioscope_dynamics::spring_body::Lanes;

use super::*;
use crate::undulation::{Gait, Spine, Style, SwimState};

fn model() -> Arc<FishModel> {
    FishModel::named("calibrated").expect("ready-made")
}

/// Fishes that swim at different speeds and turn differently.
fn school(count: usize) -> Swimmers<Lanes> {
    let mut school = Swimmers::new(model(), 1.0).expect("a pace");
    for index in 0..count {
        let place = [index as f64 * 100.0, 0.0, -3.0];
        school.add(place, Quat::IDENTITY, 0.1 + 0.01 * index as f64).expect("a fish");
        let speed = 0.05 + 0.02 * index as f32;
        school.command(index, Command { speed, ..Command::default() }).expect("finite");
        school.turn(index, 0.3 - 0.1 * index as f32);
    }
    school
}

#[test]
fn a_fish_moves_alike_in_any_company_and_on_any_threads() {
    let mut many = school(11);
    let mut alone = school(11);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for _ in 0..60 {
        many.advance(1.0 / 60.0);
        pool.install(|| alone.advance(1.0 / 60.0));
    }
    for index in 0..11 {
        assert_eq!(many.nodes(index), alone.nodes(index));
    }
    let before = (many.nodes(10), many.length(10));
    many.swap_remove(3);
    alone.swap_remove(3);
    assert_eq!((many.nodes(3), many.length(3)), before);
    assert_eq!(many.len(), 10);
    many.advance(0.1);
    alone.advance(0.1);
    assert_eq!(many.nodes(3), alone.nodes(3));
}

#[test]
fn random_admissible_activation_never_breaks_a_body() {
    use bioscope_core::{Purpose, Random};
    let mut school = Swimmers::<Lanes>::new(model(), 1.0).expect("a pace");
    for _ in 0..8 {
        school.add([0.0; 3], Quat::IDENTITY, 0.1).expect("a fish");
    }
    let step = school.natural_step();
    for tick in 0..3000 {
        for index in 0..8 {
            let mut random = Random::new(9, index as u32, tick, Purpose::new("activation"));
            let activation = std::array::from_fn(|_| random.uniform());
            school.activate(index, Some(activation));
        }
        school.advance_in(step, 1);
    }
    for index in 0..8 {
        assert_eq!(school.repairs(index), 0);
        school.activate(index, Some([0.0; 12]));
    }
    school.advance(30.0 * school.time_unit());
    let rest = &model().mechanics.anatomy;
    for index in 0..8 {
        let nodes = school.nodes(index);
        for unit in &rest.units {
            let [a, b] = unit.ends.map(|end| nodes[end]);
            let length: f64 = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
            assert!((length / 0.1 / unit.rest - 1.0).abs() < 0.02, "{unit:?} {length}");
        }
        let volume = bioscope_dynamics::spring_body::signed_volume(&rest.faces, &nodes);
        assert!((volume / 1e-3 / rest.volume() - 1.0).abs() < 0.02, "inside out: {volume}");
    }
}

#[test]
fn replicas_repeat_what_was_captured() {
    let model = model();
    let repertoire = Repertoire::capture(&model).expect("a model that swims");
    let cruise = repertoire.forward(model.design.swim.cruise as f32);
    let segment = &repertoire.segments()[cruise];
    let (first, last) = (segment.nodes(0).expect("a moment"), segment.nodes(segment.len() - 1));
    let stride = last.expect("a moment")[5] - first[5];
    assert!(segment.cyclic && stride.z > 0.3 && stride.x.abs() < 1e-3, "{stride}");
    let begin = (Vec3::ZERO, 0.0, 1.0);
    let mut replica = Replica::new(&repertoire, begin, (cruise, 0.0)).expect("it exists");
    let beats = 3.0;
    let steps = 3 * 40;
    let dt = segment.duration() * beats / steps as f32;
    let mut before = None;
    for _ in 0..steps {
        replica.advance(&repertoire, cruise, dt);
        let nodes = replica.nodes();
        if let Some(before) = before.replace(nodes) {
            // No jumps where the end meets the beginning.
            let jump =
                (0..23).map(|node| (nodes[node] - before[node]).length()).fold(0.0, f32::max);
            assert!(jump < 0.08, "{jump}");
        }
    }
    assert!((replica.position.z - beats * stride.z).abs() < 0.02, "{}", replica.position);
    replica.play(repertoire.turn(-1.5));
    for _ in 0..2000 {
        replica.advance(&repertoire, cruise, 0.05);
    }
    assert!((replica.yaw + 1.57).abs() < 0.45, "{}", replica.yaw);
}

#[test]
fn the_rest_pose_of_the_nodes_is_the_rest_pose_of_the_spine() {
    let model = model();
    let mut fish = Swimmers::<f64>::new(Arc::clone(&model), 1.0).expect("a pace");
    fish.add([1.0, 2.0, 3.0], Quat::from_rotation_y(0.7), 0.2).expect("a fish");
    let gait = Gait { style: Style::Mackerel, waves: 1.0, cruise: 1.0 };
    let cuts = Spine::even_cuts(7);
    let spine = Spine::new(0.2, gait, cuts, vec![1.0; 7], vec![]).expect("a spine");
    let mut poses = vec![bioscope_geometry::Transform::IDENTITY; spine.joint_count()];
    let nodes = fish.local_nodes(0);
    pose_from_nodes(&spine, &model.design.shape, &nodes, &SwimState::default(), &mut poses);
    for (pose, joint) in poses.iter().zip(spine.joints()) {
        assert!((pose.position - joint.rest.position).length() < 1e-4, "{pose:?}");
        assert!(pose.rotation().angle_between(Quat::IDENTITY) < 1e-3, "{pose:?}");
    }
}

#[test]
fn bad_numbers_are_refused() {
    let mut fish = Swimmers::<f64>::new(model(), 1.0).expect("a pace");
    assert!(fish.add([f64::NAN; 3], Quat::IDENTITY, 0.1).is_err());
    assert!(fish.add([0.0; 3], Quat::IDENTITY, 0.0).is_err());
    fish.add([0.0; 3], Quat::IDENTITY, 0.1).expect("a fish");
    let wrong = Command { speed: f32::NAN, ..Command::default() };
    let message = fish.command(0, wrong).expect_err("refused").to_string();
    assert!(message.contains("speed"), "{message}");
    assert!(FishModel::named("nothing").is_err());
    let text = include_str!("../../tables/calibrated.toml").replace("shortening", "shortning");
    assert!(
        FishDesign::parse(&text, "x.toml").expect_err("refused").to_string().contains("x.toml")
    );
}
