use std::sync::Arc;

use bioscope_core::{Error, Id, Result, state};
use bioscope_geometry::{Batch, Material, Mesh, ReefRelief, Terrain, Transform};
use bioscope_world::{Growth, Population, Publication};
use serde::{Deserialize, Serialize};

use super::seabed;
use super::textures;
use crate::names::free_name;

/// What the ground is made of, and how it looks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GroundOptions {
    /// Its species in the scene: `{species}_sand` and `{species}_rock`.
    pub species: String,
    /// The ground to make and to give to the world; none takes the terrain that the world has.
    pub relief: Option<ReefRelief>,
    /// Steepness in degrees from which sand gives way to rock.
    pub rock_slope: f32,
    /// Height in metres above which there is rock even where it is level.
    pub rock_height: f32,
    /// Linear color of the sand.
    pub sand_color: [f32; 3],
    /// Linear color by which rock is tinted.
    pub rock_color: [f32; 3],
    /// Length of the sand's picture on the ground, metres.
    pub texture_size: f32,
}

impl Default for GroundOptions {
    fn default() -> Self {
        Self {
            species: String::from("seabed"),
            relief: Some(ReefRelief::default()),
            rock_slope: 27.0,
            rock_height: -4.3,
            sand_color: [0.80, 0.72, 0.56],
            rock_color: [1.0, 1.0, 1.0],
            texture_size: 2.4,
        }
    }
}

/// The terrain as it looks: sand where it is level, rock where it is steep or high.
///
/// Sand and rock are two surfaces that pass through each other, so that their border is as
/// irregular as the rock itself. Both are cut into tiles with coarser versions for the distance.
pub struct Ground {
    state: State,
    assets: Assets,
}

#[derive(Clone, Default, Serialize, Deserialize)]
struct State {
    options: GroundOptions,
    /// The world's terrain where it was not made from a relief.
    terrain: Option<Terrain>,
    ids: Vec<Id>,
}

#[derive(Default)]
struct Assets {
    tiles: Vec<Tile>,
}

/// One square of sand or rock.
struct Tile {
    species: Arc<str>,
    mesh: Arc<Mesh>,
    material: Arc<Material>,
}

impl Ground {
    /// Ground of these options.
    pub fn new(options: GroundOptions) -> Result<Self> {
        check(&options)?;
        let state = State { options, ..State::default() };
        Ok(Self { state, assets: Assets::default() })
    }

    /// Ground in a state that `save` gave.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state = read(bytes)?;
        let terrain = state.terrain()?;
        let assets = terrain.map(|terrain| Assets::build(&state.options, &terrain));
        Ok(Self { state, assets: assets.unwrap_or_default() })
    }
}

impl State {
    /// The ground; none before the population has settled in a world with terrain.
    fn terrain(&self) -> Result<Option<Arc<Terrain>>> {
        match &self.options.relief {
            Some(relief) => Ok(Some(Arc::new(relief.terrain()?))),
            None => Ok(self.terrain.clone().map(Arc::new)),
        }
    }
}

impl Assets {
    fn build(options: &GroundOptions, terrain: &Terrain) -> Self {
        let surfaces = seabed::Seabed::new(terrain, options).tiles();
        let material = |name: &str, texture, roughness| {
            let name = format!("{}_{name}", options.species);
            let texture = Some(texture);
            let color = [1.0; 3];
            Arc::new(Material { name, color, texture, roughness, ..Material::default() })
        };
        let sand = material("sand", textures::sand(), 0.95);
        let rock = material("rock", textures::rock(), 0.9);
        let sand_name: Arc<str> = sand.name.as_str().into();
        let rock_name: Arc<str> = rock.name.as_str().into();
        let tiles = surfaces.into_iter().map(|surface| {
            let (species, material) = if surface.rock {
                (rock_name.clone(), rock.clone())
            } else {
                (sand_name.clone(), sand.clone())
            };
            Tile { species, mesh: surface.mesh, material }
        });
        Self { tiles: tiles.collect() }
    }
}

fn check(options: &GroundOptions) -> Result<()> {
    let lengths = [("texture_size", options.texture_size), ("rock_slope", options.rock_slope)];
    for (name, value) in lengths {
        if !(value.is_finite() && value > 0.0) {
            return Err(Error::value(name, value, "a positive number"));
        }
    }
    if options.rock_height.is_nan() {
        return Err(Error::value("rock_height", "NaN", "a height in metres"));
    }
    Ok(())
}

/// A state that was saved, checked.
fn read(bytes: &[u8]) -> Result<State> {
    let mut state: State = state::from_bytes("ground", bytes)?;
    check(&state.options)?;
    if let Some(terrain) = state.terrain.take() {
        let Terrain { origin, spacing, columns, heights, .. } = terrain;
        state.terrain = Some(Terrain::new(origin, spacing, columns, heights)?);
    }
    Ok(state)
}

impl Population for Ground {
    fn kind(&self) -> &str {
        "ground"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        if self.state.options.relief.is_none() {
            self.state.terrain = growth.environment.terrain.as_deref().cloned();
        }
        let Some(terrain) = self.state.terrain()? else {
            let expected = "a relief, or a world that has a terrain";
            return Err(Error::value("relief", "none", expected));
        };
        self.assets = Assets::build(&self.state.options, &terrain);
        growth.environment.terrain = Some(terrain);
        self.state.ids = growth.identities(self.assets.tiles.len())?;
        Ok(())
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        for (number, (tile, &id)) in self.assets.tiles.iter().zip(&self.state.ids).enumerate() {
            let name = free_name(&publication.scene, &format!("{}/{number}", tile.species));
            let (mesh, material) = (tile.mesh.clone(), tile.material.clone());
            let mut batch = Batch::new(name, tile.species.clone(), mesh, material);
            batch.ids.push(id);
            batch.transforms.push(Transform::IDENTITY);
            publication.scene.batches.push(batch);
        }
        Ok(())
    }

    fn count(&self) -> usize {
        1
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(&self.state))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        let state = read(bytes)?;
        if (&state.options, &state.terrain) == (&self.state.options, &self.state.terrain) {
            self.state = state;
        } else {
            *self = Self::from_saved(bytes)?;
        }
        Ok(())
    }
}
