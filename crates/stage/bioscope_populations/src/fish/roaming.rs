//! Single fishes with minds of their own, as [`Animals`](crate::animals::Animals) run them.

use std::sync::Arc;

use bioscope_core::{Error, Result, state};
use bioscope_minds::{Mind, Roamer};
use bioscope_motion::{Swimmer, SwimmerParameters};
use bioscope_senses::{Hearing, LateralLine, Light, Sight, Touch};

use super::FishSpecies;
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

/// A fish of this look and species with all senses, a swimming body and this mind; none gives it the mind
/// of a [`Roamer`].
pub fn roaming(
    species: &FishSpecies,
    look: &Arc<Look>,
    mind: Option<Box<dyn Mind>>,
) -> Result<Animal> {
    let spine = look
        .spine
        .clone()
        .ok_or_else(|| Error::value("look", &look.species, "the look of a fish, with a spine"))?;
    let parameters =
        SwimmerParameters { top_speed: species.swimming.burst, ..SwimmerParameters::default() };
    Ok(Animal {
        senses: vec![
            Box::new(Sight::default()),
            Box::new(Touch::default()),
            Box::new(Hearing::default()),
            Box::new(LateralLine),
            Box::new(Light),
        ],
        mind: mind.unwrap_or_else(|| Box::new(Roamer::default())),
        body: Box::new(Swimmer::new(spine, 1.0, parameters)?),
        look: look.clone(),
        may_fail: false,
    })
}
