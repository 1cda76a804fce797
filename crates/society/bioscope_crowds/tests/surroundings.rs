//! Obstacles, ground, surface, threats, home.

use bioscope_core::{Purpose, Random, Vec3};
use bioscope_crowds::avoid::{Course, force_field, impact};
use bioscope_crowds::statistics::flockette_count;
use bioscope_crowds::{Flock, FlockParameters, Goal, Home, Region, Surroundings, Threat};
use bioscope_geometry::{Obstacle, Terrain};

const DT: f32 = 1.0 / 30.0;

fn solids() -> [Obstacle; 4] {
    [
        Obstacle::Sphere { center: Vec3::Z * 40.0, radius: 6.0 },
        Obstacle::Cylinder {
            base: Vec3::new(0.0, -60.0, 40.0),
            top: Vec3::new(0.0, 60.0, 40.0),
            radius: 4.0,
        },
        Obstacle::Box { low: Vec3::new(-9.0, -5.0, 36.0), high: Vec3::new(4.0, 7.0, 50.0) },
        Obstacle::Plane { point: Vec3::Z * 40.0, normal: -Vec3::Z },
    ]
}

/// Loners that fly at the solid from everywhere, at full speed, and want to go on.
#[test]
fn nobody_hits_an_obstacle_at_full_speed() {
    for solid in solids() {
        let parameters = FlockParameters {
            radius: 0.5,
            cruise_speed: 8.0,
            goal_strength: 1.0,
            ..FlockParameters::default()
        };
        let mut flock = Flock::new(parameters, 1).unwrap();
        let mut random = Random::new(2, 0, 0, Purpose::new("approach"));
        for id in 1..=300 {
            let position = Vec3::new(random.range(-15.0, 15.0), random.range(-9.0, 9.0), 0.0);
            let aim = Vec3::new(random.range(-6.0, 6.0), random.range(-4.0, 4.0), 40.0);
            flock.push(id, position, (aim - position).normalize() * 8.0).unwrap();
        }
        let goal = Some(Goal::Direction(Vec3::Z));
        let obstacles = [solid];
        let mut nearest = f32::INFINITY;
        for _ in 0..300 {
            let around = Surroundings { obstacles: &obstacles, goal, ..Surroundings::default() };
            flock.update(DT, &around).unwrap();
            let distances = flock.positions().iter().map(|&place| solid.distance(place));
            nearest = distances.fold(nearest, f32::min);
        }
        println!("nearest {nearest:.2} BL to {solid:?}");
        assert!(nearest > 0.0, "somebody came as near as {nearest} BL to {solid:?}");
        // It is a course worth avoiding: without care most would have been inside.
        assert!(nearest < 3.0, "nobody came nearer than {nearest} BL to {solid:?}");
    }
}

#[test]
fn flight_alongside_a_wall_raises_no_request() {
    let walls = [
        (Obstacle::Plane { point: Vec3::ZERO, normal: Vec3::X }, Vec3::X),
        (
            Obstacle::Box { low: Vec3::new(-2.0, -50.0, -50.0), high: Vec3::new(0.0, 50.0, 50.0) },
            Vec3::X,
        ),
        (
            Obstacle::Cylinder { base: Vec3::Z * -50.0, top: Vec3::Z * 50.0, radius: 2.0 },
            Vec3::X * 3.0,
        ),
        (Obstacle::Sphere { center: -Vec3::X * 4.0, radius: 4.0 }, Vec3::X),
    ];
    for (wall, beside) in walls {
        for distance in [0.1, 0.3, 0.8, 2.0] {
            let position = beside.normalize() * (beside.length() - 1.0 + distance);
            let course =
                Course { position, heading: Vec3::Z, reach: 20.0, length: 1.0, clearance: 0.5 };
            assert_eq!(impact(&course, &wall), None, "{distance} from {wall:?}");
            let away = Course { heading: Vec3::new(0.3, 0.0, 1.0).normalize(), ..course };
            assert_eq!(impact(&away, &wall), None, "leaving, {distance} from {wall:?}");
            assert_ne!(force_field(&wall, position, 5.0), Vec3::ZERO, "a field does react");
        }
    }
}

/// Head-on at a wall: the field has no lateral part, steering to avoid has nothing else.
#[test]
fn a_force_field_stalls_where_steering_turns() {
    let wall = Obstacle::Plane { point: Vec3::Z * 10.0, normal: -Vec3::Z };
    let field = force_field(&wall, Vec3::Z * 7.0, 5.0);
    assert!(field.cross(Vec3::Z).length() < 1e-3 && field.z < -0.1, "{field}");
    let mut flock = Flock::new(FlockParameters::default(), 1).unwrap();
    flock.push(1, Vec3::ZERO, Vec3::Z * 4.0).unwrap();
    let obstacles = [wall];
    for _ in 0..150 {
        flock
            .update(DT, &Surroundings { obstacles: &obstacles, ..Surroundings::default() })
            .unwrap();
        assert!(flock.positions()[0].z < 10.0);
    }
    let velocity = flock.velocities()[0];
    assert!(velocity.z < 0.05 * velocity.length() && velocity.length() > 3.0, "{velocity}");
}

#[test]
fn a_flock_parts_round_a_pillar_and_joins_again() {
    let pillar = Obstacle::Cylinder {
        base: Vec3::new(0.0, -100.0, 60.0),
        top: Vec3::new(0.0, 100.0, 60.0),
        radius: 3.0,
    };
    let mut flock = Flock::new(FlockParameters::default(), 1).unwrap();
    let mut random = Random::new(3, 0, 0, Purpose::new("flock"));
    for id in 1..=80 {
        let position = random.in_ball() * Vec3::new(9.0, 5.0, 6.0);
        flock.push(id, position, Vec3::Z * 4.0).unwrap();
    }
    let obstacles = [pillar];
    let goal = Some(Goal::Direction(Vec3::Z));
    let mut counts = Vec::new();
    for _ in 0..(40.0 / DT) as usize {
        let around = Surroundings { obstacles: &obstacles, goal, ..Surroundings::default() };
        flock.update(DT, &around).unwrap();
        for &place in flock.positions() {
            assert!(pillar.distance(place) > 0.0, "{place} is in the pillar");
        }
        counts.push(flockette_count(flock.positions(), 5.0));
    }
    let most = counts.iter().max();
    assert!(most >= Some(&2), "parted into {most:?}");
    assert_eq!(counts.last(), Some(&1), "{:?}", &counts[counts.len() - 30..]);
    let sides = flock.positions().iter().all(|place| place.z > 66.0);
    assert!(sides, "all have passed");
}

#[test]
fn a_school_stays_in_its_water_over_a_hilly_bed() {
    let hills = |index: usize| {
        let (x, z) = ((index % 41) as f32, (index / 41) as f32);
        -6.0 + 2.0 * (0.5 * x).sin() * (0.4 * z).cos()
    };
    let terrain = Terrain::new([-20.0, -20.0], 1.0, 41, (0..41 * 41).map(hills).collect()).unwrap();
    let parameters =
        FlockParameters { body_length: 0.2, radius: 6.0, ..FlockParameters::default() };
    let region = Region::Box { center: Vec3::Y * -2.0, half: Vec3::new(3.0, 1.0, 3.0) };
    let mut flock = Flock::scattered(1..=100, region, 5, parameters).unwrap();
    let home = Some(Home { center: Vec3::Y * -2.5, radius: 6.0 });
    let mut random = Random::new(6, 0, 0, Purpose::new("threat"));
    for tick in 0..1800 {
        let threat =
            Threat { position: random.in_ball() * 4.0 + Vec3::Y * -2.0, velocity: Vec3::ZERO };
        let threats = if tick % 90 < 10 { vec![threat] } else { Vec::new() };
        let around = Surroundings {
            threats: &threats,
            terrain: Some(&terrain),
            surface: Some(0.0),
            home,
            ..Surroundings::default()
        };
        flock.update(DT, &around).unwrap();
        for &place in flock.positions() {
            let height = place.y - terrain.height(place.x, place.z);
            assert!(height >= 0.0999 && place.y <= -0.0999, "{place} at tick {tick}");
            assert!(place.distance(Vec3::Y * -2.5) < 14.0, "{place} at tick {tick}");
        }
    }
    // Steering keeps most away from the limits, so the hard stop is the exception.
    let stopped =
        |place: &&Vec3| place.y - terrain.height(place.x, place.z) < 0.11 || place.y > -0.11;
    assert!(flock.positions().iter().filter(stopped).count() < 5);
}

#[test]
fn a_predator_is_fled_from_by_those_near_and_then_by_their_neighbors() {
    let mut flock = Flock::new(FlockParameters::default(), 1).unwrap();
    for id in 1..=200 {
        let position = Vec3::new((id % 40) as f32 * 2.5, (id / 40) as f32 * 2.5, 0.0);
        flock.push(id, position, Vec3::Z * 4.0).unwrap();
    }
    let mut calm = flock.clone();
    let disturbed = |flock: &Flock, calm: &Flock| {
        let headings = flock.headings().iter().zip(calm.headings());
        let far = headings
            .zip(flock.positions())
            .filter(|((heading, calm), _)| heading.angle_between(**calm) > 0.1);
        far.map(|(_, place)| place.x).fold(0.0, f32::max)
    };
    let mut fled = false;
    let (mut reached, mut alarm, mut speed) = (Vec::new(), 0_f32, 0_f32);
    for tick in 0..60 {
        // Swims along with the flock, five body lengths beside its edge.
        let position = Vec3::new(-5.0, 5.0, 4.0 * DT * tick as f32);
        let predator = Threat { position, velocity: Vec3::Z * 4.0 };
        let around = Surroundings { threats: &[predator], ..Surroundings::default() };
        flock.update(DT, &around).unwrap();
        calm.update(DT, &Surroundings::default()).unwrap();
        fled |= (0..flock.len()).any(|index| flock.behavior(index) == "flee");
        alarm = alarm.max(flock.alarms()[39]);
        speed = speed.max(flock.velocities()[39].length());
        if tick % 20 == 5 {
            reached.push(disturbed(&flock, &calm));
        }
    }
    assert!(fled);
    assert!(flock.alarms()[20] == 0.0 && alarm > 0.9, "{alarm}");
    assert!(speed > 1.1 * 4.0, "the alarmed hurry: {speed}");
    assert!(reached[0] < reached[1] && reached[1] < reached[2], "{reached:?}");
    assert!(reached[2] > 12.0, "beyond those who feel the threat: {reached:?}");
}

#[test]
fn a_flock_leaves_for_its_goal_and_returns_home() {
    let region = Region::Box { center: Vec3::ZERO, half: Vec3::splat(4.0) };
    let mut flock = Flock::scattered(1..=60, region, 5, FlockParameters::default()).unwrap();
    let point = Vec3::new(60.0, 10.0, 0.0);
    for _ in 0..600 {
        let around = Surroundings { goal: Some(Goal::Point(point)), ..Surroundings::default() };
        flock.update(DT, &around).unwrap();
    }
    let middle = |flock: &Flock| flock.positions().iter().sum::<Vec3>() / flock.len() as f32;
    assert!(middle(&flock).distance(point) < 12.0, "{}", middle(&flock));
    let home = Some(Home { center: Vec3::ZERO, radius: 10.0 });
    for _ in 0..1500 {
        flock.update(DT, &Surroundings { home, ..Surroundings::default() }).unwrap();
    }
    assert!(flock.positions().iter().all(|place| place.length() < 30.0));
}
