//! The populations: assemblies of faculties that live in a world, one folder each.

use bioscope_world::Registry;

/// A registry that knows every population and field of the engine.
pub fn registry() -> Registry {
    Registry::default()
}
