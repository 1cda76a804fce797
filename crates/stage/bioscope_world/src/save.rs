use bioscope_core::{Error, Result, state};
use bioscope_geometry::{Medium, Obstacle, Rig, Sky, Terrain};
use serde::{Deserialize, Serialize};

use crate::world::Resident;
use crate::{Change, EnvironmentParameters, Recording, Registry, World};

/// First bytes of every saved world.
const MAGIC: &[u8] = b"bioscope world\n";
/// Version of the format; the current release opens all earlier ones.
const VERSION: u32 = 1;
const PART: &str = "saved world";

/// The complete simulation state: what `state_hash` covers and saved worlds hold.
#[derive(Serialize, Deserialize)]
struct State {
    seed: u64,
    dt: f64,
    tick: u64,
    epoch: (u64, f64),
    next_id: u32,
    terrain: Option<Terrain>,
    medium: Medium,
    sky: Sky,
    obstacles: Vec<Obstacle>,
    parameters: EnvironmentParameters,
    rigs: Vec<Rig>,
    shots: Vec<(String, f32)>,
    title: String,
    fields: Vec<Saved>,
    populations: Vec<Saved>,
}

#[derive(Serialize, Deserialize)]
struct Saved {
    name: String,
    kind: String,
    bytes: Vec<u8>,
}

impl World {
    /// 64 hex digits over the complete simulation state (BLAKE3).
    pub fn state_hash(&self) -> Result<String> {
        Ok(blake3::hash(&self.save_state()?).to_hex().to_string())
    }

    /// The world as the bytes of a file, with format version and checksum.
    pub fn save(&self) -> Result<Vec<u8>> {
        let body = self.save_state()?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(blake3::hash(&body).as_bytes());
        bytes.extend(body);
        Ok(bytes)
    }

    /// The world that [`save`](Self::save) stored; it continues as the original would have.
    pub fn restore(bytes: &[u8], registry: &Registry) -> Result<Self> {
        let state: State = state::from_bytes(PART, body(bytes)?)?;
        let mut world = World::new(state.seed, state.dt)?;
        for saved in &state.fields {
            let field = registry.field(&saved.kind, &saved.bytes)?;
            world.environment.fields.push((saved.name.clone(), field));
        }
        for saved in &state.populations {
            let population = registry.population(&saved.kind, &saved.bytes)?;
            world.populations.push(Resident { name: saved.name.clone(), population });
        }
        world.take(state);
        world.publish()?;
        Ok(world)
    }

    /// Goes back (or forward) to a saved state of this same world, keeping what its populations
    /// have already built; populations and fields must be those of the saved state. Populations that
    /// were added after it are gone.
    pub fn return_to(&mut self, bytes: &[u8]) -> Result<()> {
        self.restore_state(body(bytes)?)
    }

    /// Repeats a recorded run to its end; `each_tick` is called after every tick.
    pub fn replay(
        recording: &Recording,
        registry: &Registry,
        mut each_tick: impl FnMut(&World),
    ) -> Result<Self> {
        let mut world = Self::restore(&recording.start, registry)?;
        let mut inputs = recording.inputs.iter().peekable();
        loop {
            while let Some(input) = inputs.next_if(|input| input.tick <= world.tick) {
                world.apply(&input.change, registry)?;
            }
            if world.tick >= recording.end {
                return Ok(world);
            }
            world.tick()?;
            each_tick(&world);
        }
    }

    /// Makes a recorded change again.
    fn apply(&mut self, change: &Change, registry: &Registry) -> Result<()> {
        match change {
            Change::Set { owner, name, value } => self.set(owner, name, *value),
            Change::Order { population, order } => self.order(population, order),
            Change::Add { name, kind, state } => {
                let population = registry.population(kind, state)?;
                self.add(population, Some(name)).map(|_| ())
            }
        }
    }

    pub(crate) fn save_state(&self) -> Result<Vec<u8>> {
        let fields = self.environment.fields.iter().map(|(name, field)| {
            Ok(Saved { name: name.clone(), kind: field.kind().to_owned(), bytes: field.save()? })
        });
        let populations = self.populations.iter().map(|one| {
            Ok(Saved {
                name: one.name.clone(),
                kind: one.population.kind().to_owned(),
                bytes: one.population.save()?,
            })
        });
        let environment = &self.environment;
        Ok(state::to_bytes(&State {
            seed: self.seed,
            dt: self.dt,
            tick: self.tick,
            epoch: self.epoch,
            next_id: self.next_id,
            terrain: environment.terrain.as_deref().cloned(),
            medium: environment.medium,
            sky: environment.sky,
            obstacles: environment.obstacles.to_vec(),
            parameters: environment.parameters.clone(),
            rigs: self.rigs.clone(),
            shots: self.shots.clone(),
            title: self.title.clone(),
            fields: fields.collect::<Result<_>>()?,
            populations: populations.collect::<Result<_>>()?,
        }))
    }

    pub(crate) fn restore_state(&mut self, body: &[u8]) -> Result<()> {
        let state: State = state::from_bytes(PART, body)?;
        let residents = self.populations.iter().map(|one| &one.name);
        let shared = state.populations.iter().zip(residents).take_while(|(a, b)| a.name == **b);
        if shared.count() != state.populations.len() {
            return Err(Error::format(PART, "its populations are not those of this world"));
        }
        self.populations.truncate(state.populations.len());
        for (resident, saved) in self.populations.iter_mut().zip(&state.populations) {
            resident.population.restore(&saved.bytes)?;
        }
        for ((_, field), saved) in self.environment.fields.iter_mut().zip(&state.fields) {
            field.restore(&saved.bytes)?;
        }
        self.take(state);
        self.publish()?;
        Ok(())
    }

    /// Takes over everything but fields and populations.
    fn take(&mut self, state: State) {
        self.tick = state.tick;
        self.dt = state.dt;
        self.epoch = state.epoch;
        self.next_id = state.next_id;
        self.environment.terrain = state.terrain.map(Into::into);
        self.environment.medium = state.medium;
        self.environment.sky = state.sky;
        self.environment.obstacles = state.obstacles.into();
        self.environment.parameters = state.parameters;
        self.rigs = state.rigs;
        self.shots = state.shots;
        self.title = state.title;
    }
}

/// The state in a saved world after checking format, version and checksum.
fn body(bytes: &[u8]) -> Result<&[u8]> {
    let rest = bytes
        .strip_prefix(MAGIC)
        .ok_or_else(|| Error::format(PART, "not a saved world (its first bytes are others)"))?;
    let Some((version, rest)) = rest.split_first_chunk::<4>() else {
        return Err(Error::format(PART, "cut off after the first line"));
    };
    let version = u32::from_le_bytes(*version);
    if version > VERSION {
        let message = format!("format {version}; this release reads formats up to {VERSION}");
        return Err(Error::format(PART, message));
    }
    match rest.split_first_chunk::<32>() {
        Some((checksum, body)) if blake3::hash(body).as_bytes() == checksum => Ok(body),
        _ => Err(Error::format(PART, "damaged or cut off: the checksum does not match")),
    }
}
