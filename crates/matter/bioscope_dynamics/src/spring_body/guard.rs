use super::anatomy::Anatomy;
use super::real::{Real, Triple, add, cross, dot, scale, sub};
use super::skyline::Block;
use super::solver::Body;

/// A tetrahedron of nodes that must not be turned inside out. Springs know lengths only, and a mirrored body has the same
/// lengths: without a guard a strong bend can leave part of a body inside out for good.
///
/// Energy: stiffness/2 · max(0, [`LEAST`] − v/v₀)², v its volume and v₀ that at rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guard {
    pub nodes: [usize; 4],
    pub rest: f64,
    /// Where the blocks of the nodes and of their pairs 01 02 03 12 13 23 are stored.
    pub corners: [usize; 4],
    pub pairs: [usize; 6],
}

/// Share of its volume below which a tetrahedron resists.
pub(super) const LEAST: f64 = 0.5;
const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

impl Guard {
    pub fn new(anatomy: &Anatomy, nodes: [usize; 4]) -> Self {
        let places = nodes.map(|node| anatomy.nodes[node]);
        let [a, b, c] = [1, 2, 3].map(|end| sub(places[end], places[0]));
        let rest = dot(a, cross(b, c)) / 6.0;
        let skyline = &anatomy.skyline;
        Self {
            nodes,
            rest,
            corners: nodes.map(|node| skyline.index(node, node)),
            pairs: PAIRS.map(|(a, b)| skyline.index(nodes[a], nodes[b])),
        }
    }

    /// How far v/v₀ is below the least share, and the derivatives of v/v₀.
    #[inline(always)]
    fn state<R: Real>(&self, position: &[Triple<R>]) -> (R, [Triple<R>; 4]) {
        let [p, q, r, s] = self.nodes.map(|node| position[node]);
        let (a, b, c) = (sub(q, p), sub(r, p), sub(s, p));
        let share = R::splat(1.0 / (6.0 * self.rest));
        let slopes = [cross(b, c), cross(c, a), cross(a, b)].map(|slope| scale(slope, share));
        let first = scale(add(add(slopes[0], slopes[1]), slopes[2]), R::splat(-1.0));
        let lack = (R::splat(LEAST) - dot(a, slopes[0])).max(R::splat(0.0));
        (lack, [first, slopes[0], slopes[1], slopes[2]])
    }
}

/// Energy of all guards.
pub(super) fn energy<R: Real>(anatomy: &Anatomy, body: &Body<R>) -> R {
    let half = R::splat(0.5 * anatomy.guard);
    anatomy.guards.iter().fold(R::splat(0.0), |sum, guard| {
        let (lack, _) = guard.state(&body.position);
        sum + half * lack * lack
    })
}

/// Adds the forces of the guards, without regard to the velocities.
#[inline(always)]
pub(super) fn add_forces<R: Real>(anatomy: &Anatomy, body: &Body<R>, forces: &mut [Triple<R>]) {
    let stiffness = R::splat(anatomy.guard);
    for guard in &anatomy.guards {
        let (lack, slopes) = guard.state(&body.position);
        for (node, slope) in guard.nodes.into_iter().zip(slopes) {
            forces[node] = add(forces[node], scale(slope, stiffness * lack));
        }
    }
}

/// Adds the forces at the end of the step as far as they follow from the present velocities, and their resistance to
/// changes of velocity (Gauss and Newton's part of it, which is never negative).
#[inline(always)]
pub(super) fn add_forces_and_resistance<R: Real>(
    anatomy: &Anatomy,
    body: &Body<R>,
    forces: &mut [Triple<R>],
    matrix: &mut [Block<R>],
    dt: R,
) {
    for guard in &anatomy.guards {
        let (lack, slopes) = guard.state(&body.position);
        // The whole stiffness where the guard acts at all.
        let stiffness = R::splat(anatomy.guard) * (lack * R::splat(1e6)).min(R::splat(1.0));
        let closing = (0..4).fold(R::splat(0.0), |sum, corner| {
            sum + dot(slopes[corner], body.velocity[guard.nodes[corner]])
        });
        let push = stiffness * (lack - dt * closing);
        for (node, slope) in guard.nodes.into_iter().zip(slopes) {
            forces[node] = add(forces[node], scale(slope, push));
        }
        let square = stiffness * dt * dt;
        for (place, slope) in guard.corners.into_iter().zip(slopes) {
            add_product(&mut matrix[place], slope, scale(slope, square), true);
        }
        for (place, (a, b)) in guard.pairs.into_iter().zip(PAIRS) {
            // A stored block has the rows of the lower node.
            let (low, high) = if guard.nodes[a] < guard.nodes[b] { (a, b) } else { (b, a) };
            add_product(&mut matrix[place], slopes[low], scale(slopes[high], square), false);
        }
    }
}

#[inline(always)]
fn add_product<R: Real>(block: &mut Block<R>, a: Triple<R>, b: Triple<R>, symmetric: bool) {
    for row in 0..3 {
        for column in 0..3 {
            // The same bits on both sides of the diagonal.
            let swap = symmetric && column < row;
            let (row_part, column_part) =
                if swap { (a[column], b[row]) } else { (a[row], b[column]) };
            block[3 * row + column] += row_part * column_part;
        }
    }
}
