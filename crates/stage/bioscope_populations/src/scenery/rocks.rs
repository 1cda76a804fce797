use std::sync::Arc;

use bioscope_core::{Error, Id, Purpose, Quat, Random, Result, Vec3, math, state};
use bioscope_geometry::{Batch, Material, Mesh, Noise, Obstacle, Transform};
use bioscope_world::{Growth, Population, Publication};
use serde::{Deserialize, Serialize};

use super::forms::{icosphere, with_details, wrap_from_three_sides};
use super::seabed::crusted;
use super::textures;
use crate::names::free_name;
use crate::placement::{Habitat, Site};

const PLACE: Purpose = Purpose::new("rock place");
const LOOK: Purpose = Purpose::new("rock look");
const SHAPE: Purpose = Purpose::new("rock shape");
/// Most rocks of one population, and most different shapes.
const LARGEST_COUNT: usize = 20_000;
const MOST_SHAPES: u32 = 64;
/// Length of the picture on a rock of radius 1.
const TEXTURE_SIZE: f32 = 1.5;

/// How many rocks of what size lie where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RocksOptions {
    /// Their species in the scene.
    pub species: String,
    /// How many.
    pub count: usize,
    /// Where.
    pub habitat: Habitat,
    /// Least and greatest radius, metres; small ones are many.
    pub radius: [f32; 2],
    /// How much wider than high they are, about 1 (boulders) to 4 (slabs and ledges).
    pub flatness: f32,
    /// Different shapes that they share.
    pub shapes: u32,
    /// Linear color by which they are tinted.
    pub color: [f32; 3],
}

impl Default for RocksOptions {
    fn default() -> Self {
        Self {
            species: String::from("rock"),
            count: 36,
            habitat: Habitat { patchiness: 0.7, ..Habitat::default() },
            radius: [0.12, 0.8],
            flatness: 1.35,
            shapes: 6,
            color: [1.0; 3],
        }
    }
}

/// Boulders and ledges: solid, overgrown with crusts; each is an obstacle.
pub struct Rocks {
    state: State,
    assets: Assets,
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    options: RocksOptions,
    seed: u64,
    rocks: Vec<Rock>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
struct Rock {
    id: Id,
    shape: u32,
    place: Transform,
    tint: [f32; 3],
}

#[derive(Default)]
struct Assets {
    shapes: Vec<Arc<Mesh>>,
    material: Arc<Material>,
}

impl Rocks {
    /// Rocks of these options.
    pub fn new(options: RocksOptions) -> Result<Self> {
        check(&options)?;
        let state = State { options, seed: 0, rocks: Vec::new() };
        Ok(Self { state, assets: Assets::default() })
    }

    /// Rocks in a state that `save` gave.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state = read(bytes)?;
        let assets = Assets::build(&state);
        Ok(Self { state, assets })
    }
}

impl Assets {
    fn build(state: &State) -> Self {
        let shape = |number| {
            let seed = Random::new(state.seed, number + 1, 0, SHAPE).bits();
            stone(seed, state.options.flatness)
        };
        let material = Material {
            name: state.options.species.clone(),
            color: state.options.color,
            texture: Some(textures::rock()),
            roughness: 0.9,
            ..Material::default()
        };
        let shapes = (0..state.options.shapes).map(shape).collect();
        Self { shapes, material: Arc::new(material) }
    }
}

/// A weathered stone about 1 in radius: a ball worn to facets, then pitted.
fn stone(seed: u32, flatness: f32) -> Arc<Mesh> {
    let mut random = Random::new(u64::from(seed), 1, 1, SHAPE);
    let facets: Vec<(Vec3, f32)> =
        (0..9).map(|_| (random.direction(), random.range(0.55, 0.95))).collect();
    let stretch = Vec3::new(random.range(0.85, 1.25), 1.0 / flatness, random.range(0.8, 1.15));
    let noise = Noise::new(seed);
    let surface = move |direction: Vec3| {
        let lump = 1.0 + 0.42 * noise.fractal(direction * 1.3, 2);
        let mut point = direction * lump;
        for &(normal, distance) in &facets {
            point -= normal * (0.86 * (point.dot(normal) - distance).max(0.0));
        }
        let crag = 0.16 * (noise.ridged(point * 1.7 + 9.0, 4) - 0.5);
        let pit = 0.10 * (noise.cell(point * 2.6).nearest - 0.45).min(0.0);
        (point + direction * (crag + pit)) * stretch
    };
    with_details(3, |detail| {
        let mut mesh = icosphere(4 - detail);
        mesh.positions.iter_mut().for_each(|point| *point = surface(*point));
        mesh.compute_normals();
        mesh.colors = stone_colors(&mesh, noise);
        wrap_from_three_sides(&mesh, TEXTURE_SIZE)
    })
}

/// Turf above, crusts on the flanks, dark hollows and feet.
fn stone_colors(mesh: &Mesh, noise: Noise) -> Vec<[f32; 3]> {
    let color = |(&point, &normal): (&Vec3, &Vec3)| {
        let field = |seed: u32, scale: f32| {
            let value = noise.fractal(point * scale + seed as f32, 3);
            if seed == 111 { value + 0.35 * normal.y - 0.1 } else { value }
        };
        let foot = 0.45 + 0.55 * math::smoothstep(-0.6, 0.25, point.y);
        let hollow = 0.72 + 0.42 * noise.ridged(point * 1.7 + 9.0, 4);
        crusted(foot * hollow, &field, [1.0; 3])
    };
    mesh.positions.iter().zip(&mesh.normals).map(color).collect()
}

fn check(options: &RocksOptions) -> Result<()> {
    options.habitat.check()?;
    if options.count > LARGEST_COUNT {
        return Err(Error::value("count", options.count, format!("up to {LARGEST_COUNT}")));
    }
    if !(1..=MOST_SHAPES).contains(&options.shapes) {
        return Err(Error::value("shapes", options.shapes, format!("1 to {MOST_SHAPES}")));
    }
    let [small, large] = options.radius;
    if !(small > 0.0 && small <= large && large <= 1e4) {
        let found = format!("[{small}, {large}]");
        return Err(Error::value("radius", found, "least and greatest radius in metres"));
    }
    if !(0.1..=20.0).contains(&options.flatness) {
        return Err(Error::value("flatness", options.flatness, "0.1 to 20"));
    }
    Ok(())
}

fn read(bytes: &[u8]) -> Result<State> {
    let state: State = state::from_bytes("rocks", bytes)?;
    check(&state.options)?;
    if state.rocks.iter().any(|one| one.shape >= state.options.shapes) {
        return Err(Error::format("rocks", "a rock of a shape that there is not"));
    }
    Ok(state)
}

impl Rock {
    fn lay(id: Id, site: Site, radius: f32, options: &RocksOptions, seed: u64) -> Self {
        let mut random = Random::new(seed, id, 0, LOOK);
        let tilt = Quat::from_rotation_arc(Vec3::Y, Vec3::Y.lerp(site.normal, 0.6).normalize());
        let turn = Quat::from_rotation_y(random.range(0.0, math::TAU));
        let lean = Quat::from_rotation_x(random.range(-0.25, 0.25));
        let sunk = site.position - Vec3::Y * (radius / options.flatness * random.range(0.1, 0.45));
        let bright = random.range(0.72, 1.08);
        let tint = [0, 1, 2].map(|_| bright * random.range(0.93, 1.07));
        let shape = random.below(options.shapes);
        Self { id, shape, place: Transform::new(sunk, tilt * turn * lean, radius), tint }
    }

    /// The ball that moving things steer round.
    fn obstacle(&self, flatness: f32) -> Obstacle {
        let radius = self.place.scale * (0.55 + 0.45 / flatness.max(1.0));
        let center =
            self.place.position - Vec3::Y * (radius - self.place.scale / flatness).max(0.0);
        Obstacle::Sphere { center, radius }
    }
}

impl Population for Rocks {
    fn kind(&self) -> &str {
        "rocks"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        let seed = growth.moment.seed;
        self.state.seed = seed;
        let options = &self.state.options;
        let ids = growth.identities(options.count)?;
        let [small, large] = options.radius;
        let radius = |&id: &Id| {
            let share = growth.moment.random(id, SHAPE).uniform();
            small * math::pow(large / small, share * share)
        };
        let radii: Vec<f32> = ids.iter().map(radius).collect();
        let sites = options.habitat.sites(&ids, &radii, growth, PLACE);
        let lay =
            |((id, site), radius): ((Id, Site), f32)| Rock::lay(id, site, radius, options, seed);
        let rocks: Vec<Rock> = ids.into_iter().zip(sites).zip(radii).map(lay).collect();
        let obstacles = rocks.iter().map(|one| one.obstacle(options.flatness));
        growth.environment.obstacles.edit().extend(obstacles);
        self.state.rocks = rocks;
        self.assets = Assets::build(&self.state);
        Ok(())
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        let species: Arc<str> = Arc::from(self.state.options.species.as_str());
        for (number, mesh) in self.assets.shapes.iter().enumerate() {
            let name = free_name(&publication.scene, &format!("{species}/{number}"));
            let material = self.assets.material.clone();
            let mut batch = Batch::new(name, species.clone(), mesh.clone(), material);
            for rock in self.state.rocks.iter().filter(|one| one.shape as usize == number) {
                batch.ids.push(rock.id);
                batch.transforms.push(rock.place);
                batch.tints.push(rock.tint);
            }
            publication.scene.batches.push(batch);
        }
        Ok(())
    }

    fn count(&self) -> usize {
        self.state.rocks.len()
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(&self.state))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        let state = read(bytes)?;
        if (&state.options, state.seed) != (&self.state.options, self.state.seed) {
            self.assets = Assets::build(&state);
        }
        self.state = state;
        Ok(())
    }

    fn default_name(&self) -> String {
        self.state.options.species.clone()
    }
}
