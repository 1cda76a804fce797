//! Any L-system file that can be read: derived, shown and meshed within bounds.

#![no_main]

use bioscope_lsystem::{LSystem, Limits, MeshOptions, SkeletonOptions, Turtle, TurtleOptions};
use libfuzzer_sys::fuzz_target;

const LIMITS: Limits = Limits { modules: 20_000, bytes: 1 << 20, operations: 1_000_000 };

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    // The first byte decides about the notation, and whether there is a seed.
    let first = bytes.first().copied().unwrap_or(0);
    let name = if first % 2 == 0 { "fuzz.l" } else { "fuzz.lsys" };
    let seed = (first % 4 < 2).then_some(1_u64);
    let Ok(system) = LSystem::parse(&text, name) else { return };
    let Ok(string) = system.derive_within(8, seed, &LIMITS) else { return };
    let Ok(string) = system.appearance(&string, seed) else { return };
    assert!(string.to_string().len() >= string.len());
    let Ok(drawn) = Turtle::interpret(&string, &TurtleOptions::default()) else { return };
    let shape = drawn.shape(&MeshOptions::default(), &SkeletonOptions::default());
    let mesh = shape.map(|shape| shape.mesh).unwrap_or_default();
    assert!(mesh.positions.iter().all(|position| position.is_finite()));
});
