//! What is seen of the surroundings that plants share: the water in their soil.

use std::sync::Arc;

use bioscope_geometry::{Batch, Material, Mesh};
use bioscope_world::Publication;

use super::Stand;
use crate::names::free_name;

/// Linear color of the surface of the greatest amount; those of less are darker.
const WATER: [f32; 3] = [0.06, 0.30, 0.85];
/// How much of what is behind a surface hides.
const OPACITY: f32 = 0.3;

/// A surface that shows an amount, or a painted field.
pub(super) struct Sight {
    mesh: Arc<Mesh>,
    material: Arc<Material>,
}

impl Stand {
    /// Takes notice of what the surroundings keep now, if that is to be seen.
    pub(super) fn look_around(&mut self) {
        let levels = &self.state.options.levels;
        let Some(&first) = levels.first() else { return };
        let Some(amounts) = self.environment.as_ref().and_then(|one| one.amounts()) else { return };
        let most = levels.iter().copied().fold(first, f32::max);
        let species = &self.state.options.species;
        let materials: Vec<_> = self.sights.drain(..).map(|sight| sight.material).collect();
        let material = |number: usize, make: &dyn Fn() -> Material| {
            materials.get(number).cloned().unwrap_or_else(|| Arc::new(make()))
        };
        let base = || Material {
            name: format!("{species} water"),
            two_sided: true,
            ..Material::default()
        };
        self.sights = if amounts.is_deep() {
            let surface = |(number, &level): (usize, &f32)| {
                let color = WATER.map(|part| part * (0.25 + 0.75 * level / most));
                let make = || Material { color, opacity: OPACITY, roughness: 0.35, ..base() };
                Sight { mesh: Arc::new(amounts.surface(level)), material: material(number, &make) }
            };
            levels.iter().enumerate().map(surface).collect()
        } else {
            let make = || Material { color: [1.0; 3], specular: 0.0, roughness: 1.0, ..base() };
            vec![Sight { mesh: Arc::new(amounts.sheet(most)), material: material(0, &make) }]
        };
    }

    pub(super) fn show_surroundings(&self, publication: &mut Publication) {
        let species: Arc<str> = Arc::from(self.state.options.species.as_str());
        for (number, sight) in self.sights.iter().enumerate() {
            if sight.mesh.triangles.is_empty() {
                continue;
            }
            let name = free_name(&publication.scene, &format!("{species}/water{number}"));
            let (mesh, material) = (sight.mesh.clone(), sight.material.clone());
            let mut batch = Batch::new(name, species.clone(), mesh, material);
            batch.ids.extend(self.state.surroundings);
            batch.transforms = vec![self.state.space.of_surroundings()];
            publication.scene.batches.push(batch);
        }
    }
}
