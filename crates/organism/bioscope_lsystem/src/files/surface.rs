use std::collections::BTreeMap;

use bioscope_core::Vec3;

use super::function::word_number;
use super::text::{Line, Text, numbers};
use crate::{Diagnostics, interpretation::Basis};

/// Most patches of one surface.
const PATCHES: usize = 4096;
/// Most quads along a side of a patch.
const QUADS: u32 = 32;

/// A predefined surface of bicubic Bézier patches, in a .s file.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceShape {
    /// Control points of each patch, 4 rows of 4: left, ahead and down of the turtle, metres.
    pub patches: Vec<[[Vec3; 4]; 4]>,
    /// Where the turtle goes after it has drawn the surface: left, ahead and down.
    pub end: Vec3,
    /// Quads along the rows and columns of a patch.
    pub quads: [u32; 2],
    /// Number of its texture; none leaves that to the turtle.
    pub texture: Option<u16>,
    /// Its triangles, in its own coordinates: left, ahead and up of the turtle.
    pub mesh: Tessellation,
}

/// Triangles of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tessellation {
    /// Places.
    pub positions: Vec<Vec3>,
    /// Unit normals.
    pub normals: Vec<Vec3>,
    /// Texture coordinates.
    pub uvs: Vec<[f32; 2]>,
    /// Corners.
    pub triangles: Vec<[u32; 3]>,
}

impl SurfaceShape {
    /// Reads a surface file and makes it so large that its SIZE becomes `size`.
    pub fn parse(bytes: &[u8], file: &str, size: f32) -> Result<Self, Diagnostics> {
        let text = Text::new(bytes, file)?;
        let lines: Vec<Line> = text.lines().collect();
        let start = lines.iter().position(|line| line.text.contains("CONTACT"));
        let start = start.ok_or_else(|| text.ends("'CONTACT POINT'"))?;
        let point = |offset: usize, name: &str| -> Result<Vec3, Diagnostics> {
            let line = lines.get(start + offset).ok_or_else(|| text.ends(name))?;
            labeled(&line.text)
                .ok_or_else(|| text.error(line, format!("expected {name} X: x Y: y Z: z")))
        };
        let contact = point(0, "CONTACT POINT")?;
        let end = point(1, "END POINT")?;
        let heading = point(2, "HEADING")?.normalize_or(Vec3::Y);
        let up = point(3, "UP")?.normalize_or(Vec3::Z);
        let line = lines.get(start + 4).ok_or_else(|| text.ends("'SIZE: s'"))?;
        let own = line.command().and_then(|(_, size)| numbers(size).first().copied());
        let own =
            own.filter(|&own| own > 0.0).ok_or_else(|| text.error(line, "expected SIZE: s"))?;
        let left = heading.cross(up);
        let up = left.cross(heading);
        let place = |point: Vec3| {
            let local = (point - contact) * (size / own);
            left * local.x + heading * local.y + up * local.z
        };
        let mut quads = [5, 5];
        if let Some(line) = lines[..start].iter().find(|line| line.text.contains("PRECISION")) {
            let words: Vec<&str> = line.text.split_whitespace().collect();
            let given = |index| word_number(&words, index).map(|quads| quads as u32);
            if let (Some(s), Some(t)) = (given(2), given(4)) {
                quads = [s.clamp(1, 10), t.clamp(1, 10)];
            }
        }
        let patches = read_patches(&text, &lines[start + 5..], place)?;
        Ok(Self::new(patches, place(end), quads))
    }

    /// A surface of these patches.
    pub fn new(patches: Vec<[[Vec3; 4]; 4]>, end: Vec3, quads: [u32; 2]) -> Self {
        let mut shape = Self { patches, end, quads, texture: None, mesh: Tessellation::default() };
        shape.tessellate(quads);
        shape
    }

    /// Makes the triangles anew, with so many quads per patch.
    pub fn tessellate(&mut self, quads: [u32; 2]) {
        self.quads = quads.map(|count| count.clamp(1, QUADS));
        let mut mesh = Tessellation::default();
        for patch in &self.patches {
            // The turtle's up is the file's down.
            let points = patch.map(|row| row.map(|p| Vec3::new(p.x, p.y, -p.z)));
            mesh.add_patch(&points, Basis::Bezier, self.quads);
        }
        mesh.smooth_seams();
        self.mesh = mesh;
    }
}

/// The point in `NAME X: x Y: y Z: z`.
fn labeled(text: &str) -> Option<Vec3> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let after = |label: &str| {
        let index = words.iter().position(|word| *word == label)?;
        word_number(&words, index + 1)
    };
    Some(Vec3::new(after("X:")?, after("Y:")?, after("Z:")?))
}

/// Reads the patches: name, colors, three lines of neighbors, 16 points in any lines.
fn read_patches(
    text: &Text,
    lines: &[Line],
    place: impl Fn(Vec3) -> Vec3,
) -> Result<Vec<[[Vec3; 4]; 4]>, Diagnostics> {
    let mut patches = Vec::new();
    let mut points: Vec<Vec3> = Vec::new();
    for line in lines {
        let row = numbers(&line.text);
        if row.len() < 3 || line.text.contains(':') {
            continue;
        }
        if !row.len().is_multiple_of(3) {
            return Err(text.error(line, "expected x, y and z of control points"));
        }
        points.extend(row.chunks_exact(3).map(|one| place(Vec3::from_slice(one))));
        while points.len() >= 16 {
            let patch = std::array::from_fn(|r| std::array::from_fn(|c| points[4 * r + c]));
            patches.push(patch);
            points.drain(..16);
            if patches.len() > PATCHES {
                return Err(text.error(line, "more than 4096 patches"));
            }
        }
    }
    if patches.is_empty() || !points.is_empty() {
        return Err(text.ends("16 control points of a patch"));
    }
    Ok(patches)
}

impl Tessellation {
    /// Adds a patch of so many quads along its rows and columns.
    pub fn add_patch(&mut self, points: &[[Vec3; 4]; 4], basis: Basis, quads: [u32; 2]) {
        let [rows, columns] = quads;
        let first = self.positions.len() as u32;
        for row in 0..=rows {
            let s = row as f32 / rows as f32;
            let (along, along_slope) = (weights(basis, s), slopes(basis, s));
            for column in 0..=columns {
                let t = column as f32 / columns as f32;
                let (across, across_slope) = (weights(basis, t), slopes(basis, t));
                let blend = |a: &[f32; 4], b: &[f32; 4]| {
                    let mut sum = Vec3::ZERO;
                    for (line, weight) in points.iter().zip(a) {
                        for (point, other) in line.iter().zip(b) {
                            sum += *point * (weight * other);
                        }
                    }
                    sum
                };
                let normal = blend(&along_slope, &across).cross(blend(&along, &across_slope));
                self.positions.push(blend(&along, &across));
                self.normals.push(normal.normalize_or_zero());
                self.uvs.push([t, s]);
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = first + row * (columns + 1) + column;
                let b = a + columns + 1;
                self.add_triangle([a, b, a + 1]);
                self.add_triangle([a + 1, b, b + 1]);
            }
        }
        self.mend_normals(first as usize);
    }

    /// Adds a triangle unless it is a line or a point.
    fn add_triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
        if a != b && b != c && c != a {
            self.triangles.push(corners);
        }
    }

    /// Gives vertices where the patch has no normal (points that fall together) that of the triangles around.
    fn mend_normals(&mut self, first: usize) {
        if self.normals[first..].iter().all(|normal| *normal != Vec3::ZERO) {
            return;
        }
        let missing: Vec<bool> = self.normals.iter().map(|normal| *normal == Vec3::ZERO).collect();
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| self.positions[corner as usize]);
            for &corner in corners {
                if missing[corner as usize] {
                    self.normals[corner as usize] += (b - a).cross(c - a);
                }
            }
        }
        for normal in &mut self.normals[first..] {
            *normal = normal.normalize_or(Vec3::Z).normalize_or(Vec3::Z);
        }
    }

    /// Gives vertices at one place one normal, where their normals do not differ by more than 60°.
    pub fn smooth_seams(&mut self) {
        let mut places: BTreeMap<[u32; 3], Vec<usize>> = BTreeMap::new();
        for (index, position) in self.positions.iter().enumerate() {
            // Rounding may tell the edges of neighboring patches apart.
            let key = position.to_array().map(|part| (part * 16384.0).round().to_bits());
            places.entry(key).or_default().push(index);
        }
        for group in places.values().filter(|group| group.len() > 1) {
            let normals: Vec<Vec3> = group.iter().map(|&index| self.normals[index]).collect();
            for &index in group {
                let own = self.normals[index];
                let alike = normals.iter().filter(|other| other.dot(own) > 0.5);
                let sum: Vec3 = alike.sum();
                self.normals[index] = sum.normalize_or(own);
            }
        }
    }
}

/// How much each of four points in a row counts at `t`.
fn weights(basis: Basis, t: f32) -> [f32; 4] {
    let (s, tt) = (1.0 - t, t * t);
    let ttt = tt * t;
    match basis {
        Basis::Bezier => [s * s * s, 3.0 * s * s * t, 3.0 * s * tt, ttt],
        Basis::BSpline => [
            s * s * s / 6.0,
            (3.0 * ttt - 6.0 * tt + 4.0) / 6.0,
            (-3.0 * ttt + 3.0 * tt + 3.0 * t + 1.0) / 6.0,
            ttt / 6.0,
        ],
        Basis::Cardinal => [
            (-ttt + 2.0 * tt - t) / 2.0,
            (3.0 * ttt - 5.0 * tt + 2.0) / 2.0,
            (-3.0 * ttt + 4.0 * tt + t) / 2.0,
            (ttt - tt) / 2.0,
        ],
    }
}

/// The derivatives of [`weights`].
fn slopes(basis: Basis, t: f32) -> [f32; 4] {
    let (s, tt) = (1.0 - t, t * t);
    match basis {
        Basis::Bezier => {
            [-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * tt, 3.0 * tt]
        }
        Basis::BSpline => [-s * s / 2.0, 1.5 * tt - 2.0 * t, -1.5 * tt + t + 0.5, tt / 2.0],
        Basis::Cardinal => [
            (-3.0 * tt + 4.0 * t - 1.0) / 2.0,
            (9.0 * tt - 10.0 * t) / 2.0,
            (-9.0 * tt + 8.0 * t + 1.0) / 2.0,
            (3.0 * tt - 2.0 * t) / 2.0,
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_grid_of_points_gives_a_plane() {
        let flat = std::array::from_fn(|row| {
            std::array::from_fn(|column| Vec3::new(column as f32, row as f32, 0.0))
        });
        for basis in [Basis::Bezier, Basis::BSpline, Basis::Cardinal] {
            let mut mesh = Tessellation::default();
            mesh.add_patch(&flat, basis, [4, 6]);
            assert_eq!((mesh.positions.len(), mesh.triangles.len()), (35, 48));
            assert!(mesh.positions.iter().all(|place| place.z.abs() < 1e-6), "{basis:?}");
            assert!(mesh.normals.iter().all(|normal| normal.z.abs() > 0.999), "{basis:?}");
            for corners in &mesh.triangles {
                let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
                let normal = mesh.normals[corners[0] as usize];
                assert!((b - a).cross(c - a).dot(normal) > 0.0, "{basis:?} is inside out");
            }
        }
    }

    const PETAL: &str = "-29.47 29.47   0.00 42.99   -17.00 0.00\n\
        CONTACT POINT  X: 0.00 Y: -0.50 Z: 0.00\nEND POINT  X: 0 Y: 19.295 Z: 0\n\
        HEADING  X: 0.00 Y: 1.00 Z: 0.00\nUP  X: 0.0 Y: 0.00 Z: 1.00\nSIZE: 39.59\nPetal_1\n\
        TOP COLOR: 0 DIFFUSE: 0.00 BOTTOM COLOR: 0 DIFFUSE: 0.00\nAL: ~ A: ~ AR: ~ \nL: ~ R: ~ \n\
        BL: ~ B: ~ BR: ~ \n-5.80 6.00 0.00  -13.00 15.00 0.00  -16.00 27.99 -7.50  -9.00 35.49 -7.50  \n\
        -1.00 0.00 0.00  -29.47 15.00 -17.00  -29.47 27.99 -17.00  -2.00 42.99 -7.50  \n\
        1.00 0.00 0.00  29.47 15.00 -17.00  29.47 27.99 -17.00  2.00 42.99 -7.50  \n\
        5.80 6.00 0.00  13.00 15.00 0.00  16.00 27.99 -7.50  9.00 35.49 -7.50  \n";

    #[test]
    fn a_petal_has_its_size_and_its_end() {
        let petal = SurfaceShape::parse(PETAL.as_bytes(), "petal.s", 2.0).unwrap();
        assert_eq!(petal.patches.len(), 1);
        assert!(petal.end.distance(Vec3::new(0.0, 1.0, 0.0)) < 1e-3, "{}", petal.end);
        let highest = petal.mesh.positions.iter().map(|place| place.y).fold(0.0, f32::max);
        assert!((1.8..2.2).contains(&highest), "{highest}");
        let cut = &PETAL[..PETAL.len() - 60];
        let error = SurfaceShape::parse(cut.as_bytes(), "petal.s", 1.0).unwrap_err().to_string();
        assert!(error.contains("petal.s:"), "{error}");
    }
}
