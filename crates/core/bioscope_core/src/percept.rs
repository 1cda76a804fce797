use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::{Display, Id, Value};

/// Everything one animal notices in one tick: all that its mind may know.
///
/// Positions and directions are in the animal's own frame (X left, Y up, Z ahead), in metres, with
/// its centre as the origin; velocities are relative to the ground in the same frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Percepts {
    /// Who notices: the name by which others know it.
    pub id: Id,
    /// World time in seconds.
    pub time: f64,
    /// Seconds since the last decision.
    pub dt: f32,
    /// Own velocity, metres per second.
    pub velocity: Vec3,
    /// Rotation from the own frame to the world's: the sense of balance and of compass direction.
    pub attitude: Quat,
    /// Own length in metres.
    pub body_length: f32,
    /// Depth below the water surface in metres; negative above it.
    pub depth: f32,
    /// Vector from the own place to the place the animal calls home, in metres.
    pub home: Vec3,
    /// What is seen, nearest first.
    pub seen: Vec<Sighting>,
    /// Food that is smelled, seen or not, nearest first.
    pub smelled: Vec<Sighting>,
    /// Things swallowed since the last decision.
    pub fed: u32,
    /// What lies ahead within reach, if anything.
    pub ahead: Option<Impact>,
    /// Points of the solids around that are nearest to the eye, own frame, metres, nearest first.
    pub solids: Vec<Vec3>,
    /// What is heard.
    pub heard: Vec<Hearing>,
    /// Flow of the medium relative to the body, metres per second.
    pub flow: Vec3,
    /// Brightness around, 0 (dark) to 1 (full sun).
    pub light: f32,
    /// Temperature in degrees Celsius.
    pub temperature: f32,
    /// The picture on the retina, for those who look. Not part of saved states: the next look makes it
    /// anew.
    #[serde(skip)]
    pub retina: Option<Arc<Retina>>,
    /// Whatever further senses add, by name.
    pub other: BTreeMap<String, Value>,
}

/// One thing seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sighting {
    /// Its identity.
    pub id: Id,
    /// Its species, as published in the scene.
    pub species: Arc<str>,
    /// Where it is, own frame, metres.
    pub position: Vec3,
    /// How it moves, own frame, metres per second.
    pub velocity: Vec3,
    /// Where it looks: a unit vector in the own frame; zero for things without front and back.
    pub heading: Vec3,
    /// Its size in metres.
    pub size: f32,
    /// Its linear color, without the water's.
    pub color: [f32; 3],
    /// What it shows of its state.
    pub display: Display,
}

impl Sighting {
    /// Says of which species it is; costs nothing if it was of the same before. (The name is shared by all who see
    /// one, and so is the count of them, for which threads have to wait.)
    pub fn is_of(&mut self, species: &Arc<str>) {
        if !Arc::ptr_eq(&self.species, species) {
            self.species = Arc::clone(species);
        }
    }
}

/// A picture on a retina, rows from the top: what the eye sees, how far and whom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Retina {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Linear radiance, RGB; black outside the field of view.
    pub color: Vec<[f32; 3]>,
    /// Range along each pixel's ray in metres, infinite where there is nothing.
    pub range: Vec<f32>,
    /// Identity of what is seen, 0 where there is nothing.
    pub identity: Vec<Id>,
}

/// An obstacle straight ahead.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Impact {
    /// Distance along the heading, metres.
    pub distance: f32,
    /// Point beside the obstacle's silhouette to steer for, own frame, metres.
    pub aim: Vec3,
}

/// One sound heard.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hearing {
    /// Identity of its source.
    pub source: Id,
    /// Which noise.
    pub kind: Cow<'static, str>,
    /// Direction it comes from, own frame, unit length.
    pub direction: Vec3,
    /// Amplitude at the ear.
    pub amplitude: f32,
}
