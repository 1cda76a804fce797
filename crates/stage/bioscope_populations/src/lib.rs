//! The populations: assemblies of faculties that live in a world, one folder each.

pub mod animals;
pub mod bites;
pub mod catalog;
pub mod drifters;
pub mod fish;
pub mod fishing;
mod kept;
mod names;
pub mod placement;
pub mod plants;
pub mod scenery;
pub mod stand;
mod suction;

use std::sync::Arc;

use bioscope_core::{Error, Result};
use bioscope_lsystem::Environment;
use bioscope_world::{Population, Registry};

/// A registry that knows every population and field of the engine.
pub fn registry() -> Registry {
    let mut registry = Registry::default();
    add_animals(&mut registry, Arc::default());
    add_drifters(&mut registry);
    registry.add_population("fishing_line", |bytes| boxed(fishing::FishingLine::from_saved(bytes)));
    registry.add_population("fish_school", |bytes| boxed(fish::FishSchool::from_saved(bytes)));
    registry.add_population("plants", |bytes| boxed(plants::Plants::from_saved(bytes)));
    add_stands(&mut registry, |name| {
        let known = bioscope_lsystem::environment_names().iter().map(|&name| name.to_owned());
        Err(Error::Unknown { kind: "environment", name: name.to_owned(), known: known.collect() })
    });
    add_scenery(&mut registry);
    registry
}

/// Teaches a registry to bring back [`Animals`](animals::Animals) whose parts these kinds know.
pub fn add_animals(registry: &mut Registry, kinds: Arc<animals::Kinds>) {
    registry.add_population("animals", move |bytes| {
        boxed(animals::Animals::from_saved(bytes, kinds.clone()))
    });
}

/// Teaches a registry to bring back a [`Stand`](stand::Stand); `revive` brings back by name an environment that is
/// none of the engine's.
pub fn add_stands(
    registry: &mut Registry,
    revive: impl Fn(&str) -> Result<Box<dyn Environment>> + Send + Sync + 'static,
) {
    registry.add_population("stand", move |bytes| boxed(stand::Stand::from_saved(bytes, &revive)));
}

fn add_drifters(registry: &mut Registry) {
    use drifters::{Bubbles, Plankton};
    registry.add_population("plankton", |bytes| boxed(Plankton::from_saved(bytes)));
    registry.add_population("bubbles", |bytes| boxed(Bubbles::from_saved(bytes)));
}

fn add_scenery(registry: &mut Registry) {
    use scenery::{Corals, Ground, Props, Rocks};
    registry.add_population("ground", |bytes| boxed(Ground::from_saved(bytes)));
    registry.add_population("rocks", |bytes| boxed(Rocks::from_saved(bytes)));
    registry.add_population("corals", |bytes| boxed(Corals::from_saved(bytes)));
    registry.add_population("props", |bytes| boxed(Props::from_saved(bytes)));
}

fn boxed<P: Population + 'static>(
    population: bioscope_core::Result<P>,
) -> bioscope_core::Result<Box<dyn Population>> {
    Ok(Box::new(population?))
}
