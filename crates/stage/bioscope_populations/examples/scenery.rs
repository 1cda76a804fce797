//! Builds a reef without fishes, measures it and writes pictures of it:
//! `cargo run --release -p bioscope_populations --example scenery -- FOLDER`.

use std::path::Path;
use std::time::Instant;

use bioscope_core::{Result, Vec3};
use bioscope_dynamics::{Current, CurrentParameters};
use bioscope_geometry::{Camera, Mound, Options, Rasterizer, ReefRelief, Scene};
use bioscope_populations::drifters::{Bubbles, BubblesOptions, Plankton, PlanktonOptions};
use bioscope_populations::placement::{Area, Habitat};
use bioscope_populations::plants::{Plants, PlantsOptions};
use bioscope_populations::scenery::{
    CoralKind, Corals, CoralsOptions, Ground, GroundOptions, Rocks, RocksOptions,
};
use bioscope_world::World;

fn main() {
    let folder =
        std::env::args().nth(1).unwrap_or_else(|| std::env::temp_dir().display().to_string());
    let start = Instant::now();
    let mut world = reef().expect("a reef");
    println!("built in {:.2} s", start.elapsed().as_secs_f64());
    (0..120).for_each(|_| world.tick().expect("a tick"));
    println!("whole reef: {:.3} ms per tick", quickest_tick(&mut world));
    figures().expect("figures");
    let scene = world.scene();
    let triangles: usize =
        scene.batches.iter().map(|one| one.mesh.triangles.len() * one.ids.len()).sum();
    println!("{} batches, {triangles} triangles", scene.batches.len());
    pictures(scene, Path::new(&folder));
}

/// The quickest of many ticks, milliseconds: what a tick costs when nothing else runs.
fn quickest_tick(world: &mut World) -> f64 {
    let ticks = (0..300).map(|_| {
        let start = Instant::now();
        world.tick().expect("a tick");
        start.elapsed().as_secs_f64() * 1e3
    });
    ticks.fold(f64::INFINITY, f64::min)
}

/// An empty sea with a current.
fn sea() -> Result<World> {
    let mut world = World::new(7, 1.0 / 60.0)?;
    world.environment.fill_with_water(0.0);
    let current = Current::new(Vec3::new(1.0, 0.0, 0.2), CurrentParameters::default());
    world.add_field(Box::new(current), None)?;
    Ok(world)
}

/// Populations one by one.
fn figures() -> Result<()> {
    let mut world = sea()?;
    let options = PlanktonOptions { count: 2000, ..PlanktonOptions::default() };
    world.add(Box::new(Plankton::new(options)?), None)?;
    println!("2000 plankton: {:.3} ms per tick", quickest_tick(&mut world));
    let mut world = sea()?;
    stand(&mut world, "seagrass", 70, 0.12, Habitat::default())?;
    stand(&mut world, "kelp", 30, 0.5, Habitat::default())?;
    println!("100 plants: {:.3} ms per tick", quickest_tick(&mut world));
    Ok(())
}

fn rectangle(low: [f32; 2], high: [f32; 2]) -> Area {
    Area::Rectangle { low, high }
}

fn reef() -> Result<World> {
    let mut world = sea()?;
    let mounds = vec![
        Mound { center: [-4.5, 1.5], radius: 2.0, height: 2.2 },
        Mound { center: [5.0, -1.5], radius: 1.7, height: 1.5 },
    ];
    let relief = ReefRelief { mounds, seed: 3, ..ReefRelief::default() };
    let ground = GroundOptions { relief: Some(relief), ..GroundOptions::default() };
    let start = Instant::now();
    world.add(Box::new(Ground::new(ground)?), None)?;
    println!("ground made in {:.2} s", start.elapsed().as_secs_f64());
    let area = rectangle([-9.0, -9.0], [9.0, 7.0]);
    let rocks = RocksOptions {
        count: 60,
        habitat: Habitat { area: area.clone(), patchiness: 0.6, ..Habitat::default() },
        ..RocksOptions::default()
    };
    let start = Instant::now();
    world.add(Box::new(Rocks::new(rocks)?), None)?;
    println!("rocks made in {:.2} s", start.elapsed().as_secs_f64());
    let slope = Habitat {
        area: area.clone(),
        slope: [8.0, 58.0],
        height: [-5.3, -0.9],
        patchiness: 0.5,
        patch: 2.5,
    };
    let corals = CoralsOptions {
        colonies: vec![
            (CoralKind::Brain, 60),
            (CoralKind::Lobes, 60),
            (CoralKind::Table, 30),
            (CoralKind::Bush, 90),
            (CoralKind::Tubes, 16),
            (CoralKind::Fan, 22),
            (CoralKind::Whips, 16),
        ],
        habitat: slope,
        ..CoralsOptions::default()
    };
    let start = Instant::now();
    world.add(Box::new(Corals::new(corals)?), None)?;
    println!("corals made in {:.2} s", start.elapsed().as_secs_f64());
    let meadow = |low, high| Habitat {
        area: rectangle(low, high),
        slope: [0.0, 18.0],
        height: [-7.0, -4.6],
        patchiness: 1.0,
        patch: 2.5,
    };
    stand(&mut world, "seagrass", 60, 0.12, meadow([-6.0, -3.0], [7.0, 6.0]))?;
    stand(&mut world, "kelp", 12, 0.5, meadow([-9.0, -6.0], [9.0, 3.0]))?;
    let slope = Habitat { slope: [10.0, 50.0], ..meadow([-7.0, -7.0], [7.0, 3.0]) };
    let slope = Habitat { height: [-5.2, -1.0], ..slope };
    stand(&mut world, "sea_fan", 14, 0.4, slope.clone())?;
    stand(&mut world, "staghorn", 14, 0.4, slope)?;
    world.set("environment", "turbidity", 0.5)?;
    world.add(Box::new(Plankton::new(PlanktonOptions::default())?), None)?;
    let area = Area::Points(vec![[1.0, -2.0], [-2.5, 3.0], [3.0, -5.0]]);
    let bubbles = BubblesOptions { vents: 3, area, ..BubblesOptions::default() };
    world.add(Box::new(Bubbles::new(bubbles)?), None)?;
    Ok(world)
}

/// Plants grown from one of the reef's own L-systems.
fn stand(world: &mut World, name: &str, count: usize, room: f32, habitat: Habitat) -> Result<()> {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../python/bioscope/worlds/reef/plants");
    let read = |ending: &str| {
        let path = folder.join(format!("{name}.{ending}"));
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    };
    let options = PlantsOptions {
        species: name.to_owned(),
        source: read("l"),
        palette: read("colors"),
        file_name: format!("{name}.l"),
        count,
        room,
        habitat,
        ..PlantsOptions::default()
    };
    let start = Instant::now();
    world.add(Box::new(Plants::new(options)?), None)?;
    println!("{name} grown in {:.2} s", start.elapsed().as_secs_f64());
    Ok(())
}

fn pictures(scene: &Scene, folder: &Path) {
    let views = [
        ("wide", Vec3::new(0.0, -3.9, 9.0), Vec3::new(0.0, -4.0, -3.0)),
        ("bommie", Vec3::new(-1.0, -4.2, 5.0), Vec3::new(-4.5, -4.3, 1.0)),
        ("wall", Vec3::new(2.0, -3.8, 0.0), Vec3::new(-1.0, -3.2, -7.0)),
        ("sand", Vec3::new(1.0, -4.9, 6.0), Vec3::new(3.0, -5.4, -1.0)),
        ("above", Vec3::new(0.0, -0.6, 8.0), Vec3::new(0.0, -4.0, -3.0)),
    ];
    let mut rasterizer = Rasterizer::default();
    let start = Instant::now();
    let prepared = rasterizer.prepare(scene, &Options::picture());
    println!("prepare {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    for (name, position, target) in views {
        let camera = Camera::looking_at(position, target, 0.85);
        let start = Instant::now();
        let view = prepared.look(&camera, 1280, 720);
        println!("{name}: {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
        let path = folder.join(format!("{name}.png"));
        let file = std::fs::File::create(path).expect("a writable folder");
        let (width, height) = (view.width as u32, view.height as u32);
        let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), width, height);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&view.developed(1.0)).expect("a written picture");
    }
}
