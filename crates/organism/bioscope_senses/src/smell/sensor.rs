use std::sync::Arc;

use bioscope_core::{Parameters, Percepts, Result, Sighting, parameters, state};
use serde::{Deserialize, Serialize};

use crate::outlook::{Kind, Thing};
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
}

impl Smell {
    /// Smell for food of these species.
    pub fn new(foods: Vec<Arc<str>>, parameters: SmellParameters) -> Self {
        Self { parameters, foods }
    }
}

impl Sense for Smell {
    fn kind(&self) -> &str {
        "smell"
    }

    fn sense(&mut self, surroundings: &Surroundings, percepts: &mut Percepts) -> Result<()> {
        percepts.smelled.clear();
        if self.foods.is_empty() {
            return Ok(());
        }
        let scene = surroundings.scene();
        let is_food = |species: &Arc<str>| self.foods.iter().any(|food| food == species);
        let batches: Vec<bool> = scene.batches.iter().map(|one| is_food(&one.species)).collect();
        let points: Vec<bool> = scene.points.iter().map(|one| is_food(&one.species)).collect();
        let range = self.parameters.range * surroundings.body_length;
        let mut morsels: Vec<(f32, Thing)> = Vec::new();
        surroundings.outlook.near(
            surroundings.position,
            |_| range,
            |thing| {
                let smells = match thing.kind {
                    Kind::Instance => batches[thing.group as usize],
                    Kind::Point => points[thing.group as usize],
                };
                let square = thing.position.distance_squared(surroundings.position);
                if smells && square <= range * range && thing.id != surroundings.id {
                    morsels.push((square, *thing));
                }
            },
        );
        let order =
            |a: &(f32, Thing), b: &(f32, Thing)| a.0.total_cmp(&b.0).then(a.1.id.cmp(&b.1.id));
        let attention = self.parameters.attention as usize;
        if attention > 0 && morsels.len() > attention {
            morsels.select_nth_unstable_by(attention - 1, order);
        }
        morsels.truncate(attention);
        morsels.sort_unstable_by(order);
        percepts.smelled.extend(morsels.iter().map(|(_, thing)| sighting(surroundings, thing)));
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

/// A smelled thing: where and of what kind it is; a smell tells neither color nor motion.
fn sighting(surroundings: &Surroundings, thing: &Thing) -> Sighting {
    let (scene, group) = (surroundings.scene(), thing.group as usize);
    let species = match thing.kind {
        Kind::Instance => &scene.batches[group].species,
        Kind::Point => &scene.points[group].species,
    };
    Sighting {
        id: thing.id,
        species: species.clone(),
        position: surroundings.own_point(thing.position),
        size: thing.size,
        ..Sighting::default()
    }
}
