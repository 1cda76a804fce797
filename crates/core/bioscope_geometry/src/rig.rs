use std::f32::consts::TAU;

use bioscope_core::{Quat, Vec3, math};
use serde::{Deserialize, Serialize};

use crate::{Camera, Projection, Scene, Transform};

/// A named point of view with the way it moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rig {
    /// Name for the command line and the page.
    pub name: String,
    /// Vertical angle of view in radians.
    pub field_of_view: f32,
    /// How it moves.
    pub motion: Motion,
}

/// How a camera moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Motion {
    /// Stands still, but for the slight sway of one who floats.
    Fixed {
        /// Where it stands, metres.
        position: Vec3,
        /// What it looks at, metres.
        target: Vec3,
    },
    /// Circles round a point.
    Orbit {
        /// The point.
        target: Vec3,
        /// Distance on the level, metres.
        radius: f32,
        /// Height above the point, metres.
        height: f32,
        /// Time for one turn in seconds; negative turns the other way.
        period: f32,
    },
    /// Goes with an animal, late and loosely.
    Follow {
        /// Its species.
        species: String,
        /// Which of them, in the order of the scene.
        index: usize,
        /// Where the camera wants to be, in the animal's frame and in its body lengths.
        offset: Vec3,
    },
}

/// Time constants in seconds with which a following camera moves and turns.
const FOLLOW_LAG: f32 = 0.9;
const AIM_LAG: f32 = 0.35;

impl Rig {
    /// The camera at this moment. `previous` is the camera of this rig `dt` seconds ago; none cuts to
    /// where it wants to be. None if there is nothing to follow.
    pub fn camera(&self, scene: &Scene, previous: Option<&Camera>, dt: f32) -> Option<Camera> {
        let camera = match &self.motion {
            Motion::Fixed { position, target } => {
                let time = scene.time as f32;
                let sway = Vec3::new(math::sin(time * 0.53), math::sin(time * 0.41 + 1.0), 0.0);
                self.look(*position + sway * 0.015, *target)
            }
            Motion::Orbit { target, radius, height, period } => {
                let angle = (scene.time / f64::from(*period)).fract() as f32 * TAU;
                let (sine, cosine) = (math::sin(angle), math::cos(angle));
                let position = *target + Vec3::new(sine * radius, *height, cosine * radius);
                self.look(position, *target)
            }
            Motion::Follow { species, index, offset } => {
                let (place, length) = find(scene, species, *index)?;
                let level = level(place.rotation());
                let subject = place.position;
                let wanted = self.look(subject + level * (*offset * length), subject);
                match previous {
                    None => wanted,
                    Some(previous) => {
                        let go = math::relaxation(dt, FOLLOW_LAG);
                        let position = previous.position.lerp(wanted.position, go);
                        let aim = self.look(position, subject).rotation;
                        let turn = math::relaxation(dt, AIM_LAG);
                        let rotation = previous.rotation.slerp(aim, turn);
                        Camera { position, rotation, ..wanted }
                    }
                }
            }
        };
        Some(camera)
    }

    fn look(&self, position: Vec3, target: Vec3) -> Camera {
        let projection = Projection::Perspective { field_of_view: self.field_of_view };
        Camera { projection, ..Camera::looking_at(position, target, self.field_of_view) }
    }
}

/// Placement and length (metres) of the `index`-th individual of a species.
fn find(scene: &Scene, species: &str, index: usize) -> Option<(Transform, f32)> {
    let mut left = index;
    for batch in scene.batches.iter().filter(|batch| &*batch.species == species) {
        if let Some(transform) = batch.transforms.get(left) {
            let (low, high) = batch.mesh.bounds();
            return Some((*transform, (high.z - low.z) * transform.scale));
        }
        left -= batch.transforms.len();
    }
    None
}

/// The rotation about the vertical that is left of a rotation: a camera does not pitch and roll
/// with its subject.
fn level(rotation: Quat) -> Quat {
    let ahead = rotation * Vec3::Z;
    Quat::from_rotation_y(math::atan2(ahead.x, ahead.z))
}
