//! The populations: assemblies of faculties that live in a world, one folder each.

pub mod drifters;
mod names;
pub mod placement;

use bioscope_world::{Population, Registry};

/// A registry that knows every population and field of the engine.
pub fn registry() -> Registry {
    let mut registry = Registry::default();
    add_drifters(&mut registry);
    registry
}

fn add_drifters(registry: &mut Registry) {
    use drifters::{Bubbles, Plankton};
    registry.add_population("plankton", |bytes| boxed(Plankton::from_saved(bytes)));
    registry.add_population("bubbles", |bytes| boxed(Bubbles::from_saved(bytes)));
}

fn boxed<P: Population + 'static>(
    population: bioscope_core::Result<P>,
) -> bioscope_core::Result<Box<dyn Population>> {
    Ok(Box::new(population?))
}
