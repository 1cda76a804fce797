use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_geometry::{Mesh, Scene};

use crate::frame::Placed;
use crate::layout::Signature;
use crate::{asset, frame, layout};

/// What a frame says beside the scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct Status {
    /// Whether the world is running.
    pub running: bool,
    /// Times real time; none for as fast as possible.
    pub speed: Option<f64>,
    /// Ticks per second achieved.
    pub rate: f64,
    /// Whether to send annotations.
    pub annotations: bool,
}

/// A shared thing that a page must have before the layout that uses it.
#[derive(Clone, Debug)]
pub struct Asset {
    /// Unique in the process.
    pub key: u64,
    /// The message.
    pub bytes: Arc<[u8]>,
}

/// What came of encoding one scene.
pub struct Update {
    /// The present layout's revision.
    pub revision: u64,
    /// A new layout, if one was due.
    pub layout: Option<Arc<[u8]>>,
    /// The frame.
    pub frame: Vec<u8>,
}

/// Turns the scenes of one world into messages, remembering what stays the same.
#[derive(Default)]
pub struct Encoder {
    assets: BTreeMap<u64, Arc<[u8]>>,
    revision: u64,
    signature: Option<Signature>,
    placed: Placed,
}

impl Encoder {
    /// Encodes a scene: a frame, and a layout if things came, went or changed their looks.
    pub fn encode(&mut self, scene: &Scene, status: &Status) -> Update {
        let signature = Signature::of(scene);
        let mut message = None;
        if self.signature.as_ref() != Some(&signature) {
            self.signature = Some(signature);
            self.revision += 1;
            self.placed = scene
                .batches
                .iter()
                .map(|one| (one.name.clone(), one.transforms.clone()))
                .collect();
            self.collect_assets(scene);
            message = Some(layout::layout(scene, self.revision).into());
        }
        let frame = frame::frame(scene, self.revision, &self.placed, status);
        Update { revision: self.revision, layout: message, frame }
    }

    /// Everything that the present layout uses, in an order in which each comes before its first use.
    pub fn assets(&self) -> impl Iterator<Item = Asset> + '_ {
        self.assets.iter().map(|(key, bytes)| Asset { key: *key, bytes: bytes.clone() })
    }

    /// Keeps the messages of what the scene uses, makes the missing ones, forgets the others.
    fn collect_assets(&mut self, scene: &Scene) {
        let mut old = std::mem::take(&mut self.assets);
        let mut keep = |key: u64, make: &dyn Fn() -> Vec<u8>| {
            let known = || old.remove(&key).unwrap_or_else(|| make().into());
            self.assets.entry(key).or_insert_with(known);
        };
        for batch in &scene.batches {
            let material = &batch.material;
            if let Some(texture) = &material.texture {
                keep(texture.key.number(), &|| asset::texture(texture));
            }
            keep(material.key.number(), &|| asset::material(material));
            keep_mesh(&batch.mesh, &mut keep);
        }
    }
}

fn keep_mesh(mesh: &Mesh, keep: &mut impl FnMut(u64, &dyn Fn() -> Vec<u8>)) {
    keep(mesh.key.number(), &|| asset::mesh(mesh));
    for (_, level) in &mesh.levels {
        keep_mesh(level, keep);
    }
}

#[cfg(test)]
mod tests {
    use bioscope_core::Vec3;
    use bioscope_geometry::{Batch, Joint, Material, Skin, Transform};

    use super::*;

    fn scene(count: u32, x: f32) -> Scene {
        let joint = Joint { name: String::from("root"), parent: None, rest: Transform::IDENTITY };
        let skin = Skin {
            joints: vec![joint],
            indices: vec![[0; 4]; 3],
            weights: vec![[1.0, 0.0, 0.0, 0.0]; 3],
        };
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z; 3],
            triangles: vec![[0, 1, 2]],
            skin: Some(skin),
            ..Mesh::default()
        };
        let mut batch = Batch::new("fish", "fish", Arc::new(mesh), Arc::new(Material::default()));
        batch.ids = (1..=count).collect();
        batch.transforms = vec![Transform::at(Vec3::X * x); count as usize];
        batch.poses = vec![Transform::at(Vec3::Y * x); count as usize];
        Scene { batches: vec![batch], ..Scene::default() }
    }

    #[test]
    fn a_layout_is_sent_when_things_come_and_only_then() {
        let mut encoder = Encoder::default();
        let status = Status::default();
        let mut now = scene(2, 0.0);
        assert!(encoder.encode(&now, &status).layout.is_some());
        now.batches[0].transforms[0] = Transform::at(Vec3::Z);
        let update = encoder.encode(&now, &status);
        assert!(update.layout.is_none());
        now.batches[0].ids.push(9);
        now.batches[0].transforms.push(Transform::IDENTITY);
        now.batches[0].poses.push(Transform::IDENTITY);
        let update = encoder.encode(&now, &status);
        assert_eq!((update.layout.is_some(), update.revision), (true, 2));
    }

    #[test]
    fn assets_are_kept_while_used_and_forgotten_after() {
        let mut encoder = Encoder::default();
        encoder.encode(&scene(1, 0.0), &Status::default());
        let first: Vec<u64> = encoder.assets().map(|asset| asset.key).collect();
        assert_eq!(first.len(), 2);
        encoder.encode(&scene(1, 0.0), &Status::default());
        assert!(encoder.assets().all(|asset| !first.contains(&asset.key)));
    }

    #[test]
    fn what_rests_is_not_in_the_frame() {
        let mut encoder = Encoder::default();
        let mut now = scene(300, 1.0);
        let moving = encoder.encode(&now, &Status::default()).frame.len();
        now.batches[0].poses.clear();
        let resting = encoder.encode(&now, &Status::default()).frame.len();
        assert!(moving > 300 * 14 && resting < 300, "{moving} {resting}");
    }
}
