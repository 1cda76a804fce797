use bioscope_core::{Error, Result};
use serde::{Deserialize, Serialize};

use super::anatomy::Anatomy;
use super::guard;
use super::medium::{Medium, add_forces, add_forces_and_resistance, add_symmetric, dyad};
use super::real::{Real, Triple, add, dot, scale, sub};
use super::skyline::Block;

/// How a body goes from one moment to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// One Newton step of the implicit Euler method, with the stiffness of all units (but for the negative
    /// stiffness across a compressed unit, and that across all units of a body whose muscles work) and the resistance of the
    /// water (after Baraff & Witkin, "Large Steps in Cloth Simulation", 1998). Stable at any step.
    Implicit,
    /// The published scheme (Tu, "Artificial Animals for Computer Animation", section 4.2): forces as effective stiffness
    /// times extension vector, of which the stiffness is frozen and the extension is taken at the new places.
    SemiImplicit,
    /// New velocities from present forces, new places from new velocities.
    Symplectic,
    /// New velocities and new places from present forces and velocities.
    Explicit,
}

/// Places and velocities of the nodes of one body, or of eight at once, and the state of its muscles.
#[derive(Clone, Debug, PartialEq)]
pub struct Body<R> {
    /// Places, body lengths.
    pub position: Vec<Triple<R>>,
    /// Velocities, body lengths per time unit.
    pub velocity: Vec<Triple<R>>,
    /// How far each muscle is contracted, 0 (rest) to 1.
    pub contraction: Vec<R>,
}

impl<R: Real> Body<R> {
    /// A body at rest.
    pub fn at_rest(anatomy: &Anatomy) -> Self {
        let position = anatomy.nodes.iter().map(|node| node.map(R::splat)).collect();
        let zero = R::splat(0.0);
        let velocity = vec![[zero; 3]; anatomy.nodes.len()];
        Self { position, velocity, contraction: vec![zero; anatomy.muscles] }
    }
}

/// Memory that a step works in; what it holds between steps means nothing.
#[derive(Clone, Debug)]
pub struct Workspace<R> {
    matrix: Vec<Block<R>>,
    scalars: Vec<R>,
    forces: Vec<Triple<R>>,
}

impl<R: Real> Workspace<R> {
    /// Memory for bodies of this anatomy.
    pub fn new(anatomy: &Anatomy) -> Self {
        let zero = R::splat(0.0);
        let stored = anatomy.skyline.stored();
        Self {
            matrix: vec![[zero; 9]; stored],
            scalars: vec![zero; stored],
            forces: vec![[zero; 3]; anatomy.nodes.len()],
        }
    }
}

/// What a body is made of, what is round it, and how it is computed.
#[derive(Clone, Debug)]
pub struct Mechanics {
    /// Masses, units, surface.
    pub anatomy: Anatomy,
    /// The fluid.
    pub medium: Medium,
    /// The method of integration.
    pub integrator: Integrator,
}

impl Mechanics {
    /// Advances a body by `dt` time units. `flow` is the velocity of the water at each node, `push` a further
    /// force on each node (fins, contacts; body masses times body lengths per time unit squared).
    ///
    /// # Errors
    /// If the effective stiffness of the semi-implicit scheme is not positive definite, which happens when a body
    /// collapses. The body is as it was.
    #[inline(always)]
    pub fn step<R: Real>(
        &self,
        body: &mut Body<R>,
        flow: &[Triple<R>],
        push: &[Triple<R>],
        dt: f64,
        work: &mut Workspace<R>,
    ) -> Result<()> {
        match self.integrator {
            Integrator::Implicit => self.implicit(body, flow, push, R::splat(dt), work),
            Integrator::SemiImplicit => return self.semi_implicit(body, flow, push, dt, work),
            Integrator::Symplectic | Integrator::Explicit => {
                self.explicit(body, flow, push, R::splat(dt), work);
            }
        }
        Ok(())
    }

    #[inline(always)]
    fn implicit<R: Real>(
        &self,
        body: &mut Body<R>,
        flow: &[Triple<R>],
        push: &[Triple<R>],
        dt: R,
        work: &mut Workspace<R>,
    ) {
        let anatomy = &self.anatomy;
        let Workspace { matrix, forces, .. } = work;
        matrix.fill([R::splat(0.0); 9]);
        forces.copy_from_slice(push);
        let state: [&[_]; 3] = [&body.position, &body.velocity, flow];
        add_forces_and_resistance(anatomy, &self.medium, state, forces, (&mut *matrix, dt));
        add_units(anatomy, body, forces, matrix, (dt, slackness(body)));
        guard::add_forces_and_resistance(anatomy, body, forces, matrix, dt);
        for (node, &mass) in anatomy.masses.iter().enumerate() {
            let place = &mut matrix[anatomy.skyline.index(node, node)];
            for axis in [0, 4, 8] {
                place[axis] += R::splat(mass);
            }
            forces[node] = scale(forces[node], dt);
        }
        anatomy.skyline.solve_blocks(matrix, forces);
        for ((position, velocity), &change) in
            body.position.iter_mut().zip(&mut body.velocity).zip(forces.iter())
        {
            *velocity = add(*velocity, change);
            *position = add(*position, scale(*velocity, dt));
        }
    }

    #[inline(always)]
    fn semi_implicit<R: Real>(
        &self,
        body: &mut Body<R>,
        flow: &[Triple<R>],
        push: &[Triple<R>],
        dt: f64,
        work: &mut Workspace<R>,
    ) -> Result<()> {
        let anatomy = &self.anatomy;
        let Workspace { scalars, forces, .. } = work;
        scalars.fill(R::splat(0.0));
        forces.copy_from_slice(push);
        let state: [&[_]; 3] = [&body.position, &body.velocity, flow];
        add_forces(anatomy, &self.medium, state, forces);
        guard::add_forces(anatomy, body, forces);
        for (index, unit) in anatomy.units.iter().enumerate() {
            let Strain { vector, length, extension, rate, .. } = strain(anatomy, body, index);
            let tension = R::splat(unit.stiffness) * extension + R::splat(unit.damping) * rate;
            let effective = tension / length;
            let places = anatomy.places[index];
            let [a, b] = unit.ends;
            forces[a] = add(forces[a], scale(vector, effective));
            forces[b] = sub(forces[b], scale(vector, effective));
            let implicit = effective * R::splat(dt);
            scalars[places.ends[0]] += implicit;
            scalars[places.ends[1]] += implicit;
            scalars[places.between] -= implicit;
        }
        for (node, &mass) in anatomy.masses.iter().enumerate() {
            let inertia = R::splat(mass / dt);
            scalars[anatomy.skyline.index(node, node)] += inertia;
            forces[node] = add(forces[node], scale(body.velocity[node], inertia));
        }
        let least = anatomy.skyline.solve(scalars, forces);
        for lane in 0..R::LANES {
            let pivot = least.lane(lane);
            if pivot.is_nan() || pivot <= 0.0 {
                let expected = "a positive one: take a smaller step or the implicit integrator";
                return Err(Error::value("pivot of the effective stiffness", pivot, expected));
            }
        }
        body.velocity.copy_from_slice(forces);
        let dt = R::splat(dt);
        for (position, &velocity) in body.position.iter_mut().zip(&body.velocity) {
            *position = add(*position, scale(velocity, dt));
        }
        Ok(())
    }

    #[inline(always)]
    fn explicit<R: Real>(
        &self,
        body: &mut Body<R>,
        flow: &[Triple<R>],
        push: &[Triple<R>],
        dt: R,
        work: &mut Workspace<R>,
    ) {
        let forces = &mut work.forces;
        forces.copy_from_slice(push);
        let state: [&[_]; 3] = [&body.position, &body.velocity, flow];
        add_forces(&self.anatomy, &self.medium, state, forces);
        guard::add_forces(&self.anatomy, body, forces);
        for (index, unit) in self.anatomy.units.iter().enumerate() {
            let Strain { vector, length, extension, rate, .. } = strain(&self.anatomy, body, index);
            let tension = R::splat(unit.stiffness) * extension + R::splat(unit.damping) * rate;
            let force = scale(vector, tension / length);
            let [a, b] = unit.ends;
            forces[a] = add(forces[a], force);
            forces[b] = sub(forces[b], force);
        }
        for (node, &mass) in self.anatomy.masses.iter().enumerate() {
            let before = body.velocity[node];
            let after = add(before, scale(forces[node], dt / R::splat(mass)));
            let explicit = self.integrator == Integrator::Explicit;
            let mean = if explicit { before } else { after };
            body.velocity[node] = after;
            body.position[node] = add(body.position[node], scale(mean, dt));
        }
    }

    /// Kinetic and elastic energy, body masses times body lengths squared per time unit squared.
    pub fn energy<R: Real>(&self, body: &Body<R>) -> R {
        let mut energy = R::splat(0.0);
        for (&mass, &velocity) in self.anatomy.masses.iter().zip(&body.velocity) {
            energy += R::splat(0.5 * mass) * dot(velocity, velocity);
        }
        for (index, unit) in self.anatomy.units.iter().enumerate() {
            let Strain { extension, .. } = strain(&self.anatomy, body, index);
            energy += R::splat(0.5 * unit.stiffness) * extension * extension;
        }
        energy + guard::energy(&self.anatomy, body)
    }

    /// Contracts the muscles towards `wanted` (0 to 1), each by at most `change`, and returns the
    /// work they do on the body, in the unit of [`energy`](Self::energy).
    #[inline(always)]
    pub fn contract<R: Real>(&self, body: &mut Body<R>, wanted: &[R], change: R) -> R {
        let mut work = R::splat(0.0);
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        for (index, &wanted) in wanted.iter().enumerate().take(self.anatomy.muscles) {
            let stiffness = R::splat(0.5 * self.anatomy.units[index].stiffness);
            let before = strain(&self.anatomy, body, index).extension;
            let now = body.contraction[index];
            let step = (wanted.max(zero).min(one) - now).max(-change).min(change);
            body.contraction[index] = (now + step).max(zero).min(one);
            let after = strain(&self.anatomy, body, index).extension;
            work += stiffness * (after * after - before * before);
        }
        work
    }
}

/// The state of one unit.
struct Strain<R> {
    vector: Triple<R>,
    length: R,
    inverse: R,
    extension: R,
    rate: R,
}

#[inline(always)]
fn strain<R: Real>(anatomy: &Anatomy, body: &Body<R>, index: usize) -> Strain<R> {
    let unit = &anatomy.units[index];
    let [a, b] = unit.ends;
    let vector = sub(body.position[b], body.position[a]);
    let length = (dot(vector, vector) + R::splat(1e-20)).sqrt();
    let inverse = R::splat(1.0) / length;
    let rate = dot(sub(body.velocity[b], body.velocity[a]), vector) * inverse;
    let rest = if index < anatomy.muscles {
        R::splat(unit.rest) - R::splat(unit.rest * anatomy.shortening) * body.contraction[index]
    } else {
        R::splat(unit.rest)
    };
    Strain { vector, length, inverse, extension: length - rest, rate }
}

/// 1 for a body whose muscles rest, 0 for one whose muscles work.
#[inline(always)]
fn slackness<R: Real>(body: &Body<R>) -> R {
    /// Contraction from which a muscle works.
    const WORKING: f64 = 0.1;
    let most = body.contraction.iter().fold(R::splat(0.0), |most, &one| most.max(one));
    (R::splat(1.0) - most * R::splat(1.0 / WORKING)).max(R::splat(0.0))
}

/// Adds the forces of all units at the end of the step as far as they follow from the present velocities, and their
/// resistance to changes of velocity.
///
/// A unit under tension resists being turned, which in the whole body is made up for by those under compression. With the
/// compressions left out, for definiteness (Baraff and Witkin), the tensions make sure that a passive body never gains energy; but a
/// body whose muscles strain against the rest of it would be turned as if it swam in syrup, and the more the longer the step.
/// So tension counts as far as the body is `slack`. Working muscles do without: units that brace each other in all
/// directions hold the body.
#[inline(always)]
fn add_units<R: Real>(
    anatomy: &Anatomy,
    body: &Body<R>,
    forces: &mut [Triple<R>],
    matrix: &mut [Block<R>],
    (dt, slack): (R, R),
) {
    let square = dt * dt;
    for (index, (unit, places)) in anatomy.units.iter().zip(&anatomy.places).enumerate() {
        let Strain { vector, inverse, extension, rate, .. } = strain(anatomy, body, index);
        let [a, b] = unit.ends;
        let (stiffness, damping) = (R::splat(unit.stiffness), R::splat(unit.damping));
        let direction = scale(vector, inverse);
        let sideways = slack * stiffness * extension.max(R::splat(0.0)) * inverse;
        // How far the unit's force changes in the step if it goes on as it moves now.
        let ahead = (stiffness - sideways) * rate * dt;
        let tension = stiffness * extension + damping * rate + ahead;
        let drift = scale(sub(body.velocity[b], body.velocity[a]), sideways * dt);
        let force = add(scale(direction, tension), drift);
        forces[a] = add(forces[a], force);
        forces[b] = sub(forces[b], force);
        let along = square * (stiffness - sideways) + dt * damping;
        let block = dyad(direction, along, square * sideways);
        add_symmetric(&mut matrix[places.ends[0]], &block);
        add_symmetric(&mut matrix[places.ends[1]], &block);
        add_symmetric(&mut matrix[places.between], &block.map(|value| -value));
    }
}
