//! A step of the whole stand: rewriting, exchange with the environment, births and deaths.

use std::ops::Range;

use bioscope_core::{Error, Id, Purpose, Random, Result, Vec3};
use bioscope_lsystem::{Letter, Reply};
use bioscope_world::Growth;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Stand;
use super::falling::Falling;
use super::look::Look;
use super::plant::{Plant, Shed};
use super::population::State;
use crate::bites;

const PLANT: Purpose = Purpose::new("stand plant");
/// What is done of a step differs from all of it by less than this: the error of adding ticks up.
const ALL: f64 = 1.0 - 1e-9;
/// An event that cuts what is in a ball (`position`, `radius`) off the plants.
const CUT: &str = "cut";

/// What has happened to a plant in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum News {
    Germinated { who: Id },
    Pruned { who: Id, modules: u32 },
    Eaten { who: Id, into: Id },
    Died { who: Id },
}

impl Stand {
    /// Goes on by so many steps, whole or not.
    pub(super) fn go_on(&mut self, mut steps: f64, growth: &mut Growth) -> Result<()> {
        while steps > 1e-12 {
            let taken = steps.min(1.0 - self.state.part);
            self.state.part += taken;
            steps -= taken;
            let is_complete = self.state.part >= ALL;
            let count = self.state.plants.len();
            let part = if is_complete { count } else { (count as f64 * self.state.part) as usize };
            self.rewrite(self.state.done..part.max(self.state.done), growth)?;
            if is_complete {
                self.end_step(growth)?;
            }
        }
        Ok(())
    }

    /// Rewrites these plants.
    fn rewrite(&mut self, range: Range<usize>, growth: &mut Growth) -> Result<()> {
        self.state.done = range.end;
        let (steps, unfolds) = (self.steps, self.state.options.unfold);
        let (models, space) = (&self.models, &self.state.space);
        let plants = &mut self.state.plants[range.clone()];
        let shed: Vec<Result<Vec<(u32, Shed)>>> = plants
            .par_iter_mut()
            .zip(&mut self.looks[range])
            .map(|(plant, look)| {
                if plant.progress.step() >= steps {
                    if !std::mem::take(&mut plant.between).is_empty() {
                        outdate(look);
                    }
                    return Ok(Vec::new());
                }
                let shed = plant.rewrite(models.of(plant.source), space, unfolds)?;
                outdate(look);
                Ok(shed.into_iter().map(|one| (plant.source, one)).collect())
            })
            .collect();
        let shed = shed.into_iter().collect::<Result<Vec<_>>>()?.concat();
        self.let_fall(&shed, growth)
    }

    /// What comes after all plants have been rewritten.
    fn end_step(&mut self, growth: &mut Growth) -> Result<()> {
        self.state.step += 1;
        (self.state.part, self.state.done) = (0.0, 0);
        self.clip()?;
        self.bury();
        if self.state.step.is_multiple_of(self.state.options.season) {
            self.germinate(growth)?;
        }
        self.exchange()
    }

    /// Plants `sites`, the plants' places, with ids in their order.
    pub(super) fn plant(
        &mut self,
        sites: &[Vec3],
        sources: &[u32],
        growth: &mut Growth,
    ) -> Result<Vec<Id>> {
        let ids = growth.identities(sites.len())?;
        let options = &self.state.options;
        let models = &self.models;
        let seed = growth.moment.seed;
        let new: Vec<Result<Plant>> = (ids.par_iter().zip(sites).zip(sources))
            .map(|((&id, &site), &source)| {
                let random = Random::new(seed, id, 0, PLANT);
                Plant::new(id, site, source, options, models.of(source), random)
            })
            .collect();
        for plant in new {
            self.state.plants.push(plant?);
            self.looks.push(None);
        }
        Ok(ids)
    }

    /// Cuts all plants to the shape of the stand.
    fn clip(&mut self) -> Result<()> {
        let Some(shape) = &self.models.clip else { return Ok(()) };
        let (models, space) = (&self.models, &self.state.space);
        let plants = self.state.plants.par_iter_mut();
        let lost: Vec<Result<usize>> =
            plants.map(|plant| plant.clip(models.of(plant.source), space, shape)).collect();
        for (number, lost) in lost.into_iter().enumerate() {
            self.note_pruned(number, lost?);
        }
        Ok(())
    }

    fn note_pruned(&mut self, number: usize, modules: usize) {
        if modules > 0 {
            let who = self.state.plants[number].id;
            outdate(&mut self.looks[number]);
            self.state.news.push(News::Pruned { who, modules: modules as u32 });
        }
    }

    /// Lets the dead go.
    fn bury(&mut self) {
        let news = &mut self.state.news;
        let bare: Vec<bool> = self.state.plants.iter().map(|plant| plant.bare).collect();
        if !bare.contains(&true) {
            return;
        }
        let dead = self.state.plants.iter().filter(|plant| plant.bare);
        news.extend(dead.map(|plant| News::Died { who: plant.id }));
        self.state.plants.retain(|plant| !plant.bare);
        let mut bare = bare.into_iter();
        self.looks.retain(|_| !bare.next().unwrap_or(false));
    }

    /// Seeds on the ground become plants where there is room; the others are gone.
    fn germinate(&mut self, growth: &mut Growth) -> Result<()> {
        let options = &self.state.options;
        let now = growth.moment.time;
        let (landed, rest): (Vec<Falling>, Vec<Falling>) =
            self.state.falling.iter().partition(|one| one.is_seed && one.has_landed(now));
        self.state.falling = rest;
        let mut taken: Vec<_> = self.state.plants.iter().map(|plant| plant.position).collect();
        let (mut sites, mut sources) = (Vec::new(), Vec::new());
        for seed in landed {
            let draw = Random::new(growth.moment.seed, seed.id, 1, PLANT).uniform();
            let free = |other: &Vec3| {
                let way = *other - seed.to;
                way.x * way.x + way.z * way.z >= options.room * options.room
            };
            let is_dry = growth.environment.medium.surface.is_none_or(|level| seed.to.y > level);
            let grows = draw < options.parameters.germination
                && taken.len() < options.most
                && is_dry
                && options.habitat.area.is_open_at(seed.to.x, seed.to.z)
                && taken.iter().all(free);
            if grows {
                taken.push(seed.to);
                sites.push(seed.to);
                sources.push(seed.source);
            }
        }
        let ids = self.plant(&sites, &sources, growth)?;
        self.state.news.extend(ids.into_iter().map(|who| News::Germinated { who }));
        Ok(())
    }

    /// Asks the environment for all plants, in the order of their identities, and tells them the answers. One that
    /// forgets is told of those plants too that do not ask in this step.
    pub(super) fn exchange(&mut self) -> Result<()> {
        let Some(environment) = &mut self.environment else { return Ok(()) };
        let (space, forgets) = (&self.state.space, environment.forgets());
        let asks = self.state.plants.iter().any(|plant| !plant.letters.is_empty());
        if forgets && !asks {
            return Ok(());
        }
        let mut letters: Vec<Letter> = Vec::new();
        for plant in &self.state.plants {
            let own = if plant.letters.is_empty() { &plant.shade } else { &plant.letters };
            for letter in own {
                let mut letter = space.addressed(letter, plant.position, plant.yaw);
                letter.id |= u64::from(plant.id) << 32;
                letter.module = letters.len();
                letters.push(letter);
            }
        }
        let mut answers: Vec<Vec<f32>> = letters.iter().map(|one| one.parameters.clone()).collect();
        let requests: Vec<_> = letters.iter().map(Letter::request).collect();
        let mut replies: Vec<Reply> =
            answers.iter_mut().map(|answer| Reply { parameters: answer }).collect();
        environment
            .exchange(self.state.step, &requests, &mut replies)
            .map_err(|error| Error::format(&self.state.options.species, error.to_string()))?;
        let mut answers = answers.into_iter();
        for plant in &mut self.state.plants {
            if plant.letters.is_empty() {
                answers.by_ref().take(plant.shade.len()).for_each(drop);
                continue;
            }
            let own = std::mem::take(&mut plant.letters);
            let told: Vec<(usize, Vec<f32>)> =
                own.iter().zip(&mut answers).map(|(one, answer)| (one.module, answer)).collect();
            plant.progress.answer(&self.models.of(plant.source).system, &told);
            if forgets {
                plant.shade = own;
            }
        }
        Ok(())
    }

    /// What mouths and shears have done in the last tick.
    pub(super) fn lose_branches(&mut self, growth: &Growth) -> Result<()> {
        for (who, into) in bites::bitten(growth.events) {
            let place = self.state.plants.binary_search_by_key(&who, |plant| plant.id);
            let (Ok(number), Some(mouth)) = (place, place_of(growth, into)) else { continue };
            let plant = &mut self.state.plants[number];
            let model = self.models.of(plant.source);
            if plant.bite(model, &self.state.space, mouth)? > 0 {
                outdate(&mut self.looks[number]);
                self.state.news.push(News::Eaten { who, into });
            }
        }
        for event in growth.events.iter().filter(|event| event.kind == CUT) {
            let Some((center, radius)) = bites::ball(event) else { continue };
            for number in 0..self.state.plants.len() {
                let plant = &mut self.state.plants[number];
                let model = self.models.of(plant.source);
                let lost = plant.prune(model, &self.state.space, center, radius)?;
                self.note_pruned(number, lost);
            }
        }
        Ok(())
    }

    /// Draws the plants that have changed, or that unfold.
    pub(super) fn look_again(&mut self) -> Result<()> {
        let State { options, part, done, plants, .. } = &mut self.state;
        let (joints, models, count) = (options.joints, &self.models, plants.len().max(1));
        let plants = plants.par_iter_mut().zip(&mut self.looks).enumerate();
        let changed =
            plants.filter(|(_, (plant, look))| is_stale(look) || !plant.between.is_empty());
        changed.try_for_each(|(number, (plant, look))| {
            // How much of a step has gone by since it was rewritten.
            let late = if number >= *done { 1.0 } else { 0.0 };
            let share = *part + late - (number + 1) as f64 / count as f64;
            let before = look.as_ref().map(|look| look.mesh.clone());
            let own = Look::of(plant, models.of(plant.source), joints, share as f32, before)?;
            plant.sprouted |= !own.is_empty();
            plant.bare = plant.sprouted && own.is_empty();
            *look = Some(own);
            Ok(())
        })
    }
}

fn is_stale(look: &Option<Look>) -> bool {
    look.as_ref().is_none_or(|look| look.stale)
}

fn outdate(look: &mut Option<Look>) {
    if let Some(look) = look {
        look.stale = true;
    }
}

/// Where an individual was in the last tick.
fn place_of(growth: &Growth, who: Id) -> Option<Vec3> {
    growth.scene.batches.iter().find_map(|batch| {
        let number = batch.ids.iter().position(|&id| id == who)?;
        batch.transforms.get(number).map(|one| one.position)
    })
}
