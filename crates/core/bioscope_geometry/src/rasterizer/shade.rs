//! From "this sample sees that triangle" to its color.

use bioscope_core::Vec3;

use super::arithmetic::{Rgb, rgb, unit};
use super::lens::Stand;
use super::light::{Eye, Finish, Light, arriving, reflected, sky, sun_disc, sunlight};
use super::prepare::{Prepared, Thing};
use super::texture::{Level, Mipmap};
use crate::{Material, Mesh};

/// Colors what one eye sees.
pub(crate) struct Shader<'a> {
    pub prepared: &'a Prepared,
    pub stand: Stand,
    pub eye: Eye,
    /// Angle between neighboring pixels, radians.
    pub pitch: f32,
}

/// A triangle as one eye sees it, ready for many of its points.
pub(crate) struct Patch<'a> {
    material: &'a Material,
    picture: Option<&'a Mipmap>,
    /// Places relative to the eye.
    corners: [Vec3; 3],
    normals: [Vec3; 3],
    uvs: [[f32; 2]; 3],
    /// Color of the material times the instance's tint.
    color: Rgb,
    /// Vertex colors that multiply it.
    colors: Option<[Vec3; 3]>,
    /// Normals of the planes through the eye and the side opposite each corner.
    planes: [Vec3; 3],
    /// Twice the area, along the geometric normal.
    area: Vec3,
    /// Twice the area in texels.
    texels: f32,
}

/// Shares of a patch's corners at one of its points.
#[derive(Clone, Copy)]
struct Shares([f32; 3]);

impl Shares {
    #[inline(always)]
    fn mix(&self, [a, b, c]: [Vec3; 3]) -> Vec3 {
        a * self.0[0] + b * self.0[1] + c * self.0[2]
    }

    #[inline(always)]
    fn mix_uv(&self, [a, b, c]: [[f32; 2]; 3]) -> [f32; 2] {
        [0, 1].map(|axis| a[axis] * self.0[0] + b[axis] * self.0[1] + c[axis] * self.0[2])
    }
}

impl<'a> Patch<'a> {
    /// Shares of the corners where a ray meets the patch.
    #[inline(always)]
    fn shares(&self, direction: Vec3) -> Shares {
        let volumes = self.planes.map(|plane| direction.dot(plane));
        let whole = volumes[0] + volumes[1] + volumes[2];
        let inverse = if whole == 0.0 { 0.0 } else { 1.0 / whole };
        let first = (volumes[0] * inverse).clamp(0.0, 1.0);
        let second = (volumes[1] * inverse).clamp(0.0, 1.0 - first);
        Shares([first, second, 1.0 - first - second])
    }

    /// Color and opacity of the texture there; white without one. `pitch` is the angle between pixels.
    #[inline(always)]
    fn texel(&self, shares: &Shares, direction: Vec3, pitch: f32, smooth: bool) -> Rgb {
        let Some(picture) = self.picture else { return Rgb::ONE };
        let facing = self.area.dot(direction).abs().max(1e-12);
        let square = shares.mix(self.corners).length_squared();
        let footprint = (square * self.texels / facing).sqrt() * pitch;
        picture.read(shares.mix_uv(self.uvs), footprint, smooth)
    }

    /// The level of the texture that suits the patch's middle.
    #[inline(always)]
    pub fn level(&self, pitch: f32, smooth: bool) -> Option<&'a Level> {
        let middle = (self.corners[0] + self.corners[1] + self.corners[2]) * (1.0 / 3.0);
        let square = middle.length_squared();
        let facing = self.area.dot(middle).abs().max(1e-12);
        let footprint = (square * square.sqrt() * self.texels / facing).sqrt() * pitch;
        Some(self.picture?.level(footprint, smooth))
    }

    /// Vectors whose products with a ray are u, v and 1, all multiplied by the same number.
    #[inline(always)]
    pub fn texture_planes(&self) -> [Vec3; 3] {
        let [a, b, c] = self.planes;
        let mix = |[x, y, z]: [f32; 3]| a * x + b * y + c * z;
        let uvs = self.uvs;
        [mix(uvs.map(|uv| uv[0])), mix(uvs.map(|uv| uv[1])), mix([1.0; 3])]
    }
}

/// Values of an attribute at a triangle's corners.
#[inline(always)]
fn at<T: Copy>(values: &[T], triangle: [u32; 3]) -> [T; 3] {
    triangle.map(|corner| values[corner as usize])
}

impl<'a> Shader<'a> {
    /// A triangle of a thing at a level of detail, ready to be colored.
    #[inline(always)]
    pub fn patch(&self, thing: &Thing, level: usize, triangle: usize) -> Patch<'a> {
        let prepared = self.prepared;
        let posed = prepared.posed(thing, level);
        let mesh: &Mesh = &prepared.part(thing).levels[level].1;
        let triangle = mesh.triangles[triangle];
        let places = at(&posed.points, triangle).map(|corner| corner - self.stand.eye);
        let mut patch = self.bare_patch(thing, mesh, triangle, places);
        patch.normals = at(&posed.normals, triangle);
        patch.color = rgb(patch.material.color) * prepared.tint(thing);
        if !mesh.colors.is_empty() {
            patch.colors = Some(at(&mesh.colors, triangle).map(Vec3::from));
        }
        patch
    }

    /// A triangle with its texture only; `corners` are relative to the eye, in any axes.
    #[inline(always)]
    pub fn bare_patch(
        &self,
        thing: &Thing,
        mesh: &Mesh,
        triangle: [u32; 3],
        corners: [Vec3; 3],
    ) -> Patch<'a> {
        let picture = self.prepared.pictures[thing.batch as usize].as_deref();
        let picture = picture.filter(|_| !mesh.uvs.is_empty());
        let uvs = if picture.is_some() { at(&mesh.uvs, triangle) } else { [[0.0; 2]; 3] };
        let [[u, v], second, third] = uvs;
        let spread = (second[0] - u) * (third[1] - v) - (third[0] - u) * (second[1] - v);
        let [a, b, c] = corners;
        Patch {
            material: &self.prepared.scene.batches[thing.batch as usize].material,
            picture,
            corners,
            normals: [Vec3::Y; 3],
            uvs,
            color: Rgb::ONE,
            colors: None,
            planes: [b.cross(c), c.cross(a), a.cross(b)],
            area: (b - a).cross(c - a),
            texels: spread.abs() * picture.map_or(0.0, Mipmap::texels),
        }
    }

    /// What arrives at the eye from a point of a patch, at `distance` along a unit direction.
    #[inline(always)]
    pub fn surface(&self, patch: &Patch, direction: Vec3, distance: f32) -> Rgb {
        let shares = patch.shares(direction);
        let mut normal = unit(shares.mix(patch.normals));
        if patch.area.dot(direction) > 0.0 {
            normal = -normal;
        }
        let smooth = self.prepared.options.smooth;
        let mut albedo = patch.color * patch.texel(&shares, direction, self.pitch, smooth);
        if let Some(colors) = patch.colors {
            albedo *= rgb(shares.mix(colors).to_array());
        }
        let Material { specular, roughness, translucency, .. } = *patch.material;
        let finish = Finish { albedo, specular, roughness, translucency };
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
}
