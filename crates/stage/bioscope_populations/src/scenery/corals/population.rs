use std::borrow::Cow;
use std::sync::Arc;

use bioscope_core::{
    Error, Id, Purpose, Quat, Random, Result, SoundEvent, Vec3, math, parameters, state,
};
use bioscope_geometry::{Batch, Material, Mesh, Obstacle, Transform};
use bioscope_world::{Environment, Growth, Inspection, Moment, Population, Publication};
use serde::{Deserialize, Serialize};

use super::kinds::CoralKind;
use crate::kept::parameters_in;
use crate::names::free_name;
use crate::placement::{Habitat, Site};

const PLACE: Purpose = Purpose::new("coral place");
const LOOK: Purpose = Purpose::new("coral look");
const SHAPE: Purpose = Purpose::new("coral shape");
const CRACKLE: Purpose = Purpose::new("coral crackle");
/// Most colonies of one population, and most shapes of one kind.
const LARGEST_COUNT: usize = 20_000;
const MOST_VARIANTS: u32 = 32;
/// Most crackles in one tick.
const MOST_CRACKLES: usize = 16;

parameters! {
    /// What can be heard of the reef.
    pub struct CoralParameters {
        /// Snaps of snapping shrimps per second in all colonies together.
        crackle: f32 = 1.2, "1/s", 0.0..=200.0, "choice; a living reef crackles without pause";
    }
}

/// Which corals grow where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct CoralsOptions {
    /// How many colonies of each kind.
    pub colonies: Vec<(CoralKind, usize)>,
    /// Where.
    pub habitat: Habitat,
    /// Least and greatest size, relative to the usual one of the kind.
    pub size: [f32; 2],
    /// Different shapes of each kind.
    pub variants: u32,
    /// Sound.
    pub parameters: CoralParameters,
}

impl Default for CoralsOptions {
    fn default() -> Self {
        use CoralKind::{Brain, Bush, Fan, Lobes, Table, Tubes, Whips};
        Self {
            colonies: vec![
                (Brain, 12),
                (Lobes, 9),
                (Table, 8),
                (Bush, 14),
                (Tubes, 7),
                (Fan, 9),
                (Whips, 7),
            ],
            habitat: Habitat { patchiness: 0.6, height: [-7.3, 1e6], ..Habitat::default() },
            size: [0.6, 1.5],
            variants: 3,
            parameters: CoralParameters::default(),
        }
    }
}

/// Colonies of corals, sponges and fans.
pub struct Corals {
    state: State,
    assets: Vec<Kind>,
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    options: CoralsOptions,
    seed: u64,
    colonies: Vec<Colony>,
    /// What crackled in this tick.
    sounds: Vec<SoundEvent>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
struct Colony {
    id: Id,
    kind: CoralKind,
    variant: u32,
    place: Transform,
    tint: [f32; 3],
}

/// Shapes and material of one kind.
struct Kind {
    kind: CoralKind,
    species: Arc<str>,
    variants: Vec<Arc<Mesh>>,
    material: Arc<Material>,
}

impl Corals {
    /// Corals of these options.
    pub fn new(options: CoralsOptions) -> Result<Self> {
        check(&options)?;
        let state = State { options, seed: 0, colonies: Vec::new(), sounds: Vec::new() };
        Ok(Self { state, assets: Vec::new() })
    }

    /// Corals in a state that `save` gave.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state = read(bytes)?;
        let assets = build(&state);
        Ok(Self { state, assets })
    }

    /// The snaps of this tick: at random times, from random colonies.
    fn crackle(&mut self, moment: Moment) {
        let State { options, colonies, sounds, .. } = &mut self.state;
        sounds.clear();
        if colonies.is_empty() {
            return;
        }
        let mut random = moment.random(0, CRACKLE);
        // Waiting times between independent snaps are exponential.
        let rate = options.parameters.crackle;
        let mut wait = 0.0;
        while sounds.len() < MOST_CRACKLES {
            wait -= math::ln(1.0 - random.uniform()) / rate.max(1e-9);
            if wait >= moment.dt {
                return;
            }
            let colony = &colonies[random.below(colonies.len() as u32) as usize];
            sounds.push(SoundEvent {
                source: colony.id,
                kind: Cow::Borrowed("crackle"),
                time: moment.time - f64::from(moment.dt - wait),
                duration: 0.006,
                position: colony.place.position,
                velocity: Vec3::ZERO,
                amplitude: 0.04 + 0.16 * math::pow(random.uniform(), 3.0),
                // The snap of Alpheus is broad, strongest between 2 and 5 kHz (Au and Banks 1998).
                pitch: random.range(2000.0, 5000.0),
            });
        }
    }
}

/// Shapes and materials of all kinds that occur.
fn build(state: &State) -> Vec<Kind> {
    let mut kinds: Vec<CoralKind> = state.options.colonies.iter().map(|&(kind, _)| kind).collect();
    kinds.sort();
    kinds.dedup();
    let assets = kinds.into_iter().map(|kind| {
        let variants = (0..state.options.variants).map(|variant| {
            let number = kind as u32 * MOST_VARIANTS + variant + 1;
            kind.shape(Random::new(state.seed, number, 0, SHAPE).bits())
        });
        Kind {
            kind,
            species: kind.name().into(),
            variants: variants.collect(),
            material: kind.material(),
        }
    });
    assets.collect()
}

fn check(options: &CoralsOptions) -> Result<()> {
    options.habitat.check()?;
    let count = options.colonies.iter().fold(0, |sum: usize, one| sum.saturating_add(one.1));
    if count > LARGEST_COUNT || options.colonies.len() > LARGEST_COUNT {
        return Err(Error::value("colonies", count, format!("up to {LARGEST_COUNT}")));
    }
    if !(1..=MOST_VARIANTS).contains(&options.variants) {
        return Err(Error::value("variants", options.variants, format!("1 to {MOST_VARIANTS}")));
    }
    let [small, large] = options.size;
    if !(small > 0.0 && small <= large && large <= 1e3) {
        let found = format!("[{small}, {large}]");
        return Err(Error::value("size", found, "least and greatest relative size"));
    }
    Ok(())
}

fn read(bytes: &[u8]) -> Result<State> {
    let state: State = state::from_bytes("corals", bytes)?;
    check(&state.options)?;
    if state.colonies.iter().any(|one| one.variant >= state.options.variants) {
        return Err(Error::format("corals", "a colony of a shape that there is not"));
    }
    Ok(state)
}

impl Colony {
    fn settle(
        id: Id,
        kind: CoralKind,
        site: Site,
        options: &CoralsOptions,
        growth: &Growth,
    ) -> Self {
        let mut random = growth.moment.random(id, LOOK);
        let [small, large] = options.size;
        let share = random.uniform();
        let size = kind.size() * math::mix(small, large, share * share);
        let up = Vec3::Y.lerp(site.normal, kind.leaning()).normalize();
        let free = random.range(0.0, math::TAU);
        let yaw = if kind == CoralKind::Fan {
            let across = current_yaw(growth.environment, site.position).unwrap_or(free);
            across + 0.35 * random.normal().clamp(-2.0, 2.0)
        } else {
            free
        };
        let rotation = Quat::from_rotation_arc(Vec3::Y, up) * Quat::from_rotation_y(yaw);
        let palette = kind.palette();
        let color = palette[random.below(palette.len() as u32) as usize];
        let bright = random.range(0.78, 1.12);
        let tint = color.map(|one| one * bright * random.range(0.9, 1.1));
        let variant = random.below(options.variants);
        // On a slope it reaches deeper, so that its lower side does not hang free.
        let depth = (0.03 + 0.3 * kind.sinking() * (1.0 - site.normal.y)) * size;
        let position = site.position - Vec3::Y * depth;
        Self { id, kind, variant, place: Transform::new(position, rotation, size), tint }
    }

    fn obstacle(&self) -> Option<Obstacle> {
        let (radius, height) = self.kind.solid()?;
        let Transform { position, scale, .. } = self.place;
        let up = self.place.rotation() * Vec3::Y;
        let top = position + up * (height * scale);
        Some(Obstacle::Cylinder { base: position, top, radius: radius * scale })
    }
}

/// Direction of the mean flow at a point; none in still water.
fn current_yaw(environment: &Environment, point: Vec3) -> Option<f32> {
    let times = (0..12).map(|step| f64::from(step) * 1.7);
    let flows = times.filter_map(|time| environment.influence(&[point], time).ok());
    let mean: Vec3 = flows.flatten().map(|one| one.flow).sum();
    (mean.x.abs().max(mean.z.abs()) > 1e-4).then(|| math::atan2(mean.x, mean.z))
}

impl Population for Corals {
    fn kind(&self) -> &str {
        "corals"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        self.state.seed = growth.moment.seed;
        let options = &self.state.options;
        let kinds =
            options.colonies.iter().flat_map(|&(kind, count)| std::iter::repeat_n(kind, count));
        let mut kinds: Vec<CoralKind> = kinds.collect();
        // The largest settle first, so that they find room.
        kinds.sort_by(|a, b| b.size().total_cmp(&a.size()).then(a.cmp(b)));
        let ids = growth.identities(kinds.len())?;
        let middle = math::sqrt(options.size[0] * options.size[1]);
        let room: Vec<f32> = kinds.iter().map(|kind| 0.42 * kind.size() * middle).collect();
        let sites = if room.is_empty() {
            Vec::new()
        } else {
            options.habitat.sites(&ids, &room, growth, PLACE)
        };
        let settled = ids.into_iter().zip(kinds).zip(sites);
        let colonies: Vec<Colony> = settled
            .map(|((id, kind), site)| Colony::settle(id, kind, site, options, growth))
            .collect();
        let solids = growth.environment.obstacles.edit();
        solids.extend(colonies.iter().filter_map(Colony::obstacle));
        self.state.colonies = colonies;
        self.assets = build(&self.state);
        Ok(())
    }

    fn grow(&mut self, growth: &mut Growth) -> Result<()> {
        self.crackle(growth.moment);
        Ok(())
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        publication.sounds.extend_from_slice(&self.state.sounds);
        for kind in &self.assets {
            for (variant, mesh) in kind.variants.iter().enumerate() {
                let wanted = format!("{}/{variant}", kind.species);
                let name = free_name(&publication.scene, &wanted);
                let mut batch =
                    Batch::new(name, kind.species.clone(), mesh.clone(), kind.material.clone());
                batch.alive = true;
                let own = |one: &&Colony| one.kind == kind.kind && one.variant as usize == variant;
                for colony in self.state.colonies.iter().filter(own) {
                    batch.ids.push(colony.id);
                    batch.transforms.push(colony.place);
                    batch.tints.push(colony.tint);
                }
                publication.scene.batches.push(batch);
            }
        }
        Ok(())
    }

    fn count(&self) -> usize {
        self.state.colonies.len()
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(&self.state))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        let state = read(bytes)?;
        let shapes =
            |state: &State| (state.options.colonies.clone(), state.options.variants, state.seed);
        if shapes(&state) != shapes(&self.state) {
            self.assets = build(&state);
        }
        self.state = state;
        Ok(())
    }

    parameters_in!(state.options.parameters);

    fn inspect(&self, individual: Id) -> Option<Inspection> {
        let colony = self.state.colonies.iter().find(|one| one.id == individual)?;
        let values = [(String::from("size_m"), colony.place.scale.into())];
        let species = colony.kind.name().to_owned();
        Some(Inspection { species, values: values.into(), ..Inspection::default() })
    }
}
