//! Fins as fans of rays between a base on the trunk and a free edge, in body lengths.

use bioscope_core::{Quat, Vec3};
use bioscope_motion::undulation::{Hinge, ORIGIN, Part};

use super::species::{FinLook, FishSpecies, MidlineFin, PairFin, Place, Side, TailFin};
use super::trunk::Trunk;

/// How far the base of a fin reaches into the trunk.
const ROOT: f32 = 0.012;
/// How far a sheet ripples, as a share of the length of its rays.
const RIPPLE: f32 = 0.03;

/// One fin of the left side or the middle.
#[derive(Clone, Debug)]
pub struct Fin {
    /// How it looks.
    pub look: FinLook,
    /// Front and rear end of the base.
    base: [Vec3; 2],
    /// The base between them follows the skin.
    ridge: Option<Side>,
    /// The free edge from front to rear.
    edge: Vec<Vec3>,
    /// Unit normal of the sheet.
    normal: Vec3,
    /// Whether the rays of the two halves curve away from each other.
    fanned: bool,
    /// Hinge of a paired fin on the left side.
    pub hinge: Option<Hinge>,
}

/// All fins of a species, tail first.
pub fn fins(species: &FishSpecies, trunk: &Trunk) -> Vec<Fin> {
    let tail = species.tail.iter().map(|tail| tail_fin(tail, trunk));
    let midline = species.fins.iter().map(|fin| midline_fin(fin, trunk));
    let pairs = species.pairs.iter().map(|pair| pair_fin(pair, trunk));
    tail.chain(midline).chain(pairs).collect()
}

fn in_side_view([at, y]: Place, aside: f32) -> Vec3 {
    Vec3::new(aside, y, ORIGIN - at)
}

fn tail_fin(tail: &TailFin, trunk: &Trunk) -> Fin {
    let at = trunk.end - ROOT;
    let (top, bottom) = (trunk.top(at), trunk.bottom(at));
    let inset = 0.06 * (top - bottom);
    Fin {
        look: tail.look.clone(),
        base: [in_side_view([at, top - inset], 0.0), in_side_view([at, bottom + inset], 0.0)],
        ridge: None,
        edge: tail.edge.iter().map(|&point| in_side_view(point, 0.0)).collect(),
        normal: Vec3::X,
        fanned: true,
        hinge: None,
    }
}

fn midline_fin(fin: &MidlineFin, trunk: &Trunk) -> Fin {
    let base = fin.base.map(|at| ridge_point(trunk, fin.on, at));
    Fin {
        look: fin.look.clone(),
        base,
        ridge: Some(fin.on),
        edge: fin.edge.iter().map(|&point| in_side_view(point, 0.0)).collect(),
        normal: Vec3::X,
        fanned: false,
        hinge: None,
    }
}

fn ridge_point(trunk: &Trunk, side: Side, at: f32) -> Vec3 {
    let (top, bottom) = (trunk.top(at), trunk.bottom(at));
    let root = ROOT.min(0.3 * (top - bottom));
    let y = match side {
        Side::Back => top - root,
        Side::Belly => bottom + root,
    };
    in_side_view([at, y], 0.0)
}

fn pair_fin(pair: &PairFin, trunk: &Trunk) -> Fin {
    let skin = pair.base.map(|place| trunk.point(place));
    let inward = pair.base.map(|place| trunk.frame(place).0 * (-0.4 * ROOT));
    let base = [skin[0] + inward[0], skin[1] + inward[1]];
    let last = (pair.edge.len() - 1) as f32;
    let flat: Vec<Vec3> = pair
        .edge
        .iter()
        .enumerate()
        .map(|(index, &point)| {
            let share = index as f32 / last;
            in_side_view(point, base[0].x + (base[1].x - base[0].x) * share)
        })
        .collect();
    let middle = 0.5 * (base[0] + base[1]);
    let reach = flat.iter().sum::<Vec3>() / flat.len() as f32 - middle;
    let along = (base[1] - base[0]).normalize_or(Vec3::NEG_Z);
    let axis = if along.cross(reach).x < 0.0 { -along } else { along };
    let spread = Quat::from_axis_angle(axis, pair.flare.to_radians());
    let part = if pair.rows {
        Part::Oar { across: (spread * reach).cross(axis).normalize_or(Vec3::X) }
    } else {
        Part::Flap
    };
    let edge: Vec<Vec3> = flat.iter().map(|&point| base[0] + spread * (point - base[0])).collect();
    Fin {
        look: pair.look.clone(),
        base,
        ridge: None,
        edge,
        normal: axis.cross(spread * reach).normalize_or(Vec3::X),
        fanned: false,
        hinge: Some(Hinge {
            position: middle,
            axis,
            side: 1.0,
            swing: pair.swing.to_radians(),
            part,
        }),
    }
}

/// The same hinge on the right side.
pub fn mirrored(hinge: Hinge) -> Hinge {
    let position = hinge.position;
    // Axes of rotation keep what lies across the mirror.
    let across_mirror = |axis: Vec3| Vec3::new(axis.x, -axis.y, -axis.z);
    let part = match hinge.part {
        Part::Oar { across } => Part::Oar { across: across_mirror(across) },
        part => part,
    };
    Hinge {
        position: Vec3::new(-position.x, position.y, position.z),
        axis: across_mirror(hinge.axis),
        side: -hinge.side,
        part,
        ..hinge
    }
}

/// A grid of points over a fin: rays side by side, each from base to edge.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Points, ray by ray.
    pub points: Vec<Vec3>,
    /// Place of each ray from front (0) to rear (1).
    pub rays: Vec<f32>,
    /// Points per ray.
    pub rows: usize,
    /// Half the thickness at each point.
    pub half_thickness: Vec<f32>,
}

impl Fin {
    /// Size in the texture: about the square root of the area.
    pub fn size(&self) -> f32 {
        let height = self.edge.iter().map(|point| point.distance(self.base[0])).fold(0.0, f32::max);
        (height * (self.base[0].distance(self.base[1]) + height)).sqrt()
    }

    /// Length of the rays from front to rear, as (place, length).
    pub fn ray_lengths(&self, trunk: &Trunk) -> Vec<[f32; 2]> {
        let grid = self.grid(trunk, 0.02, 2);
        let lengths = grid.points.chunks(2).map(|ends| ends[0].distance(ends[1]));
        grid.rays.iter().zip(lengths).map(|(&ray, length)| [ray, length]).collect()
    }

    /// Whether it is fanned out from the end of the trunk.
    pub fn is_tail(&self) -> bool {
        self.fanned
    }

    /// Unit normal of the sheet.
    pub fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Rays in steps of at most `step` along the edge, at least one per point of the edge, each
    /// with `rows` points.
    pub fn grid(&self, trunk: &Trunk, step: f32, rows: usize) -> Grid {
        let edge = smooth(&self.edge, step);
        let mut rays = vec![0.0];
        for two in edge.windows(2) {
            rays.push(rays[rays.len() - 1] + two[0].distance(two[1]).max(1e-5));
        }
        let total = rays[rays.len() - 1];
        rays.iter_mut().for_each(|ray| *ray /= total);
        let mut grid = Grid { points: vec![], rays, rows, half_thickness: vec![] };
        for (index, &tip) in edge.iter().enumerate() {
            let ray = grid.rays[index];
            let foot = self.foot(trunk, ray);
            for row in 0..rows {
                let share = row as f32 / (rows - 1) as f32;
                grid.points.push(self.on_ray(foot, tip, ray, share));
                grid.half_thickness.push(self.half_thickness(ray, share));
            }
        }
        grid
    }

    fn foot(&self, trunk: &Trunk, ray: f32) -> Vec3 {
        let point = self.base[0].lerp(self.base[1], ray);
        match self.ridge {
            Some(side) => ridge_point(trunk, side, ORIGIN - point.z),
            None => point,
        }
    }

    fn on_ray(&self, foot: Vec3, tip: Vec3, ray: f32, share: f32) -> Vec3 {
        let reach = tip - foot;
        let forward = self.normal.cross(reach);
        let forward = if self.fanned {
            forward * (2.0 * ray - 1.0)
        } else {
            // Towards the front ray.
            forward * forward.dot(self.edge[0] - self.edge[self.edge.len() - 1]).signum()
        };
        let hump = 4.0 * share * (1.0 - share);
        let ripple = RIPPLE * reach.length() * (9.0 * ray + 2.0 * share).sin() * share * share;
        let ripple = if self.look.thickness > 0.0 { 0.0 } else { ripple };
        foot + reach * share + forward * (self.look.bow * hump) + self.normal * ripple
    }

    /// Half the thickness of a foil: round in front, sharp behind, thinner towards the tip.
    fn half_thickness(&self, ray: f32, share: f32) -> f32 {
        let section = 2.6 * (ray.sqrt() - ray) * (1.0 - 0.35 * ray);
        0.5 * self.look.thickness * section.max(0.0) * (1.0 - share).max(0.0).powf(0.6)
    }
}

/// A smooth line through points (Catmull & Rom), in steps of at most `step`, through every point.
fn smooth(points: &[Vec3], step: f32) -> Vec<Vec3> {
    const MOST: f32 = 24.0;
    let last = points.len() - 1;
    let mut line = vec![points[0]];
    for segment in 0..last {
        let (from, to) = (points[segment], points[segment + 1]);
        let before = points[segment.saturating_sub(1)];
        let after = points[(segment + 2).min(last)];
        // Tangents no longer than the segment: no loops at a sharp tip.
        let chord = from.distance(to);
        let enter = (0.5 * (to - before)).clamp_length_max(chord);
        let leave = (0.5 * (after - from)).clamp_length_max(chord);
        let count = (chord / step).ceil().clamp(1.0, MOST) as usize;
        for index in 1..=count {
            let t = index as f32 / count as f32;
            let (t2, t3) = (t * t, t * t * t);
            line.push(
                from * (2.0 * t3 - 3.0 * t2 + 1.0)
                    + enter * (t3 - 2.0 * t2 + t)
                    + to * (3.0 * t2 - 2.0 * t3)
                    + leave * (t3 - t2),
            );
        }
    }
    line
}
