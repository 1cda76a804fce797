use std::collections::BTreeMap;

use bioscope_core::{NOTHING, Percepts, Value};
use bioscope_world::Inspection;

use super::individual::Individual;

/// What can be known of an animal.
pub(super) fn inspect(individual: &Individual) -> Inspection {
    let (parts, record) = (&individual.parts, &individual.record);
    let body = &parts.body;
    let intention = &record.intention;
    let mut values = body.values();
    values.append(&mut parts.mind.values());
    values.insert("body_length_m".into(), body.length().into());
    values.insert("wanted_speed_body_lengths_per_s".into(), intention.speed.into());
    values.insert("wanted_heading".into(), intention.heading.into());
    values.insert("urgency".into(), intention.urgency.into());
    values.insert("steered".into(), record.steering.is_some().into());
    if let Some(target) = intention.target {
        values.insert("target".into(), f64::from(target).into());
    }
    let placement = body.placement();
    Inspection {
        species: parts.look.species.to_string(),
        behavior: Some(intention.behavior.to_string()),
        values,
        traits: super::settings::traits(parts),
        percepts: percepts(&record.percepts),
        eye: parts.senses.iter().find_map(|sense| sense.eye(&placement, body.length())),
    }
}

/// One value of an animal's inner life: `id`, `intention` (the behavior that won), `target` (an identity, 0
/// for nobody), or what its mind or body tells under this name.
pub(super) fn value(individual: &Individual, name: &str) -> Option<Value> {
    let (parts, intention) = (&individual.parts, &individual.record.intention);
    match name {
        "id" => Some(f64::from(individual.id).into()),
        "intention" => Some((&*intention.behavior).into()),
        "target" => Some(f64::from(intention.target.unwrap_or(NOTHING)).into()),
        _ => parts.mind.values().remove(name).or_else(|| parts.body.values().remove(name)),
    }
}

/// Percepts as named values, with units.
pub(crate) fn percepts(percepts: &Percepts) -> BTreeMap<String, Value> {
    let mut values = percepts.other.clone();
    let mut note = |name: &str, value: Value| values.insert(name.to_owned(), value);
    note("seen", (percepts.seen.len() as f64).into());
    if let Some(nearest) = percepts.seen.first() {
        note("nearest_species", (&*nearest.species).into());
        note("nearest_id", f64::from(nearest.id).into());
        note("nearest_distance_m", nearest.position.length().into());
        note("nearest_direction", nearest.position.normalize_or_zero().into());
    }
    if let Some(impact) = percepts.ahead {
        note("obstacle_ahead_m", impact.distance.into());
    }
    if let Some(loudest) = percepts.heard.first() {
        note("heard", loudest.kind.as_ref().into());
        note("heard_direction", loudest.direction.into());
    }
    note("depth_m", percepts.depth.into());
    note("home_distance_m", percepts.home.length().into());
    note("flow_m_per_s", percepts.flow.into());
    note("smelled", (percepts.smelled.len() as f64).into());
    note("light", percepts.light.into());
    note("temperature_degc", percepts.temperature.into());
    values
}
