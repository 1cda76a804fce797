//! From points to pixels and back, for both projections.
//!
//! The rasterizer never projects triangles: it asks for each pixel whether the pixel's exact ray passes
//! between the planes through the eye and the triangle's edges (homogeneous rasterization, Olano and Greer
//! 1997). That holds for any projection, needs no clipping and leaves no gaps. Projected vertices only say
//! which pixels are worth asking. With a perspective the tests are linear in the pixel's column
//! and row; with a fish-eye they are dot products with a table of rays.

use bioscope_core::{Quat, Vec3};
use wide::f32x4;

use super::arithmetic::{angle, unit};
use crate::{Camera, Projection};

/// Widest fish-eye, radians.
const WIDEST: f32 = 300.0 * std::f32::consts::PI / 180.0;

/// A vertex as a lens sees it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seen {
    /// Place relative to the camera, along its axes.
    pub point: Vec3,
    /// Where it is in the picture, pixels from the left and top edges.
    pub x: f32,
    pub y: f32,
    /// Perspective: distance along the axis. Fish-eye: angle from the axis.
    pub away: f32,
    /// One over the distance (fish-eye only).
    pub inverse: f32,
}

/// Columns and rows of the pixels that a triangle may cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    pub columns: [u32; 2],
    pub rows: [u32; 2],
}

impl Window {
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.columns[0] >= self.columns[1] || self.rows[0] >= self.rows[1]
    }
}

/// Samples per side of the blocks by which the rays of a fish-eye are bounded.
pub(crate) const BLOCK: u32 = 8;

/// All rays of a fish-eye, in camera space.
#[derive(Debug)]
pub(crate) struct Round {
    /// Four samples at a time, row by row.
    pub rays: Vec<[f32x4; 3]>,
    /// Per block a unit vector and the sine of the angle within which all its rays lie round it.
    pub blocks: Vec<(Vec3, f32)>,
    /// Blocks per row.
    pub across: u32,
}

/// A projection onto a grid of samples.
#[derive(Debug)]
pub(crate) struct Lens {
    pub projection: Projection,
    pub width: usize,
    pub height: usize,
    pub near: f32,
    pub far: f32,
    /// Pixels per unit of tangent, or per radian.
    pub scale: f32,
    pitch: f32,
    /// Middle of the picture.
    middle: [f32; 2],
    /// The rays of a fish-eye; none for a perspective.
    pub round: Option<Round>,
    /// Greatest angle of a visible ray from the axis.
    reach: f32,
    /// How far images of great circles bend from straight lines, by angle in sixteenths of a radian.
    bend: Vec<f32>,
}

impl Lens {
    /// The camera's projection on a grid; `samples` per pixel and direction.
    pub fn new(camera: &Camera, width: usize, height: usize, samples: usize) -> Self {
        let (width, height) = (width * samples, height * samples);
        let middle = [width as f32 * 0.5, height as f32 * 0.5];
        let near = if camera.near > 1e-6 { camera.near } else { 1e-6 };
        let far = if camera.far > near { camera.far } else { f32::INFINITY };
        let mut lens = Self {
            projection: camera.projection,
            width,
            height,
            near,
            far,
            scale: 1.0,
            pitch: 1.0,
            middle,
            round: None,
            reach: 0.0,
            bend: Vec::new(),
        };
        match camera.projection {
            Projection::Perspective { field_of_view } => {
                let half = (field_of_view * 0.5).clamp(1e-4, 1.55);
                lens.scale = middle[1] / half.tan();
                lens.reach = (middle[0].hypot(middle[1]) / lens.scale).atan();
            }
            Projection::Fisheye { field_of_view } => {
                let half = (field_of_view * 0.5).clamp(1e-4, WIDEST * 0.5);
                lens.scale = middle[0].min(middle[1]) / half;
                lens.reach = half;
                lens.bend = (0..52).map(|step| bend(step as f32 / 16.0)).collect();
                lens.round = Some(lens.all_rays());
            }
        }
        lens.pitch = 1.0 / lens.scale;
        lens
    }

    /// Groups of four samples per row.
    pub fn groups(&self) -> usize {
        self.width.div_ceil(4)
    }

    /// Unit vector, in camera space, through the middle of a sample; none outside a fish-eye's circle.
    #[inline(always)]
    pub fn ray(&self, column: usize, row: usize) -> Option<Vec3> {
        let x = column as f32 + 0.5 - self.middle[0];
        let y = self.middle[1] - row as f32 - 0.5;
        if self.round.is_none() {
            return Some(unit(Vec3::new(x, y, -self.scale)));
        }
        self.round_ray(column, row)
    }

    fn round_ray(&self, column: usize, row: usize) -> Option<Vec3> {
        let x = column as f32 + 0.5 - self.middle[0];
        let y = self.middle[1] - row as f32 - 0.5;
        let size = (x * x + y * y).sqrt();
        let turn = size / self.scale;
        if turn > self.reach {
            return None;
        }
        let aside = turn.sin() / size.max(1e-20);
        Some(Vec3::new(x * aside, y * aside, -turn.cos()))
    }

    fn all_rays(&self) -> Round {
        let mut rays = Vec::with_capacity(self.groups() * self.height);
        for row in 0..self.height {
            for group in 0..self.groups() {
                let four: [Vec3; 4] = std::array::from_fn(|lane| {
                    self.round_ray(group * 4 + lane, row).unwrap_or(Vec3::ZERO)
                });
                rays.push([
                    f32x4::from(four.map(|ray| ray.x)),
                    f32x4::from(four.map(|ray| ray.y)),
                    f32x4::from(four.map(|ray| ray.z)),
                ]);
            }
        }
        let block = BLOCK as usize;
        let (across, down) = (self.width.div_ceil(block), self.height.div_ceil(block));
        let blocks = (0..across * down).map(|index| self.block(index % across, index / across));
        Round { rays, blocks: blocks.collect(), across: across as u32 }
    }

    fn block(&self, column: usize, row: usize) -> (Vec3, f32) {
        let block = BLOCK as usize;
        let pixels = (0..block * block).map(|index| [index % block, index / block]);
        let rays = pixels.filter_map(|[x, y]| self.round_ray(column * block + x, row * block + y));
        let rays: Vec<Vec3> = rays.collect();
        let center = unit(rays.iter().sum());
        let cosine = rays.iter().map(|ray| ray.dot(center)).fold(1.0, f32::min);
        // A block that spans more than a quarter turn is never skipped.
        let sine = if cosine > 0.0 { (1.0 - cosine * cosine).sqrt() + 1e-3 } else { 2.0 };
        (center, sine)
    }

    /// Coefficients by which a test that is linear in rays becomes linear in (column, row, 1);
    /// unchanged for a fish-eye. Negated tests have exactly negated coefficients.
    #[inline(always)]
    pub fn coefficients(&self, test: Vec3) -> Vec3 {
        if self.round.is_some() {
            return test;
        }
        let column = test.x * self.pitch();
        let row = -test.y * self.pitch();
        let start = column * (0.5 - self.middle[0]) + row * (0.5 - self.middle[1]);
        Vec3::new(column, row, start - test.z)
    }

    /// A point given in camera space, as this lens sees it.
    #[inline(always)]
    pub fn see(&self, point: Vec3) -> Seen {
        if self.round.is_none() {
            let away = -point.z;
            let size = self.scale / away;
            let (x, y) = (self.middle[0] + point.x * size, self.middle[1] - point.y * size);
            return Seen { point, x, y, away, inverse: 0.0 };
        }
        let aside = point.x * point.x + point.y * point.y;
        let inverse = 1.0 / (aside + point.z * point.z).max(1e-30).sqrt();
        let aside = aside.max(1e-30).sqrt();
        let away = angle(aside, -point.z);
        let size = self.scale * away / aside;
        let (x, y) = (self.middle[0] + point.x * size, self.middle[1] - point.y * size);
        Seen { point, x, y, away, inverse }
    }

    /// Whether a triangle clearly shows its back; what is near the eye or nearly edge on is left to the exact
    /// test.
    #[inline(always)]
    pub fn turned_away(&self, [a, b, c]: [&Seen; 3]) -> bool {
        let before = a.away.min(b.away).min(c.away) >= self.near;
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        before && self.round.is_none() && area > 1e-3
    }

    /// The samples among `rows` that a triangle may cover.
    #[inline(always)]
    pub fn window(&self, corners: [&Seen; 3], rows: [u32; 2]) -> Option<Window> {
        let [a, b, c] = corners;
        let mut low = [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)];
        let mut high = [a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y)];
        let mut margin = 0.02;
        if self.round.is_some() {
            margin = self.bent(corners)?;
        } else if a.away < self.near || b.away < self.near || c.away < self.near {
            (low, high) = self.clipped(corners)?;
        }
        let missed = high[0] + margin < 0.0
            || low[0] - margin > self.width as f32
            || high[1] + margin < rows[0] as f32
            || low[1] - margin > rows[1] as f32;
        if missed {
            return None;
        }
        let bound = |value: f32, limit: u32| (value.max(0.0) as u32).min(limit);
        let columns = [
            bound(low[0] + 0.5 - margin, self.width as u32),
            bound(high[0] + 0.5 + margin, self.width as u32),
        ];
        let rows = [
            bound(low[1] + 0.5 - margin, rows[1]).max(rows[0]),
            bound(high[1] + 0.5 + margin, rows[1]),
        ];
        let window = Window { columns, rows };
        if window.is_empty() { None } else { Some(window) }
    }

    /// Corners of the box round the part of a triangle beyond the near plane of a perspective.
    #[cold]
    fn clipped(&self, corners: [&Seen; 3]) -> Option<([f32; 2], [f32; 2])> {
        let mut low = [f32::INFINITY; 2];
        let mut high = [f32::NEG_INFINITY; 2];
        let mut take = |seen: &Seen| {
            low = [low[0].min(seen.x), low[1].min(seen.y)];
            high = [high[0].max(seen.x), high[1].max(seen.y)];
        };
        for index in 0..3 {
            let (from, to) = (corners[index], corners[(index + 1) % 3]);
            let (before, after) = (from.away - self.near, to.away - self.near);
            if before >= 0.0 {
                take(from);
            }
            if (before < 0.0) != (after < 0.0) {
                let cut = from.point + (to.point - from.point) * (before / (before - after));
                take(&self.see(Vec3::new(cut.x, cut.y, -self.near)));
            }
        }
        (low[0] <= high[0]).then_some((low, high))
    }

    /// Pixels by which the image of a triangle may exceed the box round its corners: the images of
    /// its edges (great circles of angle l) leave their chords by at most bend · l² / 8. None if
    /// nothing of it can be seen; infinite near the point straight behind.
    #[inline(always)]
    fn bent(&self, [a, b, c]: [&Seen; 3]) -> Option<f32> {
        let chord = |from: &Seen, to: &Seen| {
            2.0 - 2.0 * (from.point.dot(to.point) * from.inverse * to.inverse)
        };
        let square = chord(a, b).max(chord(b, c)).max(chord(c, a)) + 1e-6;
        let square = square * (1.0 + 0.37 * square);
        let nearest = a.away.min(b.away).min(c.away);
        let farthest = a.away.max(b.away).max(c.away);
        if square < 0.01 {
            if nearest > self.reach + 0.1 {
                return None;
            }
            let step = ((farthest + 0.05) * 16.0) as usize + 1;
            let bend = self.bend.get(step).copied().unwrap_or(f32::INFINITY);
            return Some(0.05 + bend * square * 0.125 * self.scale);
        }
        let length = square.sqrt();
        if nearest > self.reach + length {
            return None;
        }
        let step = ((farthest + 0.5 * length) * 16.0) as usize + 1;
        let around = step > 48 || surrounds_back(a.point, b.point, c.point);
        let bend = if around { f32::INFINITY } else { self.bend[step] };
        Some(0.05 + bend * square * 0.125 * self.scale)
    }

    /// Rows that a ball may touch, none if it is out of sight. `center` is in camera space.
    pub fn sees_ball(&self, center: Vec3, radius: f32) -> Option<[u32; 2]> {
        let all = [0, self.height as u32];
        let distance = center.length();
        if distance - radius > self.far {
            return None;
        }
        if distance <= radius * 1.01 {
            return Some(all);
        }
        if self.round.is_some() {
            let away = angle(center.x.hypot(center.y), -center.z);
            return (away - (radius / distance).asin() <= self.reach + 0.01).then_some(all);
        }
        let away = -center.z;
        if away + radius < self.near {
            return None;
        }
        let [x, y] = self.middle.map(|half| half / self.scale);
        let outside = |offset: f32, slope: f32| {
            offset.abs() - away * slope > radius * (1.0 + slope * slope).sqrt()
        };
        if outside(center.x, x) || outside(center.y, y) {
            return None;
        }
        if away - radius < self.near {
            return Some(all);
        }
        let row = |height: f32| {
            let ends =
                [away - radius, away + radius].map(|z| self.middle[1] - height * self.scale / z);
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        };
        let (top, bottom) = (row(center.y + radius)[0] - 1.0, row(center.y - radius)[1] + 2.0);
        Some([(top.max(0.0) as u32).min(all[1]), (bottom.max(0.0) as u32).min(all[1])])
    }

    /// Diameter in samples of a ball seen from a distance.
    #[inline(always)]
    pub fn size(&self, radius: f32, distance: f32) -> f32 {
        2.0 * radius * self.scale / distance.max(self.near)
    }

    /// Angle between neighboring samples near the axis, radians.
    #[inline(always)]
    pub fn pitch(&self) -> f32 {
        self.pitch
    }

    /// Whether two cameras have the same lens.
    pub fn fits(&self, camera: &Camera) -> bool {
        let far = if camera.far > self.near { camera.far } else { f32::INFINITY };
        self.projection == camera.projection
            && self.near == camera.near.max(1e-6)
            && self.far == far
    }
}

/// Bound on how sharply the equidistant image of a great circle bends within `turn` of the axis, in
/// radians per radian squared (the greatest of both components of its second derivative).
fn bend(turn: f32) -> f32 {
    let turn = turn.max(1.0);
    if turn < 3.0 { 1.6 * turn / turn.sin().powi(2) } else { f32::INFINITY }
}

/// Whether a triangle contains the direction straight behind the camera.
fn surrounds_back(a: Vec3, b: Vec3, c: Vec3) -> bool {
    let sides = [a.cross(b).z, b.cross(c).z, c.cross(a).z];
    sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
}

/// Turns world vectors into camera space and back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stand {
    pub eye: Vec3,
    /// The camera's axes in the world.
    pub axes: [Vec3; 3],
}

impl Stand {
    pub fn new(camera: &Camera) -> Self {
        let turn = camera.rotation;
        let turn = if turn.is_finite() && turn.length_squared() > 1e-12 {
            turn.normalize()
        } else {
            Quat::IDENTITY
        };
        let eye = if camera.position.is_finite() { camera.position } else { Vec3::ZERO };
        Self { eye, axes: [turn * Vec3::X, turn * Vec3::Y, turn * Vec3::Z] }
    }

    #[inline(always)]
    pub fn inward(&self, point: Vec3) -> Vec3 {
        let offset = point - self.eye;
        Vec3::new(offset.dot(self.axes[0]), offset.dot(self.axes[1]), offset.dot(self.axes[2]))
    }

    #[inline(always)]
    pub fn outward(&self, direction: Vec3) -> Vec3 {
        self.axes[0] * direction.x + self.axes[1] * direction.y + self.axes[2] * direction.z
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn fisheye(degrees: f32) -> Lens {
        let projection = Projection::Fisheye { field_of_view: degrees.to_radians() };
        let camera = Camera { projection, ..Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 1.0) };
        Lens::new(&camera, 64, 64, 1)
    }

    #[test]
    fn fisheye_rays_turn_evenly_from_the_axis() {
        let lens = fisheye(300.0);
        for column in 0..64 {
            let turn = (column as f32 + 0.5 - 32.0) * (300f32.to_radians() / 64.0);
            let across = (0.5f32 * 300f32.to_radians() / 64.0).hypot(turn);
            let ray = lens.ray(column, 31);
            assert_eq!(ray.is_some(), across <= 150f32.to_radians());
            let Some(ray) = ray else { continue };
            assert!((ray.length() - 1.0).abs() < 1e-5);
            assert!(((-ray.z).acos() - across).abs() < 2e-3, "{column}: {ray} {across}");
            assert_eq!(ray.x > 0.0, turn > 0.0);
        }
        assert!(lens.ray(0, 0).is_none());
    }

    proptest! {
        #[test]
        fn seeing_undoes_the_ray(column in 0usize..64, row in 0usize..64, wide: bool, far in 0.1f32..50.0) {
            let camera = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 1.2);
            let lens = if wide { fisheye(280.0) } else { Lens::new(&camera, 64, 48, 1) };
            if let Some(ray) = lens.ray(column, row) {
                let seen = lens.see(ray * far);
                prop_assert!((seen.x - column as f32 - 0.5).abs() < 0.01, "{} {column}", seen.x);
                prop_assert!((seen.y - row as f32 - 0.5).abs() < 0.01, "{} {row}", seen.y);
            }
        }

        /// Every pixel whose ray meets the triangle lies in its window.
        #[test]
        fn windows_hold_the_whole_triangle(
            corners in prop::array::uniform3(prop::array::uniform3(-1f32..1.0)), wide: bool, scale in 0.01f32..1.0
        ) {
            let camera = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 1.2);
            let lens = if wide { fisheye(300.0) } else { Lens::new(&camera, 64, 64, 1) };
            let [a, b, c] = corners.map(Vec3::from);
            let [b, c] = [b, c].map(|corner| a + (corner - a) * scale);
            let seen = [a, b, c].map(|corner| lens.see(corner));
            let window = lens.window([&seen[0], &seen[1], &seen[2]], [0, 64]);
            let determinant = a.dot(b.cross(c));
            prop_assume!(determinant.abs() > 1e-6);
            for row in 0..64u32 {
                for column in 0..64u32 {
                    let Some(ray) = lens.ray(column as usize, row as usize) else { continue };
                    let sides = [b.cross(c), c.cross(a), a.cross(b)].map(|side| ray.dot(side) / determinant);
                    let along = sides[0] * a.z + sides[1] * b.z + sides[2] * c.z;
                    let near = !wide && -along / sides.iter().sum::<f32>() < lens.near;
                    if sides.iter().any(|&side| side <= 0.0) || near {
                        continue;
                    }
                    let inside = window.is_some_and(|window| {
                        (window.columns[0]..window.columns[1]).contains(&column)
                            && (window.rows[0]..window.rows[1]).contains(&row)
                    });
                    prop_assert!(inside, "{column} {row} outside {window:?}");
                }
            }
        }
    }
}
