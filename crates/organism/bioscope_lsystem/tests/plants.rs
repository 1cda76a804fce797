//! The plants of the ready-made reef keep their sizes and budgets, and no two are alike.

use std::{ops::RangeInclusive, path::Path};

use bioscope_lsystem::{
    LSystem, MeshOptions, Palette, PlantShape, SkeletonOptions, Turtle, TurtleOptions,
};

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../python/bioscope/worlds/reef/plants")
}

fn grow(name: &str, seed: u64) -> PlantShape {
    let system = LSystem::read(folder().join(format!("{name}.l"))).unwrap();
    assert_eq!(system.warnings(), []);
    let string = system.derive(u64::from(system.derivation_length()), seed).unwrap();
    let colors = std::fs::read_to_string(folder().join(format!("{name}.colors"))).unwrap();
    let sides = system.constant("SIDES").unwrap() as u32;
    let mesh = MeshOptions { sides, palette: Palette::parse(&colors, name).unwrap() };
    let drawn = Turtle::interpret(&string, &TurtleOptions::default()).unwrap();
    drawn.shape(&mesh, &SkeletonOptions::default()).unwrap()
}

fn check(name: &str, heights: RangeInclusive<f32>, triangles: usize) {
    let mut volumes = Vec::new();
    for seed in 0..40 {
        let plant = grow(name, seed);
        assert!(heights.contains(&plant.height), "{name} {seed}: {} m high", plant.height);
        let count = plant.mesh.triangles.len();
        assert!((triangles / 4..=triangles).contains(&count), "{name} {seed}: {count} triangles");
        let joints = plant.mesh.skin.unwrap().joints.len();
        assert!((6..=24).contains(&joints), "{name} {seed}: {joints} joints");
        volumes.push(plant.mesh.positions.iter().map(|place| place.length()).sum::<f32>());
    }
    volumes.sort_by(f32::total_cmp);
    assert!(volumes.windows(2).all(|pair| pair[0] != pair[1]), "{name}: twins");
}

#[test]
fn kelp() {
    check("kelp", 2.0..=4.0, 4000);
}

#[test]
fn seagrass() {
    check("seagrass", 0.3..=0.7, 800);
}

#[test]
fn sea_fan() {
    check("sea_fan", 0.5..=1.0, 4000);
}

#[test]
fn staghorn() {
    check("staghorn", 0.4..=0.8, 4000);
}

#[test]
fn tube_sponge() {
    check("tube_sponge", 0.3..=0.8, 4000);
}

#[test]
fn red_alga() {
    check("red_alga", 0.2..=0.6, 4000);
}

#[test]
fn table_coral() {
    check("table_coral", 0.2..=0.6, 4000);
}
