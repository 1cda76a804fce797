//! Geometric flight: speed, path, roll.

use bioscope_core::{Vec3, math};
use bioscope_crowds::{Flock, FlockParameters, Goal, Region, Surroundings, Threat};

fn alone(parameters: FlockParameters, velocity: Vec3) -> Flock {
    let mut flock = Flock::new(parameters, 1).unwrap();
    flock.push(1, Vec3::ZERO, velocity).unwrap();
    flock
}

fn toward(direction: Vec3) -> Surroundings<'static> {
    Surroundings { goal: Some(Goal::Direction(direction)), ..Surroundings::default() }
}

#[test]
fn speed_stays_within_its_limits_and_the_path_follows_the_heading() {
    let parameters =
        FlockParameters { minimum_speed: 1.0, wander_strength: 0.8, ..FlockParameters::default() };
    let region = Region::Box { center: Vec3::ZERO, half: Vec3::splat(5.0) };
    let mut flock = Flock::scattered(1..=100, region, 3, parameters).unwrap();
    let dt = 1.0 / 30.0;
    for tick in 0..300_u32 {
        let before = flock.positions().to_vec();
        let threat = Threat { position: Vec3::new(0.0, 3.0, 0.0), velocity: Vec3::X };
        let time = f64::from(tick) * f64::from(dt);
        let around = Surroundings { time, threats: &[threat], ..Surroundings::default() };
        flock.update(dt, &around).unwrap();
        for (index, before) in before.into_iter().enumerate() {
            let (velocity, heading) = (flock.velocities()[index], flock.headings()[index]);
            let speed = velocity.length();
            assert!((1.0 - 1e-4..=8.0 + 1e-4).contains(&speed), "{speed}");
            assert!((velocity / speed).distance(heading) < 1e-5);
            let step = (flock.positions()[index] - before) / dt;
            assert!(step.distance(velocity) < 2e-2, "{step} {velocity}");
            let (up, ahead) = (flock.ups()[index], flock.rotation(index) * Vec3::Z);
            assert!(up.dot(heading).abs() < 1e-4 && (up.length() - 1.0).abs() < 1e-4);
            assert!(ahead.distance(heading) < 1e-4);
            assert!((flock.rotation(index) * Vec3::Y).distance(up) < 1e-4);
        }
    }
    assert!(flock.alarms().iter().any(|&alarm| alarm > 0.0), "the threat was felt");
}

#[test]
fn a_sudden_change_of_goal_gives_a_curve_no_tighter_than_acceleration_allows() {
    let parameters = FlockParameters { goal_strength: 1.0, ..FlockParameters::default() };
    let path = |dt: f32| {
        let mut flock = alone(parameters.clone(), Vec3::Z * 4.0);
        let mut path = vec![Vec3::ZERO];
        for tick in 0..(4.0 / dt).round() as usize {
            let late = tick as f32 * dt >= 1.0;
            let before = flock.velocities()[0];
            flock.update(dt, &toward(if late { Vec3::X } else { Vec3::Z })).unwrap();
            let change = (flock.velocities()[0] - before).length() / dt;
            assert!(change <= 8.0 + 0.3 * 8.0 + 1e-2, "{change} BL/s²");
            path.push(flock.positions()[0]);
        }
        path
    };
    let (coarse, fine) = (path(1.0 / 30.0), path(1.0 / 60.0));
    let length = 16.0;
    for (index, place) in coarse.iter().enumerate() {
        let off = place.distance(fine[2 * index]);
        assert!(off < 0.01 * length, "{off} BL off at {index}");
    }
}

/// Roll in radians, positive towards the left.
fn roll(flock: &Flock) -> f32 {
    let (up, ahead) = (flock.ups()[0], flock.headings()[0]);
    math::atan2(up.dot(Vec3::Y.cross(ahead).normalize()), up.dot(ahead.cross(Vec3::Y.cross(ahead))))
}

/// A boid that a threat in the middle of nowhere does not exist for, flown in a circle by a goal
/// that always lies to its left; returns roll, speed and radius of the circle at the end.
fn circle(parameters: FlockParameters) -> (f32, f32, f32) {
    let mut flock = alone(parameters, Vec3::Z * 4.0);
    let dt = 1.0 / 240.0;
    let mut turned = 0.0;
    for tick in 0..2400 {
        let ahead = flock.headings()[0];
        flock.update(dt, &toward(Vec3::Y.cross(ahead))).unwrap();
        if tick >= 2390 {
            turned += ahead.angle_between(flock.headings()[0]) / (10.0 * dt);
        }
    }
    let speed = flock.velocities()[0].length();
    (roll(&flock), speed, speed / turned)
}

#[test]
fn a_steady_turn_banks_by_the_law_and_level_flight_does_not() {
    let parameters = FlockParameters { goal_strength: 0.5, ..FlockParameters::default() };
    let mut level = alone(parameters.clone(), Vec3::new(1.0, 0.0, 4.0));
    for _ in 0..300 {
        level.update(1.0 / 60.0, &Surroundings::default()).unwrap();
    }
    assert!(roll(&level).abs() < 1e-3, "{}", roll(&level));

    let (leans, speed, radius) = circle(parameters.clone());
    let law = math::atan2(speed * speed / radius, parameters.gravity);
    assert!(law > 0.2, "a turn worth the name: {law}");
    assert!((leans - law).abs() < 1_f32.to_radians(), "{leans} for {law}");

    let reversed = FlockParameters { bank: -1.0, ..parameters.clone() };
    assert!((circle(reversed).0 + law).abs() < 1_f32.to_radians());
    let weightless = FlockParameters { gravity: 0.0, ..parameters };
    let (leans, ..) = circle(weightless);
    assert!((leans - std::f32::consts::FRAC_PI_2).abs() < 2_f32.to_radians(), "{leans}");
}

#[test]
fn straight_up_and_standstill_have_an_orientation_too() {
    for velocity in [Vec3::Y * 4.0, -Vec3::Y * 4.0, Vec3::ZERO] {
        let parameters = FlockParameters { cruise_speed: 0.0, ..FlockParameters::default() };
        let mut flock = alone(parameters, velocity);
        for _ in 0..200 {
            flock.update(0.05, &Surroundings::default()).unwrap();
            let rotation = flock.rotation(0);
            assert!(rotation.is_finite() && rotation.is_normalized(), "{velocity}: {rotation}");
        }
    }
}

#[test]
fn the_medium_carries_everybody_along() {
    let mut flock = alone(FlockParameters::default(), Vec3::Z * 4.0);
    let flow = [Vec3::new(0.5, 0.0, 0.0)];
    for _ in 0..60 {
        flock.update(1.0 / 60.0, &Surroundings { flow: &flow, ..Surroundings::default() }).unwrap();
    }
    assert!(flock.positions()[0].distance(Vec3::new(0.5, 0.0, 4.0)) < 1e-2);
    assert!(flock.headings()[0].distance(Vec3::Z) < 1e-5);
}
