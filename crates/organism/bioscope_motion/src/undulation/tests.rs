use proptest::prelude::*;

use super::*;

const STYLES: [Style; 2] = [Style::Mackerel, Style::Eel];

fn gait(style: Style, cruise: f32) -> Gait {
    Gait { style, waves: 1.0, cruise }
}

fn spine(style: Style, length: f32) -> Spine {
    let hinge = |side: f32| Hinge {
        position: Vec3::new(0.06 * side * length, 0.0, 0.15 * length),
        axis: Vec3::Y,
        side,
        swing: 0.7,
        part: Part::Flap,
    };
    let masses = vec![1.0, 2.0, 2.2, 1.6, 1.0, 0.5, 0.2];
    let cuts = Spine::even_cuts(masses.len());
    Spine::new(length, gait(style, 2.0), cuts, masses, vec![hinge(1.0), hinge(-1.0)]).unwrap() // numbers are in range
}

fn pose(spine: &Spine, swim: &SwimState) -> Vec<Transform> {
    let mut out = vec![Transform::IDENTITY; spine.joint_count()];
    spine_pose(spine, swim, &mut out);
    out
}

/// The fore ends of all links and the tip of the tail.
fn ends(spine: &Spine, swim: &SwimState) -> Vec<Vec3> {
    let poses = pose(spine, swim);
    let links = spine.link_count();
    let last = spine.cuts[links] - spine.cuts[links - 1];
    let tip = poses[links - 1].point(Vec3::new(0.0, 0.0, -last * spine.length()));
    poses[..links].iter().map(|pose| pose.position).chain([tip]).collect()
}

#[test]
fn the_tail_swings_as_wide_as_the_law() {
    for style in STYLES {
        let spine = spine(style, 0.3);
        let widest = (0..720)
            .map(|step| SwimState {
                phase: step as f32 * math::TAU / 720.0,
                amplitude: 1.0,
                ..Default::default()
            })
            .map(|swim| ends(&spine, &swim).last().map_or(0.0, |tip| tip.x.abs()))
            .fold(0.0, f32::max);
        let law = style.amplitude(1.0) * 0.3;
        assert!((widest / law - 1.0).abs() < 0.001, "{style:?}: {widest} m, law {law} m");
    }
    assert!((Style::Mackerel.amplitude(1.0) - 0.1).abs() < 1e-6);
    assert!((Style::Eel.amplitude(1.0) - 0.1).abs() < 1e-6);
}

#[test]
fn the_wave_travels_from_head_to_tail_once_over_the_body() {
    let spine = spine(Style::Eel, 1.0);
    // The moment at which each end swings furthest to the left comes later towards the tail.
    let moments: Vec<f32> = (2..=spine.link_count())
        .map(|end| math::atan2(spine.wave[end][0], spine.wave[end][1]))
        .collect();
    let mut total = 0.0;
    for two in moments.windows(2) {
        let later = wrap(two[1] - two[0]);
        assert!(later > 0.0 && later < math::PI, "{moments:?}");
        total += later;
    }
    let expected = math::TAU * (1.0 - spine.cuts[2]);
    assert!((total - expected).abs() < 1e-3, "{total} {expected}");
}

#[test]
fn strouhal_number_stays_in_the_band_over_the_speed_range() {
    for (cruise, burst) in [(0.5, 3.0), (1.0, 8.0), (2.0, 12.0), (3.0, 20.0)] {
        let gait = gait(Style::Mackerel, cruise);
        for step in 1..200 {
            let speed = burst * step as f32 / 199.0;
            let mut swim = SwimState::default();
            let stroke = Stroke { speed, ..Default::default() };
            for _ in 0..600 {
                swim.advance(gait, &stroke, 1.0 / 60.0);
            }
            for _ in 0..600 {
                swim.advance(gait, &stroke, 1.0 / 60.0);
                let width = 2.0 * gait.style.amplitude(1.0) * swim.amplitude;
                let strouhal = gait.tail_beat(speed) * width / speed;
                assert!((0.2..=0.45).contains(&strouhal), "{strouhal} at {speed} of {cruise}");
            }
        }
        assert!(gait.tail_beat(2.0 * cruise) > gait.tail_beat(cruise));
    }
}

#[test]
fn the_head_leads_a_turn_and_the_tail_follows() {
    let gait = gait(Style::Mackerel, 2.0);
    let mut swim = SwimState::default();
    let stroke = Stroke { speed: 2.0, turn: 3.0, ..Default::default() };
    for _ in 0..6 {
        swim.advance(gait, &stroke, 1.0 / 60.0);
    }
    assert!(swim.bend[0] > 2.0 * swim.bend[1] && swim.bend[1] > 0.0, "{:?}", swim.bend);
    let bent = SwimState { bend: [0.4, 0.4], ..Default::default() };
    let ends = ends(&spine(Style::Mackerel, 0.2), &bent);
    let (snout, tail) = (ends[0], ends[ends.len() - 1]);
    assert!(snout.x > 0.005 && tail.x > 0.005, "a left turn is hollow on the left: {snout} {tail}");
    let raised = SwimState { lift: 0.2, ..Default::default() };
    assert!(self::ends(&spine(Style::Mackerel, 0.2), &raised)[0].y > 0.005);
}

#[test]
fn slowing_down_glides_and_starting_beats_harder() {
    let gait = gait(Style::Mackerel, 2.0);
    let run = |acceleration: f32| {
        let mut swim = SwimState::default();
        for _ in 0..60 {
            swim.advance(
                gait,
                &Stroke { speed: 1.0, acceleration, ..Default::default() },
                1.0 / 60.0,
            );
        }
        swim.amplitude
    };
    assert!(run(-1.0) < 0.4 * run(0.0), "{} {}", run(-1.0), run(0.0));
    assert!(run(6.0) > 1.1 * run(0.0), "{} {}", run(6.0), run(0.0));
}

#[test]
fn at_rest_joints_and_poses_agree_and_weights_sum_to_one() {
    let spine = spine(Style::Mackerel, 0.5);
    for (joint, pose) in spine.joints().iter().zip(pose(&spine, &SwimState::default())) {
        assert!((joint.rest.position - pose.position).length() < 1e-6, "{}", joint.name);
        assert!(joint.rest.rotation().angle_between(pose.rotation()) < 1e-3, "{}", joint.name);
    }
    for step in 0..=100 {
        let (indices, weights) = spine.weights(step as f32 / 100.0);
        assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        assert!(indices.iter().all(|&joint| usize::from(joint) < spine.link_count()));
    }
}

#[test]
fn a_spine_that_makes_no_sense_is_refused() {
    let make = |length: f32, cuts: Vec<f32>, masses: Vec<f32>| {
        Spine::new(length, gait(Style::Mackerel, 1.0), cuts, masses, vec![])
            .unwrap_err()
            .to_string()
    };
    assert!(make(f32::NAN, vec![0.0, 0.5, 1.0], vec![1.0; 2]).contains("spine length = NaN"));
    assert!(make(1.0, vec![0.0, 1.0], vec![1.0]).contains("spine links = 1 masses, 2 cuts"));
    assert!(make(1.0, vec![0.0, 0.7, 0.5, 1.0], vec![1.0; 3]).contains("spine cuts"));
    assert!(make(1.0, vec![0.0, 0.5, 1.0], vec![0.0; 2]).contains("mass of the body = 0"));
    assert!(make(1.0, vec![0.0, 0.5, 1.0], vec![1.0, -1.0]).contains("link masses"));
}

proptest! {
    #[test]
    fn links_keep_their_length_and_the_centre_stays(
        phase in 0f32..7.0, amplitude in 0f32..1.5, fore in -0.6f32..0.6, hind in -0.6f32..0.6,
        lift in -0.3f32..0.3, length in 0.02f32..5.0, eel: bool,
    ) {
        let spine = spine(STYLES[usize::from(eel)], length);
        let swim = SwimState { phase, amplitude, bend: [fore, hind], lift, ..Default::default() };
        let ends = ends(&spine, &swim);
        let mut centre = Vec3::ZERO;
        let mut rest = Vec3::ZERO;
        for link in 0..spine.link_count() {
            let long = (spine.cuts[link + 1] - spine.cuts[link]) * length;
            prop_assert!(((ends[link] - ends[link + 1]).length() / long - 1.0).abs() < 1e-3);
            centre += 0.5 * (ends[link] + ends[link + 1]) * spine.masses[link];
            let middle = 0.5 * (spine.cuts[link] + spine.cuts[link + 1]);
            rest.z += spine.along(middle) * spine.masses[link];
        }
        prop_assert!((centre - rest).length() < 1e-4 * length, "{centre} {rest}");
    }

    #[test]
    fn any_motion_keeps_the_state_finite_and_bounded(
        speed in -9f32..30.0, acceleration in -90f32..90.0, turn in -40f32..40.0, rise in -40f32..40.0,
        dt in 0f32..0.5,
    ) {
        let mut swim = SwimState::default();
        for _ in 0..50 {
            swim.advance(gait(Style::Mackerel, 1.5), &Stroke { speed, acceleration, turn, lift: rise, brake: 0.0 }, dt);
        }
        prop_assert!((0.0..=math::TAU).contains(&swim.phase) && (0.0..=1.2).contains(&swim.amplitude));
        prop_assert!(swim.bend.iter().all(|bend| bend.abs() <= GREATEST_BEND) && swim.lift.abs() <= 0.3);
        let poses = pose(&spine(Style::Mackerel, 0.1), &swim);
        prop_assert!(poses.iter().all(|pose| pose.position.is_finite() && pose.rotation().is_normalized()));
    }
}

#[test]
fn oars_run_round_with_the_speed_backward_inside_a_turn_and_when_braking() {
    let turned = |speed: f32, turn: f32, brakes: bool| {
        let mut swim = SwimState::default();
        for _ in 0..100 {
            swim.row(speed, turn, brakes, 0.001);
        }
        swim.oars.map(|phase| if phase > math::PI { phase - math::TAU } else { phase })
    };
    let [left, right] = turned(2.0, 0.0, false);
    assert!(left > 0.0 && (left - right).abs() < 1e-6);
    assert!((turned(4.0, 0.0, false)[0] / left - 2.0).abs() < 1e-3, "in proportion to the speed");
    assert!(turned(0.0, 0.0, false)[0] > 0.0, "never at rest");
    let [left, right] = turned(2.0, 1.0, false);
    assert!(left < 0.0 && right > 0.0, "a turn to the left");
    let [left, right] = turned(2.0, -1.0, false);
    assert!(left > 0.0 && right < 0.0, "a turn to the right");
    assert!(turned(2.0, 0.0, true).iter().all(|&phase| phase < 0.0), "braking");
}

#[test]
fn a_stroke_of_an_oar_is_one_turn_on_a_cone() {
    let hinge = Hinge {
        position: Vec3::ZERO,
        axis: Vec3::Y,
        side: 1.0,
        swing: 0.6,
        part: Part::Oar { across: Vec3::X },
    };
    let masses = vec![1.0; 4];
    let cuts = Spine::even_cuts(4);
    let spine = Spine::new(1.0, gait(Style::Mackerel, 1.0), cuts, masses, vec![hinge]).unwrap(); // numbers are in range
    let tip = |phase: f32| {
        let swim = SwimState { oars: [phase, 0.0], fanning: 1.0, ..SwimState::default() };
        let fin = pose(&spine, &swim)[spine.link_count()];
        fin.rotation() * Vec3::Z
    };
    assert!(tip(0.0).distance(tip(math::TAU)) < 1e-3, "a stroke ends where it began");
    let middle = (tip(0.0) + tip(math::PI)).normalize();
    for step in 0..12 {
        let angle = middle.dot(tip(step as f32 * math::TAU / 12.0)).acos();
        assert!((0.25..0.37).contains(&angle), "{angle} at {step}");
    }
}

#[test]
fn the_mouth_opens_and_shuts_in_time() {
    let mut swim = SwimState::default();
    swim.gape(1.0, 0.06);
    assert!((0.4..0.6).contains(&swim.mouth));
    swim.gape(f32::NAN, 0.01);
    assert!(swim.mouth < 0.5);
    for _ in 0..20 {
        swim.gape(7.0, 0.02);
    }
    assert_eq!(swim.mouth, 1.0);
}
