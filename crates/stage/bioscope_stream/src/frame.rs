use std::collections::BTreeMap;

use bioscope_core::{Annotation, Mark};
use bioscope_geometry::{Batch, Points, Scene, Transform};
use serde::Serialize;
use serde_bytes::ByteBuf;

use crate::asset::encode;
use crate::batch::Laid;
use crate::{Status, quantize};

#[derive(Serialize)]
struct FrameMessage<'a> {
    r#type: &'static str,
    layout: u64,
    tick: u64,
    time: f64,
    running: bool,
    speed: Option<f64>,
    rate: f64,
    moving: BTreeMap<&'a str, MovingMessage>,
    drifting: BTreeMap<&'a str, DriftingMessage>,
    #[serde(skip_serializing_if = "Option::is_none")]
    annotations: Option<Vec<AnnotationMessage<'a>>>,
}

#[derive(Default, Serialize)]
struct MovingMessage {
    #[serde(skip_serializing_if = "Option::is_none")]
    r#box: Option<[f32; 6]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    positions: Option<ByteBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotations: Option<ByteBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    size: Option<[f32; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scales: Option<ByteBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    extent: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    poses: Option<ByteBuf>,
}

#[derive(Serialize)]
struct DriftingMessage {
    r#box: [f32; 6],
    positions: ByteBuf,
    radius: [f32; 2],
    radii: ByteBuf,
}

#[derive(Default, Serialize)]
struct AnnotationMessage<'a> {
    subject: u32,
    role: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<[f32; 6]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    center: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    text: Option<&'a str>,
}

/// The message that says where everything is now; `laid` has the batches as they are known, by name.
pub fn frame(
    scene: &Scene,
    revision: u64,
    laid: &BTreeMap<String, Laid>,
    status: &Status,
) -> Vec<u8> {
    let batches = scene.batches.iter();
    let moving = batches
        .filter_map(|batch| Some((batch.name.as_str(), moving(batch, laid.get(&batch.name)?)?)));
    let drifting = scene.points.iter().map(|points| (points.name.as_str(), drifting(points)));
    let annotations = || scene.annotations.iter().map(annotation).collect();
    encode(&FrameMessage {
        r#type: "frame",
        layout: revision,
        tick: scene.tick,
        time: scene.time,
        running: status.running,
        speed: status.speed,
        rate: status.rate,
        moving: moving.collect(),
        drifting: drifting.collect(),
        annotations: status.annotations.then(annotations),
    })
}

fn moving(batch: &Batch, laid: &Laid) -> Option<MovingMessage> {
    let mut message = MovingMessage::default();
    let [is_moved, is_turned, is_sized] = changes(&laid.transforms, &batch.transforms);
    if is_moved {
        let positions = || batch.transforms.iter().map(|one| one.position);
        let (low, high) = quantize::bounds(positions());
        message.r#box = Some(corners(low, high));
        message.positions = Some(quantize::points(positions(), low, high).into());
    }
    if is_turned {
        message.rotations = Some(quantize::rotations(batch.transforms.iter()).into());
    }
    if is_sized {
        let (size, scales) = quantize::scales(batch.transforms.iter().map(|one| one.scale));
        (message.size, message.scales) = (Some(size), Some(scales.into()));
    }
    if !batch.poses.is_empty() {
        let reach = batch.poses.iter().map(|pose| pose.position.abs().max_element());
        let extent = reach.fold(1e-6_f32, f32::max);
        message.extent = Some(extent);
        message.poses = Some(quantize::poses(batch.poses.iter(), extent).into());
    }
    let MovingMessage { positions, rotations, scales, poses, .. } = &message;
    let any = [positions, rotations, scales, poses].into_iter().any(Option::is_some);
    any.then_some(message)
}

/// Whether any has another position, rotation, scale.
fn changes(old: &[Transform], new: &[Transform]) -> [bool; 3] {
    let mut changes = [old.len() != new.len(); 3];
    for (old, new) in old.iter().zip(new) {
        changes[0] |= old.position != new.position;
        changes[1] |= old.rotation() != new.rotation();
        changes[2] |= old.scale != new.scale;
        if changes == [true; 3] {
            break;
        }
    }
    changes
}

fn drifting(points: &Points) -> DriftingMessage {
    let (low, high) = quantize::bounds(points.positions.iter().copied());
    let least = points.radii.iter().copied().fold(f32::INFINITY, f32::min).min(1e3);
    let greatest = points.radii.iter().copied().fold(0.0, f32::max).max(least);
    let step = 255.0 / (greatest - least).max(1e-9);
    let radii: Vec<u8> =
        points.radii.iter().map(|radius| ((radius - least) * step).round() as u8).collect();
    DriftingMessage {
        r#box: corners(low, high),
        positions: quantize::points(points.positions.iter().copied(), low, high).into(),
        radius: [least, greatest],
        radii: radii.into(),
    }
}

fn annotation(annotation: &Annotation) -> AnnotationMessage<'_> {
    let (subject, role) = (annotation.subject, annotation.role.as_ref());
    let message = AnnotationMessage { subject, role, ..Default::default() };
    match &annotation.mark {
        Mark::Line { from, to } => AnnotationMessage { line: Some(corners(*from, *to)), ..message },
        Mark::Sphere { center, radius } => {
            AnnotationMessage { center: Some(center.to_array()), radius: Some(*radius), ..message }
        }
        Mark::Label { position, text } => {
            let position = Some(position.to_array());
            AnnotationMessage { position, text: Some(text), ..message }
        }
    }
}

fn corners(low: bioscope_core::Vec3, high: bioscope_core::Vec3) -> [f32; 6] {
    [low.x, low.y, low.z, high.x, high.y, high.z]
}
