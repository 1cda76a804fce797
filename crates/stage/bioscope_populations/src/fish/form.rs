//! From a species to a body: a lofted, skinned mesh in several levels of detail with its material.

use std::sync::Arc;

use bioscope_core::Vec3;
use bioscope_geometry::{Material, Mesh, Skin, Texture};
use bioscope_motion::undulation::{Hinge, ORIGIN, Spine};

use super::atlas::{Atlas, Cell};
use super::fins::{self, Fin};
use super::paint;
use super::species::{Detail, Eye, FishSpecies};
use super::trunk::Trunk;
use mouth::Slit;

mod mouth;

/// What is needed to show fishes of one species.
#[derive(Clone, Debug)]
pub struct FishForm {
    /// Skinned mesh of an average individual, metres, with coarser levels. Snout at +Z.
    pub mesh: Arc<Mesh>,
    /// Its skin.
    pub material: Arc<Material>,
    /// By what it bends; its joints are those of the mesh.
    pub spine: Spine,
    /// Whole length of an average individual, metres.
    pub length: f32,
}

/// How finely one level is built.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// Used from this size on screen downward, pixels.
    pixels: f32,
    /// Cross sections from snout to tail.
    rings: usize,
    /// Faces from back to belly on each side.
    sides: usize,
    /// Greatest distance between neighboring rays of a fin, body lengths.
    step: f32,
    /// Points on a ray.
    rows: usize,
    /// Faces round an eye, none for painted eyes.
    eye: usize,
}

const PLAIN: [Level; 4] = [
    Level { pixels: f32::INFINITY, rings: 22, sides: 6, step: 0.05, rows: 3, eye: 12 },
    Level { pixels: 60.0, rings: 11, sides: 4, step: 0.1, rows: 2, eye: 0 },
    Level { pixels: 16.0, rings: 6, sides: 2, step: 1.0, rows: 2, eye: 0 },
    Level { pixels: 6.0, rings: 3, sides: 2, step: 1.0, rows: 2, eye: 0 },
];

const FINE: [Level; 4] = [
    Level { pixels: f32::INFINITY, rings: 44, sides: 12, step: 0.025, rows: 5, eye: 18 },
    Level { pixels: 160.0, rings: 24, sides: 7, step: 0.05, rows: 3, eye: 10 },
    Level { pixels: 50.0, rings: 12, sides: 4, step: 0.1, rows: 2, eye: 0 },
    Level { pixels: 14.0, rings: 6, sides: 2, step: 1.0, rows: 2, eye: 0 },
];

impl FishForm {
    /// Builds the body of a species that was checked.
    pub fn new(species: &FishSpecies) -> Self {
        let body = Body::new(species);
        let texture = paint::paint(species, &body.trunk, &body.fins, &body.atlas);
        Self {
            mesh: Arc::new(body.meshes(species)),
            material: Arc::new(material(species, texture)),
            spine: body.spine,
            length: species.length,
        }
    }
}

fn material(species: &FishSpecies, texture: Texture) -> Material {
    let sheen = species.skin.sheen;
    Material {
        name: species.name.clone(),
        color: [1.0; 3],
        texture: Some(Arc::new(texture)),
        cutout: true,
        roughness: 0.55 - 0.27 * sheen,
        specular: 0.04 + 0.36 * sheen,
        translucency: 0.1,
        two_sided: true,
        ..Material::default()
    }
}

/// The spine of the species, its mass shared out by the cross sections of the trunk.
fn spine(species: &FishSpecies, trunk: &Trunk, fins: &[Fin], links: usize) -> Spine {
    let length = species.length;
    let cuts = Spine::even_cuts(links);
    // A tail fin weighs little.
    let tail = 0.02 * trunk.area(0.4 * trunk.end);
    let area = |at: f32| if at < trunk.end { trunk.area(at) } else { tail };
    let masses = cuts.windows(2).map(|ends| {
        let middle = |share: f32| ends[0] + (ends[1] - ends[0]) * share;
        (ends[1] - ends[0]) * (area(middle(0.25)) + area(middle(0.5)) + area(middle(0.75)))
    });
    let hinges = fins
        .iter()
        .filter_map(|fin| fin.hinge)
        .flat_map(|hinge| [hinge, fins::mirrored(hinge)])
        .chain(jaw(species, trunk))
        .map(|hinge| Hinge { position: hinge.position * length, ..hinge });
    Spine::new(length, species.gait(), cuts.clone(), masses.collect(), hinges.collect())
        .expect("a species that was checked has a length and a body")
}

/// The hinge of the jaw, in body lengths; fishes of a school are too small for a mouth that opens.
fn jaw(species: &FishSpecies, trunk: &Trunk) -> Option<Hinge> {
    (species.detail == Detail::Fine).then(|| mouth::hinge(&species.mouth, trunk))
}

/// A part of the body, in body lengths.
struct Part {
    mesh: Mesh,
    /// The joint that carries the whole part; none for the spine.
    joint: Option<u8>,
    /// How far each vertex goes with the jaw instead; empty where none does.
    jaw: Vec<f32>,
}

impl Part {
    /// A part that goes with the spine, or with a joint.
    fn new(mesh: Mesh, joint: Option<u8>) -> Self {
        Self { mesh, joint, jaw: Vec::new() }
    }
}

/// The parts of a body before they become triangles.
struct Body {
    trunk: Trunk,
    fins: Vec<Fin>,
    atlas: Atlas,
    spine: Spine,
}

impl Body {
    fn new(species: &FishSpecies) -> Self {
        let links = match species.detail {
            Detail::Plain => 7,
            Detail::Fine => 9,
        };
        let trunk = Trunk::new(&species.outline);
        let fins = fins::fins(species, &trunk);
        let atlas = Atlas::new(&fins.iter().map(Fin::size).collect::<Vec<_>>());
        let spine = spine(species, &trunk, &fins, links);
        Self { trunk, fins, atlas, spine }
    }

    /// The finest mesh, with the coarser ones.
    fn meshes(&self, species: &FishSpecies) -> Mesh {
        let [finest, coarser @ ..] = match species.detail {
            Detail::Plain => PLAIN,
            Detail::Fine => FINE,
        };
        let level = |level: Level| (level.pixels, Arc::new(self.mesh(species, level)));
        let levels = coarser.into_iter().map(level).collect();
        Mesh { levels, ..self.mesh(species, finest) }
    }

    fn mesh(&self, species: &FishSpecies, level: Level) -> Mesh {
        let mut parts = vec![self.trunk_part(species, level)];
        if level.eye > 0 {
            let eye = eye_mesh(&species.eye, &self.trunk, self.atlas.eye, level.eye);
            parts.push(Part::new(mirror(&eye), None));
            parts.push(Part::new(eye, None));
        }
        let mut joint = self.spine.link_count() as u8;
        for (fin, &cell) in self.fins.iter().zip(&self.atlas.fins) {
            let hinged = fin.hinge.is_some();
            // Too small to be seen at this size.
            let mesh = if fin.size() * level.pixels < 2.0 {
                Mesh::default()
            } else {
                fin_mesh(fin, &self.trunk, cell, level)
            };
            if hinged {
                parts.push(Part::new(mirror(&mesh), Some(joint + 1)));
                joint += 2;
            }
            parts.push(Part::new(mesh, hinged.then(|| joint - 2)));
        }
        self.join(&parts)
    }

    /// The trunk; near by, where eyes stand out, its mouth can open.
    fn trunk_part(&self, species: &FishSpecies, level: Level) -> Part {
        let mesh = trunk_mesh(&self.trunk, self.atlas.trunk, level);
        let has_mouth = level.eye > 0 && species.detail == Detail::Fine;
        match has_mouth.then(|| Slit::new(&species.mouth, &self.trunk, level)).flatten() {
            Some(slit) => {
                let pupil = self.atlas.eye.uv(0.5, 0.5);
                let mouth::Slitted { mesh, jaw } = slit.cut(mesh, pupil);
                Part { mesh, joint: None, jaw }
            }
            None => Part::new(mesh, None),
        }
    }

    /// One skinned mesh of all parts, in metres.
    fn join(&self, parts: &[Part]) -> Mesh {
        let mut whole = Mesh::default();
        let mut skin = Skin { joints: self.spine.joints(), indices: vec![], weights: vec![] };
        for part in parts {
            for (vertex, point) in part.mesh.positions.iter().enumerate() {
                let jaw = part.jaw.get(vertex).copied().unwrap_or(0.0);
                let (indices, weights) = match part.joint {
                    Some(joint) => ([joint, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]),
                    None if jaw > 0.0 => {
                        ([0, self.spine.joint_count() as u8 - 1, 0, 0], [1.0 - jaw, jaw, 0.0, 0.0])
                    }
                    None => self.spine.weights(ORIGIN - point.z),
                };
                skin.indices.push(indices);
                skin.weights.push(weights);
            }
            let first = whole.positions.len() as u32;
            let scaled = part.mesh.positions.iter().map(|&point| point * self.spine.length());
            whole.positions.extend(scaled);
            whole.normals.extend(&part.mesh.normals);
            whole.uvs.extend(&part.mesh.uvs);
            whole
                .triangles
                .extend(part.mesh.triangles.iter().map(|one| one.map(|index| index + first)));
        }
        whole.skin = Some(skin);
        whole
    }
}

/// The trunk: rings from snout to tail, closed at both ends.
fn trunk_mesh(trunk: &Trunk, cell: Cell, level: Level) -> Mesh {
    let Level { rings, sides, .. } = level;
    let around = 2 * sides;
    let mut mesh = Mesh::default();
    for ring in 0..rings {
        let share = ring as f32 / (rings - 1) as f32;
        let at = trunk.end * station(share);
        for side in 0..around {
            let down = if side <= sides { side } else { around - side } as f32 / sides as f32;
            let point = trunk.point([at, 1.0 - down]);
            let aside = if side <= sides { point.x } else { -point.x };
            mesh.positions.push(Vec3::new(aside, point.y, point.z));
            mesh.uvs.push(cell.uv(at / trunk.end, down));
        }
    }
    let vertex = |ring: usize, side: usize| (ring * around + side % around) as u32;
    let snout = mesh.positions.len() as u32;
    let ahead = 0.35 * (trunk.top(0.0) - trunk.bottom(0.0));
    mesh.positions.push(middle(trunk, 0.0) + Vec3::Z * ahead);
    mesh.uvs.push(cell.uv(0.0, 0.5));
    for side in 0..around {
        mesh.triangles.push([snout, vertex(0, side + 1), vertex(0, side)]);
        for ring in 1..rings {
            let [a, b] = [vertex(ring - 1, side), vertex(ring - 1, side + 1)];
            let [c, d] = [vertex(ring, side), vertex(ring, side + 1)];
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    mesh.compute_normals();
    // A wedge reaches into the tail fin; each side has its own tip, so that its flat sides are shaded flat.
    let behind = (0.4 * (trunk.top(trunk.end) - trunk.bottom(trunk.end))).min(0.03);
    for normal in [Vec3::X, Vec3::NEG_X] {
        mesh.positions.push(middle(trunk, trunk.end) - Vec3::Z * behind);
        mesh.normals.push(normal);
        mesh.uvs.push(cell.uv(1.0, 0.5));
    }
    for side in 0..around {
        let tip = snout + if side < sides { 1 } else { 2 };
        mesh.triangles.push([tip, vertex(rings - 1, side), vertex(rings - 1, side + 1)]);
    }
    mesh
}

/// Where a cross section lies on the trunk: close together at the snout, even from the gills on.
fn station(share: f32) -> f32 {
    const HEAD: f32 = 0.35;
    let steep = 1.0 / (HEAD * (2.0 - HEAD));
    if share < HEAD { steep * share * share } else { steep * HEAD * (2.0 * share - HEAD) }
}

fn middle(trunk: &Trunk, at: f32) -> Vec3 {
    Vec3::new(0.0, 0.5 * (trunk.top(at) + trunk.bottom(at)), ORIGIN - at)
}

/// The left eye: a dome that fits the head at its rim.
fn eye_mesh(eye: &Eye, trunk: &Trunk, cell: Cell, faces: usize) -> Mesh {
    const RINGS: usize = 3;
    let (normal, _) = trunk.frame(eye.place);
    let girth = trunk.girth(eye.place);
    let dome = |rise: f32, aft: f32| {
        let out = rise.hypot(aft).min(1.0);
        let height = eye.bulge * (1.0 - out * out).sqrt() - 0.03 * out;
        let place = [eye.place[0] + aft * eye.radius, eye.place[1] + rise * eye.radius / girth];
        trunk.point(place) + normal * (height * eye.radius)
    };
    let mut mesh = Mesh::default();
    for ring in 1..=RINGS {
        let out = (ring as f32 / RINGS as f32).sqrt();
        for face in 0..faces {
            let angle = std::f32::consts::TAU * face as f32 / faces as f32;
            let (rise, aft) = (angle.sin() * out, angle.cos() * out);
            mesh.positions.push(dome(rise, aft));
            mesh.uvs.push(cell.uv(0.5 + 0.5 * aft, 0.5 - 0.5 * rise));
        }
    }
    let top = mesh.positions.len() as u32;
    mesh.positions.push(dome(0.0, 0.0));
    mesh.uvs.push(cell.uv(0.5, 0.5));
    let vertex = |ring: usize, face: usize| (ring * faces + face % faces) as u32;
    for face in 0..faces {
        mesh.triangles.push([top, vertex(0, face + 1), vertex(0, face)]);
        for ring in 1..RINGS {
            let [a, b] = [vertex(ring - 1, face), vertex(ring - 1, face + 1)];
            let [c, d] = [vertex(ring, face), vertex(ring, face + 1)];
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    face_outward(&mut mesh, normal);
    mesh
}

/// A fin: one sheet, or the two faces of a foil.
fn fin_mesh(fin: &Fin, trunk: &Trunk, cell: Cell, level: Level) -> Mesh {
    let grid = fin.grid(trunk, level.step, level.rows);
    let mut mesh = Mesh::default();
    let faces: &[f32] = if fin.look.thickness > 0.0 { &[1.0, -1.0] } else { &[0.0] };
    for &face in faces {
        let mut sheet = Mesh::default();
        for (index, &point) in grid.points.iter().enumerate() {
            let ray = grid.rays[index / grid.rows];
            let out = (index % grid.rows) as f32 / (grid.rows - 1) as f32;
            sheet.positions.push(point + fin.normal() * (face * grid.half_thickness[index]));
            sheet.uvs.push(cell.uv(ray, 1.0 - out));
        }
        for ray in 1..grid.rays.len() {
            for row in 1..grid.rows {
                let vertex = |ray: usize, row: usize| (ray * grid.rows + row) as u32;
                let [a, b] = [vertex(ray - 1, row - 1), vertex(ray, row - 1)];
                let [c, d] = [vertex(ray - 1, row), vertex(ray, row)];
                sheet.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
        face_outward(&mut sheet, fin.normal() * if face < 0.0 { -1.0 } else { 1.0 });
        let first = mesh.positions.len() as u32;
        mesh.positions.append(&mut sheet.positions);
        mesh.normals.append(&mut sheet.normals);
        mesh.uvs.append(&mut sheet.uvs);
        mesh.triangles.extend(sheet.triangles.iter().map(|one| one.map(|index| index + first)));
    }
    mesh
}

/// Turns the triangles so that their normals are on the side of `outward`, and computes the normals.
fn face_outward(sheet: &mut Mesh, outward: Vec3) {
    let points = &sheet.positions;
    let area: Vec3 = sheet
        .triangles
        .iter()
        .map(|one| {
            let [a, b, c] = one.map(|index| points[index as usize]);
            (b - a).cross(c - a)
        })
        .sum();
    if area.dot(outward) < 0.0 {
        sheet.triangles.iter_mut().for_each(|one| one.swap(1, 2));
    }
    sheet.compute_normals();
}

/// The same part on the other side.
fn mirror(part: &Mesh) -> Mesh {
    let flip = |point: &Vec3| Vec3::new(-point.x, point.y, point.z);
    Mesh {
        positions: part.positions.iter().map(flip).collect(),
        normals: part.normals.iter().map(flip).collect(),
        uvs: part.uvs.clone(),
        triangles: part.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        ..Mesh::default()
    }
}

#[cfg(test)]
mod tests;
