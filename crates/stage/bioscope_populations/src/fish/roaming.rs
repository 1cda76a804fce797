//! Single fishes with minds of their own, as [`Animals`](crate::animals::Animals) run them.

use std::sync::Arc;

use bioscope_core::{Error, Result, state};
use bioscope_minds::{Mind, Roamer};
use bioscope_motion::{Body, MuscleSwimmer, Swimmer, SwimmerParameters};
use bioscope_senses::{Hearing, LateralLine, Light, Sense, Sight, Smell, SmellParameters, Touch};
use serde::Deserialize;

use super::{FishSpecies, MindRequest};
use crate::animals::{Animal, Look};

/// What a fish of this species looks like.
pub fn look(species: &FishSpecies) -> Arc<Look> {
    let form = species.form();
    Arc::new(Look {
        kind: String::from("fish"),
        description: state::to_bytes(&(&species.name, species.text())),
        species: species.name.as_str().into(),
        mesh: form.mesh.clone(),
        material: form.material.clone(),
        spine: Some(Arc::new(form.spine.clone())),
    })
}

/// The look that this description stands for.
pub(crate) fn look_from(description: &[u8]) -> Result<Arc<Look>> {
    let (name, text): (String, String) = state::from_bytes("look of a fish", description)?;
    Ok(look(&*FishSpecies::named_or_parsed(&name, &text)?))
}

/// How a fish is moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// By geometric flight: [`Swimmer`].
    #[default]
    Swimmer,
    /// By muscles that pull springs in water: [`MuscleSwimmer`].
    MuscleSwimmer,
}

impl BodyKind {
    fn build(self, species: &FishSpecies, look: &Look) -> Result<Box<dyn Body>> {
        let spine = look.spine.clone().ok_or_else(|| {
            Error::value("look", &look.species, "the look of a fish, with a spine")
        })?;
        let top_speed = species.swimming.burst;
        let parameters = SwimmerParameters { top_speed, ..SwimmerParameters::default() };
        Ok(match self {
            Self::Swimmer => Box::new(Swimmer::new(spine, 1.0, parameters)?),
            Self::MuscleSwimmer => Box::new(MuscleSwimmer::new(spine, "calibrated")?),
        })
    }
}

/// A fish of this look and species with this mind and all senses, of which smell knows its food by species; no mind
/// gives it that of a [`Roamer`].
pub fn roaming(
    species: &FishSpecies,
    look: &Arc<Look>,
    mind: Option<Box<dyn Mind>>,
    food: &[Arc<str>],
    body: BodyKind,
) -> Result<Animal> {
    let senses: Vec<Box<dyn Sense>> = vec![
        Box::new(Sight::default()),
        Box::new(Smell::new(food.to_vec(), SmellParameters::default())),
        Box::new(Touch::default()),
        Box::new(Hearing::default()),
        Box::new(LateralLine),
        Box::new(Light),
    ];
    let mind = mind.unwrap_or_else(|| Box::new(Roamer::default()));
    let body = body.build(species, look)?;
    Ok(Animal { senses, mind, body, look: look.clone(), may_fail: false })
}

/// A fish of this look and species with the senses and mind of an artificial fish.
pub fn minded(
    species: &FishSpecies,
    look: &Arc<Look>,
    request: &MindRequest,
    body: BodyKind,
) -> Result<Animal> {
    let request = request.clone().of(species);
    let (senses, mind) = (request.senses(), request.build()?);
    let body = body.build(species, look)?;
    Ok(Animal { senses, mind, body, look: look.clone(), may_fail: false })
}
