use std::sync::Arc;

use bioscope_geometry::{Material, Mesh};
use bioscope_motion::undulation::Spine;

/// What an animal looks like and how its shape bends: shared by all that look alike.
#[derive(Clone, Debug)]
pub struct Look {
    /// Word under which saved worlds find the constructor.
    pub kind: String,
    /// What the constructor needs to build the same look again.
    pub description: Vec<u8>,
    /// Species under which it appears in the scene.
    pub species: Arc<str>,
    /// Shape, looking along +Z.
    pub mesh: Arc<Mesh>,
    /// Surface.
    pub material: Arc<Material>,
    /// Anatomy of a body that undulates; none for other bodies.
    pub spine: Option<Arc<Spine>>,
}

impl Look {
    /// How many joints the mesh has.
    pub fn joint_count(&self) -> usize {
        self.mesh.skin.as_ref().map_or(0, |skin| skin.joints.len())
    }

    /// Whether both are of the same kind and description.
    pub(super) fn equals(&self, other: &Self) -> bool {
        let same = || self.kind == other.kind && self.description == other.description;
        std::ptr::eq(self, other) || same()
    }
}
