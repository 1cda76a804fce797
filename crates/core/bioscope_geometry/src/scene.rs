//! The published scene: the one description of what can be seen, read by retinas, live view, film
//! and export alike.

use std::sync::Arc;

use bioscope_core::{Annotation, Display, Id, Vec3};
use serde::{Deserialize, Serialize};

use crate::{Key, Mesh, Rig, Transform};

/// All that can be seen at one tick. Rebuilt by every `publish`; assets are shared.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Tick after which this was published.
    pub tick: u64,
    /// World time in seconds.
    pub time: f64,
    /// Things with a mesh, grouped by mesh, material and species.
    pub batches: Vec<Batch>,
    /// Things too small for a mesh.
    pub points: Vec<Points>,
    /// Mouths that are open and suck.
    pub mouths: Vec<Mouth>,
    /// The sun.
    pub sun: Sun,
    /// The light from everywhere else.
    pub sky: Sky,
    /// What fills the space.
    pub medium: Medium,
    /// Points of view that the world offers, the first being the main one.
    pub rigs: Vec<Rig>,
    /// What senses and minds show of their work.
    pub annotations: Vec<Annotation>,
}

impl Scene {
    /// The scene without some individuals of its batches.
    pub fn without(&self, ids: &[Id]) -> Self {
        let mut scene = self.clone();
        for batch in &mut scene.batches {
            if batch.ids.iter().any(|id| ids.contains(id)) {
                batch.remove(ids);
            }
        }
        scene
    }
}

/// Instances of one mesh in one material, all of one species.
#[derive(Clone, Debug)]
pub struct Batch {
    /// Stable name, unique in the scene: `anchovy`, `kelp/3`, `seabed`.
    pub name: String,
    /// Species of all instances.
    pub species: Arc<str>,
    /// Shape.
    pub mesh: Arc<Mesh>,
    /// Appearance.
    pub material: Arc<Material>,
    /// Identity of each instance.
    pub ids: Vec<Id>,
    /// Placement of each instance.
    pub transforms: Vec<Transform>,
    /// Velocity of each instance in metres per second; empty for things that stay.
    pub velocities: Vec<Vec3>,
    /// Linear colour that multiplies the material's, per instance; empty for no tint.
    pub tints: Vec<[f32; 3]>,
    /// Poses of the mesh's joints in mesh space: joint count × instances, instance by instance;
    /// empty for a rigid mesh (or all at rest). Scales in it are 1.
    pub poses: Vec<Transform>,
    /// What each instance shows of its state; empty where none shows anything.
    pub displays: Vec<Display>,
    /// Whether an animal's eye may pick it as an individual (animals and plants; not sand and rock).
    pub alive: bool,
}

impl Batch {
    /// A batch without instances.
    pub fn new(
        name: impl Into<String>,
        species: impl Into<Arc<str>>,
        mesh: Arc<Mesh>,
        material: Arc<Material>,
    ) -> Self {
        Self {
            name: name.into(),
            species: species.into(),
            mesh,
            material,
            ids: Vec::new(),
            transforms: Vec::new(),
            velocities: Vec::new(),
            tints: Vec::new(),
            poses: Vec::new(),
            displays: Vec::new(),
            alive: false,
        }
    }

    /// Takes out instances by their identity.
    fn remove(&mut self, ids: &[Id]) {
        let stays: Vec<bool> = self.ids.iter().map(|id| !ids.contains(id)).collect();
        let joints = self.joint_count();
        keep(&mut self.poses, &stays, joints);
        keep(&mut self.ids, &stays, 1);
        keep(&mut self.transforms, &stays, 1);
        keep(&mut self.velocities, &stays, 1);
        keep(&mut self.tints, &stays, 1);
        keep(&mut self.displays, &stays, 1);
    }

    /// How many joint poses each instance has.
    pub fn joint_count(&self) -> usize {
        if self.ids.is_empty() { 0 } else { self.poses.len() / self.ids.len() }
    }

    /// Joint poses of one instance; empty if the mesh is rigid.
    pub fn pose(&self, instance: usize) -> &[Transform] {
        let count = self.joint_count();
        &self.poses[instance * count..(instance + 1) * count]
    }
}

/// Keeps the rows, of so many numbers each, of the instances that stay.
fn keep<T>(rows: &mut Vec<T>, stays: &[bool], width: usize) {
    let mut index = 0;
    rows.retain(|_| {
        index += 1;
        stays[(index - 1) / width]
    });
}

/// Small round things: plankton, bubbles, motes, sparks.
#[derive(Clone, Debug)]
pub struct Points {
    /// Stable name, unique in the scene.
    pub name: String,
    /// Species of all points.
    pub species: Arc<str>,
    /// Identity of each point.
    pub ids: Vec<Id>,
    /// Centre of each point, metres.
    pub positions: Vec<Vec3>,
    /// Radius of each point, metres.
    pub radii: Vec<f32>,
    /// Linear colour of all.
    pub color: [f32; 3],
    /// 0 (invisible) to 1 (solid).
    pub opacity: f32,
    /// Whether they are clear balls of gas that glint at the rim (bubbles) rather than matt grains.
    pub glassy: bool,
}

/// An open mouth: what is free and small enough is drawn into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mouth {
    /// Whose it is.
    pub owner: Id,
    /// Where it is, metres.
    pub position: Vec3,
    /// Direction in which it opens: a unit vector.
    pub ahead: Vec3,
    /// Length of the animal, metres.
    pub body_length: f32,
    /// How far it is open, 0 to 1.
    pub gape: f32,
}

/// A picture wrapped on a mesh.
#[derive(Clone, Debug)]
pub struct Texture {
    /// By which observers recognize it.
    pub key: Key,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// sRGB colour and linear opacity, rows from the top.
    pub pixels: Vec<[u8; 4]>,
}

impl Texture {
    /// A texture of these pixels; `pixels.len()` must be `width` × `height`.
    pub fn new(width: u32, height: u32, pixels: Vec<[u8; 4]>) -> Self {
        assert_eq!(pixels.len(), width as usize * height as usize, "pixels of a texture");
        Self { key: Key::default(), width, height, pixels }
    }
}

/// How a surface answers light.
#[derive(Clone, Debug)]
pub struct Material {
    /// By which observers recognize it.
    pub key: Key,
    /// Name in exported files.
    pub name: String,
    /// Linear colour, multiplied by texture, vertex colour and tint.
    pub color: [f32; 3],
    /// Picture on it.
    pub texture: Option<Arc<Texture>>,
    /// Whether texels with opacity below one half are holes (frayed fins, leaves).
    pub cutout: bool,
    /// 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// Strength of the highlight at normal incidence, 0 to 1 (0.04 for wet skin, 0.5 for silver scales).
    pub specular: f32,
    /// Share of light that comes through from behind (leaves, fins).
    pub translucency: f32,
    /// Share of what is behind that it hides: 1 solid, less a veil (the surface of a field, glass). A veil
    /// throws no shadow, and who looks through it knows only what is behind.
    pub opacity: f32,
    /// Whether the inside shows too.
    pub two_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            key: Key::default(),
            name: String::from("matt"),
            color: [0.8; 3],
            texture: None,
            cutout: false,
            roughness: 0.8,
            specular: 0.04,
            translucency: 0.0,
            opacity: 1.0,
            two_sided: false,
        }
    }
}

/// The sun: parallel light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sun {
    /// Unit vector towards the sun.
    pub direction: Vec3,
    /// Linear irradiance on a surface that faces it, above the water.
    pub color: [f32; 3],
}

impl Default for Sun {
    fn default() -> Self {
        Self { direction: Vec3::new(0.32, 0.9, 0.28).normalize(), color: [3.0, 2.9, 2.7] }
    }
}

/// Diffuse light: a gradient from straight up to straight down (linear radiance).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sky {
    /// Straight up.
    pub zenith: [f32; 3],
    /// Level.
    pub horizon: [f32; 3],
    /// Straight down.
    pub nadir: [f32; 3],
}

impl Default for Sky {
    fn default() -> Self {
        Self { zenith: [0.25, 0.45, 0.85], horizon: [0.6, 0.7, 0.85], nadir: [0.2, 0.18, 0.15] }
    }
}

/// What fills the space and eats light: `radiance · e^(−(absorption + scattering) d)` of a thing
/// at distance d arrives, the rest is replaced by the medium's own glow, which darkens with depth by the same absorption.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Medium {
    /// Height of the water surface in metres; none for air throughout.
    pub surface: Option<f32>,
    /// Light lost per metre, linear RGB.
    pub absorption: [f32; 3],
    /// Light scattered per metre, linear RGB.
    pub scattering: [f32; 3],
    /// Radiance of the medium itself just below the surface, looking level, linear RGB.
    pub glow: [f32; 3],
    /// Strength of caustics (0 none, 1 full): brightness pattern of sunlight refracted by waves.
    pub caustics: f32,
    /// Size of the caustic cells in metres.
    pub caustic_scale: f32,
    /// Strength of visible sun shafts, 0 to 1.
    pub shafts: f32,
}

impl Default for Medium {
    fn default() -> Self {
        Self {
            surface: None,
            absorption: [0.0; 3],
            scattering: [0.0; 3],
            glow: [0.0; 3],
            caustics: 0.0,
            caustic_scale: 1.0,
            shafts: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use bioscope_core::Quat;

    use super::*;

    #[test]
    fn individuals_go_with_all_that_is_theirs() {
        let mut batch =
            Batch::new("a", "a", Arc::new(Mesh::default()), Arc::new(Material::default()));
        for id in 1..=4 {
            let place = Vec3::splat(id as f32);
            batch.ids.push(id);
            batch.transforms.push(Transform::new(place, Quat::IDENTITY, 1.0));
            batch.velocities.push(place);
            batch.poses.extend([Transform::new(place, Quat::IDENTITY, 1.0); 2]);
        }
        let scene = Scene { batches: vec![batch], ..Scene::default() };
        let left = &scene.without(&[2, 4, 9]).batches[0];
        assert_eq!(left.ids, [1, 3]);
        assert_eq!(left.transforms[1].position, Vec3::splat(3.0));
        assert_eq!(left.velocities, [Vec3::splat(1.0), Vec3::splat(3.0)]);
        assert!(left.tints.is_empty());
        assert_eq!(left.pose(1), &scene.batches[0].poses[4..6]);
        assert_eq!(scene.without(&[9]).batches[0].ids.len(), 4);
    }
}
