use bioscope_core::{Error, Result};
use serde::{Deserialize, Serialize};

use super::anatomy::Anatomy;
use super::real::{Real, Triple, add, cross, dot, scale, sub};
use super::skyline::Block;

/// How the push of the water depends on the velocity v of a surface triangle of area A and outward normal n. Only
/// triangles that advance into the water (n·v > 0) are pushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// −μ A |v| (n·v) n (Tu, "Artificial Animals for Computer Animation", section 4.1.3).
    Quadratic,
    /// −μ A (n·v) n (Terzopoulos, Tu & Grzeszczuk, "Artificial Fishes", 1994); μ is per unit of speed.
    Linear,
    /// −μ A (n·v)² n: the flow along a surface adds nothing to the pressure across it (the cross-flow principle;
    /// Hoerner, "Fluid-Dynamic Drag", 1965, chapter 3). A slender snout then parts the water with little drag.
    CrossFlow,
}

/// How the water pushes one kind of surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// How the push depends on the velocity.
    pub law: Law,
    /// μ in body masses per body length cubed.
    pub push: f64,
}

/// The fluid round a body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Medium {
    /// Push on the trunk.
    pub trunk: Surface,
    /// Push on the tail fin.
    pub fin: Surface,
    /// Friction along all surfaces, −σ A |v| (v − (n·v) n), in the same unit.
    pub friction: f64,
    /// Fluid relative to water: 0 is air, 1 water, more is oil.
    pub thickness: f64,
}

impl Medium {
    /// Refuses negative and infinite numbers.
    pub fn checked(self) -> Result<Self> {
        for (name, value) in [
            ("push on the trunk", self.trunk.push),
            ("push on the fin", self.fin.push),
            ("friction", self.friction),
            ("thickness", self.thickness),
        ] {
            if !(0.0..=1e6).contains(&value) {
                return Err(Error::value(format!("water: {name}"), value, "0 to 1,000,000"));
            }
        }
        Ok(self)
    }

    #[inline(always)]
    fn surface(&self, anatomy: &Anatomy, face: usize) -> Surface {
        if face < anatomy.fin { self.trunk } else { self.fin }
    }
}

/// Force on one triangle, and how it opposes a change of its velocity: `along` n nᵀ + `across` (1 − n nᵀ).
struct Push<R> {
    force: Triple<R>,
    normal: Triple<R>,
    along: R,
    across: R,
}

#[inline(always)]
fn push<R: Real>(
    medium: &Medium,
    surface: Surface,
    points: [Triple<R>; 3],
    velocity: Triple<R>,
) -> Push<R> {
    let tiny = R::splat(1e-20);
    let zero = R::splat(0.0);
    let span = cross(sub(points[1], points[0]), sub(points[2], points[0]));
    let twice_area = (dot(span, span) + tiny).sqrt();
    let normal = scale(span, R::splat(1.0) / twice_area);
    let area = twice_area * R::splat(0.5 * medium.thickness);
    let speed = (dot(velocity, velocity) + tiny).sqrt();
    let through = dot(normal, velocity);
    let into = through.max(zero);
    let pushing = area * R::splat(surface.push);
    let (pressure, slope) = match surface.law {
        Law::Quadratic => (speed * into, R::splat(2.0) * speed.min(into * R::splat(1e6))),
        Law::Linear => (into, (into * R::splat(1e6)).min(R::splat(1.0))),
        Law::CrossFlow => (into * into, R::splat(2.0) * into),
    };
    let drag = area * R::splat(medium.friction) * speed;
    let slip = sub(velocity, scale(normal, through));
    let force = sub(scale(normal, -(pushing * pressure)), scale(slip, drag));
    Push { force, normal, along: pushing * slope, across: drag }
}

/// Adds the forces of the water to `forces`. `flow` is its velocity at each node, body lengths per time
/// unit.
#[inline(always)]
pub(super) fn add_forces<R: Real>(
    anatomy: &Anatomy,
    medium: &Medium,
    [position, velocity, flow]: [&[Triple<R>]; 3],
    forces: &mut [Triple<R>],
) {
    for (index, &face) in anatomy.faces.iter().enumerate() {
        let surface = medium.surface(anatomy, index);
        let relative = relative_velocity(face, velocity, flow);
        let Push { force, .. } =
            push(medium, surface, face.map(|corner| position[corner]), relative);
        let share = scale(force, R::splat(1.0 / 3.0));
        for corner in face {
            forces[corner] = add(forces[corner], share);
        }
    }
}

/// The same, and adds `dt` times the resistance of the water to changes of velocity to `matrix`.
#[inline(always)]
pub(super) fn add_forces_and_resistance<R: Real>(
    anatomy: &Anatomy,
    medium: &Medium,
    [position, velocity, flow]: [&[Triple<R>]; 3],
    forces: &mut [Triple<R>],
    (matrix, dt): (&mut [Block<R>], R),
) {
    let ninth = dt * R::splat(1.0 / 9.0);
    for (index, (&face, places)) in anatomy.faces.iter().zip(&anatomy.face_places).enumerate() {
        let surface = medium.surface(anatomy, index);
        let relative = relative_velocity(face, velocity, flow);
        let found = push(medium, surface, face.map(|corner| position[corner]), relative);
        let share = scale(found.force, R::splat(1.0 / 3.0));
        for corner in face {
            forces[corner] = add(forces[corner], share);
        }
        let across = found.across * ninth;
        let block = dyad(found.normal, found.along * ninth - across, across);
        for place in places.corners.into_iter().chain(places.sides) {
            add_symmetric(&mut matrix[place], &block);
        }
    }
}

#[inline(always)]
fn relative_velocity<R: Real>(
    [a, b, c]: [usize; 3],
    velocity: &[Triple<R>],
    flow: &[Triple<R>],
) -> Triple<R> {
    let sum = add(add(velocity[a], velocity[b]), velocity[c]);
    let water = add(add(flow[a], flow[b]), flow[c]);
    scale(sub(sum, water), R::splat(1.0 / 3.0))
}

/// The upper half of `along` d dᵀ + `even` 1: xx, xy, xz, yy, yz, zz.
#[inline(always)]
pub(super) fn dyad<R: Real>(d: Triple<R>, along: R, even: R) -> [R; 6] {
    let [x, y, z] = scale(d, along);
    [x * d[0] + even, x * d[1], x * d[2], y * d[1] + even, y * d[2], z * d[2] + even]
}

#[inline(always)]
pub(super) fn add_symmetric<R: Real>(block: &mut Block<R>, upper: &[R; 6]) {
    for (place, part) in [0, 1, 2, 1, 3, 4, 2, 4, 5].into_iter().enumerate() {
        block[place] += upper[part];
    }
}
