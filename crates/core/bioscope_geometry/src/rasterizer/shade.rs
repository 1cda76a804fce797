//! From "this sample sees that triangle" to its color.

use bioscope_core::Vec3;

use super::arithmetic::{Rgb, rgb, unit};
use super::lens::Stand;
use super::light::{Eye, Finish, Light, arriving, reflected, sky, sun_disc, sunlight};
use super::prepare::{Prepared, Thing};
use super::texture::Mipmap;
use crate::{Material, Mesh};

/// Colors what one eye sees.
pub(crate) struct Shader<'a> {
    pub prepared: &'a Prepared,
    pub stand: Stand,
    pub eye: Eye,
    /// Angle between neighboring pixels, radians.
    pub pitch: f32,
}

/// A triangle as one eye sees it.
struct Corner3 {
    /// Corners relative to the eye.
    corners: [Vec3; 3],
    /// Twice the area, along the geometric normal.
    area: Vec3,
    /// Shares of the corners at the point that is seen.
    shares: [f32; 3],
}

impl Corner3 {
    #[inline(always)]
    fn new(corners: [Vec3; 3], direction: Vec3) -> Self {
        let [a, b, c] = corners;
        let volumes =
            [direction.dot(b.cross(c)), direction.dot(c.cross(a)), direction.dot(a.cross(b))];
        let whole = volumes[0] + volumes[1] + volumes[2];
        let inverse = if whole == 0.0 { 0.0 } else { 1.0 / whole };
        let first = (volumes[0] * inverse).clamp(0.0, 1.0);
        let second = (volumes[1] * inverse).clamp(0.0, 1.0 - first);
        Self { corners, area: (b - a).cross(c - a), shares: [first, second, 1.0 - first - second] }
    }

    #[inline(always)]
    fn mix(&self, [a, b, c]: [Vec3; 3]) -> Vec3 {
        a * self.shares[0] + b * self.shares[1] + c * self.shares[2]
    }

    /// Texture coordinates, and how many texels a pixel of this angular size takes in.
    #[inline(always)]
    fn texel(
        &self,
        picture: &Mipmap,
        uvs: [[f32; 2]; 3],
        direction: Vec3,
        pitch: f32,
    ) -> ([f32; 2], f32) {
        let [a, b, c] = uvs;
        let mix = |axis: usize| {
            a[axis] * self.shares[0] + b[axis] * self.shares[1] + c[axis] * self.shares[2]
        };
        let spread = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        let facing = self.area.dot(direction).abs().max(1e-12);
        let distance = self.mix(self.corners).length_squared();
        let footprint = (distance * spread.abs() * picture.texels() / facing).sqrt() * pitch;
        ([mix(0), mix(1)], footprint)
    }
}

/// Values of an attribute at a triangle's corners.
#[inline(always)]
fn at<T: Copy>(values: &[T], triangle: [u32; 3]) -> [T; 3] {
    triangle.map(|corner| values[corner as usize])
}

impl<'a> Shader<'a> {
    /// What arrives at the eye from a point of a triangle, at `distance` along a unit direction.
    #[inline(always)]
    pub fn surface(
        &self,
        thing: &Thing,
        level: usize,
        triangle: usize,
        direction: Vec3,
        distance: f32,
    ) -> Rgb {
        let prepared = self.prepared;
        let posed = prepared.posed(thing, level);
        let mesh: &Mesh = &prepared.part(thing).levels[level].1;
        let material: &Material = &prepared.scene.batches[thing.batch as usize].material;
        let triangle = mesh.triangles[triangle];
        let eye = self.stand.eye;
        let seen = Corner3::new(at(&posed.points, triangle).map(|corner| corner - eye), direction);
        let mut normal = unit(seen.mix(at(&posed.normals, triangle)));
        if seen.area.dot(direction) > 0.0 {
            normal = -normal;
        }
        let mut albedo = rgb(material.color) * prepared.tint(thing);
        if !mesh.colors.is_empty() {
            albedo *= rgb(seen.mix(at(&mesh.colors, triangle).map(Vec3::from)).to_array());
        }
        if let Some(picture) = self.picture(thing, mesh) {
            let (uv, footprint) =
                seen.texel(picture, at(&mesh.uvs, triangle), direction, self.pitch);
            let [red, green, blue, _] = picture.read(uv, footprint, prepared.options.smooth);
            albedo *= rgb([red, green, blue]);
        }
        let finish = Finish {
            albedo,
            specular: material.specular,
            roughness: material.roughness,
            translucency: material.translucency,
        };
        self.lit(&finish, normal, direction, distance)
    }

    /// What arrives from a surface in the scene's light.
    #[inline(always)]
    fn lit(&self, finish: &Finish, normal: Vec3, direction: Vec3, distance: f32) -> Rgb {
        let light = &self.prepared.light;
        let point = self.stand.eye + direction * distance;
        let depth = light.depth(point.y);
        let sun = if depth > 0.0 { light.sun_below } else { light.sun };
        let facing = normal.dot(sun);
        let lit = facing > 0.0 || finish.translucency > 0.0;
        let sunlight =
            if lit { self.sunlight(point, normal * facing.signum(), depth) } else { Rgb::ZERO };
        let radiance = reflected(light, finish, sunlight, depth, normal, -direction);
        self.arriving(direction, distance, radiance)
    }

    /// Sunlight at a point whose surface faces the sun with this normal: dimmed by water, gathered by
    /// waves, kept off by what stands before it.
    #[inline(always)]
    pub fn sunlight(&self, point: Vec3, normal: Vec3, depth: f32) -> Rgb {
        let Prepared { light, waves, shadow, .. } = self.prepared;
        let mut strength = 1.0;
        if depth > 0.0 && light.caustics > 0.0 {
            strength = waves.caustic(light, point, depth);
        }
        if let Some(shadow) = shadow {
            strength *= shadow.lit(point, normal);
        }
        sunlight(light, depth) * strength
    }

    /// Radiance after its way to the eye.
    #[inline(always)]
    pub fn arriving(&self, direction: Vec3, distance: f32, radiance: Rgb) -> Rgb {
        let Prepared { light, waves, .. } = self.prepared;
        let slope = |point, distance| waves.slope(point, distance);
        arriving(light, &self.eye, direction, distance, radiance, slope)
    }

    /// What arrives from where there is nothing.
    #[inline(always)]
    pub fn background(&self, direction: Vec3) -> Rgb {
        let light: &Light = &self.prepared.light;
        let radiance = if self.eye.depth > 0.0 {
            Rgb::ZERO
        } else {
            sky(light, direction) + sun_disc(light, direction, 0.0)
        };
        self.arriving(direction, f32::INFINITY, radiance)
    }

    /// Whether a thing's texture is opaque where a ray meets its triangle. `corners` are relative to
    /// the eye, in the same axes as the ray.
    pub fn solid(
        &self,
        thing: &Thing,
        mesh: &Mesh,
        triangle: [u32; 3],
        corners: [Vec3; 3],
        ray: Vec3,
    ) -> bool {
        let Some(picture) = self.picture(thing, mesh) else { return true };
        let seen = Corner3::new(corners, ray);
        let (uv, footprint) = seen.texel(picture, at(&mesh.uvs, triangle), ray, self.pitch);
        picture.read(uv, footprint, self.prepared.options.smooth)[3] >= 0.5
    }

    #[inline(always)]
    fn picture(&self, thing: &Thing, mesh: &Mesh) -> Option<&'a Mipmap> {
        let picture = self.prepared.pictures[thing.batch as usize].as_deref();
        picture.filter(|_| !mesh.uvs.is_empty())
    }
}
