use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{
    Error, Event, Id, NOTHING, Parameters, Quat, Result, SoundEvent, Vec3, math, parameters, state,
};
use bioscope_geometry::{Batch, Material, Mesh, Transform};
use bioscope_world::{Growth, Moment, Population, Publication, View};
use serde::{Deserialize, Serialize};

use super::tackle;
use crate::bites::{BITTEN, EATEN, HOOKED, bitten, of_species};
use crate::kept::{parameters_in, saved_as_state};
use crate::names::free_name;

/// Species of line and hook in the scene.
const LINE: &str = "fishing_line";
/// Height of the tip of the rod over the water, metres.
const ROD: f32 = 1.5;
/// Height of the hook over the water before it is lowered and after it was hauled, metres.
const DRY: f32 = 0.4;
/// Lean of the line per speed of the water, radians per metre and second, and the most (choice).
const LEAN: (f32, f32) = (0.5, 0.3);
/// Time constant with which the line follows the water, seconds.
const FOLLOW_TIME: f32 = 1.5;
/// Lean of the line by which a struggling fish tugs, radians.
const TUG: f32 = 0.025;

parameters! {
    /// When and how fast a line is lowered and hauled.
    pub struct FishingLineParameters {
        /// World time at which it is lowered.
        start: f32 = 0.0, "s", 0.0..=100000.0, "choice";
        /// Depth at which the hook comes to rest.
        depth: f32 = 3.0, "m", 0.1..=50.0, "choice";
        /// Speed at which it sinks.
        sinking: f32 = 0.5, "m/s", 0.01..=5.0, "choice";
        /// Speed at which a fish is hauled.
        hauling: f32 = 0.5, "m/s", 0.01..=5.0, "choice";
        /// Thickness of the line.
        thickness: f32 = 0.003, "m", 0.0001..=0.1, "choice";
    }
}

/// Where a line hangs, and what is on its hook.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FishingLineOptions {
    /// x and z at which it is lowered, metres.
    pub place: [f32; 2],
    /// Species of its bait in the scene, by which animals know it as food.
    pub bait: String,
    /// When and how fast.
    pub parameters: FishingLineParameters,
}

impl Default for FishingLineOptions {
    fn default() -> Self {
        let parameters = FishingLineParameters::default();
        Self { place: [0.0; 2], bait: String::from("bait"), parameters }
    }
}

/// A fishing line with a baited hook (Tu 1996, sections 5.3 and 8.2); see the [module](super).
pub struct FishingLine {
    state: State,
    line: Arc<Mesh>,
    bait: Arc<Mesh>,
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    options: FishingLineOptions,
    hook: Id,
    bait: Id,
    /// Depth of the hook, metres; negative over the water.
    depth: f32,
    /// Lean of the line along x and z, radians.
    lean: [f32; 2],
    /// How the hook moves, metres per second.
    velocity: Vec3,
    /// Height of the water, metres.
    surface: f32,
    /// Who took the bait.
    catch: Option<Id>,
    /// Whether the catch is out of the water.
    landed: bool,
    /// What is told in this tick: that the catch was hooked, that it is lifted out.
    news: Option<News>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum News {
    Hooked,
    Landed,
}

impl FishingLine {
    /// A line that waits over the water.
    pub fn new(options: FishingLineOptions) -> Result<Self> {
        let FishingLineOptions { place, parameters, .. } = &options;
        if !place.iter().all(|one| one.is_finite()) {
            return Err(Error::value("place", format!("{place:?}"), "two finite numbers, metres"));
        }
        for one in parameters.descriptions() {
            one.check(parameters.get(&one.name).unwrap_or(f64::NAN))?;
        }
        let thickness = parameters.thickness;
        let state = State {
            options,
            hook: NOTHING,
            bait: NOTHING,
            depth: -DRY,
            lean: [0.0; 2],
            velocity: Vec3::ZERO,
            surface: 0.0,
            catch: None,
            landed: false,
            news: None,
        };
        Ok(Self { state, line: tackle::line_and_hook(thickness), bait: tackle::bait() })
    }

    /// A line in a state that `save` gave.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state: State = state::from_bytes(LINE, bytes)?;
        let line = Self::new(state.options.clone())?;
        Ok(Self { state, ..line })
    }

    /// Where the hook is.
    fn placement(&self) -> Transform {
        let State { options, depth, lean, surface, .. } = &self.state;
        let [x, z] = options.place;
        let down = Vec3::new(lean[0], -1.0, lean[1]).normalize();
        let rod = Vec3::new(x, surface + ROD, z);
        let rotation = Quat::from_rotation_arc(Vec3::NEG_Y, down);
        Transform::new(rod + down * (depth + ROD), rotation, 1.0)
    }

    fn batch(
        &self,
        name: String,
        species: &str,
        id: Id,
        mesh: &Arc<Mesh>,
        color: [f32; 3],
    ) -> Batch {
        let material =
            Material { name: species.to_owned(), color, roughness: 0.4, ..Material::default() };
        let mut batch = Batch::new(name, species, mesh.clone(), Arc::new(material));
        batch.ids = vec![id];
        batch.transforms = vec![self.placement()];
        batch.velocities = vec![self.state.velocity];
        batch
    }
}

impl State {
    /// Lowers or hauls by one tick.
    fn wind(&mut self, moment: &Moment) {
        let FishingLineParameters { start, depth, sinking, hauling, .. } = self.options.parameters;
        if self.catch.is_some() {
            self.depth = (self.depth - hauling * moment.dt).max(-DRY);
        } else if moment.time >= f64::from(start) {
            self.depth = (self.depth + sinking * moment.dt).min(depth.max(self.depth));
        }
    }

    /// Leans with the water, and with a catch that tugs.
    fn lean(&mut self, flow: Vec3, moment: &Moment) {
        let tug = if self.catch.is_some() && !self.landed { TUG } else { 0.0 };
        let beat = |rate: f64| math::sin(((moment.time * rate).fract() as f32) * math::TAU);
        let wanted = [flow.x * LEAN.0 + tug * beat(1.7), flow.z * LEAN.0 + tug * beat(2.3)];
        let share = math::relaxation(moment.dt, if tug > 0.0 { 0.1 } else { FOLLOW_TIME });
        for (lean, wanted) in self.lean.iter_mut().zip(wanted) {
            *lean += (wanted.clamp(-LEAN.1, LEAN.1) - *lean) * share;
        }
    }

    fn event(&self, kind: &'static str, subject: Id, object: Id, moment: &Moment) -> Event {
        Event {
            tick: moment.tick,
            time: moment.time,
            kind: Cow::Borrowed(kind),
            subject,
            object: Some(object),
            data: BTreeMap::new(),
        }
    }
}

impl Population for FishingLine {
    fn kind(&self) -> &str {
        LINE
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        let ids = growth.identities(2)?;
        (self.state.hook, self.state.bait) = (ids[0], ids[1]);
        self.state.surface = growth.environment.medium.surface.unwrap_or(0.0);
        Ok(())
    }

    fn advance(&mut self, view: &View) -> Result<()> {
        let place = self.placement().position;
        let influence = view.environment.influence(&[place], view.moment.time)?;
        self.state.wind(&view.moment);
        self.state.lean(influence[0].flow, &view.moment);
        self.state.velocity = (self.placement().position - place) / view.moment.dt;
        Ok(())
    }

    fn grow(&mut self, growth: &mut Growth) -> Result<()> {
        let state = &mut self.state;
        state.news = None;
        match state.catch {
            None => {
                state.catch = bitten(growth.events).get(&state.bait).copied();
                state.news = state.catch.map(|_| News::Hooked);
            }
            Some(_) if !state.landed && state.depth <= 0.0 => {
                (state.landed, state.news) = (true, Some(News::Landed));
            }
            Some(_) => {}
        }
        Ok(())
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        let state = &self.state;
        let Publication { moment, scene, sounds, events } = publication;
        let name = free_name(scene, LINE);
        scene.batches.push(self.batch(name, LINE, state.hook, &self.line, [1.0; 3]));
        // Over the water nobody in it notices the bait.
        if state.catch.is_none() && state.depth > 0.0 {
            let species = &state.options.bait;
            let name = free_name(scene, species);
            let mut bait = self.batch(name, species, state.bait, &self.bait, [0.75, 0.26, 0.2]);
            bait.alive = true;
            scene.batches.push(bait);
        }
        let (Some(catch), Some(news)) = (state.catch, state.news) else {
            return Ok(());
        };
        match news {
            News::Hooked => {
                let data = of_species(&state.options.bait);
                events.push(Event { data, ..state.event(EATEN, state.bait, catch, moment) });
                events.push(state.event(HOOKED, catch, state.hook, moment));
            }
            News::Landed => {
                events.push(state.event(BITTEN, catch, state.hook, moment));
                sounds.push(SoundEvent {
                    source: state.hook,
                    kind: Cow::Borrowed("splash"),
                    time: moment.time,
                    duration: 0.8,
                    position: self.placement().position,
                    velocity: Vec3::ZERO,
                    amplitude: 0.5,
                    pitch: 500.0,
                });
            }
        }
        Ok(())
    }

    fn count(&self) -> usize {
        1
    }

    saved_as_state!();

    parameters_in!(state.options.parameters);

    fn statistics(&self) -> BTreeMap<String, f64> {
        let caught = f64::from(u8::from(self.state.landed));
        let depth = f64::from(self.state.depth);
        BTreeMap::from([
            ("depth_m".into(), depth),
            ("caught".into(), caught),
            ("count".into(), 1.0),
        ])
    }
}
