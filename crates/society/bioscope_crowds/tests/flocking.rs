//! A flock forms, is one, and is the same every time.

use bioscope_core::{Purpose, Random, Vec3};
use bioscope_crowds::statistics::{flockette_count, nearest_neighbor_distances, polarization};
use bioscope_crowds::{Flock, FlockParameters, Region, Surroundings};

const DT: f32 = 1.0 / 30.0;

fn cube(half_side: f32) -> Region {
    Region::Box { center: Vec3::ZERO, half: Vec3::splat(half_side) }
}

fn fly(flock: &mut Flock, seconds: f32) {
    for _ in 0..(seconds / DT).round() as usize {
        flock.update(DT, &Surroundings::default()).unwrap();
    }
}

/// What became of eighty boids.
#[derive(Debug)]
struct Outcome {
    /// Polarization after five and ten seconds.
    polarization: [f32; 2],
    /// Mean distance of nearest neighbors after ten seconds, and the least after the third.
    nearest: [f32; 2],
    components: usize,
}

fn outcome(half_side: f32, seed: u64, parameters: &FlockParameters) -> Outcome {
    let mut flock = Flock::scattered(1..=80, cube(half_side), seed, parameters.clone()).unwrap();
    fly(&mut flock, 3.0);
    let mut least = f32::INFINITY;
    let mut at_five_seconds = 0.0;
    let mut mean = 0.0;
    for tick in 1..=210 {
        flock.update(DT, &Surroundings::default()).unwrap();
        let distances = nearest_neighbor_distances(flock.positions(), parameters.radius);
        least = distances.iter().copied().fold(least, f32::min);
        mean = distances.iter().sum::<f32>() / 80.0;
        if tick == 60 {
            at_five_seconds = polarization(flock.velocities());
        }
    }
    Outcome {
        polarization: [at_five_seconds, polarization(flock.velocities())],
        nearest: [mean, least],
        components: flockette_count(flock.positions(), parameters.radius),
    }
}

#[test]
fn eighty_boids_become_one_polarized_flock_that_keeps_its_distances() {
    for seed in 0..8 {
        let outcome = outcome(8.0, seed, &FlockParameters::default());
        println!("seed {seed}: {outcome:?}");
        let Outcome { polarization: [at_five, at_ten], nearest: [mean, least], components } =
            outcome;
        assert!(at_five >= 0.93 && at_ten >= 0.995, "seed {seed}: {at_five} {at_ten}");
        assert_eq!(components, 1, "seed {seed}");
        assert!((2.0..=3.0).contains(&mean), "seed {seed}: nearest neighbors at {mean} BL");
        assert!(least >= 1.5, "seed {seed}: two came within {least} BL");
    }
}

/// From a denser start and with other parameters some seeds take longer, so the middle of five
/// seeds is held against the figures. Half side, radius, cruise speed, gains.
#[test]
fn other_starts_and_parameters_lead_to_one_flock_as_well() {
    let starts = [
        (4.0, 10.0, 4.0, 4.0, 3.0),
        (8.0, 15.0, 4.0, 4.0, 3.0),
        (4.0, 10.0, 2.0, 4.0, 3.0),
        (4.0, 10.0, 4.0, 8.0, 4.0),
    ];
    for (half_side, radius, cruise_speed, matching, centering) in starts {
        let parameters = FlockParameters {
            radius,
            cruise_speed,
            matching,
            centering,
            ..FlockParameters::default()
        };
        let mut outcomes: Vec<_> =
            (0..5).map(|seed| outcome(half_side, seed, &parameters)).collect();
        outcomes.sort_by(|a, b| a.polarization[0].total_cmp(&b.polarization[0]));
        println!("{outcomes:?}");
        let Outcome { polarization: [at_five, at_ten], nearest: [mean, _], components } =
            outcomes[2];
        assert!(at_five >= 0.85 && at_ten >= 0.995, "{at_five} {at_ten} of {parameters:?}");
        assert!(components == 1 && (2.0..=3.0).contains(&mean), "{components} {mean}");
    }
}

#[test]
fn a_crowded_start_expands_at_once() {
    let mut flock = Flock::scattered(1..=80, cube(1.0), 3, FlockParameters::default()).unwrap();
    let size = |flock: &Flock| {
        let middle = flock.positions().iter().sum::<Vec3>() / 80.0;
        flock.positions().iter().map(|place| place.distance(middle)).fold(0.0, f32::max)
    };
    let before = size(&flock);
    fly(&mut flock, 2.0);
    assert!(size(&flock) > 2.0 * before, "{} after {before}", size(&flock));
    fly(&mut flock, 1.0);
    let distances = nearest_neighbor_distances(flock.positions(), 10.0);
    assert!(distances.iter().all(|&distance| distance > 1.0), "{distances:?}");
}

#[test]
fn a_flock_of_any_size_does_the_same_in_body_lengths() {
    let at_scale = |body_length: f32| {
        let parameters = FlockParameters { body_length, ..FlockParameters::default() };
        let mut flock = Flock::scattered(1..=80, cube(4.0 * body_length), 1, parameters).unwrap();
        fly(&mut flock, 2.0);
        flock.positions().iter().map(|&place| place / body_length).collect::<Vec<_>>()
    };
    for (small, large) in at_scale(0.125).into_iter().zip(at_scale(1.0)) {
        assert!(small.distance(large) < 1e-2, "{small} {large}");
    }
}

/// The sums of the model written down plainly: crowding, mean velocity against the own, middle
/// against the own place, number of neighbors.
fn plainly(flock: &Flock, index: usize, exponent: f32, radius: f32) -> (Vec3, Vec3, Vec3, u32) {
    let (places, velocities) = (flock.positions(), flock.velocities());
    let (mut crowding, mut motion, mut middle) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
    let (mut weights, mut count) = (0.0, 0);
    for other in (0..flock.len()).filter(|&other| other != index) {
        let way = places[other] - places[index];
        let distance = way.length();
        if distance < radius {
            let weight = distance.max(0.5).powf(-exponent);
            crowding -= way * (weight / distance);
            motion += (velocities[other] - velocities[index]) * weight;
            middle += way * weight;
            weights += weight;
            count += 1;
        }
    }
    (crowding, motion / weights, middle / weights, count)
}

#[test]
fn neighbors_weigh_by_the_power_of_their_distance_and_nothing_beyond_the_radius() {
    for exponent in [-1.0, 0.0, 1.0, 1.7, 2.0, 3.0] {
        let parameters = FlockParameters { exponent, radius: 3.0, ..FlockParameters::default() };
        let mut flock = Flock::scattered(1..=400, cube(6.0), 5, parameters).unwrap();
        flock.sense(&Surroundings::default());
        for index in 0..flock.len() {
            let (crowding, motion, middle, count) = plainly(&flock, index, exponent, 3.0);
            let percept = flock.percept(index).unwrap();
            assert_eq!(percept.neighbors, count);
            let close =
                |seen: Vec3, plain: Vec3| (seen - plain).length() < 1e-3 * (1.0 + plain.length());
            assert!(close(percept.crowding, crowding), "{} {crowding}", percept.crowding);
            if count > 0 {
                assert!(close(percept.motion, motion), "{} {motion}", percept.motion);
                assert!(close(percept.middle, middle), "{} {middle}", percept.middle);
            }
        }
    }
}

#[test]
fn only_the_nearest_are_heeded_where_so_many_are_asked_for() {
    let parameters = FlockParameters { maximum_neighbors: 6.0, ..FlockParameters::default() };
    let mut flock = Flock::scattered(1..=200, cube(6.0), 5, parameters).unwrap();
    flock.sense(&Surroundings::default());
    for index in 0..flock.len() {
        let mut distances: Vec<f32> = flock
            .positions()
            .iter()
            .map(|place| place.distance(flock.positions()[index]))
            .collect();
        distances.sort_by(f32::total_cmp);
        let (_, _, middle, count) =
            plainly(&flock, index, 2.0, 0.5 * (distances[6] + distances[7]));
        let percept = flock.percept(index).unwrap();
        assert_eq!((percept.neighbors, count), (6, 6));
        assert!(percept.middle.distance(middle) < 1e-3);
    }
}

#[test]
fn one_and_two_threads_give_the_same_bits_and_another_seed_gives_others() {
    let run = |threads: usize, seed: u64| {
        let parameters = FlockParameters { wander_strength: 0.3, ..FlockParameters::default() };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut flock = Flock::scattered(1..=1000, cube(20.0), seed, parameters).unwrap();
            fly(&mut flock, 3.0);
            flock.save()
        })
    };
    let once = run(1, 9);
    assert_eq!(once, run(1, 9));
    assert_eq!(once, run(2, 9));
    assert_ne!(once, run(1, 10));
}

#[test]
fn a_restored_flock_goes_on_identically_and_damaged_states_are_refused() {
    let mut flock = Flock::scattered(1..=100, cube(5.0), 2, FlockParameters::default()).unwrap();
    fly(&mut flock, 2.0);
    let bytes = flock.save();
    let mut other = Flock::restore(&bytes).unwrap();
    fly(&mut flock, 2.0);
    fly(&mut other, 2.0);
    assert_eq!(flock.save(), other.save());
    assert!(Flock::restore(&bytes[..bytes.len() / 2]).is_err());
    let mut random = Random::new(1, 1, 1, Purpose::new("damage"));
    for _ in 0..500 {
        let mut damaged = bytes.clone();
        let place = random.below(damaged.len() as u32) as usize;
        damaged[place] ^= 1 << random.below(8);
        if let Ok(mut flock) = Flock::restore(&damaged) {
            assert!(flock.update(DT, &Surroundings::default()).is_ok());
        }
    }
}

#[test]
fn members_come_and_go() {
    let mut flock = Flock::scattered(1..=50, cube(5.0), 2, FlockParameters::default()).unwrap();
    fly(&mut flock, 0.5);
    let place = flock.positions()[30];
    assert!(flock.remove(10) && !flock.remove(10));
    assert_eq!((flock.len(), flock.ids()[29], flock.positions()[29]), (49, 31, place));
    flock.push(99, Vec3::ZERO, Vec3::X).unwrap();
    assert!(flock.push(100, Vec3::NAN, Vec3::X).is_err());
    fly(&mut flock, 0.5);
    assert_eq!((flock.len(), flock.ids().last()), (50, Some(&99)));
    assert!(flock.update(f32::NAN, &Surroundings::default()).is_err());
    let flow = [Vec3::X; 3];
    let error = flock.update(DT, &Surroundings { flow: &flow, ..Surroundings::default() });
    assert!(error.unwrap_err().to_string().contains("50 members"));
    let mut nobody = Flock::new(FlockParameters::default(), 0).unwrap();
    nobody.update(DT, &Surroundings::default()).unwrap();
}

#[test]
fn a_heap_in_one_place_comes_apart_in_bounded_time() {
    let mut flock = Flock::new(FlockParameters::default(), 4).unwrap();
    for id in 1..=2000 {
        flock.push(id, Vec3::ONE, Vec3::Z * 4.0).unwrap();
    }
    for tick in 0..30 {
        let time = f64::from(tick) * f64::from(DT);
        flock.update(DT, &Surroundings { time, ..Surroundings::default() }).unwrap();
    }
    assert!(flock.positions().iter().all(|place| place.is_finite()));
    let distances = nearest_neighbor_distances(flock.positions(), 10.0);
    assert!(distances.iter().all(|&distance| distance > 0.0), "still in one place");
}

#[test]
fn individuals_differ_as_asked() {
    let parameters = FlockParameters { speed_spread: 0.2, ..FlockParameters::default() };
    let half = Vec3::new(8.0, 2.0, 4.0);
    let region = Region::Ellipsoid { center: Vec3::Y * 3.0, half };
    let flock = Flock::scattered(1..=2000, region, 8, parameters).unwrap();
    let inside = |place: &Vec3| ((*place - Vec3::Y * 3.0) / half).length() <= 1.0;
    assert!(flock.positions().iter().all(inside));
    let speeds: Vec<f32> = flock.velocities().iter().map(|velocity| velocity.length()).collect();
    let least = speeds.iter().copied().fold(f32::INFINITY, f32::min);
    let most = speeds.iter().copied().fold(0.0, f32::max);
    let mean = speeds.iter().sum::<f32>() / 2000.0;
    assert!(least >= 3.2 && most <= 4.8 && most - least > 1.5, "{least} {most}");
    assert!((mean - 4.0).abs() < 0.05, "{mean}");
    assert!(polarization(flock.velocities()) < 0.1);
}
