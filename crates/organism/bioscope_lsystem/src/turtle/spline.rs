//! Axes over control points: generalized cylinders along Hermite curves and B-splines.
//!
//! Source: R. Měch, *CPFG version 4.0 user's manual* (2005), generalized cylinders.

use bioscope_core::math;
use glam::DVec3;

use super::{Turtle, axes::rotated, finite};
use crate::interpretation::{Contour, Segment};

/// Rings from one control point to the next if nobody says how many.
const RINGS: u32 = 10;
/// Most rings between two points.
const MOST_RINGS: f32 = 1000.0;
/// Points nearer than this are one, metres.
const NEAREST: f64 = 1e-5;

/// A curve in the making.
#[derive(Clone, Debug)]
pub(super) struct Spline {
    closed: bool,
    smooth: bool,
    /// Whether `F` and `f` set control points.
    steps_count: bool,
    rings: u32,
    /// The first points, to close the curve with.
    first: Vec<Point>,
    /// The last points: one of a Hermite curve, three of a B-spline.
    last: Vec<Point>,
    /// The axis that is being drawn.
    axis: Option<u32>,
}

/// What the turtle was at a control point.
#[derive(Clone, Copy, Debug)]
struct Point {
    position: DVec3,
    heading: DVec3,
    left: DVec3,
    width: f32,
    color: i32,
    contour: Contour,
    tangents: [f32; 2],
    radius_tangents: [[f32; 2]; 2],
    scaled: bool,
}

impl Turtle<'_> {
    /// Begins a curve: kind 1 and 2 Hermite, 3 and 4 B-spline; 2 and 4 closed.
    pub(super) fn begin_spline(&mut self, kind: Option<f32>, rings: Option<f32>) {
        self.end_stroke();
        let kind = kind.unwrap_or(1.0) as i32;
        if !(1..=4).contains(&kind) {
            return;
        }
        self.leave_axis();
        let rings = rings.map(finite).filter(|&rings| rings >= 1.0);
        self.spline = Some(Box::new(Spline {
            closed: kind % 2 == 0,
            smooth: kind > 2,
            steps_count: true,
            rings: rings.map_or(RINGS, |rings| rings.min(MOST_RINGS) as u32),
            first: Vec::new(),
            last: Vec::new(),
            axis: None,
        }));
    }

    /// Lets only `@Gc` and `@Ge` set points.
    pub(super) fn ignore_steps(&mut self) {
        if let Some(spline) = &mut self.spline {
            spline.steps_count = false;
        }
    }

    /// A point of `@Gc` or `@Ge`, which begin a curve if there is none.
    pub(super) fn axis_point(&mut self, rings: Option<f32>) {
        if !self.is_cpfg() {
            return;
        }
        if self.spline.is_none() {
            self.begin_spline(Some(1.0), None);
        }
        self.control_point(rings);
    }

    /// A point of `F` or `f`.
    pub(super) fn step_point(&mut self) {
        if self.spline.as_ref().is_some_and(|spline| spline.steps_count) {
            self.control_point(None);
        }
    }

    /// Sets a control point here; as many rings lie between it and the last one.
    pub(super) fn control_point(&mut self, rings: Option<f32>) {
        let Some(mut spline) = self.spline.take() else { return };
        let point = self.point();
        let rings = rings.filter(|&rings| rings >= 1.0);
        let rings = rings.map_or(spline.rings, |rings| rings.min(MOST_RINGS) as u32);
        self.add_point(&mut spline, point, rings);
        self.spline = Some(spline);
    }

    pub(super) fn end_spline(&mut self) {
        let Some(mut spline) = self.spline.take() else { return };
        if spline.closed {
            for point in std::mem::take(&mut spline.first) {
                let rings = spline.rings;
                self.add_point(&mut spline, point, rings);
            }
        }
    }

    fn point(&self) -> Point {
        let state = &self.state;
        Point {
            position: state.position,
            heading: state.axes.heading,
            left: state.axes.left,
            width: state.width,
            color: state.color,
            contour: state.contour,
            tangents: state.tangents,
            radius_tangents: state.radius_tangents,
            scaled: state.scaled_radius_tangents,
        }
    }

    fn add_point(&mut self, spline: &mut Spline, mut point: Point, rings: u32) {
        let needed = if spline.smooth { 3 } else { 1 };
        if spline.closed && spline.first.len() < needed {
            spline.first.push(point);
        }
        if spline.last.len() < needed {
            spline.last.push(point);
            return;
        }
        if spline.smooth {
            self.section(spline, bspline(&spline.last, &point), rings);
            spline.last.remove(0);
        } else {
            let from = spline.last[0];
            if !self.options.twist {
                point.left = rotated(from.left, from.heading, point.heading);
            }
            self.section(spline, hermite(from, point), rings);
            spline.last.clear();
        }
        spline.last.push(point);
    }

    /// Draws one section of a curve.
    fn section(&mut self, spline: &mut Spline, section: Option<Section>, rings: u32) {
        let Some(section) = section else { return };
        if !self.draws {
            return;
        }
        let outside = (self.state.axis, self.state.contour, self.state.anchor);
        self.state.axis = spline
            .axis
            .filter(|&axis| self.out.axes[axis as usize].contour == section.from.contour);
        self.state.contour = section.from.contour;
        let (mut before, mut left) = (section.node(0.0), section.from.left);
        for ring in 1..=rings {
            let node = section.node(ring as f32 / rings as f32);
            let tangent = (node.position - before.position).normalize_or(section.from.heading);
            left = rotated(left, before.tangent, tangent);
            if self.options.twist && ring == rings {
                left = section.to.left;
            }
            self.add_segment(Segment {
                start: before.position.as_vec3(),
                end: node.position.as_vec3(),
                start_radius: before.radius,
                end_radius: node.radius,
                start_color: section.from.color,
                color: section.to.color,
                axis: 0,
                depth: self.state.depth,
                left: (left - tangent * tangent.dot(left)).normalize_or(left).as_vec3(),
            });
            before = Node { tangent, ..node };
        }
        spline.axis = self.state.axis;
        (self.state.axis, self.state.contour, self.state.anchor) = outside;
    }

    /// The slopes of the radius: an angle (degrees) and a length when reaching a point, and when leaving it.
    pub(super) fn radius_tangents(&mut self, parameters: &[f32]) {
        let slope = |angle: f32, length: f32| {
            let radians = finite(angle).to_radians();
            let (sine, cosine) = (math::sin(radians), math::cos(radians));
            [cosine * finite(length), sine * finite(length)]
        };
        match *parameters {
            [scaled] => self.state.scaled_radius_tangents = scaled != 0.0,
            [angle, length] | [angle, length, _] => {
                self.state.radius_tangents = [slope(angle, length); 2];
            }
            [angle, length, leaving, reach, ..] => {
                self.state.radius_tangents = [slope(angle, length), slope(leaving, reach)];
            }
            [] => {}
        }
    }
}

/// A cubic piece of a curve.
struct Section {
    from: Point,
    to: Point,
    /// Coefficients of the place, from the constant on.
    place: [DVec3; 4],
    /// Coefficients of (parameter of the curve, radius).
    radius: [[f32; 2]; 4],
}

#[derive(Clone, Copy)]
struct Node {
    position: DVec3,
    tangent: DVec3,
    radius: f32,
}

impl Section {
    fn node(&self, r: f32) -> Node {
        let cubic = |part: usize| {
            let [a, b, c, d] = self.radius.map(|one| one[part]);
            ((d * r + c) * r + b) * r + a
        };
        let t = f64::from(cubic(0));
        let [a, b, c, d] = self.place;
        Node {
            position: ((d * t + c) * t + b) * t + a,
            tangent: ((d * (3.0 * t) + c * 2.0) * t + b).normalize_or(self.from.heading),
            radius: cubic(1).max(0.0),
        }
    }
}

/// The Hermite curve between two points along their headings.
fn hermite(from: Point, to: Point) -> Option<Section> {
    let way = to.position - from.position;
    let length = way.length();
    if !(length >= NEAREST && length.is_finite()) {
        return None;
    }
    let leaving = from.heading * (length * f64::from(from.tangents[1]));
    let reaching = to.heading * (length * f64::from(to.tangents[0]));
    let place = [
        from.position,
        leaving,
        way * 3.0 - leaving * 2.0 - reaching,
        way * -2.0 + leaving + reaching,
    ];
    Some(Section { from, to, place, radius: radii(&from, &to, length as f32) })
}

/// The piece of the uniform B-spline over the last three points and a new one.
fn bspline(last: &[Point], next: &Point) -> Option<Section> {
    let [p0, p1, p2] = last else { return None };
    let [a, b, c, d] = [p0.position, p1.position, p2.position, next.position];
    let place = [
        (a + b * 4.0 + c) / 6.0,
        (c - a) / 2.0,
        (a - b * 2.0 + c) / 2.0,
        (d - a + (b - c) * 3.0) / 6.0,
    ];
    let (start, end) = (place[0], place[0] + place[1] + place[2] + place[3]);
    let length = start.distance(end);
    if !(length >= NEAREST && length.is_finite()) {
        return None;
    }
    let heading = place[1].try_normalize().unwrap_or(p1.heading);
    let left = rotated(p1.left, p1.heading, heading);
    let from = Point { position: start, heading, left, ..*p1 };
    Some(Section { from, to: *p2, place, radius: radii(p1, p2, length as f32) })
}

/// How the radius (and the parameter of the curve with it) goes from one point to the next.
fn radii(from: &Point, to: &Point, length: f32) -> [[f32; 2]; 4] {
    let change = 0.5 * (to.width - from.width);
    let slope = |mut tangent: [f32; 2]| {
        if to.scaled {
            tangent[1] *= length;
        }
        if tangent == [0.0; 2] { [1.0, change] } else { tangent }
    };
    let (leaving, reaching) = (slope(from.radius_tangents[1]), slope(to.radius_tangents[0]));
    let cubic = |part: usize, start: f32, way: f32| {
        let (a, b) = (leaving[part], reaching[part]);
        [start, a, 3.0 * way - 2.0 * a - b, a + b - 2.0 * way]
    };
    let (along, across) = (cubic(0, 0.0, 1.0), cubic(1, 0.5 * from.width, change));
    [0, 1, 2, 3].map(|power| [along[power], across[power]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(place: [f64; 3], width: f32) -> Point {
        Point {
            position: DVec3::from_array(place),
            heading: DVec3::Y,
            left: DVec3::NEG_X,
            width,
            color: 1,
            contour: Contour::Round,
            tangents: [1.2; 2],
            radius_tangents: [[0.0; 2]; 2],
            scaled: false,
        }
    }

    #[test]
    fn curves_pass_where_they_should() {
        let section = hermite(point([0.0; 3], 2.0), point([1.0, 3.0, 0.0], 1.0)).unwrap();
        let (start, end) = (section.node(0.0), section.node(1.0));
        assert!(start.position.length() < 1e-12 && (start.radius - 1.0).abs() < 1e-6);
        assert!(end.position.distance(DVec3::new(1.0, 3.0, 0.0)) < 1e-9);
        assert!((section.node(0.5).radius - 0.75).abs() < 1e-6, "radii change evenly by default");
        assert!(start.tangent.distance(DVec3::Y) < 1e-9 && end.tangent.distance(DVec3::Y) < 1e-9);
        let line = [0.0, 1.0, 2.0].map(|y| point([0.0, y, 0.0], 1.0));
        let straight = bspline(&line, &point([0.0, 3.0, 0.0], 1.0)).unwrap();
        let half = straight.node(0.5).position;
        assert!(half.distance(DVec3::new(0.0, 1.5, 0.0)) < 1e-9, "{half} of a straight B-spline");
    }
}
