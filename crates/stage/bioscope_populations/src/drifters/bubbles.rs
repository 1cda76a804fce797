use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{
    Error, Event, Id, Purpose, Result, SoundEvent, Value, Vec3, math, parameters, state,
};
use bioscope_geometry::Points;
use bioscope_world::{Growth, Moment, Population, Publication, View};
use serde::{Deserialize, Serialize};

use crate::kept::{parameters_in, saved_as_state};
use crate::names::free_name;
use crate::placement::{Area, Habitat, Site};

const VENT: Purpose = Purpose::new("bubble vent");
const BURST: Purpose = Purpose::new("bubble burst");
const BIRTH: Purpose = Purpose::new("bubble birth");

/// Surface tension of sea water, newtons per metre.
const TENSION: f32 = 0.073;
/// Density of sea water, kilograms per cubic metre.
const DENSITY: f32 = 1025.0;
/// Acceleration of gravity, metres per second squared.
const GRAVITY: f32 = 9.81;
/// Kinematic viscosity of sea water at 20 degrees Celsius, square metres per second.
const VISCOSITY: f32 = 1.05e-6;
/// Pressure of the air, pascal.
const AIR_PRESSURE: f32 = 101_325.0;
/// Most vents and most bubbles at once.
const LARGEST_COUNT: usize = 100_000;

parameters! {
    /// How much and what size of gas comes out of the ground.
    pub struct BubbleParameters {
        /// Clusters that all vents together release per second.
        rate: f32 = 0.25, "1/s", 0.0..=100.0, "choice";
        /// Mean number of bubbles in a cluster.
        cluster: f32 = 9.0, "1", 1.0..=200.0, "choice";
        /// Radius of a middling bubble.
        radius: f32 = 0.004, "m", 0.0002..=0.05, "choice";
        /// Sideways swing of a rising bubble in its own radii.
        wobble: f32 = 1.6, "1", 0.0..=10.0, "rising bubbles of 1 mm and more spiral with a swing of about their own size";
    }
}

/// Where gas comes out, and how much.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BubblesOptions {
    /// Its species in the scene.
    pub species: String,
    /// How many vents.
    pub vents: usize,
    /// Where the vents are.
    pub area: Area,
    /// Most bubbles at once; vents wait while there are so many.
    pub capacity: usize,
    /// Size and number.
    pub parameters: BubbleParameters,
}

impl Default for BubblesOptions {
    fn default() -> Self {
        Self {
            species: String::from("bubble"),
            vents: 5,
            area: Area::default(),
            capacity: 400,
            parameters: BubbleParameters::default(),
        }
    }
}

/// Bubbles that rise from vents in the ground and burst at the surface.
pub struct Bubbles {
    state: State,
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    options: BubblesOptions,
    vents: Vec<Vent>,
    bubbles: Vec<Bubble>,
    /// Clusters begun in this tick, as (vent, number of bubbles).
    bursts: Vec<(Id, u32)>,
    /// What sounded in this tick.
    sounds: Vec<SoundEvent>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
struct Vent {
    id: Id,
    position: Vec3,
    /// Bubbles still to come of the present cluster.
    waiting: u32,
    /// Seconds until the next of them.
    pause: f32,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
struct Bubble {
    id: Id,
    position: Vec3,
    velocity: Vec3,
    /// Radius at the surface; deeper it is smaller by the pressure.
    surface_radius: f32,
    radius: f32,
    /// Where it is on its spiral, radians.
    phase: f32,
}

/// Speed in metres per second at which a bubble of this radius (metres) rises: Stokes' law for the
/// smallest, surface waves for the others (Mendelson 1967: v² = σ/(ρ r) + g r).
pub fn rise_speed(radius: f32) -> f32 {
    let radius = radius.max(1e-6);
    let stokes = 2.0 / 9.0 * GRAVITY * radius * radius / VISCOSITY;
    let wave = math::sqrt(TENSION / (DENSITY * radius) + GRAVITY * radius);
    stokes.min(wave)
}

/// Frequency in hertz at which a bubble of this radius (metres) rings at this depth (metres):
/// f r = 3.26 Hz m at the surface, higher under pressure (Minnaert 1933).
pub fn minnaert_frequency(radius: f32, depth: f32) -> f32 {
    3.26 / radius.max(1e-5) * math::sqrt(pressure(depth))
}

/// Pressure at a depth, in pressures of the air.
fn pressure(depth: f32) -> f32 {
    1.0 + DENSITY * GRAVITY * depth.max(0.0) / AIR_PRESSURE
}

impl Bubbles {
    /// Bubbles of these options.
    pub fn new(options: BubblesOptions) -> Result<Self> {
        check(&options)?;
        let state = State {
            options,
            vents: Vec::new(),
            bubbles: Vec::new(),
            bursts: Vec::new(),
            sounds: Vec::new(),
        };
        Ok(Self { state })
    }

    /// Bubbles in a state that `save` gave.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state: State = state::from_bytes("bubbles", bytes)?;
        check(&state.options)?;
        Ok(Self { state })
    }

    /// Places (metres) and velocities (metres per second) of all bubbles.
    pub fn motions(&self) -> impl Iterator<Item = (Vec3, Vec3)> + '_ {
        self.state.bubbles.iter().map(|one| (one.position, one.velocity))
    }

    /// Begins clusters, and lets those that have begun go on.
    fn release(&mut self, growth: &mut Growth, surface: f32) -> Result<()> {
        let State { options, vents, bubbles, bursts, sounds } = &mut self.state;
        let BubbleParameters { rate, cluster, radius, .. } = options.parameters;
        let moment = growth.moment;
        let chance = rate / vents.len().max(1) as f32 * moment.dt;
        for vent in vents.iter_mut() {
            let mut random = moment.random(vent.id, BURST);
            if vent.waiting == 0 && random.uniform() < chance {
                vent.waiting = 1 + (cluster * random.range(0.3, 1.7)) as u32;
                vent.pause = 0.0;
                bursts.push((vent.id, vent.waiting));
            }
            vent.pause = (vent.pause - moment.dt).max(-moment.dt);
            while vent.waiting > 0 && vent.pause <= 0.0 && bubbles.len() < options.capacity {
                vent.waiting -= 1;
                vent.pause += random.range(0.02, 0.3);
                let id = growth.identities(1)?[0];
                let bubble = Bubble::born(id, vent.position, radius, surface, moment);
                sounds.push(bubble.ring(moment, surface));
                bubbles.push(bubble);
            }
        }
        Ok(())
    }

    /// Takes away what has reached the surface.
    fn burst(&mut self, moment: Moment, surface: f32) {
        let State { bubbles, sounds, .. } = &mut self.state;
        bubbles.retain(|bubble| {
            let up = bubble.position.y + bubble.radius >= surface;
            if up {
                let ring = bubble.ring(moment, surface);
                sounds.push(SoundEvent { amplitude: ring.amplitude * 0.4, ..ring });
            }
            !up
        });
    }
}

impl Bubble {
    fn born(id: Id, vent: Vec3, middling: f32, surface: f32, moment: Moment) -> Self {
        let mut random = moment.random(id, BIRTH);
        // Sizes are log-normal, as counted over gas seeps.
        let spread = math::exp(0.45 * random.normal().clamp(-2.5, 2.5));
        let mut bubble = Self {
            id,
            position: vent + random.in_ball() * Vec3::new(0.04, 0.01, 0.04) + Vec3::Y * 0.02,
            velocity: Vec3::ZERO,
            surface_radius: middling * spread,
            radius: 0.0,
            phase: random.range(0.0, math::TAU),
        };
        bubble.swell(surface);
        bubble
    }

    /// Takes the radius that the gas has at its depth (Boyle's law).
    fn swell(&mut self, surface: f32) {
        let share = pressure(surface - self.position.y);
        self.radius = self.surface_radius * math::pow(share, -1.0 / 3.0);
    }

    fn advance(&mut self, flow: Vec3, wobble: f32, surface: f32, dt: f32) {
        // Shape oscillation sets the pace of the spiral: larger bubbles swing more slowly.
        let pace = math::TAU * (5.0 * math::sqrt(0.003 / self.radius.max(1e-4))).min(9.0);
        self.phase = (self.phase + pace * dt) % math::TAU;
        let swing = (wobble * self.radius * pace).min(0.25);
        let spiral = Vec3::new(math::cos(self.phase), 0.0, math::sin(self.phase)) * swing;
        self.velocity = flow + spiral + Vec3::Y * rise_speed(self.radius);
        self.position += self.velocity * dt;
        self.swell(surface);
    }

    /// The tone of its birth or death.
    fn ring(&self, moment: Moment, surface: f32) -> SoundEvent {
        let pitch = minnaert_frequency(self.radius, surface - self.position.y);
        SoundEvent {
            source: self.id,
            kind: Cow::Borrowed("bubble"),
            time: moment.time,
            // Its oscillation decays within some twenty periods.
            duration: (20.0 / pitch).clamp(0.01, 0.2),
            position: self.position,
            velocity: self.velocity,
            amplitude: (self.radius * 30.0).min(0.5),
            pitch,
        }
    }
}

fn check(options: &BubblesOptions) -> Result<()> {
    options.area.check()?;
    if options.vents > LARGEST_COUNT || options.capacity > LARGEST_COUNT {
        let found = format!("{} vents, capacity {}", options.vents, options.capacity);
        return Err(Error::value("vents", found, format!("up to {LARGEST_COUNT} of each")));
    }
    Ok(())
}

fn surface(environment: &bioscope_world::Environment) -> Result<f32> {
    let expected = "a world with water: fill it before bubbles are added";
    environment.medium.surface.ok_or_else(|| Error::value("surface", "none", expected))
}

impl Population for Bubbles {
    fn kind(&self) -> &str {
        "bubbles"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        surface(growth.environment)?;
        let options = &self.state.options;
        let ids = growth.identities(options.vents)?;
        let habitat = Habitat { area: options.area.clone(), ..Habitat::default() };
        let sites = habitat.sites(&ids, &[0.3], growth, VENT);
        let vent =
            |(id, site): (Id, Site)| Vent { id, position: site.position, waiting: 0, pause: 0.0 };
        self.state.vents = ids.into_iter().zip(sites).map(vent).collect();
        Ok(())
    }

    fn advance(&mut self, view: &View) -> Result<()> {
        let surface = surface(view.environment)?;
        let State { options, bubbles, .. } = &mut self.state;
        let points = bubbles.iter().map(|one| one.position).collect::<Vec<_>>();
        let influences = view.environment.influence(&points, view.moment.time)?;
        for (bubble, influence) in bubbles.iter_mut().zip(&influences) {
            bubble.advance(influence.flow, options.parameters.wobble, surface, view.moment.dt);
            if let Some(ground) = &view.environment.terrain {
                let least = ground.height(bubble.position.x, bubble.position.z) + bubble.radius;
                bubble.position.y = bubble.position.y.max(least);
            }
        }
        Ok(())
    }

    fn grow(&mut self, growth: &mut Growth) -> Result<()> {
        let surface = surface(growth.environment)?;
        self.state.bursts.clear();
        self.state.sounds.clear();
        self.burst(growth.moment, surface);
        self.release(growth, surface)
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        let State { options, bubbles, bursts, sounds, .. } = &self.state;
        publication.sounds.extend_from_slice(sounds);
        for &(vent, bubbles) in bursts {
            publication.events.push(Event {
                tick: publication.moment.tick,
                time: publication.moment.time,
                kind: Cow::Borrowed("bubbled"),
                subject: vent,
                object: None,
                data: BTreeMap::from([(
                    String::from("bubbles"),
                    Value::Number(f64::from(bubbles)),
                )]),
            });
        }
        publication.scene.points.push(Points {
            name: free_name(&publication.scene, &options.species),
            species: Arc::from(options.species.as_str()),
            ids: bubbles.iter().map(|one| one.id).collect(),
            positions: bubbles.iter().map(|one| one.position).collect(),
            radii: bubbles.iter().map(|one| one.radius).collect(),
            color: [0.9, 0.95, 1.0],
            opacity: 0.55,
            glassy: true,
        });
        Ok(())
    }

    fn count(&self) -> usize {
        self.state.bubbles.len()
    }

    saved_as_state!();

    parameters_in!(state.options.parameters);
}
