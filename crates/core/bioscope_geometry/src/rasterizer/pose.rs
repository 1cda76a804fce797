//! Where the vertices of an instance are in the world: placed, and bent by its joints.

use bioscope_core::{Mat3, Vec3};

use super::arithmetic::unit;
use super::assets::Part;
use crate::{Batch, Mesh, Skin, Transform};

/// Vertices of one instance at one level of detail, in the world.
#[derive(Debug)]
pub(crate) struct Posed {
    pub points: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
}

/// A transform ready for many points.
#[derive(Clone, Copy, Debug)]
struct Placement {
    axes: Mat3,
    origin: Vec3,
}

impl Placement {
    fn new(transform: &Transform) -> Self {
        let axes = Mat3::from_quat(transform.rotation()) * transform.scale;
        Self { axes, origin: transform.position }
    }

    #[inline(always)]
    fn point(&self, point: Vec3) -> Vec3 {
        self.axes * point + self.origin
    }
}

/// Evaluates an instance (linear blend skinning: each joint moves a vertex by its pose times the
/// inverse of its rest pose; the results are mixed by weight).
pub(crate) fn pose(batch: &Batch, instance: usize, mesh: &Mesh) -> Posed {
    let transform = &batch.transforms[instance];
    match (&mesh.skin, moves(batch, instance, mesh)) {
        (Some(skin), Some(joints)) => skinned(mesh, skin, &joints),
        _ => {
            let placement = Placement::new(transform);
            Posed {
                points: mesh.positions.iter().map(|&point| placement.point(point)).collect(),
                normals: mesh.normals.iter().map(|&normal| unit(placement.axes * normal)).collect(),
            }
        }
    }
}

/// How each joint of an instance moves the mesh into the world; none for a rigid instance.
fn moves(batch: &Batch, instance: usize, mesh: &Mesh) -> Option<Vec<Placement>> {
    let skin = mesh.skin.as_ref()?;
    let poses = batch.pose(instance);
    if poses.len() != skin.joints.len() || poses.is_empty() {
        return None;
    }
    let transform = &batch.transforms[instance];
    let joints = poses.iter().zip(&skin.joints);
    Some(
        joints
            .map(|(pose, joint)| {
                Placement::new(&transform.compose(&pose.compose(&joint.rest.inverse())))
            })
            .collect(),
    )
}

fn skinned(mesh: &Mesh, skin: &Skin, joints: &[Placement]) -> Posed {
    let count = mesh.positions.len();
    let mut posed = Posed { points: Vec::with_capacity(count), normals: Vec::with_capacity(count) };
    for (index, (&point, &normal)) in mesh.positions.iter().zip(&mesh.normals).enumerate() {
        let (numbers, weights) = (skin.indices[index], skin.weights[index]);
        let first = &joints[numbers[0] as usize];
        if weights[0] >= 1.0 {
            posed.points.push(first.point(point));
            posed.normals.push(unit(first.axes * normal));
            continue;
        }
        let mut axes = first.axes * weights[0];
        let mut origin = first.origin * weights[0];
        for (&number, &weight) in numbers.iter().zip(&weights).skip(1) {
            if weight > 0.0 {
                axes += joints[number as usize].axes * weight;
                origin += joints[number as usize].origin * weight;
            }
        }
        posed.points.push(axes * point + origin);
        posed.normals.push(unit(axes * normal));
    }
    posed
}

/// Center and radius of a ball round an instance's part in the world. A vertex is a mean of the places
/// where its joints would put it, so it is inside the box round the moved balls of all joints.
pub(crate) fn bounds(batch: &Batch, instance: usize, part: &Part) -> (Vec3, f32) {
    let transform = &batch.transforms[instance];
    let rigid = (transform.point(part.center), part.radius * transform.scale.abs());
    let Some(joints) = moves(batch, instance, &part.levels[0].1) else { return rigid };
    let scale = transform.scale.abs();
    let mut low = Vec3::INFINITY;
    let mut high = Vec3::NEG_INFINITY;
    for &(joint, center, radius) in &part.joints {
        let center = joints[joint].point(center);
        low = low.min(center - radius * scale);
        high = high.max(center + radius * scale);
    }
    if part.joints.is_empty() {
        return rigid;
    }
    ((low + high) * 0.5, (high - low).length() * 0.5)
}
