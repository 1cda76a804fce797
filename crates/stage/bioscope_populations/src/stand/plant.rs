//! One plant.

use bioscope_core::{Id, Random, Result, Vec3, math};
use bioscope_lsystem::{
    Between, Interpretation, Letter, Lineage, Placed, Progress, Shape, Shown, Turtle,
};
use serde::{Deserialize, Serialize};

use super::StandOptions;
use super::model::Model;
use super::space::Space;
use crate::plants::Sway;

/// Most modules that one bite takes.
const MOUTHFUL: usize = 40;

/// One plant of a stand.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Plant {
    pub id: Id,
    /// Which of the texts it grows from.
    pub source: u32,
    pub seed: u64,
    pub position: Vec3,
    pub yaw: f32,
    /// Its own place in the rhythm of the flutter, radians.
    pub phase: f32,
    pub tint: [f32; 3],
    pub sway: Sway,
    pub progress: Progress,
    /// What it asks in this step.
    pub letters: Vec<Letter>,
    /// What it asked last, where the surroundings forget: it shades the others in steps in which it does not ask.
    pub shade: Vec<Letter>,
    /// Whether it has ever drawn anything.
    pub sprouted: bool,
    /// What it grows from while a step lasts, if it is to be seen growing.
    pub between: Between,
    /// Whether it had, but draws nothing any more: it is dead.
    pub bare: bool,
}

/// A module that has left its plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shed {
    pub is_seed: bool,
    /// Where, world space.
    pub from: Vec3,
}

impl Plant {
    pub fn new(
        id: Id,
        position: Vec3,
        source: u32,
        options: &StandOptions,
        model: &Model,
        mut random: Random,
    ) -> Result<Self> {
        let seed = u64::from(random.bits());
        let bright = 1.0 + options.variety * random.range(-0.6, 0.6);
        let tint = [0, 1, 2].map(|_| bright * (1.0 + options.variety * random.range(-0.35, 0.35)));
        let yaw = random.range(0.0, math::TAU);
        let (progress, letters) = model.germinate(seed)?;
        Ok(Self {
            id,
            source,
            seed,
            position,
            yaw: if options.turned { yaw } else { 0.0 },
            phase: random.range(0.0, math::TAU),
            tint,
            sway: Sway::default(),
            progress,
            letters,
            shade: Vec::new(),
            sprouted: false,
            between: Between::default(),
            bare: false,
        })
    }

    /// What it looks like when so much of a step has gone by, 0 to 1.
    pub fn drawn(&self, model: &Model, share: f32) -> Result<Interpretation> {
        let string = self.progress.appearance(&model.system, self.seed)?;
        Turtle::interpret_between(&string, &model.turtle, &self.between, share)
    }

    fn shown(&self, model: &Model) -> Result<Shown> {
        self.progress.shown_by_module(&model.system, self.seed)
    }

    /// Makes a step; what it has shed.
    pub fn rewrite(&mut self, model: &Model, space: &Space, unfolds: bool) -> Result<Vec<Shed>> {
        let before = unfolds.then(|| self.shown(model)).transpose()?;
        let mut lineage;
        (self.progress, self.letters, lineage) =
            model.advance(self.seed, &self.progress, unfolds)?;
        let shed = self.shed(model, space, &mut lineage)?;
        if let Some(before) = before {
            let after = self.shown(model)?;
            self.between = Between::new(&before, &after, &lineage, &model.turtle);
        }
        Ok(shed)
    }

    /// Takes out the modules that leave the plant.
    fn shed(&mut self, model: &Model, space: &Space, lineage: &mut Lineage) -> Result<Vec<Shed>> {
        let leaves = |kind: &u8| model.seeds.contains(kind) || model.litter.contains(kind);
        if !self.progress.kinds().iter().any(leaves) {
            return Ok(Vec::new());
        }
        let places = self.progress.places(&model.system, &model.turtle)?;
        let body = space.of_plant(self.position, self.yaw);
        let gone = places.iter().filter(|one| leaves(&one.kind));
        let shed = gone.map(|one| Shed {
            is_seed: model.seeds.contains(&one.kind),
            from: body.point(one.position),
        });
        let shed = shed.collect();
        lineage.retain(|module| !leaves(&places[module].kind));
        self.keep(model, |module| !leaves(&places[module].kind));
        Ok(shed)
    }

    /// Removes the other modules; letters of removed ones are not sent.
    fn keep(&mut self, model: &Model, keep: impl Fn(usize) -> bool) {
        let mut renumbered = Vec::with_capacity(self.progress.modules());
        let mut number = 0;
        for module in 0..self.progress.modules() {
            renumbered.push(keep(module).then_some(number));
            number += usize::from(keep(module));
        }
        self.progress.retain(&model.system, |module| renumbered[module].is_some());
        // What it draws has other numbers now.
        self.between = Between::default();
        self.letters.retain_mut(|letter| match renumbered[letter.module] {
            Some(number) => {
                letter.module = number;
                true
            }
            None => false,
        });
    }

    /// Loses the small branch nearest to a mouth (world space); how many modules went.
    pub fn bite(&mut self, model: &Model, space: &Space, mouth: Vec3) -> Result<usize> {
        let places = self.progress.places(&model.system, &model.turtle)?;
        let near = self.own(space, mouth);
        let size = |one: &Placed| self.progress.end_of_branch(one.module) - one.module;
        let far = |one: &&Placed| one.position.distance_squared(near);
        let small = places.iter().filter(|one| one.depth > 0 && !is_bracket(one.kind));
        let small = small.filter(|one| size(one) <= MOUTHFUL);
        // A sprout without branches goes as a whole.
        let sprout = places.iter().filter(|one| size(one) <= MOUTHFUL && !is_bracket(one.kind));
        let nearest = small.min_by(|a, b| far(a).total_cmp(&far(b)));
        let Some(place) = nearest.or_else(|| sprout.min_by(|a, b| far(a).total_cmp(&far(b))))
        else {
            return Ok(0);
        };
        Ok(self.cut(model, place.module))
    }

    /// Loses everything from where it enters a ball (world space) on; how many modules went.
    pub fn prune(
        &mut self,
        model: &Model,
        space: &Space,
        center: Vec3,
        radius: f32,
    ) -> Result<usize> {
        let ball =
            Shape::Ball { center: self.own(space, center), radius: radius / self.size(space) };
        self.cut_where(model, |place| ball.distance(place) < 0.0)
    }

    /// Loses everything from where it leaves a shape (metres from its foot) on; how many modules went.
    pub fn clip(&mut self, model: &Model, space: &Space, shape: &Shape) -> Result<usize> {
        let size = self.size(space);
        self.cut_where(model, |place| shape.distance(place * size) > 0.0)
    }

    fn cut_where(&mut self, model: &Model, gone: impl Fn(Vec3) -> bool) -> Result<usize> {
        let places = self.progress.places(&model.system, &model.turtle)?;
        let mut keep = vec![true; places.len()];
        let mut module = 0;
        while module < places.len() {
            let place = &places[module];
            if is_bracket(place.kind) || !gone(place.position) {
                module += 1;
                continue;
            }
            let end = self.progress.end_of_branch(module);
            keep[module..end].fill(false);
            module = end;
        }
        let lost = keep.iter().filter(|kept| !**kept).count();
        if lost > 0 {
            self.keep(model, |module| keep[module]);
        }
        Ok(lost)
    }

    fn cut(&mut self, model: &Model, module: usize) -> usize {
        let end = self.progress.end_of_branch(module);
        self.keep(model, |one| one < module || one >= end);
        end - module
    }

    fn size(&self, space: &Space) -> f32 {
        space.size
    }

    /// A place of the world in the plant's own space.
    fn own(&self, space: &Space, place: Vec3) -> Vec3 {
        let body = space.of_plant(self.position, self.yaw);
        body.rotation().inverse() * ((place - body.position) / body.scale)
    }
}

fn is_bracket(kind: u8) -> bool {
    kind == bioscope_lsystem::Alphabet::OPEN || kind == bioscope_lsystem::Alphabet::CLOSE
}
