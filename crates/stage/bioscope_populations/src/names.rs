//! Names of what populations publish.

use bioscope_geometry::Scene;

/// `wanted` if nothing in the scene has this name yet, else the first free of `wanted-2`, `wanted-3`…
pub(crate) fn free_name(scene: &Scene, wanted: &str) -> String {
    let taken = |name: &str| {
        scene.batches.iter().any(|one| one.name == name)
            || scene.points.iter().any(|one| one.name == name)
    };
    let numbered = (2..).map(|number| format!("{wanted}-{number}"));
    let mut names = std::iter::once(wanted.to_owned()).chain(numbered);
    names.find(|name| !taken(name)).expect("names are endless")
}
