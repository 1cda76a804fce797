use bioscope_core::Id;
use bioscope_geometry::{Batch, Medium, Scene, Sky, Sun, Transform};
use bytemuck::cast_slice;
use serde::Serialize;
use serde_bytes::Bytes;

use crate::asset::encode;
use crate::quantize::bounds;

#[derive(Serialize)]
struct LayoutMessage<'a> {
    r#type: &'static str,
    revision: u64,
    batches: Vec<BatchMessage<'a>>,
    points: Vec<PointsMessage<'a>>,
    sun: &'a Sun,
    sky: &'a Sky,
    medium: &'a Medium,
    bounds: [f32; 6],
}

#[derive(Serialize)]
struct BatchMessage<'a> {
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

#[derive(Serialize)]
struct PointsMessage<'a> {
    name: &'a str,
    species: &'a str,
    color: [f32; 3],
    opacity: f32,
    glassy: bool,
}

/// What a layout depends on, to notice when a new one is due.
#[derive(Clone, PartialEq)]
pub struct Signature {
    batches: Vec<BatchSignature>,
    points: Vec<(String, [f32; 3], bool)>,
    light: (Sun, Sky, Medium),
}

#[derive(Clone, PartialEq)]
struct BatchSignature {
    name: String,
    mesh: u64,
    material: u64,
    ids: Vec<Id>,
    /// Frames do not say how large things are.
    scales: Vec<f32>,
}

impl Signature {
    /// The signature of a scene.
    pub fn of(scene: &Scene) -> Self {
        let batch = |batch: &Batch| BatchSignature {
            name: batch.name.clone(),
            mesh: batch.mesh.key.number(),
            material: batch.material.key.number(),
            ids: batch.ids.clone(),
            scales: batch.transforms.iter().map(|one| one.scale).collect(),
        };
        let points = scene.points.iter().map(|one| (one.name.clone(), one.color, one.glassy));
        Self {
            batches: scene.batches.iter().map(batch).collect(),
            points: points.collect(),
            light: (scene.sun, scene.sky, scene.medium),
        }
    }
}

/// The message that lays out everything but motion.
pub fn layout(scene: &Scene, revision: u64) -> Vec<u8> {
    let batches = scene.batches.iter().map(|batch| BatchMessage {
        name: &batch.name,
        species: &batch.species,
        mesh: batch.mesh.key.number(),
        material: batch.material.key.number(),
        alive: batch.alive,
        count: batch.ids.len(),
        ids: Bytes::new(cast_slice(&batch.ids)),
        transforms: Bytes::new(cast_slice(&batch.transforms)),
        tints: (!batch.tints.is_empty()).then(|| Bytes::new(cast_slice(&batch.tints))),
        joints: batch.joint_count(),
    });
    let points = scene.points.iter().map(|points| PointsMessage {
        name: &points.name,
        species: &points.species,
        color: points.color,
        opacity: points.opacity,
        glassy: points.glassy,
    });
    let (low, high) = bounds(scene.batches.iter().flat_map(corners));
    encode(&LayoutMessage {
        r#type: "layout",
        revision,
        batches: batches.collect(),
        points: points.collect(),
        sun: &scene.sun,
        sky: &scene.sky,
        medium: &scene.medium,
        bounds: [low.x, low.y, low.z, high.x, high.y, high.z],
    })
}

/// Points that span a batch: the box of its mesh around each instance, in any rotation.
fn corners(batch: &Batch) -> impl Iterator<Item = bioscope_core::Vec3> + '_ {
    let (low, high) = batch.mesh.bounds();
    let (center, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
    let exact = batch.transforms.len() == 1 && batch.transforms[0] == Transform::IDENTITY;
    batch.transforms.iter().flat_map(move |transform| {
        if exact {
            return [low, high];
        }
        let (middle, reach) = (transform.point(center), radius * transform.scale);
        [middle - reach, middle + reach]
    })
}
