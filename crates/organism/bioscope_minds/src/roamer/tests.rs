use std::collections::BTreeMap;

use bioscope_core::{Impact, Purpose, Quat, Sighting, Value, math};

use super::*;

const MIND: Purpose = Purpose::new("mind");
const DT: f32 = 1.0 / 30.0;
const LENGTH: f32 = 0.6;
const FLOOR: f32 = -6.0;
/// A school that stays where it is.
const SCHOOL: Vec3 = Vec3::new(4.0, -3.0, 2.0);
const ROCK: (Vec3, f32) = (Vec3::new(-2.0, -3.0, 1.0), 1.2);

/// A fish with the simplest of bodies: it turns at most 1.5 rad/s towards the heading it wants.
struct Fish {
    mind: Roamer,
    position: Vec3,
    attitude: Quat,
    speed: f32,
    tick: u64,
    intention: Intention,
}

impl Fish {
    fn new() -> Self {
        Self {
            mind: Roamer::default(),
            position: Vec3::new(0.0, -3.0, -3.0),
            attitude: Quat::IDENTITY,
            speed: 0.0,
            tick: 0,
            intention: Intention::default(),
        }
    }

    fn percepts(&self) -> Percepts {
        let inward = self.attitude.inverse();
        let member = |index: u32| Sighting {
            id: 10 + index,
            species: "anchovy".into(),
            position: inward * (SCHOOL + Vec3::X * index as f32 * 0.1 - self.position),
            velocity: Vec3::ZERO,
            size: 0.1,
            ..Sighting::default()
        };
        let seen: Vec<Sighting> = (0..5).map(member).filter(|one| one.position.z > 0.0).collect();
        let altitude = Value::from(self.position.y - FLOOR);
        Percepts {
            time: self.tick as f64 * f64::from(DT),
            dt: DT,
            velocity: Vec3::Z * self.speed,
            attitude: self.attitude,
            body_length: LENGTH,
            depth: -self.position.y,
            home: inward * (Vec3::Y * -3.0 - self.position),
            seen,
            ahead: rock_ahead(inward * (ROCK.0 - self.position)),
            other: BTreeMap::from([(String::from("altitude"), altitude)]),
            ..Percepts::default()
        }
    }

    fn step(&mut self) {
        let mut random = Random::new(11, 1, self.tick, MIND);
        let percepts = self.percepts();
        self.intention = self.mind.decide(&percepts, &mut random, &mut Vec::new()).unwrap();
        let turn = Quat::from_rotation_arc(Vec3::Z, self.intention.heading.normalize());
        let share = (1.5 * DT / turn.angle_between(Quat::IDENTITY).max(1e-6)).min(1.0);
        // Keeps upright: no roll about the new heading.
        let ahead = self.attitude * Quat::IDENTITY.slerp(turn, share) * Vec3::Z;
        let left = Vec3::Y.cross(ahead).normalize();
        let axes = bioscope_core::Mat3::from_cols(left, ahead.cross(left), ahead);
        self.attitude = Quat::from_mat3(&axes);
        self.speed = math::mix(self.speed, self.intention.speed * LENGTH, DT * 2.0);
        self.position += ahead * self.speed * DT;
        self.tick += 1;
    }
}

/// Where a ray straight ahead meets the rock, with half a body length to spare.
fn rock_ahead(center: Vec3) -> Option<Impact> {
    let radius = ROCK.1 + 0.5 * LENGTH;
    let across = center.with_z(0.0);
    let depth = radius * radius - across.length_squared();
    let distance = center.z - math::sqrt(depth.max(0.0));
    let aim = center - across.normalize_or(Vec3::X) * (radius + LENGTH);
    (depth > 0.0 && distance > 0.0).then_some(Impact { distance, aim })
}

#[test]
fn ten_minutes_of_roaming_show_every_behavior_and_stay_in_bounds() {
    let mut fish = Fish::new();
    let mut seconds: BTreeMap<String, f32> = BTreeMap::new();
    for _ in 0..(600.0 / DT) as usize {
        fish.step();
        *seconds.entry(fish.intention.behavior.to_string()).or_default() += DT;
        let place = fish.position;
        assert!(place.y < -0.3 && place.y > FLOOR + 0.3, "{place} at tick {}", fish.tick);
        assert!(place.distance(Vec3::Y * -3.0) < 12.0, "{place} at tick {}", fish.tick);
        assert!(place.distance(ROCK.0) > ROCK.1, "in the rock at tick {}", fish.tick);
        assert!(fish.intention.speed.is_finite() && fish.intention.heading.is_finite());
    }
    let names: Vec<&str> = seconds.keys().map(String::as_str).collect();
    assert_eq!(names, ["avoid", "cruise", "dash", "inspect", "turn home"], "{seconds:?}");
    assert!(seconds["cruise"] > 150.0 && seconds["dash"] < 60.0, "{seconds:?}");
}

#[test]
fn a_restored_mind_goes_on_identically() {
    let mut fish = Fish::new();
    (0..900).for_each(|_| fish.step());
    let mut other = Fish {
        mind: Roamer::restore(&fish.mind.save().unwrap()).unwrap(),
        intention: fish.intention.clone(),
        ..fish
    };
    for _ in 0..900 {
        fish.step();
        other.step();
        assert_eq!(fish.intention, other.intention);
    }
    assert_eq!(fish.mind.save().unwrap(), other.mind.save().unwrap());
}

#[test]
fn damaged_states_and_bad_parameters_are_refused() {
    let bytes = Roamer::default().save().unwrap();
    assert!(Roamer::restore(&bytes[..bytes.len() - 1]).is_err());
    let mut roamer = Roamer::default();
    let parameters = roamer.parameters_mut().unwrap();
    assert!(parameters.set("cruise_speed", -1.0).is_err());
    roamer.parameters.cruise_speed = f32::NAN;
    assert!(Roamer::restore(&roamer.save().unwrap()).is_err());
}

#[test]
fn the_surface_sends_it_down_and_annotations_show_the_heading() {
    let percepts = Percepts {
        dt: DT,
        depth: 0.1,
        body_length: LENGTH,
        velocity: Vec3::Z,
        ..Percepts::default()
    };
    let mut notes = Vec::new();
    let mut random = Random::new(1, 1, 1, MIND);
    let intention = Roamer::default().decide(&percepts, &mut random, &mut notes).unwrap();
    assert_eq!(intention.behavior, "avoid");
    assert!(intention.heading.y < -0.5, "{}", intention.heading);
    assert!(notes.iter().any(|note| note.role == "heading"));
}
