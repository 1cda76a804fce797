use std::sync::Arc;

use bioscope_core::{Parameters, Percepts, Result, Sighting, parameters, state};
use serde::{Deserialize, Serialize};

use crate::outlook::{Reach, Register, Shortlist, Thing};
use crate::{Sense, Surroundings};

parameters! {
    /// How well an animal smells.
    pub struct SmellParameters {
        /// Distance up to which food is smelled, `O_r`.
        range: f32 = 20.0, "BL", 0.0..=1000.0, "choice; Tu 1996 asks for more than sight's range";
        /// How many morsels it attends to at once, the nearest first.
        attention: f32 = 8.0, "1", 0.0..=1000.0, "choice";
    }
}

/// Smell of food; see the [module](self).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Smell {
    parameters: SmellParameters,
    /// Species that smell of food.
    foods: Vec<Arc<str>>,
    /// Those among what moves, among what stays where it is, and among points.
    #[serde(skip)]
    shortlists: [Shortlist; 3],
}

/// Food within range.
#[derive(Clone, Copy)]
struct Morsel {
    /// Square of its distance, metres squared.
    square: f32,
    is_point: bool,
    thing: Thing,
}

impl Smell {
    /// Smell for food of these species.
    pub fn new(foods: Vec<Arc<str>>, parameters: SmellParameters) -> Self {
        Self { parameters, foods, shortlists: Default::default() }
    }
}

impl Sense for Smell {
    fn kind(&self) -> &str {
        "smell"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        if self.foods.is_empty() {
            percepts.smelled.clear();
            return Ok(());
        }
        let Self { parameters, foods, shortlists: [among_movers, among_stays, among_points] } =
            self;
        let (scene, outlook) = (surroundings.scene(), surroundings.outlook);
        let is_food = |species: &Arc<str>| foods.iter().any(|food| food == species);
        let batches: Vec<bool> = scene.batches.iter().map(|one| is_food(&one.species)).collect();
        let points: Vec<bool> = scene.points.iter().map(|one| is_food(&one.species)).collect();
        let (place, range) = (surroundings.position, parameters.range * surroundings.body_length);
        let mut morsels: Vec<Morsel> = Vec::new();
        let mut smell =
            |register: &Register, shortlist: &mut Shortlist, food: &[bool], is_point| {
                if !food.contains(&true) {
                    return;
                }
                let keep = |thing: &Thing| food[thing.group as usize];
                shortlist.near(register, (place, Reach { range, least: 0.0 }), keep, |thing| {
                    let square = thing.position.distance_squared(place);
                    // Another thing may have come in the place of food.
                    if square <= range * range && thing.id != surroundings.id && keep(thing) {
                        morsels.push(Morsel { square, is_point, thing: *thing });
                    }
                });
            };
        smell(outlook.movers(), among_movers, &batches, false);
        smell(outlook.stays(), among_stays, &batches, false);
        smell(outlook.points(), among_points, &points, true);
        let order = |a: &Morsel, b: &Morsel| {
            a.square.total_cmp(&b.square).then(a.thing.id.cmp(&b.thing.id))
        };
        let attention = parameters.attention as usize;
        if attention > 0 && morsels.len() > attention {
            morsels.select_nth_unstable_by(attention - 1, order);
        }
        morsels.truncate(attention);
        morsels.sort_unstable_by(order);
        percepts.smelled.resize_with(morsels.len(), Sighting::default);
        for (sighting, morsel) in percepts.smelled.iter_mut().zip(&morsels) {
            smell_of(surroundings, morsel, sighting);
        }
        Ok(())
    }

    fn parameters(&self) -> Option<&dyn Parameters> {
        Some(&self.parameters)
    }

    fn parameters_mut(&mut self) -> Option<&mut dyn Parameters> {
        Some(&mut self.parameters)
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(self))
    }
}

/// Notes a smelled thing in place of another one: where and of what kind it is; a smell tells neither color nor motion.
fn smell_of(surroundings: &Surroundings, morsel: &Morsel, sighting: &mut Sighting) {
    let Morsel { is_point, thing, .. } = morsel;
    let (scene, group) = (surroundings.scene(), thing.group as usize);
    let species =
        if *is_point { &scene.points[group].species } else { &scene.batches[group].species };
    sighting.is_of(species);
    sighting.id = thing.id;
    sighting.position = surroundings.own_point(thing.position);
    sighting.size = thing.size;
}
