use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_geometry::{Batch, Mesh, Scene};

use crate::batch::Laid;
use crate::layout::Surroundings;
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
    surroundings: Option<Surroundings>,
    laid: BTreeMap<String, Laid>,
}

impl Encoder {
    /// Encodes a scene: a frame, and a layout if things came, went or changed their looks.
    pub fn encode(&mut self, scene: &Scene, status: &Status) -> Update {
        let surroundings = Surroundings::of(scene);
        let fits = |batch: &Batch| self.laid.get(&batch.name).is_some_and(|one| one.fits(batch));
        let same = self.surroundings.as_ref() == Some(&surroundings)
            && self.laid.len() == scene.batches.len()
            && scene.batches.iter().all(fits);
        let mut message = None;
        if !same {
            self.surroundings = Some(surroundings);
            self.revision += 1;
            let keys = self.lay_out(scene);
            message = Some(layout::layout(scene, keys, self.revision).into());
        }
        let frame = frame::frame(scene, self.revision, &self.laid, status);
        Update { revision: self.revision, layout: message, frame }
    }

    /// Keys of everything that the present layout uses. In their order each comes before its first use.
    pub fn keys(&self) -> impl Iterator<Item = u64> + '_ {
        self.assets.keys().copied()
    }

    /// The message of one of them.
    pub fn asset(&self, key: u64) -> Option<&Arc<[u8]>> {
        self.assets.get(&key)
    }

    /// Keeps the messages of what the scene uses, makes the missing ones, forgets the others; keys of the batches.
    fn lay_out(&mut self, scene: &Scene) -> Vec<u64> {
        let mut old = std::mem::take(&mut self.assets);
        let mut laid = std::mem::take(&mut self.laid);
        let mut keep = |key: u64, make: &dyn Fn() -> Vec<u8>| {
            let known = || old.remove(&key).unwrap_or_else(|| make().into());
            self.assets.entry(key).or_insert_with(known);
        };
        let mut keys = Vec::with_capacity(scene.batches.len());
        for batch in &scene.batches {
            let material = &batch.material;
            if let Some(texture) = &material.texture {
                keep(texture.key.number(), &|| asset::texture(texture));
            }
            keep(material.key.number(), &|| asset::material(material));
            keep_mesh(&batch.mesh, &mut keep);
            let former = laid.remove(&batch.name).filter(|one| one.fits(batch));
            let one = former.unwrap_or_else(|| Laid::of(batch));
            keep(one.key.number(), &|| one.message(batch));
            keys.push(one.key.number());
            self.laid.insert(batch.name.clone(), one);
        }
        keys
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
    use bioscope_geometry::{Joint, Material, Skin, Transform};

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
        let first: Vec<u64> = encoder.keys().collect();
        assert_eq!(first.len(), 3);
        encoder.encode(&scene(1, 0.0), &Status::default());
        assert!(encoder.keys().all(|key| !first.contains(&key)));
    }

    #[test]
    fn only_the_batches_that_changed_are_sent_again() {
        let mut encoder = Encoder::default();
        let mut now = scene(2, 0.0);
        let mut other = now.batches[0].clone();
        other.name = String::from("crab");
        now.batches.push(other);
        encoder.encode(&now, &Status::default());
        let first: Vec<u64> = encoder.keys().collect();
        now.batches[1].ids[0] = 7;
        assert!(encoder.encode(&now, &Status::default()).layout.is_some());
        let second: Vec<u64> = encoder.keys().collect();
        let fresh = second.iter().filter(|key| !first.contains(key));
        assert_eq!((second.len(), fresh.count()), (4, 1));
    }

    #[test]
    fn growth_is_told_by_frames_alone() {
        let mut encoder = Encoder::default();
        let mut now = scene(200, 0.0);
        now.batches[0].poses.clear();
        encoder.encode(&now, &Status::default());
        now.batches[0].transforms[3].scale = 2.0;
        let update = encoder.encode(&now, &Status::default());
        assert!(update.layout.is_none() && update.frame.len() < 700, "{}", update.frame.len());
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
