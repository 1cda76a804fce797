use bioscope_core::{Purpose, Random};
use proptest::prelude::*;

use super::fish::{CENTER_LINE, FishShape, FishTissue, MUSCLES, NODES, fish};
use super::*;

const SHAPE: FishShape = FishShape {
    stations: [0.16, 0.36, 0.56, 0.80, 0.88],
    half_heights: [0.08, 0.13, 0.12, 0.045, 0.04],
    half_widths: [0.05, 0.07, 0.065, 0.022, 0.012],
    tail_half_height: 0.10,
};
const TISSUE: FishTissue = FishTissue {
    masses: [1.1, 6.6, 11.0, 6.6, 1.1, 1.1, 0.165],
    stiffness: [0.355, 0.2616, 0.2803],
    damping: 0.000_934,
    shortening: 0.12,
    guard: 0.0,
};
const WATER: Surface = Surface { law: Law::Quadratic, push: 25.64 };
const STEP: f64 = 0.055;

fn published(integrator: Integrator) -> Mechanics {
    let anatomy = fish(&SHAPE, &TISSUE).expect("a sound fish");
    let medium = Medium { trunk: WATER, fin: WATER, friction: 0.0, thickness: 1.0 };
    Mechanics { anatomy, medium, integrator }
}

fn still<R: Real>() -> Vec<Triple<R>> {
    vec![[R::splat(0.0); 3]; NODES]
}

/// Rest shape with places and velocities disturbed at random by up to these amounts.
fn disturbed(mechanics: &Mechanics, seed: u64, place: f32, speed: f32) -> Body<f64> {
    let mut random = Random::new(seed, 1, 0, Purpose::new("disturb"));
    let mut body = Body::at_rest(&mechanics.anatomy);
    for axis in body.position.iter_mut().flatten() {
        *axis += f64::from(random.range(-place, place));
    }
    for axis in body.velocity.iter_mut().flatten() {
        *axis = f64::from(random.range(-speed, speed));
    }
    body
}

#[test]
fn the_fish_has_its_published_counts() {
    let anatomy = published(Integrator::Implicit).anatomy;
    assert_eq!((anatomy.nodes.len(), anatomy.units.len(), anatomy.muscles), (23, 91, 12));
    assert_eq!(anatomy.faces.len(), 42);
    assert_eq!((anatomy.skyline().stored(), anatomy.skyline().half_bandwidth()), (126, 7));
    let along: Vec<_> = anatomy.units[..MUSCLES].iter().map(|unit| unit.ends).collect();
    assert_eq!(along, (1..=12).map(|node| [node, node + 4]).collect::<Vec<_>>());
    for ends in [[2, 7], [0, 2]] {
        let found = anatomy.units.iter().any(|unit| unit.ends == ends || unit.ends == [7, 2]);
        assert!(found, "{ends:?}");
    }
    assert_eq!(CENTER_LINE.iter().map(|nodes| nodes.len()).sum::<usize>(), NODES);
    assert!(anatomy.volume() > 0.01);
}

#[test]
fn numbering_decides_the_bandwidth() {
    let anatomy = published(Integrator::Implicit).anatomy;
    let moved = |node: usize| match node {
        0 => 0,
        22 => 1,
        node => node + 1,
    };
    let pairs = anatomy.units.iter().map(|unit| (moved(unit.ends[0]), moved(unit.ends[1])));
    assert_eq!(Skyline::new(NODES, pairs).half_bandwidth(), 21);
}

#[test]
fn a_resting_fish_stays_at_rest() {
    for integrator in [Integrator::Implicit, Integrator::SemiImplicit] {
        let mechanics = published(integrator);
        let mut body = Body::<f64>::at_rest(&mechanics.anatomy);
        let mut work = Workspace::new(&mechanics.anatomy);
        for _ in 0..10_000 {
            mechanics.step(&mut body, &still(), &still(), STEP, &mut work).expect("definite");
        }
        for (place, rest) in body.position.iter().zip(&mechanics.anatomy.nodes) {
            for axis in 0..3 {
                assert!((place[axis] - rest[axis]).abs() < 1e-6);
            }
        }
    }
}

/// Solves by elimination with pivots.
fn dense(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let size = right.len();
    for column in 0..size {
        let best = (column..size)
            .max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs()))
            .expect("rows are left");
        matrix.swap(column, best);
        right.swap(column, best);
        for row in column + 1..size {
            let factor = matrix[row][column] / matrix[column][column];
            let pivot = matrix[column].clone();
            for (value, above) in matrix[row].iter_mut().zip(&pivot).skip(column) {
                *value -= factor * above;
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..size).rev() {
        let rest: f64 = (row + 1..size).map(|at| matrix[row][at] * right[at]).sum();
        right[row] = (right[row] - rest) / matrix[row][row];
    }
    right
}

proptest! {
    #[test]
    fn the_skyline_solves_as_a_dense_solver_does(seed: u64) {
        let anatomy = published(Integrator::Implicit).anatomy;
        let skyline = anatomy.skyline();
        let mut random = Random::new(seed, 1, 0, Purpose::new("matrix"));
        let mut blocks = vec![[0.0; 9]; skyline.stored()];
        let mut full = vec![vec![0.0; 3 * NODES]; 3 * NODES];
        for unit in &anatomy.units {
            let [a, b] = unit.ends;
            for axis in 0..3 {
                let value = f64::from(random.range(0.1, 2.0));
                for (row, column, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                    full[3 * row + axis][3 * column + axis] += sign * value;
                    if row <= column || row == column {
                        let place = skyline.index(row, column);
                        if row == column || (row, column) == (a.min(b), a.max(b)) {
                            blocks[place][4 * axis] += sign * value;
                        }
                    }
                }
            }
        }
        for node in 0..NODES {
            for axis in 0..3 {
                full[3 * node + axis][3 * node + axis] += 0.1;
                blocks[skyline.index(node, node)][4 * axis] += 0.1;
            }
        }
        let mut right: Vec<[f64; 3]> =
            (0..NODES).map(|_| [0; 3].map(|_| f64::from(random.range(-1.0, 1.0)))).collect();
        let expected = dense(full, right.iter().flatten().copied().collect());
        // The same matrix for one axis alone, with numbers instead of blocks.
        let mut scalars: Vec<f64> = blocks.iter().map(|block| block[0]).collect();
        let mut single = right.clone();
        prop_assert!(skyline.solve(&mut scalars, &mut single) > 0.0);
        skyline.solve_blocks(&mut blocks, &mut right);
        for (node, found) in right.iter().enumerate() {
            for axis in 0..3 {
                let wanted = expected[3 * node + axis];
                prop_assert!((found[axis] - wanted).abs() <= 1e-10 * wanted.abs().max(1.0));
            }
            prop_assert!((single[node][0] - expected[3 * node]).abs() <= 1e-9);
        }
    }

    #[test]
    fn a_passive_body_never_gains_energy(
        seed: u64, dt in 0.02f64..0.44, thickness in 0.0f64..3.0
    ) {
        let mut mechanics = published(Integrator::Implicit);
        mechanics.medium.thickness = thickness;
        let mut body = disturbed(&mechanics, seed, 0.01, 0.3);
        let mut work = Workspace::new(&mechanics.anatomy);
        let mut before = mechanics.energy(&body);
        for _ in 0..200 {
            mechanics.step(&mut body, &still(), &still(), dt, &mut work).expect("always definite");
            let after = mechanics.energy(&body);
            prop_assert!(after <= before * (1.0 + 1e-9) + 1e-15, "{before} to {after}");
            before = after;
        }
    }

    #[test]
    fn internal_forces_move_no_center_of_mass(seed: u64, dt in 0.01f64..0.2) {
        let mut mechanics = published(Integrator::Implicit);
        mechanics.medium.thickness = 0.0;
        let mut body = disturbed(&mechanics, seed, 0.01, 0.3);
        let mut work = Workspace::new(&mechanics.anatomy);
        let momentum = |body: &Body<f64>| {
            [0, 1, 2].map(|axis| {
                let parts = body.velocity.iter().zip(&mechanics.anatomy.masses);
                parts.map(|(velocity, mass)| velocity[axis] * mass).sum::<f64>()
            })
        };
        let before = momentum(&body);
        let beat = [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0];
        for _ in 0..50 {
            mechanics.contract(&mut body, &beat, 0.1);
            mechanics.step(&mut body, &still(), &still(), dt, &mut work).expect("always definite");
        }
        for (now, then) in momentum(&body).into_iter().zip(before) {
            prop_assert!((now - then).abs() < 1e-12);
        }
    }

    #[test]
    fn water_only_takes_energy_from_what_moves_in_it(
        seed: u64, law in prop::sample::select(vec![Law::Quadratic, Law::Linear, Law::CrossFlow])
    ) {
        let mut mechanics = published(Integrator::Symplectic);
        mechanics.medium.trunk.law = law;
        mechanics.medium.friction = 0.3;
        let body = disturbed(&mechanics, seed, 0.02, 1.0);
        let mut forces = still::<f64>();
        medium::add_forces(
            &mechanics.anatomy,
            &mechanics.medium,
            [&body.position, &body.velocity, &still()],
            &mut forces,
        );
        let power = |force: &Triple<f64>, velocity: &Triple<f64>| real::dot(*force, *velocity);
        let total: f64 =
            forces.iter().zip(&body.velocity).map(|(force, velocity)| power(force, velocity)).sum();
        prop_assert!(total < 0.0);
    }
}

#[test]
fn lanes_agree_with_one_body_and_with_any_instructions() {
    let mechanics = published(Integrator::Implicit);
    let mut alone = Body::<f64>::at_rest(&mechanics.anatomy);
    let mut eight = Body::<Lanes>::at_rest(&mechanics.anatomy);
    let mut plain = eight.clone();
    let mut work = Workspace::new(&mechanics.anatomy);
    let mut desk = Workspace::new(&mechanics.anatomy);
    for step in 0..400 {
        let side = f64::from(step / 40 % 2);
        let beat: [f64; 12] = std::array::from_fn(|muscle| match (muscle / 4, muscle % 4 < 2) {
            (0, _) => 0.0,
            (1, left) => {
                if left {
                    side
                } else {
                    1.0 - side
                }
            }
            (_, left) => {
                if left {
                    1.0 - side
                } else {
                    side
                }
            }
        });
        mechanics.contract(&mut alone, &beat, 0.075);
        mechanics.step(&mut alone, &still(), &still(), STEP, &mut work).expect("definite");
        for body in [&mut eight, &mut plain] {
            mechanics.contract(body, &beat.map(Lanes::splat), Lanes::splat(0.075));
        }
        Dispatch::step(&mechanics, &mut eight, &still(), &still(), STEP, &mut desk)
            .expect("definite");
        mechanics.step(&mut plain, &still(), &still(), STEP, &mut desk).expect("definite");
    }
    assert_eq!(eight, plain);
    for (one, many) in alone.position.iter().flatten().zip(eight.position.iter().flatten()) {
        for lane in 0..8 {
            assert!((one - many.lane(lane)).abs() < 2e-3, "{one} {many:?}");
        }
    }
}

#[test]
fn muscles_that_strain_do_not_keep_a_body_from_turning() {
    let tissue =
        FishTissue { stiffness: [11.0, 213.0, 15.0], damping: 2.0, shortening: 0.2, ..TISSUE };
    let mut mechanics = published(Integrator::Implicit);
    mechanics.anatomy = fish(&SHAPE, &tissue).expect("a sound fish");
    mechanics.medium.thickness = 0.0;
    let mut body = Body::<f64>::at_rest(&mechanics.anatomy);
    let mut work = Workspace::new(&mechanics.anatomy);
    let left: [f64; 12] = std::array::from_fn(|muscle| if muscle % 4 < 2 { 1.0 } else { 0.0 });
    for _ in 0..500 {
        mechanics.contract(&mut body, &left, 0.05);
        mechanics.step(&mut body, &still(), &still(), STEP, &mut work).expect("definite");
    }
    body.velocity.iter_mut().zip(&body.position).for_each(|(velocity, place)| {
        *velocity = [0.2 * (place[2] + 0.4), 0.0, -0.2 * place[0]];
    });
    let spin = |body: &Body<f64>| -> f64 {
        let masses = &mechanics.anatomy.masses;
        let mean = |axis: usize| -> f64 {
            body.position.iter().zip(masses).map(|(place, mass)| place[axis] * mass).sum()
        };
        let (x, z) = (mean(0), mean(2));
        let nodes = body.position.iter().zip(&body.velocity).zip(masses);
        nodes.map(|((at, v), mass)| mass * ((at[2] - z) * v[0] - (at[0] - x) * v[2])).sum()
    };
    let before = spin(&body);
    for _ in 0..100 {
        mechanics.step(&mut body, &still(), &still(), 3.0 * STEP, &mut work).expect("definite");
    }
    let kept = spin(&body) / before;
    assert!((0.95..1.05).contains(&kept), "{kept} of the spin is left");
}

#[test]
fn a_passive_fish_is_carried_by_the_water() {
    let mechanics = published(Integrator::Implicit);
    let mut body = Body::<f64>::at_rest(&mechanics.anatomy);
    let mut work = Workspace::new(&mechanics.anatomy);
    let flow = vec![[0.05, 0.0, 0.02]; NODES];
    for _ in 0..40_000 {
        mechanics.step(&mut body, &flow, &still(), STEP, &mut work).expect("definite");
    }
    let mean = [0, 2].map(|axis| body.velocity.iter().map(|node| node[axis]).sum::<f64>() / 23.0);
    assert!((mean[0] - 0.05).abs() < 0.005 && (mean[1] - 0.02).abs() < 0.004, "{mean:?}");
}

#[test]
fn impossible_bodies_are_refused_by_name() {
    let refused = |shape: FishShape, tissue: FishTissue| {
        fish(&shape, &tissue).expect_err("should be refused").to_string()
    };
    let backward = FishShape { stations: [0.3, 0.2, 0.5, 0.8, 0.9], ..SHAPE };
    assert!(refused(backward, TISSUE).contains("stations"));
    let flat = FishShape { tail_half_height: f64::NAN, ..SHAPE };
    assert!(refused(flat, TISSUE).contains("half height"));
    let massless = FishTissue { masses: [1.1, 0.0, 11.0, 6.6, 1.1, 1.1, 0.165], ..TISSUE };
    assert!(refused(SHAPE, massless).contains("mass of node 1"));
    let infinite = FishTissue { damping: f64::INFINITY, ..TISSUE };
    assert!(refused(SHAPE, infinite).contains("stiffness and damping"));
}
