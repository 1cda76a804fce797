use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Id, NOTHING, Parameters, Purpose, Quat, Result, Vec3};
use bioscope_crowds::{Flock, Goal, Home, Surroundings, statistics};
use bioscope_geometry::Transform;
use bioscope_motion::undulation::Spine;
use bioscope_world::{Growth, Inspection, Order, Population, Publication, View, no_such_order};
use rayon::prelude::*;

use super::bodies::{Bodies, Members};
use super::course::Course;
use super::fish::{Fish, Step};
use super::threats::Lookout;
use super::{FishSchoolOptions, SchoolParameters};
use crate::animals::way_out;
use crate::bites::{Gone, bitten};
use crate::fish::FishForm;
use crate::suction::Mouths;

const BIRTH: Purpose = Purpose::new("birth of a schooling fish");
const COURSE: Purpose = Purpose::new("first course of a school");
/// How much the first headings of fishes differ from their school's, as a share of it.
const HEADINGS: f32 = 0.5;
/// Seconds for which the pull of a mouth acts on a fish that it draws in: a flock has no inertia to resist with.
const CARRIED: f32 = 0.1;
/// Fishes that one task handles.
pub(super) const TASK: usize = 64;
/// Ticks from one count of groups to the next.
const COUNT_INTERVAL: u64 = 30;
/// Distance in body lengths below which two fishes belong to one group.
const LINK: f32 = 6.0;
/// Least share of the school that counts as a group of its own.
const LEAST_GROUP: f32 = 0.08;

/// A school of fish; see the [module](super).
pub struct FishSchool {
    pub(super) options: FishSchoolOptions,
    pub(super) form: Arc<FishForm>,
    pub(super) spine: Arc<Spine>,
    /// Bodies that are more than a spine, if motion is replayed.
    pub(super) bodies: Bodies,
    pub(super) flock: Flock,
    pub(super) fishes: Vec<Fish>,
    pub(super) course: Course,
    /// Number of groups at the last count.
    pub(super) groups: usize,
    /// Number of groups before, if the last tick changed it.
    pub(super) regrouped_from: Option<usize>,
    /// Wishes of the first few fishes, for show: accelerations in units of the greatest.
    pub(super) wishes: Vec<Vec3>,
    /// Those that were caught in this tick.
    pub(super) caught: Vec<Gone>,
    pub(super) scratch: Scratch,
}

/// What is worked out anew in every tick.
#[derive(Default)]
pub(super) struct Scratch {
    lookout: Lookout,
    flows: Vec<Vec3>,
    before: Vec<(Quat, f32)>,
}

impl FishSchool {
    /// A school that will settle as the options say; refuses options that make no sense.
    pub fn new(options: FishSchoolOptions) -> Result<Self> {
        options.check()?;
        let home = options.home.unwrap_or(options.center);
        let form = options.species.form();
        Ok(Self {
            spine: Arc::new(form.spine.clone()),
            bodies: Bodies::default(),
            form,
            flock: Flock::new(options.flock.clone(), 0)?,
            fishes: Vec::new(),
            course: Course::starting(home),
            groups: 1,
            regrouped_from: None,
            wishes: Vec::new(),
            caught: Vec::new(),
            scratch: Scratch::default(),
            options,
        })
    }

    /// Identities of all fishes.
    pub fn ids(&self) -> &[Id] {
        self.flock.ids()
    }

    /// Where each fish is, metres.
    pub fn positions(&self) -> &[Vec3] {
        self.flock.positions()
    }

    /// Where each fish is, how it is turned, and its size relative to its species.
    pub(super) fn placement(&self, index: usize) -> Transform {
        let scale = self.fishes[index].scale;
        Transform::new(self.flock.positions()[index], self.flock.rotation(index), scale)
    }

    pub(super) fn body_length(&self) -> f32 {
        self.flock.parameters.body_length
    }

    /// Takes one out, if it is here.
    fn let_go(&mut self, id: Id) {
        if let Some(index) = self.flock.ids().iter().position(|&one| one == id) {
            self.flock.remove(id);
            self.bodies.forget(id);
            self.fishes.remove(index);
        }
    }

    /// The flock among what surrounds it.
    fn with_surroundings(
        &mut self,
        view: &View,
        verb: impl FnOnce(&mut Flock, &Surroundings) -> Result<()>,
    ) -> Result<()> {
        let center = self.options.home.unwrap_or(self.options.center);
        let surroundings = Surroundings {
            time: view.moment.time,
            obstacles: &view.environment.obstacles,
            threats: &self.scratch.lookout.threats,
            terrain: view.environment.terrain.as_deref(),
            surface: view.environment.medium.surface,
            goal: Some(Goal::Point(self.course.goal)),
            home: Some(Home { center, radius: self.options.parameters.home_radius }),
            flow: &self.scratch.flows,
        };
        verb(&mut self.flock, &surroundings)
    }

    /// Lets newcomers come, near the middle of the place where the school began.
    fn join(&mut self, count: usize, growth: &mut Growth) -> Result<()> {
        let FishSchoolOptions { center, half, ref species, .. } = self.options;
        let variation = species.variation;
        let (length, cruise) = (self.body_length(), self.flock.parameters.cruise_speed);
        let ids = growth.identities(count)?;
        // A school that has long been together swims one way.
        let first = ids.first().copied().unwrap_or(NOTHING);
        let common = growth.moment.random(first, COURSE).direction();
        for id in ids {
            let mut random = growth.moment.random(id, BIRTH);
            let environment = &*growth.environment;
            let mut draw = || center + half * random.in_ball();
            let free = |place: &Vec3| way_out(*place, length, environment) == Vec3::ZERO;
            let drawn = (0..32).map(|_| draw()).find(free);
            let place = drawn.unwrap_or_else(|| center + way_out(center, length, environment));
            let heading = common + random.direction() * HEADINGS;
            let level = heading * Vec3::new(1.0, 0.2, 1.0);
            let velocity = level.normalize_or(Vec3::Z) * (cruise * length);
            self.flock.push(id, place, velocity)?;
            self.fishes.push(Fish::born(variation, velocity, &mut random));
        }
        Ok(())
    }

    /// Looks for threats so near that somebody may flee.
    fn look_out(&mut self, view: &View) {
        let reach = self.flock.parameters.flight_distance * self.body_length();
        let start = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (low, high) = self
            .flock
            .positions()
            .iter()
            .fold(start, |(low, high), &one| (low.min(one - reach), high.max(one + reach)));
        let least_length = self.options.parameters.threat_ratio * self.body_length();
        let species = &self.options.species.name;
        self.scratch.lookout.scan(view.scene, species, least_length, (low, high));
    }

    /// Sets the pace of each for this tick, and keeps what is needed to tell how it moved.
    fn prepare(&mut self, dt: f32) {
        let SchoolParameters { burst, burst_period, .. } = self.options.parameters;
        for (fish, pace) in self.fishes.iter_mut().zip(self.flock.paces_mut()) {
            fish.beat(dt, burst_period);
            *pace = fish.pace_now(burst);
        }
        let flock = &self.flock;
        (0..flock.len())
            .into_par_iter()
            .with_min_len(TASK)
            .map(|index| (flock.rotation(index), flock.velocities()[index].length()))
            .collect_into_vec(&mut self.scratch.before);
    }

    /// Lets every fish feel, bend and beat as the flock has moved it.
    fn follow(&mut self, dt: f32) {
        let length = self.body_length();
        let Self { flock, scratch, form, fishes, .. } = self;
        let gait = form.spine.gait();
        fishes.par_iter_mut().enumerate().with_min_len(TASK).for_each(|(index, fish)| {
            let (before, speed_before) = scratch.before[index];
            let velocity = flock.velocities()[index];
            fish.motion = velocity + scratch.flows[index];
            let body = length * fish.scale;
            let speeds = [speed_before, velocity.length()].map(|speed| speed / body);
            fish.swim(gait, &Step { before, heading: flock.headings()[index], speeds, dt });
            let place = flock.positions()[index];
            let alarm = flock.alarms()[index];
            let threat = if alarm > 0.0 { scratch.lookout.nearest(place) } else { None };
            let threat = threat.map_or(NOTHING, |(id, _)| id);
            fish.feel(alarm, flock.behavior(index), threat, dt);
        });
    }

    /// Counts the groups of the school from time to time.
    fn count_groups(&mut self, tick: u64) {
        self.regrouped_from = None;
        if !tick.is_multiple_of(COUNT_INTERVAL) || self.fishes.is_empty() {
            return;
        }
        let least = (LEAST_GROUP * self.fishes.len() as f32).max(2.0) as usize;
        let labels = statistics::flockettes(self.flock.positions(), LINK * self.body_length());
        let mut sizes = vec![0; self.fishes.len()];
        labels.into_iter().for_each(|label| sizes[label] += 1);
        let groups = sizes.into_iter().filter(|&size| size >= least).count().max(1);
        if groups != self.groups {
            self.regrouped_from = Some(self.groups);
        }
        self.groups = groups;
    }

    pub(super) fn replays(&self) -> bool {
        self.options.parameters.replayed >= 0.5
    }

    /// Beats and moves the bodies, if motion is replayed.
    fn move_bodies(&mut self, view: &View) -> Result<()> {
        if !self.replays() {
            self.bodies = Bodies::default();
            return Ok(());
        }
        let length = self.body_length();
        let Self { flock, fishes, spine, scratch, .. } = self;
        let mut members = Members { flock, fishes, spine, length, flows: &scratch.flows };
        let parameters = &self.options.parameters;
        self.bodies.advance(&mut members, parameters, view.environment, view.moment.dt)
    }

    fn note_wishes(&mut self) {
        let shown = (self.options.parameters.annotated as usize).min(self.fishes.len());
        self.wishes = (0..shown).map(|index| self.flock.request(index)).collect();
    }
}

impl Population for FishSchool {
    fn kind(&self) -> &str {
        "fish_school"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        self.flock = Flock::new(self.flock.parameters.clone(), growth.moment.seed)?;
        self.join(self.options.count, growth)
    }

    fn obey(&mut self, order: &Order, growth: &mut Growth) -> Result<()> {
        match *order {
            Order::Number(count) => {
                FishSchoolOptions { count, ..self.options.clone() }.check()?;
                self.join(count.saturating_sub(self.fishes.len()), growth)?;
                let surplus = self.flock.ids()[count..].to_vec();
                surplus.into_iter().for_each(|id| self.let_go(id));
                Ok(())
            }
            Order::Remove(id) if self.flock.ids().contains(&id) => {
                self.let_go(id);
                Ok(())
            }
            _ => Err(no_such_order(self.kind(), order)),
        }
    }

    fn sense(&mut self, view: &View) -> Result<()> {
        self.look_out(view);
        let length = self.body_length();
        let influences = view.environment.influence(self.flock.positions(), view.moment.time)?;
        self.scratch.flows.clear();
        self.scratch.flows.extend(influences.iter().map(|one| one.flow));
        let mouths = Mouths::new(&view.scene.mouths);
        let all = self.flock.ids().iter().zip(self.flock.positions()).zip(&self.fishes);
        for (flow, ((&id, &place), fish)) in self.scratch.flows.iter_mut().zip(all) {
            *flow += mouths.pull(id, place, length * fish.scale) * CARRIED;
        }
        self.with_surroundings(view, |flock, surroundings| {
            flock.sense(surroundings);
            Ok(())
        })
    }

    fn decide(&mut self, view: &View) -> Result<()> {
        self.with_surroundings(view, |flock, surroundings| {
            flock.decide(surroundings);
            Ok(())
        })
    }

    fn advance(&mut self, view: &View) -> Result<()> {
        let dt = view.moment.dt;
        self.prepare(dt);
        self.note_wishes();
        self.with_surroundings(view, |flock, surroundings| flock.advance(dt, surroundings))?;
        self.move_bodies(view)?;
        self.follow(dt);
        let cruise = self.flock.parameters.cruise_speed * self.body_length();
        let SchoolParameters { goal_pace, home_radius, .. } = self.options.parameters;
        let home = (self.options.home.unwrap_or(self.options.center), home_radius);
        self.course.advance(cruise * goal_pace * dt, home, view.environment, &view.moment);
        self.count_groups(view.moment.tick);
        Ok(())
    }

    fn grow(&mut self, growth: &mut Growth) -> Result<()> {
        self.caught.clear();
        for (who, into) in bitten(growth.events) {
            if self.flock.ids().contains(&who) {
                self.let_go(who);
                self.caught.push(Gone {
                    who,
                    into,
                    species: self.options.species.name.as_str().into(),
                });
            }
        }
        Ok(())
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        self.show(publication);
        Ok(())
    }

    fn count(&self) -> usize {
        self.fishes.len()
    }

    fn save(&self) -> Result<Vec<u8>> {
        self.to_saved()
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        *self = Self::from_saved(bytes)?;
        Ok(())
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(self)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(self)
    }

    fn inspect(&self, id: Id) -> Option<Inspection> {
        let index = self.flock.ids().iter().position(|&one| one == id)?;
        Some(self.inspect_one(index))
    }

    fn statistics(&self) -> BTreeMap<String, f64> {
        self.figures()
    }

    fn default_name(&self) -> String {
        self.options.species.name.clone()
    }
}
