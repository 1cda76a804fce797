//! The fish of 23 nodes and 91 units (Tu, "Artificial Animals for Computer Animation", section 4.1).
//!
//! Node 0 is the snout, ring k (1 to 5) has the nodes 4k−3 … 4k (left top, left bottom, right
//! bottom, right top), nodes 21 and 22 are the upper and lower tip of the tail. The figure of the
//! source does not name the units; this is the simple arrangement that gives its counts (23, 91, 12), its
//! half-bandwidth of 7 and the units that its text names.

use bioscope_core::{Error, Result};
use serde::{Deserialize, Serialize};

use super::anatomy::{Anatomy, Unit};

/// Nodes of a fish.
pub const NODES: usize = 23;
/// Muscles of a fish: three segments of four, in each left top, left bottom, right bottom, right top.
pub const MUSCLES: usize = 12;
/// The nodes whose means are the center line, from the snout to the tail.
pub const CENTER_LINE: [&[usize]; 7] = [
    &[0],
    &[1, 2, 3, 4],
    &[5, 6, 7, 8],
    &[9, 10, 11, 12],
    &[13, 14, 15, 16],
    &[17, 18, 19, 20],
    &[21, 22],
];

/// Shape at rest, in body lengths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FishShape {
    /// Distances of the five rings from the snout, rising between 0 and 1.
    pub stations: [f64; 5],
    /// Half heights of the rings.
    pub half_heights: [f64; 5],
    /// Half widths of the rings.
    pub half_widths: [f64; 5],
    /// Half height of the end of the tail fin.
    pub tail_half_height: f64,
}

/// What the fish is made of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FishTissue {
    /// Mass of the snout node, of one node in each ring, and of one tail node, in any one unit.
    pub masses: [f64; 7],
    /// Stiffness of cross units, muscles and other units, body masses per time unit squared.
    pub stiffness: [f64; 3],
    /// Damping of all units, body masses per time unit.
    pub damping: f64,
    /// Share of its length by which a fully active muscle shortens.
    pub shortening: f64,
    /// Stiffness with which the body resists being turned inside out, body masses times body lengths squared per time
    /// unit squared; 0 in the source.
    pub guard: f64,
}

const CROSS: usize = 0;
const MUSCLE: usize = 1;
const OTHER: usize = 2;

/// Builds a fish.
///
/// # Errors
/// For stations that do not rise from snout to tail, sizes or masses that are not positive, and constants that
/// are not finite.
pub fn fish(shape: &FishShape, tissue: &FishTissue) -> Result<Anatomy> {
    check(shape)?;
    let nodes = nodes(shape);
    let masses = (0..NODES).map(|node| tissue.masses[ring_of(node)]).collect();
    let units = units().map(|(class, a, b)| {
        let rest = (0..3).map(|axis| (nodes[a][axis] - nodes[b][axis]).powi(2)).sum::<f64>();
        Unit {
            ends: [a, b],
            rest: rest.sqrt(),
            stiffness: tissue.stiffness[class],
            damping: tissue.damping,
        }
    });
    let units = units.collect();
    Anatomy::new(nodes, masses, units, MUSCLES, tissue.shortening, (faces(), 36))?
        .guarded(&tetrahedra(), tissue.guard)
}

/// At each corner of each ring, that corner with its neighbors in the ring and behind it.
fn tetrahedra() -> Vec<[usize; 4]> {
    let trunk = (1..5).flat_map(|ring| {
        (0..4).map(move |at| {
            let beside = [corner(ring, at + 3), corner(ring, at), corner(ring, at + 1)];
            [beside[0], beside[1], beside[2], corner(ring + 1, at)]
        })
    });
    trunk.chain([[20, 17, 18, 21], [18, 19, 20, 22], [4, 1, 2, 0], [2, 3, 4, 0]]).collect()
}

fn check(shape: &FishShape) -> Result<()> {
    let stations = shape.stations;
    let rising = stations.windows(2).all(|two| two[1] - two[0] > 0.01);
    if !rising || stations[0].is_nan() || stations[0] < 0.01 || stations[4] > 0.99 {
        let expected = "numbers rising between 0 (snout) and 1 (end of the tail)";
        return Err(Error::value("stations", format!("{stations:?}"), expected));
    }
    let sizes = shape.half_heights.iter().chain(&shape.half_widths);
    for &size in sizes.chain([&shape.tail_half_height]) {
        if !(0.002..=0.5).contains(&size) {
            let expected = "0.002 to 0.5 body lengths";
            return Err(Error::value("half height or half width", size, expected));
        }
    }
    Ok(())
}

/// 0 for the snout, 1 to 5 for the rings, 6 for the tail.
pub fn ring_of(node: usize) -> usize {
    node.div_ceil(4)
}

fn nodes(shape: &FishShape) -> Vec<[f64; 3]> {
    let mut nodes = vec![[0.0, 0.0, 0.0]];
    for ring in 0..5 {
        let (wide, high) = (shape.half_widths[ring], shape.half_heights[ring]);
        let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]];
        nodes.extend(corners.map(|[x, y]| [x * wide, y * high, -shape.stations[ring]]));
    }
    nodes.extend([1.0, -1.0].map(|y| [0.0, y * shape.tail_half_height, -1.0]));
    nodes
}

/// Node of a ring (1 to 5) at a corner (counted round).
fn corner(ring: usize, corner: usize) -> usize {
    4 * ring - 3 + corner % 4
}

/// Class and ends of each unit, muscles first.
fn units() -> impl Iterator<Item = (usize, usize, usize)> {
    let along = |ring| (0..4).map(move |at| (corner(ring, at), corner(ring + 1, at)));
    let muscles = (1..4).flat_map(along).map(|(a, b)| (MUSCLE, a, b));
    let snout = (0..4).map(|at| (OTHER, 0, corner(1, at)));
    let edges = (1..6)
        .flat_map(|ring| (0..4).map(move |at| (OTHER, corner(ring, at), corner(ring, at + 1))));
    let diagonals = (1..6)
        .flat_map(|ring| (0..2).map(move |at| (CROSS, corner(ring, at), corner(ring, at + 2))));
    let stalk = along(4).map(|(a, b)| (OTHER, a, b));
    let sides = (1..5).flat_map(|ring| {
        (0..4).flat_map(move |at| {
            [
                (corner(ring, at), corner(ring + 1, at + 1)),
                (corner(ring, at + 1), corner(ring + 1, at)),
            ]
        })
    });
    let upper = |at: usize| at == 0 || at == 3;
    let tail = (0..4).flat_map(move |at| {
        let class = |same: bool| if same { OTHER } else { CROSS };
        [(class(upper(at)), corner(5, at), 21), (class(!upper(at)), corner(5, at), 22)]
    });
    muscles
        .chain(snout)
        .chain(edges)
        .chain(diagonals)
        .chain(stalk)
        .chain(sides.map(|(a, b)| (CROSS, a, b)))
        .chain(tail)
        .chain([(OTHER, 21, 22)])
}

fn faces() -> Vec<[usize; 3]> {
    let snout = (0..4).map(|at| [0, corner(1, at), corner(1, at + 1)]);
    let trunk = (1..5).flat_map(|ring| {
        (0..4).flat_map(move |at| {
            let [a, b] = [corner(ring, at), corner(ring, at + 1)];
            let [c, d] = [corner(ring + 1, at), corner(ring + 1, at + 1)];
            [[a, b, c], [b, d, c]]
        })
    });
    let tail = [[17, 18, 21], [18, 22, 21], [19, 20, 22], [20, 21, 22], [20, 17, 21], [18, 19, 22]];
    snout.chain(trunk).chain(tail).collect()
}
