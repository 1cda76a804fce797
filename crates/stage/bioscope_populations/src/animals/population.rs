use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{
    Error, Event, Id, NOTHING, Parameters, Purpose, Random, Result, Value, Vec3, math,
};
use bioscope_dynamics::Influence;
use bioscope_geometry::{Batch, Transform};
use bioscope_motion::MuscleSwimmer;
use bioscope_senses::{Memory, Outlook};
use bioscope_world::{Environment, Growth, Inspection, Order, Population, Publication, View};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::contact::way_out;
use super::individual::{Individual, Record};
use super::saved::SavedIndividual;
use super::{Animal, Kinds, feeding, hooked};
use crate::bites::{CAUGHT, Gone};
use crate::names::free_name;
use crate::suction::Mouths;

const BIRTH: Purpose = Purpose::new("birth of an animal");
/// Most animals of one population: each has a mind of its own.
const LARGEST_COUNT: usize = 100_000;
/// Fewest animals that are worth sharing among threads: of those that look with retinas, and of others, of which a
/// dozen think and move in the time that it takes to wake a thread.
const WORTH_THREADS: (usize, usize) = (4, 24);

/// Animals that one task poses.
const TASK: usize = 32;

/// A ball in which animals begin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Its middle, metres.
    pub center: Vec3,
    /// Its radius, metres.
    pub radius: f32,
}

/// Where animals live and how much they differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnimalsOptions {
    /// Where they begin; none leaves each where its body was put.
    pub place: Option<Place>,
    /// The place they call home, metres; none for the middle of `place`, or where each began.
    pub home: Option<Vec3>,
    /// By how much of its size each differs from its kin, 0 to 0.9; a share of it goes for color.
    pub variation: f32,
    /// Seconds from one decision to the next, 0 for one in every tick. Between decisions nothing new is noticed, as if
    /// senses and nerves took that time; fishes answer what they see after about a tenth of a second.
    pub reaction: f32,
}

impl Default for AnimalsOptions {
    fn default() -> Self {
        Self { place: None, home: None, variation: 0.1, reaction: 0.0 }
    }
}

/// A population of animals with senses, minds and bodies; see the [module](super).
pub struct Animals {
    pub(super) options: AnimalsOptions,
    pub(super) individuals: Vec<Individual>,
    /// What newcomers are made like, in turn: the first individuals before they lived.
    pub(super) patterns: Vec<SavedIndividual>,
    pub(super) kinds: Arc<Kinds>,
    /// Those that were caught in this tick.
    pub(super) caught: Vec<Gone>,
    /// What acts on each of them in this tick, as they felt it before they moved; no state.
    pub(super) felt: Vec<Influence>,
}

impl Animals {
    /// A population of these animals. `kinds` must know all kinds of their parts, for saving.
    pub fn new(animals: Vec<Animal>, options: AnimalsOptions, kinds: Arc<Kinds>) -> Result<Self> {
        check_count(animals.len())?;
        check_options(&options)?;
        animals.iter().try_for_each(check)?;
        let individuals = animals
            .into_iter()
            .map(|parts| Individual { id: NOTHING, parts, record: Record::default() })
            .collect();
        let (patterns, caught, felt) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { options, individuals, patterns, kinds, caught, felt })
    }

    /// Runs `work` on every individual: in parallel, or in order where a part is the user's own. Of
    /// several errors the first individual's is returned.
    fn each(
        &mut self,
        work: impl Fn(&mut Individual, usize) -> Result<()> + Send + Sync,
    ) -> Result<()> {
        let first = self.individuals.first();
        let looks = first.is_some_and(|one| one.record.percepts.retina.is_some());
        let fewest = if looks { WORTH_THREADS.0 } else { WORTH_THREADS.1 };
        let in_order = self.individuals.len() < fewest || self.may_fail();
        let mut individuals = self.individuals.iter_mut().enumerate();
        if in_order {
            return individuals.try_for_each(|(index, one)| work(one, index));
        }
        let all = self.individuals.par_iter_mut().enumerate();
        let outcomes: Vec<Result<()>> = all.map(|(index, one)| work(one, index)).collect();
        outcomes.into_iter().collect()
    }

    /// What acts on each of them.
    fn influences(&self, view: &View) -> Result<Vec<Influence>> {
        let bodies = self.individuals.iter().map(|one| one.parts.body.placement().position);
        view.environment.influence(&bodies.collect::<Vec<_>>(), view.moment.time)
    }

    /// What moves each of them: what acts on it, and mouths that suck. A body of muscles is drawn node by node, so that
    /// what of it is before the mouth goes first; others as a whole.
    fn drives(&mut self, view: &View) -> Result<Vec<Influence>> {
        // Nobody has moved since it was felt.
        let mut influences = std::mem::take(&mut self.felt);
        if influences.len() != self.individuals.len() {
            influences = self.influences(view)?;
        }
        if !view.scene.mouths.is_empty() {
            let (mouths, dt) = (Mouths::new(&view.scene.mouths), view.moment.dt);
            for (one, influence) in self.individuals.iter_mut().zip(&mut influences) {
                let (id, body) = (one.id, &mut one.parts.body);
                let (position, length) = (body.placement().position, body.length());
                match body.muscles() {
                    Some(muscles) if mouths.reach(position, length) => {
                        muscles.draw(|node| mouths.pull(id, node, length) * dt);
                    }
                    Some(_) => {}
                    None => influence.force += mouths.pull(id, position, length),
                }
            }
        }
        Ok(influences)
    }

    /// The batch of all animals that look like the `first`.
    fn batch(&self, name: String, first: &Individual) -> Batch {
        let look = &first.parts.look;
        let mut batch =
            Batch::new(name, look.species.clone(), look.mesh.clone(), look.material.clone());
        batch.alive = true;
        let alike = self.individuals.iter().filter(|one| one.parts.look.equals(look));
        let alike: Vec<&Individual> = alike.collect();
        batch.ids = alike.iter().map(|one| one.id).collect();
        batch.tints = alike.iter().map(|one| one.record.tint).collect();
        batch.displays = alike.iter().map(|one| one.record.intention.display).collect();
        batch.transforms = alike.iter().map(|one| one.parts.body.placement()).collect();
        batch.velocities = alike.iter().map(|one| one.parts.body.velocity()).collect();
        let joints = look.joint_count();
        if joints > 0 {
            batch.poses = vec![Transform::IDENTITY; joints * alike.len()];
            let pose = |(some, poses): (&[&Individual], &mut [Transform])| {
                let each = some.iter().zip(poses.chunks_mut(joints));
                each.for_each(|(one, pose)| one.parts.body.pose(pose));
            };
            if alike.len() <= TASK {
                pose((&alike, &mut batch.poses));
            } else {
                let poses = batch.poses.par_chunks_mut(joints * TASK);
                alike.par_chunks(TASK).zip(poses).for_each(pose);
            }
        }
        batch
    }
}

/// Refuses more animals than one population may have.
pub(super) fn check_count(count: usize) -> Result<()> {
    if count <= LARGEST_COUNT {
        return Ok(());
    }
    Err(Error::value("count", count, format!("up to {LARGEST_COUNT}")))
}

/// Gives a newcomer its identity, its size and color, and its place.
pub(super) fn be_born(
    individual: &mut Individual,
    id: Id,
    options: &AnimalsOptions,
    growth: &Growth,
) {
    let AnimalsOptions { place, home, variation, .. } = *options;
    let mut random = growth.moment.random(id, BIRTH);
    let body = &mut individual.parts.body;
    body.vary(variation, &mut random);
    if let Some(place) = place {
        let position = room(place, body.length(), growth.environment, &mut random);
        let bearing = random.range(0.0, math::TAU);
        body.put(position, Vec3::new(math::sin(bearing), 0.0, math::cos(bearing)));
    }
    let began = body.placement().position;
    individual.id = id;
    individual.record.home = home.or(place.map(|place| place.center)).unwrap_or(began);
    individual.record.tint = tint(variation, &mut random);
}

fn check_options(options: &AnimalsOptions) -> Result<()> {
    if let Some(Place { center, radius }) = options.place
        && !(center.is_finite() && radius.is_finite() && radius >= 0.0)
    {
        let found = format!("{radius} m round {center}");
        return Err(Error::value("place", found, "a ball with a finite center and radius"));
    }
    if let Some(home) = options.home.filter(|home| !home.is_finite()) {
        return Err(Error::value("home", home, "a finite point in metres"));
    }
    if !(0.0..=0.9).contains(&options.variation) {
        return Err(Error::value("variation", options.variation, "0 to 0.9"));
    }
    if !(0.0..=2.0).contains(&options.reaction) {
        return Err(Error::value("reaction", options.reaction, "0 to 2 seconds"));
    }
    Ok(())
}

/// Refuses an animal whose body does not fit its look.
pub(super) fn check(animal: &Animal) -> Result<()> {
    let (joints, posed) = (animal.look.joint_count(), animal.body.joint_count());
    if joints == posed {
        return Ok(());
    }
    let name = format!("joints of body '{}'", animal.body.kind());
    let expected = format!("{joints}, as many as the mesh of '{}' has", animal.look.species);
    Err(Error::value(name, posed, expected))
}

/// A random place in a ball with room for `radius` metres on all sides, if one is found.
fn room(place: Place, radius: f32, environment: &Environment, random: &mut Random) -> Vec3 {
    const DRAWS: usize = 32;
    let mut draw = || place.center + random.in_ball() * place.radius;
    let free = |point: &Vec3| way_out(*point, radius, environment) == Vec3::ZERO;
    let drawn = (0..DRAWS).map(|_| draw()).find(free);
    drawn.unwrap_or_else(|| place.center + way_out(place.center, radius, environment))
}

/// A color near white: brightness and hue differ a little.
pub(crate) fn tint(variation: f32, random: &mut Random) -> [f32; 3] {
    let bright = 1.0 + random.range(-variation, variation);
    let warm = 0.5 * random.range(-variation, variation);
    [bright * (1.0 + warm), bright, bright * (1.0 - warm)]
}

impl Population for Animals {
    fn kind(&self) -> &str {
        "animals"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        let ids = growth.identities(self.individuals.len())?;
        self.patterns = self.distinct()?;
        for (individual, id) in self.individuals.iter_mut().zip(ids) {
            be_born(individual, id, &self.options, growth);
        }
        Ok(())
    }

    fn sense(&mut self, view: &View) -> Result<()> {
        let influences = self.influences(view)?;
        let memory = view.common.get::<Memory>();
        let outlook = Outlook::shared(view.scene, &memory);
        let meals = feeding::meals(view.events);
        let reaction = self.options.reaction;
        self.each(|individual, index| {
            let fed = meals.get(&individual.id).copied().unwrap_or(0);
            individual.sense(view, &outlook, (influences[index], fed, reaction))
        })?;
        self.felt = influences;
        Ok(())
    }

    fn decide(&mut self, view: &View) -> Result<()> {
        let reaction = self.options.reaction;
        self.each(|individual, _| individual.decide(&view.moment, reaction))
    }

    fn advance(&mut self, view: &View) -> Result<()> {
        let influences = self.drives(view)?;
        let dt = view.moment.dt;
        self.each(|individual, index| individual.drive(&influences[index], dt))?;
        let bodies = self.individuals.iter_mut().map(|one| &mut one.parts.body);
        let mut muscles: Vec<_> = bodies.filter_map(|body| body.muscles()).collect();
        MuscleSwimmer::advance_together(&mut muscles, dt);
        let hooks = hooked::places(&self.individuals, view.scene, dt);
        self.each(|individual, _| {
            match individual.record.hook.map(|hook| hooks.get(&hook)) {
                Some(Some(&hook)) => individual.hang(hook),
                Some(None) => individual.record.hook = None,
                None => {}
            }
            individual.arrive(view.environment)
        })
    }

    fn grow(&mut self, growth: &mut Growth) -> Result<()> {
        self.caught = feeding::be_caught(&mut self.individuals, growth.events);
        hooked::hook(&mut self.individuals, growth.events);
        Ok(())
    }

    fn obey(&mut self, order: &Order, growth: &mut Growth) -> Result<()> {
        self.follow(order, growth)
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        let Publication { moment, scene, sounds, events } = publication;
        events.extend(self.caught.iter().map(|gone| gone.event(CAUGHT, moment)));
        for (index, individual) in self.individuals.iter().enumerate() {
            let look = &individual.parts.look;
            let earlier = &self.individuals[..index];
            if !earlier.iter().any(|one| one.parts.look.equals(look)) {
                let name = free_name(scene, &look.species);
                scene.batches.push(self.batch(name, individual));
            }
            let body = &individual.parts.body;
            let placement = body.placement();
            let first = scene.annotations.len();
            scene.annotations.extend_from_slice(&individual.record.annotations);
            let (position, attitude) = (placement.position, placement.rotation());
            let annotations = &mut scene.annotations[first..];
            bioscope_minds::place(annotations, individual.id, position, attitude);
            let first = sounds.len();
            body.sounds(sounds);
            sounds.extend(feeding::bite_sound(&individual.record, body.as_ref()));
            for sound in &mut sounds[first..] {
                (sound.source, sound.time) = (individual.id, moment.time);
            }
            scene.mouths.extend(feeding::open_mouth(
                individual.id,
                &individual.record,
                body.as_ref(),
            ));
            events.extend(
                individual.record.bite.map(|prey| feeding::bitten_by(individual.id, prey, moment)),
            );
            for (kind, object) in individual.record.events() {
                events.push(Event {
                    tick: moment.tick,
                    time: moment.time,
                    kind: Cow::Borrowed(kind),
                    subject: individual.id,
                    object,
                    data: BTreeMap::new(),
                });
            }
        }
        Ok(())
    }

    fn count(&self) -> usize {
        self.individuals.len()
    }

    fn save(&self) -> Result<Vec<u8>> {
        self.to_saved()
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        self.restore_from(bytes)
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(self)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(self)
    }

    fn inspect(&self, id: Id) -> Option<Inspection> {
        let individual = self.individuals.iter().find(|one| one.id == id)?;
        Some(super::inspection::inspect(individual))
    }

    fn values(&self, name: &str) -> Option<Vec<Value>> {
        let all = self.individuals.iter().map(|one| super::inspection::value(one, name));
        all.collect()
    }

    fn statistics(&self) -> BTreeMap<String, f64> {
        let count = self.individuals.len();
        let mean = |value: fn(&Individual) -> f32| {
            let sum: f64 = self.individuals.iter().map(|one| f64::from(value(one))).sum();
            sum / count.max(1) as f64
        };
        BTreeMap::from([
            ("count".into(), count as f64),
            ("mean_speed_m_per_s".into(), mean(|one| one.parts.body.velocity().length())),
            ("energy_spent_j_per_kg".into(), mean(|one| one.parts.body.energy_spent())),
        ])
    }

    fn may_fail(&self) -> bool {
        self.individuals.iter().any(|one| one.parts.may_fail)
    }

    fn default_name(&self) -> String {
        let first = self.individuals.first();
        first.map_or_else(|| self.kind().to_owned(), |one| one.parts.look.species.to_string())
    }
}
