use bioscope_core::{Error, Result};

use super::guard::Guard;
use super::skyline::Skyline;

/// A spring and a dashpot in parallel between two nodes (a Voigt unit).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The nodes it joins.
    pub ends: [usize; 2],
    /// Length at rest, body lengths.
    pub rest: f64,
    /// Force per extension, body masses per time unit squared.
    pub stiffness: f64,
    /// Force per rate of extension, body masses per time unit.
    pub damping: f64,
}

/// What a body of springs is made of: masses, viscoelastic units, of which the first are muscles, and
/// the triangles of its surface, which push water.
///
/// Lengths are in body lengths, masses in body masses, times in time units, so that one anatomy serves
/// bodies of any size: scaling a body by s at the same timing multiplies masses, stiffness and
/// damping by s³ and all forces by s⁴.
#[derive(Clone, Debug)]
pub struct Anatomy {
    /// Places of the nodes at rest (+Z ahead, +X left, +Y up).
    pub nodes: Vec<[f64; 3]>,
    /// Mass of each node; together 1.
    pub masses: Vec<f64>,
    /// The units, muscles first.
    pub units: Vec<Unit>,
    /// How many of the units are muscles.
    pub muscles: usize,
    /// Share of its length by which a fully active muscle shortens its rest length.
    pub shortening: f64,
    /// Surface triangles, counterclockwise from outside.
    pub faces: Vec<[usize; 3]>,
    /// Index of the first triangle of the tail fin.
    pub fin: usize,
    /// Stiffness with which tetrahedra of the body resist being turned inside out, body masses times body lengths
    /// squared per time unit squared.
    pub guard: f64,
    pub(super) guards: Vec<Guard>,
    pub(super) skyline: Skyline,
    pub(super) places: Vec<UnitPlaces>,
    pub(super) face_places: Vec<FacePlaces>,
}

/// Where the blocks of a unit are stored: those of its two ends, and the one between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct UnitPlaces {
    pub ends: [usize; 2],
    pub between: usize,
}

/// Where the blocks of a triangle are stored: of its corners, and of the pairs 01, 12, 20.
#[derive(Clone, Copy, Debug)]
pub(super) struct FacePlaces {
    pub corners: [usize; 3],
    pub sides: [usize; 3],
}

impl Anatomy {
    /// Checks and completes an anatomy: nodes at rest in body lengths, masses in any one unit, units whose
    /// first `muscles` are muscles, triangles, from `fin` on those of the tail fin, in any orientation (they are turned outward from the long
    /// axis, through the mean of the nodes along Z).
    ///
    /// # Errors
    /// For coordinates, masses or constants that are not finite, masses that are not positive, units without length, triangles
    /// without area, and ends that do not exist.
    pub fn new(
        nodes: Vec<[f64; 3]>,
        masses: Vec<f64>,
        units: Vec<Unit>,
        muscles: usize,
        shortening: f64,
        (faces, fin): (Vec<[usize; 3]>, usize),
    ) -> Result<Self> {
        check(&nodes, &masses, &units, &faces)?;
        if muscles > units.len() || !(0.0..=0.5).contains(&shortening) {
            let found = format!("{muscles} muscles that shorten by {shortening}");
            let expected = "no more muscles than units, shortening 0 to 0.5";
            return Err(Error::value("muscles", found, expected));
        }
        let total: f64 = masses.iter().sum();
        let masses = masses.into_iter().map(|mass| mass / total).collect();
        let faces: Vec<_> = faces.iter().map(|&face| outward(&nodes, face)).collect();
        let sides = faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let pairs = units.iter().map(|unit| (unit.ends[0], unit.ends[1])).chain(sides);
        let skyline = Skyline::new(nodes.len(), pairs);
        let places = units.iter().map(|unit| UnitPlaces {
            ends: unit.ends.map(|end| skyline.index(end, end)),
            between: skyline.index(unit.ends[0], unit.ends[1]),
        });
        let face_places = faces.iter().map(|&[a, b, c]| FacePlaces {
            corners: [a, b, c].map(|corner| skyline.index(corner, corner)),
            sides: [skyline.index(a, b), skyline.index(b, c), skyline.index(c, a)],
        });
        let (places, face_places) = (places.collect(), face_places.collect());
        Ok(Self {
            nodes,
            masses,
            units,
            muscles,
            shortening,
            faces,
            fin,
            guard: 0.0,
            guards: Vec::new(),
            skyline,
            places,
            face_places,
        })
    }

    /// Guards these tetrahedra, whose nodes must be joined by units, from being turned inside out.
    ///
    /// # Errors
    /// For a stiffness that is negative or not finite, and for tetrahedra without volume.
    pub fn guarded(mut self, tetrahedra: &[[usize; 4]], stiffness: f64) -> Result<Self> {
        if !(0.0..=1e6).contains(&stiffness) {
            return Err(Error::value("guard", stiffness, "a stiffness of 0 to 1,000,000"));
        }
        let guards = tetrahedra.iter().map(|&nodes| Guard::new(&self, nodes));
        let guards: Vec<Guard> = guards.collect();
        if let Some(flat) = guards.iter().find(|guard| guard.rest.abs() < 1e-12) {
            let found = format!("{:?}", flat.nodes);
            return Err(Error::value("guarded tetrahedron", found, "one that has a volume"));
        }
        if stiffness > 0.0 {
            (self.guard, self.guards) = (stiffness, guards);
        }
        Ok(self)
    }

    /// Where the entries of its matrices are stored.
    pub fn skyline(&self) -> &Skyline {
        &self.skyline
    }

    /// Volume within the surface at rest, body lengths cubed.
    pub fn volume(&self) -> f64 {
        signed_volume(&self.faces, &self.nodes)
    }
}

/// Volume that a closed surface of triangles encloses; negative if it is turned inside out.
pub fn signed_volume(faces: &[[usize; 3]], nodes: &[[f64; 3]]) -> f64 {
    faces.iter().map(|face| triple(face.map(|corner| nodes[corner])) / 6.0).sum()
}

fn triple([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let [p, q] = [b, c].map(|end| [end[0] - a[0], end[1] - a[1], end[2] - a[2]]);
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

/// The triangle turned so that its normal points away from the long axis of the body.
fn outward(nodes: &[[f64; 3]], face: [usize; 3]) -> [usize; 3] {
    let corners = face.map(|corner| nodes[corner]);
    let mean = |axis: usize| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0;
    let count = nodes.len() as f64;
    let middle = [0, 1, 2].map(|axis| nodes.iter().map(|node| node[axis]).sum::<f64>() / count);
    let normal = normal(corners);
    let away: f64 = (0..2).map(|axis| normal[axis] * (mean(axis) - middle[axis])).sum();
    if away < 0.0 { [face[0], face[2], face[1]] } else { face }
}

fn check(nodes: &[[f64; 3]], masses: &[f64], units: &[Unit], faces: &[[usize; 3]]) -> Result<()> {
    let count = nodes.len();
    if !(2..=256).contains(&count) || masses.len() != count {
        let found = format!("{count} nodes with {} masses", masses.len());
        return Err(Error::value("nodes", found, "2 to 256, each with a mass"));
    }
    for (index, node) in nodes.iter().enumerate() {
        if !node.iter().all(|value| value.abs() <= 1e3) {
            let expected = "finite coordinates within 1,000 body lengths";
            return Err(Error::value(format!("node {index}"), format!("{node:?}"), expected));
        }
        if !(masses[index].is_finite() && masses[index] > 0.0) {
            let name = format!("mass of node {index}");
            return Err(Error::value(name, masses[index], "a positive number"));
        }
    }
    for (index, unit) in units.iter().enumerate() {
        let name = |what: &str| format!("{what} of unit {index}");
        let [a, b] = unit.ends;
        if a == b || a.max(b) >= count {
            return Err(Error::value(name("ends"), format!("{a}, {b}"), "two nodes of the body"));
        }
        if !(unit.rest.is_finite() && unit.rest > 1e-6) {
            return Err(Error::value(name("length"), unit.rest, "at least 1e-6 body lengths"));
        }
        let constant = |value: f64| value.is_finite() && value >= 0.0;
        if !constant(unit.stiffness) || !constant(unit.damping) {
            let found = format!("{}, {}", unit.stiffness, unit.damping);
            return Err(Error::value(name("stiffness and damping"), found, "no negative number"));
        }
    }
    for (index, face) in faces.iter().enumerate() {
        let inside = face.iter().all(|&corner| corner < count);
        let area = |face: &[usize; 3]| {
            normal(face.map(|corner| nodes[corner])).iter().map(|part| part * part).sum::<f64>()
        };
        if !inside || area(face).is_nan() || area(face) < 1e-16 {
            let expected = "three nodes of the body that span an area";
            return Err(Error::value(format!("triangle {index}"), format!("{face:?}"), expected));
        }
    }
    Ok(())
}
