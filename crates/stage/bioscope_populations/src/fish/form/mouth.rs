//! The mouth: the trunk is slit along the lips, the lower lip goes with the jaw, and a dark roof and floor
//! close the mouth inside.

use std::collections::BTreeMap;

use bioscope_core::Vec3;
use bioscope_geometry::Mesh;
use bioscope_motion::undulation::{Hinge, ORIGIN, Part};

use super::super::species::{Line, Place};
use super::super::trunk::Trunk;
use super::{Level, station};

/// How far a jaw opens, and one on the underside, radians (choice).
const SWING: [f32; 2] = [0.5, 0.3];
/// Mouths that begin lower than this are on the underside, as in sharks.
const UNDERSIDE: f32 = 0.1;
/// How far behind an underside mouth its jaw ends, in lengths of the mouth.
const LONG_JAW: f32 = 1.5;

/// A slit along the grid of a trunk's rings and sides, the same on both flanks.
pub(super) struct Slit {
    /// Ring and side of the corner of the mouth on the left.
    corner: [usize; 2],
    /// The lips on the left, from the corner to the middle, without it.
    lips: Vec<[usize; 2]>,
    /// Rings between which the jaw lies.
    jaw: [usize; 2],
    /// Whether it is on the underside.
    under: bool,
    sides: usize,
    rings: usize,
}

/// A trunk with a mouth, and how far each of its vertices goes with the jaw, 0 to 1.
pub(super) struct Slitted {
    pub mesh: Mesh,
    pub jaw: Vec<f32>,
}

/// The hinge of the jaw, in body lengths.
pub(super) fn hinge(mouth: &Line, trunk: &Trunk) -> Hinge {
    let [front, corner] = ends(mouth);
    let (at, swing) = if front[1] < UNDERSIDE {
        (jaw_end(front, corner), SWING[1])
    } else {
        (corner[0], SWING[0])
    };
    let at = at.clamp(0.01, 0.19);
    let y = trunk.bottom(at) + (trunk.top(at) - trunk.bottom(at)) * corner[1];
    let position = Vec3::new(0.0, y, ORIGIN - at);
    Hinge { position, axis: Vec3::X, side: 0.0, swing, part: Part::Jaw }
}

fn ends(mouth: &Line) -> [Place; 2] {
    let path = &mouth.path;
    [path[0], path[path.len() - 1]]
}

fn jaw_end(front: Place, corner: Place) -> f32 {
    corner[0] + LONG_JAW * (corner[0] - front[0])
}

impl Slit {
    /// Where the grid of a level is slit; none if it is too coarse.
    pub fn new(mouth: &Line, trunk: &Trunk, level: Level) -> Option<Self> {
        let Level { rings, sides, .. } = level;
        let at = |ring: usize| trunk.end * station(ring as f32 / (rings - 1) as f32);
        let first_beyond = |place: f32| (1..rings).find(|&ring| at(ring) >= place);
        let [front, corner] = ends(mouth);
        let side = (((1.0 - corner[1]) * sides as f32).round() as usize).clamp(1, sides - 1);
        let under = front[1] < UNDERSIDE;
        let (ring, jaw, lips) = if under {
            let ring = first_beyond(0.5 * (front[0] + corner[0]))?;
            let end = first_beyond(jaw_end(front, corner))?.max(ring + 1);
            (ring, [ring, end], (side + 1..=sides).map(|side| [ring, side]).collect())
        } else {
            let ring = first_beyond(corner[0])?;
            (ring, [0, ring], (0..ring).rev().map(|ring| [ring, side]).collect())
        };
        Some(Self { corner: [ring, side], lips, jaw, under, sides, rings })
    }

    /// Cuts the trunk that was built for the level; `dark` are the texture coordinates of the inside.
    pub fn cut(&self, mut mesh: Mesh, dark: [f32; 2]) -> Slitted {
        let around = 2 * self.sides as u32;
        let left = |[ring, side]: [usize; 2]| ring as u32 * around + side as u32;
        let right =
            |[ring, side]: [usize; 2]| ring as u32 * around + (around - side as u32) % around;
        let mut lips = vec![left(self.corner)];
        lips.extend(self.lips.iter().map(|&place| left(place)));
        if !self.under {
            lips.push(self.rings as u32 * around);
        }
        let back = self.lips.iter().rev().filter(|place| place[1] < self.sides);
        lips.extend(back.map(|&place| right(place)));
        lips.push(right(self.corner));

        let mut jaw: Vec<f32> =
            (0..mesh.positions.len() as u32).map(|one| self.share(one)).collect();
        let mut lower = BTreeMap::new();
        for &lip in &lips[1..lips.len() - 1] {
            lower.insert(lip, mesh.positions.len() as u32);
            repeat(&mut mesh, lip);
            jaw.push(self.share_at(if lip == self.rings as u32 * around {
                0
            } else {
                lip / around
            }));
        }
        for triangle in &mut mesh.triangles {
            if triangle.iter().all(|&one| self.is_below(one)) {
                *triangle = triangle.map(|one| lower.get(&one).copied().unwrap_or(one));
            }
        }
        for (normal, opens) in [(Vec3::NEG_Y, false), (Vec3::Y, true)] {
            let edge =
                lips.iter().map(|lip| if opens { lower.get(lip).unwrap_or(lip) } else { lip });
            let edge: Vec<u32> = edge.copied().collect();
            fan(&mut mesh, &mut jaw, &edge, (normal, dark));
        }
        Slitted { mesh, jaw }
    }

    /// Ring and side of a vertex of the grid, the side counted on its own flank; none for the tips.
    fn place(&self, vertex: u32) -> Option<[usize; 2]> {
        let (vertex, around) = (vertex as usize, 2 * self.sides);
        let side = vertex % around;
        (vertex < self.rings * around).then_some([vertex / around, side.min(around - side)])
    }

    /// Whether a vertex of the grid lies on the jaw, its edges included.
    fn is_below(&self, vertex: u32) -> bool {
        match self.place(vertex) {
            Some([ring, side]) => {
                (self.jaw[0]..=self.jaw[1]).contains(&ring) && side >= self.corner[1]
            }
            None => !self.under && vertex as usize == self.rings * 2 * self.sides,
        }
    }

    /// How far a vertex of the grid goes with the jaw; the upper lip does not.
    fn share(&self, vertex: u32) -> f32 {
        let Some(place) = self.place(vertex) else { return 0.0 };
        let on_jaw = self.is_below(vertex) && place[1] > self.corner[1];
        if on_jaw && !self.lips.contains(&place) { self.share_at(place[0] as u32) } else { 0.0 }
    }

    /// The skin of the throat stretches between jaw and trunk.
    fn share_at(&self, ring: u32) -> f32 {
        let [fore, hind] = self.jaw.map(|ring| ring as f32);
        let share = ((ring as f32 - fore) / (hind - fore)).clamp(0.0, 1.0);
        1.0 - share * share
    }
}

/// Appends a copy of a vertex.
fn repeat(mesh: &mut Mesh, vertex: u32) {
    let vertex = vertex as usize;
    mesh.positions.push(mesh.positions[vertex]);
    mesh.normals.push(mesh.normals[vertex]);
    mesh.uvs.push(mesh.uvs[vertex]);
}

/// Roof or floor: triangles from a point between the corners of the mouth to its edge.
fn fan(mesh: &mut Mesh, jaw: &mut Vec<f32>, edge: &[u32], (normal, dark): (Vec3, [f32; 2])) {
    let first = mesh.positions.len() as u32;
    let place = |index: usize| mesh.positions[edge[index] as usize];
    let throat = 0.5 * (place(0) + place(edge.len() - 1));
    let points: Vec<Vec3> = (0..edge.len()).map(place).collect();
    mesh.positions.push(throat);
    jaw.push(0.0);
    mesh.positions.extend(points);
    jaw.extend(edge.iter().map(|&one| jaw[one as usize]).collect::<Vec<_>>());
    let count = edge.len() as u32;
    mesh.normals.extend((0..=count).map(|_| normal));
    mesh.uvs.extend((0..=count).map(|_| dark));
    mesh.triangles.extend((1..count).map(|index| {
        let (one, next) = (first + index, first + index + 1);
        if normal.y > 0.0 { [first, next, one] } else { [first, one, next] }
    }));
}
