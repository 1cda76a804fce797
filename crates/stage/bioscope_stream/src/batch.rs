use bioscope_core::Id;
use bioscope_geometry::{Batch, Key, Transform};
use bytemuck::cast_slice;
use serde::Serialize;
use serde_bytes::Bytes;

use crate::asset::encode;

#[derive(Serialize)]
struct BatchMessage<'a> {
    r#type: &'static str,
    key: u64,
    name: &'a str,
    species: &'a str,
    mesh: u64,
    material: u64,
    alive: bool,
    count: usize,
    ids: &'a Bytes,
    transforms: &'a Bytes,
    tints: Option<&'a Bytes>,
    joints: usize,
}

/// A batch as pages know it: frames only say what has moved since.
pub struct Laid {
    /// Key of its message.
    pub key: Key,
    /// Where its instances were.
    pub transforms: Vec<Transform>,
    mesh: u64,
    material: u64,
    joints: usize,
    alive: bool,
    ids: Vec<Id>,
}

impl Laid {
    /// A batch as it is now.
    pub fn of(batch: &Batch) -> Self {
        Self {
            key: Key::default(),
            transforms: batch.transforms.clone(),
            mesh: batch.mesh.key.number(),
            material: batch.material.key.number(),
            joints: batch.joint_count(),
            alive: batch.alive,
            ids: batch.ids.clone(),
        }
    }

    /// Whether the same individuals are still there, with the same looks.
    pub fn fits(&self, batch: &Batch) -> bool {
        self.mesh == batch.mesh.key.number()
            && self.material == batch.material.key.number()
            && self.joints == batch.joint_count()
            && self.alive == batch.alive
            && self.ids == batch.ids
    }

    /// The message that describes it.
    pub fn message(&self, batch: &Batch) -> Vec<u8> {
        encode(&BatchMessage {
            r#type: "batch",
            key: self.key.number(),
            name: &batch.name,
            species: &batch.species,
            mesh: self.mesh,
            material: self.material,
            alive: self.alive,
            count: batch.ids.len(),
            ids: Bytes::new(cast_slice(&batch.ids)),
            transforms: Bytes::new(cast_slice(&batch.transforms)),
            tints: (!batch.tints.is_empty()).then(|| Bytes::new(cast_slice(&batch.tints))),
            joints: self.joints,
        })
    }
}
