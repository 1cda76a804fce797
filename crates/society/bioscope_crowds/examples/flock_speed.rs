//! Prints how many members of a flock are updated per second, for flocks of several sizes at the
//! same density (about twelve neighbors each), and where the time goes.
//!
//! `cargo run --release -p bioscope_crowds --example flock_speed`

use std::time::{Duration, Instant};

use bioscope_core::{Purpose, Random, Result, Vec3};
use bioscope_crowds::{Flock, FlockParameters, Home, Region, Surroundings};
use bioscope_geometry::Obstacle;

const NEIGHBORS: f32 = 12.5;
const DT: f32 = 1.0 / 60.0;
/// Updates timed after each random start; in half a second the density hardly changes.
const TICKS: usize = 30;

fn main() -> Result<()> {
    println!("threads {}", rayon::current_num_threads());
    for count in [1_000, 10_000, 100_000] {
        measure(count)?;
    }
    among_obstacles()
}

/// What steering round a hundred rocks costs a school of three hundred.
fn among_obstacles() -> Result<()> {
    let parameters = FlockParameters { body_length: 0.1, ..FlockParameters::default() };
    let region = Region::Box { center: Vec3::ZERO, half: Vec3::new(3.0, 1.0, 3.0) };
    let mut random = Random::new(1, 0, 0, Purpose::new("rocks"));
    let mut rock = || {
        let center = random.in_ball() * Vec3::new(8.0, 3.0, 8.0);
        Obstacle::Sphere { center, radius: random.range(0.1, 0.6) }
    };
    let rocks: Vec<Obstacle> = (0..100).map(|_| rock()).collect();
    for obstacles in [&rocks[..0], &rocks] {
        let mut flock = Flock::scattered(1..=300, region, 3, parameters.clone())?;
        let home = Some(Home { center: Vec3::ZERO, radius: 4.0 });
        let surroundings = Surroundings { obstacles, home, ..Surroundings::default() };
        let mut best = Duration::MAX;
        for _ in 0..600 {
            let start = Instant::now();
            flock.update(DT, &surroundings)?;
            best = best.min(start.elapsed());
        }
        println!("300 members, {:3} obstacles: {best:?} per tick at best", obstacles.len());
    }
    Ok(())
}

fn measure(count: usize) -> Result<()> {
    let parameters = FlockParameters::default();
    let volume = 4.19 * parameters.radius_metres().powi(3);
    let region = Region::of_density(count, NEIGHBORS / volume);
    let surroundings = Surroundings::default();
    let mut spent = [Duration::ZERO; 3];
    let (mut best, mut met) = (Duration::MAX, 0.0);
    let rounds = (200_000 / count).max(2);
    for round in 0..rounds {
        let mut flock =
            Flock::scattered(1..=count as u32, region, round as u64, parameters.clone())?;
        flock.update(DT, &surroundings)?;
        for _ in 0..TICKS {
            let start = Instant::now();
            flock.sense(&surroundings);
            let sensed = start.elapsed();
            flock.decide(&surroundings);
            let decided = start.elapsed();
            flock.advance(DT, &surroundings)?;
            let total = start.elapsed();
            for (sum, part) in spent.iter_mut().zip([sensed, decided - sensed, total - decided]) {
                *sum += part;
            }
            best = best.min(total);
        }
        met += mean_neighbors(&flock) / rounds as f64;
    }
    let updates = (count * rounds * TICKS) as f64;
    let [sense, decide, advance] = spent.map(|time| time.as_secs_f64() * 1e9 / updates);
    let total = sense + decide + advance;
    println!(
        "{count:>7} members, {met:4.1} neighbors: {:5.2} million updates/s (best tick {:5.2}); \
         {total:4.0} ns each: sense {sense:4.0}, decide {decide:3.0}, advance {advance:3.0}",
        1e3 / total,
        count as f64 / best.as_secs_f64() * 1e-6,
    );
    Ok(())
}

fn mean_neighbors(flock: &Flock) -> f64 {
    let percepts = (0..flock.len()).filter_map(|index| flock.percept(index));
    percepts.map(|percept| f64::from(percept.neighbors)).sum::<f64>() / flock.len() as f64
}
