//! A scene made ready: what all views of one tick share.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use bioscope_core::{Id, Vec3};

use super::arithmetic::{Rgb, rgb};
use super::assets::{Flaw, Part, Rasterizer, Shape};
use super::light::Light;
use super::pose::{Posed, bounds, pose};
use super::shadow::Shadow;
use super::texture::Mipmap;
use super::waves::Waves;
use crate::Scene;

/// What looks at a scene should take trouble over.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Pictures for people: four samples per pixel, smoothly read textures, sun shafts. Else one sample
    /// per pixel, exactly along its ray.
    pub smooth: bool,
    /// Whether things stand in each other's sunlight.
    pub shadows: bool,
    /// Multiplies the size on screen by which levels of detail are chosen; 1 keeps their error at
    /// about half a pixel, less is coarser and faster.
    pub detail: f32,
}

impl Options {
    /// For animals' eyes: many small views.
    pub fn eye() -> Self {
        Self { smooth: false, shadows: false, detail: 0.5 }
    }

    /// For stills and film.
    pub fn picture() -> Self {
        Self { smooth: true, shadows: true, detail: 0.7 }
    }
}

/// A scene made ready for any number of looks, from any number of threads. It keeps what it needs,
/// so the scene may change or go. Looks never change it (vertices of an instance are worked out when
/// first seen, always to the same result).
#[derive(Debug)]
pub struct Prepared {
    pub(crate) scene: Scene,
    pub(crate) options: Options,
    pub(crate) light: Light,
    pub(crate) waves: Waves,
    pub(crate) shadow: Option<Shadow>,
    /// Per batch.
    pub(crate) shapes: Vec<Arc<Shape>>,
    /// Per batch.
    pub(crate) pictures: Vec<Option<Arc<Mipmap>>>,
    pub(crate) things: Vec<Thing>,
    posed: Vec<OnceLock<Posed>>,
}

/// One part of one instance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Thing {
    /// Ball round it in the world.
    pub center: Vec3,
    pub radius: f32,
    pub id: Id,
    pub batch: u32,
    instance: u32,
    part: u32,
    /// Number of its finest level among all levels of all things.
    first: u32,
}

/// Prepares a scene for looking at, from scratch. To look at a changing scene again and again, keep
/// a [`Rasterizer`], which remembers meshes and textures.
pub fn prepare(scene: &Scene, options: &Options) -> Prepared {
    Rasterizer::default().prepare(scene, options)
}

impl Prepared {
    pub(crate) fn new(
        scene: &Scene,
        options: &Options,
        shapes: &BTreeMap<u64, Arc<Shape>>,
        pictures: &BTreeMap<u64, Arc<Mipmap>>,
    ) -> Self {
        let light = Light::new(scene);
        let waves = Waves::still();
        let shape = |key: u64| shapes[&key].clone();
        let shapes: Vec<_> =
            scene.batches.iter().map(|batch| shape(batch.mesh.key.number())).collect();
        let textures = scene.batches.iter().map(|batch| batch.material.texture.as_ref());
        let pictures = textures
            .map(|texture| texture.map(|texture| pictures[&texture.key.number()].clone()))
            .collect();
        let (things, levels) = things(scene, &shapes);
        let posed = std::iter::repeat_with(OnceLock::new).take(levels).collect();
        let (scene, options) = (scene.clone(), options.clone());
        let mut prepared =
            Self { scene, options, light, waves, shadow: None, shapes, pictures, things, posed };
        let fineness = if prepared.options.smooth { 256 } else { 64 };
        (prepared.waves, prepared.shadow) = rayon::join(
            || Waves::new(&prepared.light, prepared.scene.time, fineness),
            || if prepared.options.shadows { Shadow::new(&prepared) } else { None },
        );
        prepared
    }

    /// The part of a mesh that a thing shows.
    #[inline(always)]
    pub(crate) fn part(&self, thing: &Thing) -> &Part {
        &self.shapes[thing.batch as usize].parts[thing.part as usize]
    }

    /// Vertices of a thing at a level, in the world.
    #[inline(always)]
    pub(crate) fn posed(&self, thing: &Thing, level: usize) -> &Posed {
        self.posed[thing.first as usize + level].get_or_init(|| {
            let mesh = &self.part(thing).levels[level].1;
            pose(&self.scene.batches[thing.batch as usize], thing.instance as usize, mesh)
        })
    }

    /// Whether a tile of a large mesh has its turn: its own error is invisible, that of the coarser tile in
    /// its place is not. `visible` judges an error and the nearest distance to it, both in metres in
    /// the world. Other things always have their turn.
    #[inline(always)]
    pub(crate) fn has_turn(
        &self,
        thing: &Thing,
        eye: Vec3,
        visible: impl Fn(f32, f32) -> bool,
    ) -> bool {
        let Some(reign) = &self.part(thing).tile else { return true };
        let transform =
            &self.scene.batches[thing.batch as usize].transforms[thing.instance as usize];
        let scale = transform.scale.abs();
        let eye = transform.inverse().point(eye);
        let shows = |flaw: &Flaw| visible(flaw.error * scale, flaw.distance(eye) * scale);
        !shows(&reign.own) && reign.parent.as_ref().is_none_or(shows)
    }

    /// Whether one sees through a thing.
    #[inline(always)]
    pub(crate) fn is_veil(&self, thing: &Thing) -> bool {
        self.scene.batches[thing.batch as usize].material.opacity < 1.0
    }

    /// Tint of a thing.
    #[inline(always)]
    pub(crate) fn tint(&self, thing: &Thing) -> Rgb {
        let tints = &self.scene.batches[thing.batch as usize].tints;
        tints.get(thing.instance as usize).map_or(Rgb::ONE, |&tint| rgb(tint))
    }
}

/// All things, and the number of their levels together.
fn things(scene: &Scene, shapes: &[Arc<Shape>]) -> (Vec<Thing>, usize) {
    let mut things = Vec::new();
    let mut levels = 0;
    for (number, (batch, shape)) in scene.batches.iter().zip(shapes).enumerate() {
        for instance in 0..batch.ids.len().min(batch.transforms.len()) {
            for (part_number, part) in shape.parts.iter().enumerate() {
                let (center, radius) = bounds(batch, instance, part);
                if !(center.is_finite() && radius.is_finite()) {
                    continue;
                }
                things.push(Thing {
                    center,
                    radius,
                    id: batch.ids[instance],
                    batch: number as u32,
                    instance: instance as u32,
                    part: part_number as u32,
                    first: levels as u32,
                });
                levels += part.levels.len();
            }
        }
    }
    (things, levels)
}
