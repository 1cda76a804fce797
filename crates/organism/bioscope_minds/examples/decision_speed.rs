//! Time per decision of each mind in a school with food, mates and a predator in view: one JSON line each.

use std::hint::black_box;
use std::time::Instant;

use bioscope_core::{Percepts, Purpose, Quat, Random, Sighting, Vec3};
use bioscope_minds::{BehaviorNetwork, FreeFlow, Habits, Intentions, Mind, Nature, Role, Temper};

const DECISIONS: u64 = 20_000;

fn sighting(id: u32, species: &str, random: &mut Random) -> Sighting {
    let (position, heading) = (random.in_ball(), random.direction());
    let velocity = heading * 0.1;
    Sighting {
        id,
        species: species.into(),
        position,
        velocity,
        heading,
        size: 0.1,
        ..Sighting::default()
    }
}

fn percepts(tick: u64) -> Percepts {
    let mut random = Random::new(1, 1, tick, Purpose::new("scene"));
    let mut seen: Vec<Sighting> = (2..24).map(|id| sighting(id, "fish", &mut random)).collect();
    seen.push(sighting(30, "shark", &mut random));
    let smelled = (40..48).map(|id| sighting(id, "plankton", &mut random)).collect();
    Percepts {
        id: 1,
        time: tick as f64 / 30.0,
        dt: 1.0 / 30.0,
        velocity: Vec3::Z * 0.1,
        attitude: Quat::IDENTITY,
        body_length: 0.1,
        depth: 3.0,
        seen,
        smelled,
        solids: vec![Vec3::X * 0.3; 4],
        ..Percepts::default()
    }
}

fn main() {
    let nature = Nature {
        role: Role::Generic,
        habits: Habits { school: true, ..Habits::default() },
        species: "fish".into(),
        enemies: vec!["shark".into()],
        food: vec!["plankton".into()],
        ..Nature::default()
    };
    let scenes: Vec<Percepts> = (0..64).map(percepts).collect();
    let minds: [Box<dyn Mind>; 3] = [
        Box::new(Intentions::new(nature.clone(), Temper::default())),
        Box::new(BehaviorNetwork::new(nature.clone(), Temper::default())),
        Box::new(FreeFlow::new(nature, Temper::default())),
    ];
    for mut mind in minds {
        let (start, mut notes) = (Instant::now(), Vec::new());
        for tick in 0..DECISIONS {
            notes.clear();
            let mut random = Random::new(1, 1, tick, Purpose::new("mind"));
            let scene = &scenes[(tick % 64) as usize];
            black_box(mind.decide(scene, &mut random, &mut notes).expect("a decision"));
        }
        let time = start.elapsed().as_secs_f64() * 1e6 / DECISIONS as f64;
        println!("{{\"name\": \"mind.{}\", \"value\": {time:.2}, \"unit\": \"us\"}}", mind.name());
    }
}
