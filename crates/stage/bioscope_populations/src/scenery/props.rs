use std::collections::BTreeMap;
use std::sync::Arc;

use bioscope_core::{Error, Id, Result, Vec3, state};
use bioscope_geometry::{Batch, Material, Mesh, Obstacle, Texture, Transform};
use bioscope_world::{
    Environment, Growth, Inspection, Order, Population, Publication, no_such_order,
};
use serde::{Deserialize, Serialize};

use crate::names::free_name;

/// Most vertices, triangles, pixels and instances of one prop.
const LARGEST_MESH: usize = 4_000_000;
const LARGEST_PICTURE: usize = 1 << 24;
const LARGEST_COUNT: usize = 100_000;

/// A shape of the user's own, and where it stands.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PropsOptions {
    /// Species in the scene.
    pub species: String,
    /// Vertices, metres.
    pub positions: Vec<Vec3>,
    /// Three vertex numbers per triangle, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Unit normals, one per vertex; empty to have them computed.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one per vertex, or empty.
    pub uvs: Vec<[f32; 2]>,
    /// Linear vertex colors, one per vertex, or empty.
    pub colors: Vec<[f32; 3]>,
    /// Picture on it.
    pub texture: Option<Picture>,
    /// Linear color that multiplies picture and vertex colors.
    pub color: [f32; 3],
    /// 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// Whether the inside shows too.
    pub two_sided: bool,
    /// Whether an animal's eye may pick it as an individual.
    pub alive: bool,
    /// Where each copy stands.
    pub places: Vec<Transform>,
    /// Solids that moving things steer round, in the world.
    pub obstacles: Vec<Obstacle>,
}

/// Pixels of a texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Pixels per row.
    pub width: u32,
    /// sRGB color and linear opacity, rows from the top.
    pub pixels: Vec<[u8; 4]>,
}

/// Things of the user's own that stay: a wreck, a pillar, a scanned stone.
pub struct Props {
    state: State,
    mesh: Arc<Mesh>,
    material: Arc<Material>,
}

#[derive(Clone, Serialize, Deserialize)]
struct State {
    options: PropsOptions,
    props: Vec<Prop>,
}

/// One copy of the shape.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prop {
    /// Its identity.
    pub id: Id,
    /// Where it stands.
    pub place: Transform,
}

impl Props {
    /// Things of this shape; refuses numbers that are not finite and triangles without vertices.
    pub fn new(options: PropsOptions) -> Result<Self> {
        check(&options)?;
        let (mesh, material) = (mesh(&options), material(&options));
        Ok(Self { state: State { options, props: Vec::new() }, mesh, material })
    }

    /// Props in a state that `save` gave.
    pub fn from_saved(bytes: &[u8]) -> Result<Self> {
        let state: State = state::from_bytes("props", bytes)?;
        let props = Self::new(state.options.clone())?;
        Ok(Self { state, ..props })
    }
}

/// The solid with everything moved from one place to another, and sized by `scale` about it.
fn moved(solid: Obstacle, from: Vec3, to: Vec3, scale: f32) -> Obstacle {
    let carry = |point: Vec3| to + (point - from) * scale;
    match solid {
        Obstacle::Sphere { center, radius } => {
            Obstacle::Sphere { center: carry(center), radius: radius * scale }
        }
        Obstacle::Cylinder { base, top, radius } => {
            Obstacle::Cylinder { base: carry(base), top: carry(top), radius: radius * scale }
        }
        Obstacle::Box { low, high } => Obstacle::Box { low: carry(low), high: carry(high) },
        Obstacle::Plane { point, normal } => Obstacle::Plane { point: carry(point), normal },
    }
}

impl Props {
    /// Puts one elsewhere, with its solid if each has one.
    fn put(
        &mut self,
        (id, position, scale): (Id, Vec3, f32),
        environment: &mut Environment,
    ) -> Result<()> {
        let State { options, props } = &mut self.state;
        let Some(index) = props.iter().position(|one| one.id == id) else {
            return Err(Error::value("id", id, "a prop of this population"));
        };
        let place = &mut props[index].place;
        if options.obstacles.len() == options.places.len() {
            let solid = &mut options.obstacles[index];
            let after = moved(*solid, place.position, position, scale);
            let known = environment.obstacles.edit().iter_mut().find(|one| *one == solid);
            if let Some(known) = known {
                *known = after;
            }
            *solid = after;
        }
        place.position = position;
        place.scale *= scale;
        Ok(())
    }
}

fn mesh(options: &PropsOptions) -> Arc<Mesh> {
    let mut mesh = Mesh {
        positions: options.positions.clone(),
        normals: options.normals.clone(),
        uvs: options.uvs.clone(),
        colors: options.colors.clone(),
        triangles: options.triangles.clone(),
        ..Mesh::default()
    };
    if mesh.normals.is_empty() {
        mesh.compute_normals();
    }
    Arc::new(mesh)
}

fn material(options: &PropsOptions) -> Arc<Material> {
    let texture = options.texture.as_ref().map(|picture| {
        let rows = picture.pixels.len() as u32 / picture.width;
        Arc::new(Texture::new(picture.width, rows, picture.pixels.clone()))
    });
    Arc::new(Material {
        name: options.species.clone(),
        color: options.color,
        texture,
        roughness: options.roughness,
        two_sided: options.two_sided,
        ..Material::default()
    })
}

fn check(options: &PropsOptions) -> Result<()> {
    let PropsOptions { positions, triangles, normals, uvs, colors, places, .. } = options;
    let bounded = |name: &str, count: usize, limit: usize| {
        if count <= limit {
            Ok(())
        } else {
            Err(Error::value(name, count, format!("up to {limit}")))
        }
    };
    bounded("positions", positions.len(), LARGEST_MESH)?;
    bounded("triangles", triangles.len(), LARGEST_MESH)?;
    bounded("places", places.len(), LARGEST_COUNT)?;
    bounded("obstacles", options.obstacles.len(), LARGEST_COUNT)?;
    for (name, count) in [("normals", normals.len()), ("uvs", uvs.len()), ("colors", colors.len())]
    {
        if count != 0 && count != positions.len() {
            let expected = format!("one per vertex ({}) or none", positions.len());
            return Err(Error::value(name, format!("{count} values"), expected));
        }
    }
    let vertices = positions.len() as u32;
    if let Some(stray) = triangles.iter().flatten().find(|&&index| index >= vertices) {
        return Err(Error::value("triangles", stray, format!("vertex numbers below {vertices}")));
    }
    let finite = positions.iter().chain(normals).all(|one| one.is_finite())
        && uvs.iter().flatten().chain(colors.iter().flatten()).all(|one| one.is_finite())
        && options.color.iter().all(|one| one.is_finite())
        && places.iter().all(|one| {
            one.position.is_finite() && one.scale.is_finite() && one.rotation().is_finite()
        });
    if !finite {
        return Err(Error::value("mesh", "a number that is not finite", "finite numbers only"));
    }
    match &options.texture {
        Some(Picture { width, pixels }) => {
            bounded("texture", pixels.len(), LARGEST_PICTURE)?;
            let full =
                *width > 0 && !pixels.is_empty() && pixels.len().is_multiple_of(*width as usize);
            let found = || format!("{} pixels in rows of {width}", pixels.len());
            if full { Ok(()) } else { Err(Error::value("texture", found(), "full rows of pixels")) }
        }
        None => Ok(()),
    }
}

impl Population for Props {
    fn kind(&self) -> &str {
        "props"
    }

    fn settle(&mut self, growth: &mut Growth) -> Result<()> {
        let options = &self.state.options;
        growth.environment.obstacles.edit().extend_from_slice(&options.obstacles);
        let ids = growth.identities(options.places.len())?;
        let places = options.places.iter();
        self.state.props =
            ids.into_iter().zip(places).map(|(id, &place)| Prop { id, place }).collect();
        Ok(())
    }

    fn obey(&mut self, order: &Order, growth: &mut Growth) -> Result<()> {
        match *order {
            Order::Place { id, position, scale } => {
                self.put((id, position, scale), growth.environment)
            }
            _ => Err(no_such_order(self.kind(), order)),
        }
    }

    fn publish(&self, publication: &mut Publication) -> Result<()> {
        let State { options, props } = &self.state;
        let name = free_name(&publication.scene, &options.species);
        let (mesh, material) = (self.mesh.clone(), self.material.clone());
        let mut batch = Batch::new(name, options.species.as_str(), mesh, material);
        batch.ids = props.iter().map(|one| one.id).collect();
        batch.transforms = props.iter().map(|one| one.place).collect();
        batch.alive = options.alive;
        publication.scene.batches.push(batch);
        Ok(())
    }

    fn inspect(&self, individual: Id) -> Option<Inspection> {
        let prop = self.state.props.iter().find(|one| one.id == individual)?;
        let values = BTreeMap::from([
            (String::from("position"), prop.place.position.into()),
            (String::from("scale"), prop.place.scale.into()),
        ]);
        let species = self.state.options.species.clone();
        Some(Inspection { species, values, ..Inspection::default() })
    }

    fn count(&self) -> usize {
        self.state.props.len()
    }

    fn save(&self) -> Result<Vec<u8>> {
        Ok(state::to_bytes(&self.state))
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<()> {
        let state: State = state::from_bytes("props", bytes)?;
        if state.options == self.state.options {
            self.state = state;
        } else {
            *self = Self::from_saved(bytes)?;
        }
        Ok(())
    }

    fn default_name(&self) -> String {
        self.state.options.species.clone()
    }
}
