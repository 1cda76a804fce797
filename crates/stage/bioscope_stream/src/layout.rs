use bioscope_geometry::{Batch, Medium, Scene, Sky, Sun, Transform};
use serde::Serialize;

use crate::asset::encode;
use crate::quantize::bounds;

#[derive(Serialize)]
struct LayoutMessage<'a> {
    r#type: &'static str,
    revision: u64,
    batches: Vec<u64>,
    points: Vec<PointsMessage<'a>>,
    sun: &'a Sun,
    sky: &'a Sky,
    medium: &'a Medium,
    bounds: [f32; 6],
}

#[derive(Serialize)]
struct PointsMessage<'a> {
    name: &'a str,
    species: &'a str,
    color: [f32; 3],
    opacity: f32,
    glassy: bool,
}

/// What a layout depends on beside its batches, to notice when a new one is due.
#[derive(Clone, PartialEq)]
pub struct Surroundings {
    points: Vec<(String, [f32; 3], bool)>,
    light: (Sun, Sky, Medium),
}

impl Surroundings {
    /// The surroundings in a scene.
    pub fn of(scene: &Scene) -> Self {
        let points = scene.points.iter().map(|one| (one.name.clone(), one.color, one.glassy));
        Self { points: points.collect(), light: (scene.sun, scene.sky, scene.medium) }
    }
}

/// The message that lays out everything but motion; `batches` are the keys of their messages.
pub fn layout(scene: &Scene, batches: Vec<u64>, revision: u64) -> Vec<u8> {
    let points = scene.points.iter().map(|points| PointsMessage {
        name: &points.name,
        species: &points.species,
        color: points.color,
        opacity: points.opacity,
        glassy: points.glassy,
    });
    let (low, high) =
        bounds(scene.batches.iter().filter(|one| !one.ids.is_empty()).flat_map(corners));
    encode(&LayoutMessage {
        r#type: "layout",
        revision,
        batches,
        points: points.collect(),
        sun: &scene.sun,
        sky: &scene.sky,
        medium: &scene.medium,
        bounds: [low.x, low.y, low.z, high.x, high.y, high.z],
    })
}

/// Points that span a batch: the box round its instances, each of them in any rotation.
fn corners(batch: &Batch) -> [bioscope_core::Vec3; 2] {
    let (low, high) = batch.mesh.bounds();
    if batch.transforms.len() == 1 && batch.transforms[0] == Transform::IDENTITY {
        return [low, high];
    }
    let (least, greatest) = bounds(batch.transforms.iter().map(|one| one.position));
    let largest = batch.transforms.iter().map(|one| one.scale).fold(0.0, f32::max);
    let reach = largest * ((low + high).length() + (high - low).length()) / 2.0;
    [least - reach, greatest + reach]
}
