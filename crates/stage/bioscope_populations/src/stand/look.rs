//! What is seen of one plant: a bending mesh of its wood, and where its leaves are on it.

use std::ops::Range;
use std::sync::Arc;

use bioscope_core::{Mat3, Quat, Result, Vec3, math};
use bioscope_geometry::{Mesh, Transform};
use bioscope_lsystem::{
    Frame, Held, Interpretation, MeshOptions, Palette, Shapes, SkeletonOptions, Surface,
};

use super::model::Model;
use super::plant::Plant;
use crate::plants::shapes::Bend;

/// Steps by which the proportions of leaves that share a mesh may differ.
const PROPORTIONS: f32 = 16.0;
/// Leaves smaller than this are buds that are not drawn, units of the model.
const SMALLEST: f32 = 1e-4;

/// A shape of leaves that is drawn once: name, color and texture, width and thickness by length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Form {
    pub name: char,
    pub color: i32,
    pub texture: u16,
    pub proportions: [i16; 2],
}

/// A leaf of a plant.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub form: Form,
    /// Where it is at rest, in the plant's own space.
    pub place: Transform,
    /// What it moves with.
    pub joints: [u8; 4],
    pub weights: [f32; 4],
}

/// What is seen of a plant.
pub(super) struct Look {
    /// The wood.
    pub mesh: Arc<Mesh>,
    pub joints: Vec<Bend>,
    /// Where the joints rest, in the plant's own space.
    pub rests: Vec<Vec3>,
    pub leaves: Vec<Leaf>,
    /// Height above its foot, units of the model.
    pub height: f32,
    /// Longest way from its foot to a tip, units of the model.
    pub length: f32,
    /// How many segments it has.
    pub segments: usize,
    /// Whether the plant has changed since.
    pub stale: bool,
}

impl Look {
    /// The look of a plant; `share` of the last step has gone by. Wood that looks as it did before stays the same
    /// mesh, so that observers need not take it in again.
    pub fn of(
        plant: &Plant,
        model: &Model,
        joints: u32,
        share: f32,
        before: Option<Arc<Mesh>>,
    ) -> Result<Self> {
        let mut drawn = plant.drawn(model, math::smoothstep(-0.05, 1.0, share))?;
        for segment in &mut drawn.segments {
            segment.start_radius = stepped(segment.start_radius);
            segment.end_radius = stepped(segment.end_radius);
        }
        let segments = drawn.segments.len();
        let skeleton = SkeletonOptions { joints, ..SkeletonOptions::default() };
        let (shape, held) = drawn.shape_and_leaves(&model.meshing, &skeleton)?;
        let own = shape.mesh.skin.as_ref().map_or(&[][..], |skin| &skin.joints);
        let rests = own.iter().map(|joint| joint.rest.position).collect();
        let joints = Bend::of(&shape);
        let leaves = held.into_iter().filter_map(leaf).collect();
        let (height, length) = (shape.height, shape.length);
        let mut mesh = shape.mesh;
        mesh.uvs.clear();
        let mesh = match before {
            Some(before) if is_same(&before, &mesh) => before,
            _ => Arc::new(mesh),
        };
        Ok(Self { mesh, joints, rests, leaves, height, length, segments, stale: false })
    }

    /// Whether there is nothing to be seen.
    pub fn is_empty(&self) -> bool {
        self.mesh.triangles.is_empty() && self.leaves.is_empty()
    }

    /// Ranges of leaves that follow each other and have one form.
    pub fn runs(&self) -> impl Iterator<Item = (Form, Range<usize>)> + '_ {
        let mut start = 0;
        self.leaves.chunk_by(|one, next| one.form == next.form).map(move |run| {
            let range = start..start + run.len();
            start = range.end;
            (run[0].form, range)
        })
    }

    /// Where the leaves are when the plant stands so and its joints have these poses; none if they rest.
    pub fn leaves(&self, body: &Transform, poses: &[Transform]) -> Vec<Transform> {
        let stance = Placing::of(body, Vec3::ZERO);
        let joints: Vec<Placing> = poses
            .iter()
            .zip(&self.rests)
            .map(|(pose, &rest)| stance.after(&Placing::of(pose, rest)))
            .collect();
        let size = body.scale;
        let placed = |leaf: &Leaf| {
            let Leaf { place, joints: held_by, weights, .. } = leaf;
            if joints.is_empty() {
                let position = stance.turn * place.position + stance.shift;
                return Transform::new(
                    position,
                    stance.rotation * place.rotation(),
                    size * place.scale,
                );
            }
            let mut position = Vec3::ZERO;
            let mut turn = (0.0, stance.rotation);
            for (&joint, &weight) in held_by.iter().zip(weights) {
                if weight > 0.0 {
                    let joint = &joints[joint as usize];
                    position += (joint.turn * place.position + joint.shift) * weight;
                    if weight > turn.0 {
                        turn = (weight, joint.rotation);
                    }
                }
            }
            Transform::new(position, turn.1 * place.rotation(), size * place.scale)
        };
        self.leaves.iter().map(placed).collect()
    }
}

/// A placement as a matrix, quicker for many points.
struct Placing {
    turn: Mat3,
    shift: Vec3,
    rotation: Quat,
}

impl Placing {
    /// That of what rests at `rest` and has come to `pose`.
    fn of(pose: &Transform, rest: Vec3) -> Self {
        let turn = Mat3::from_quat(pose.rotation()) * pose.scale;
        Self { turn, shift: pose.position - turn * rest, rotation: pose.rotation() }
    }

    /// First the inner one, then this.
    fn after(&self, inner: &Self) -> Self {
        Self {
            turn: self.turn * inner.turn,
            shift: self.turn * inner.shift + self.shift,
            rotation: self.rotation * inner.rotation,
        }
    }
}

/// A radius in steps of four per cent, which nobody sees.
fn stepped(radius: f32) -> f32 {
    if radius > 0.0 { math::exp((math::ln(radius) * 24.0).round() / 24.0) } else { radius }
}

fn is_same(one: &Mesh, other: &Mesh) -> bool {
    let joints = |mesh: &Mesh| {
        let skin = mesh.skin.as_ref();
        skin.map(|skin| skin.joints.iter().map(|joint| joint.rest).collect::<Vec<_>>())
    };
    one.positions == other.positions
        && one.triangles == other.triangles
        && one.colors == other.colors
        && joints(one) == joints(other)
}

fn leaf(held: Held) -> Option<Leaf> {
    let Held { surface, joints, weights } = held;
    let size = surface.scale.y;
    if size < SMALLEST || !surface.scale.is_finite() {
        return None;
    }
    let proportion = |part: f32| (part / size * PROPORTIONS).round().clamp(-3e4, 3e4) as i16;
    let form = Form {
        name: surface.name,
        color: surface.color,
        texture: surface.texture,
        proportions: [proportion(surface.scale.x), proportion(surface.scale.z)],
    };
    let Frame { heading, left, up } = surface.frame;
    let rotation = Quat::from_mat3(&Mat3::from_cols(-left, heading, up)).normalize();
    Some(Leaf { form, place: Transform::new(surface.position, rotation, size), joints, weights })
}

impl Form {
    /// The mesh of a leaf of this form of length 1 at the start of a turtle.
    pub fn mesh(&self, shapes: &Arc<Shapes>, palette: &Palette) -> Mesh {
        let [width, thickness] = self.proportions.map(|part| f32::from(part) / PROPORTIONS);
        let frame = Frame { heading: Vec3::Y, left: Vec3::NEG_X, up: Vec3::Z };
        let surface = Surface {
            name: self.name,
            position: Vec3::ZERO,
            frame,
            scale: Vec3::new(width, 1.0, thickness),
            color: self.color,
            texture: self.texture,
            anchor: None,
        };
        let (surfaces, shapes) = (vec![surface], shapes.clone());
        let drawn = Interpretation { surfaces, shapes, ..Interpretation::default() };
        let meshing = MeshOptions { palette: palette.clone(), ..MeshOptions::default() };
        drawn.mesh(&meshing).with_levels()
    }
}
