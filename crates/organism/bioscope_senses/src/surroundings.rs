use bioscope_core::{Id, Percepts, Quat, SoundEvent, Vec3};
use bioscope_dynamics::Influence;
use bioscope_geometry::{Medium, Scene, Solids, Sun, Terrain};

use crate::Outlook;

/// The world round one animal as the last tick left it: all that its senses may read.
///
/// Places and velocities are in the world, in metres and seconds; the methods carry them into the
/// animal's own frame (X left, Y up, Z ahead).
#[derive(Clone, Copy)]
pub struct Surroundings<'a> {
    /// Whose senses these are: nobody sees or hears itself.
    pub id: Id,
    /// Where the animal's centre is.
    pub position: Vec3,
    /// Rotation from the own frame to the world's.
    pub attitude: Quat,
    /// How the animal moves over ground.
    pub velocity: Vec3,
    /// Its length in metres.
    pub body_length: f32,
    /// The place it calls home.
    pub home: Vec3,
    /// What can be seen.
    pub outlook: &'a Outlook<'a>,
    /// What began to sound in the last tick.
    pub sounds: &'a [SoundEvent],
    /// What acts at the animal's place.
    pub influence: Influence,
    /// Solids.
    pub obstacles: &'a Solids,
    /// The ground, if there is any.
    pub terrain: Option<&'a Terrain>,
    /// What fills the space.
    pub medium: &'a Medium,
    /// The sun.
    pub sun: Sun,
    /// Temperature of the world in degrees Celsius, before fields act on it.
    pub temperature: f32,
    /// World time in seconds.
    pub time: f64,
    /// Seconds since the last decision.
    pub dt: f32,
}

impl<'a> Surroundings<'a> {
    /// What can be seen.
    pub fn scene(&self) -> &'a Scene {
        self.outlook.scene()
    }

    /// A place in the world as seen from the animal's centre.
    pub fn own_point(&self, point: Vec3) -> Vec3 {
        self.own_vector(point - self.position)
    }

    /// A direction or velocity of the world in the own frame.
    pub fn own_vector(&self, vector: Vec3) -> Vec3 {
        self.attitude.inverse() * vector
    }

    /// Direction in which the animal looks: a unit vector in the world.
    pub fn heading(&self) -> Vec3 {
        self.attitude * Vec3::Z
    }

    /// Depth of the animal below the surface of the water in metres; zero where there is none.
    pub fn depth(&self) -> f32 {
        self.medium.surface.map_or(0.0, |surface| surface - self.position.y)
    }

    /// Begins percepts anew with what every animal knows of itself without a sense of its own: name, time, motion,
    /// balance, size, depth and the way home. Lists and further percepts stay as they were, for the senses to
    /// overwrite them.
    pub fn begin(&self, percepts: &mut Percepts) {
        let Percepts { seen, smelled, solids, heard, other, .. } = std::mem::take(percepts);
        *percepts = Percepts {
            id: self.id,
            time: self.time,
            dt: self.dt,
            velocity: self.own_vector(self.velocity),
            attitude: self.attitude,
            body_length: self.body_length,
            depth: self.depth(),
            home: self.own_point(self.home),
            seen,
            smelled,
            solids,
            heard,
            other,
            ..Percepts::default()
        };
    }
}
