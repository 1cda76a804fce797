use bioscope_core::Vec2;

use super::function::clamped_spline;
use super::text::{Line, Text, numbers};
use crate::Diagnostics;

/// Most control points of a contour.
const POINTS: usize = 100_000;
/// Places per control point at which the length of a contour is measured.
const PIECES: usize = 10;

/// A cross-section: a uniform cubic B-spline over control points, in a .con file.
#[derive(Clone, Debug, PartialEq)]
pub struct ContourShape {
    points: Vec<[f32; 3]>,
    /// Whether it closes.
    pub closed: bool,
}

/// One place of a cross-section of radius 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourVertex {
    /// Along the turtle's down and right.
    pub point: Vec2,
    /// Along its heading.
    pub ahead: f32,
    /// Out of the contour, a unit vector.
    pub normal: Vec2,
    /// Way along the contour, 0 to 1.
    pub way: f32,
}

impl ContourShape {
    /// Reads a contour file: `n 2 closed` with n points, `cver 1 1` to `1 3`, or `version: 1.4`.
    pub fn parse(bytes: &[u8], file: &str) -> Result<Self, Diagnostics> {
        let (points, closed, _) = control_points(bytes, file)?;
        if points.len() < 4 {
            return Err(Text::new(bytes, file)?.ends("at least 4 control points"));
        }
        Ok(Self { points, closed })
    }

    /// Places along the contour, equally far from each other: `sides` + 1 of them; of a closed
    /// contour the last is the first.
    pub fn sampled(&self, sides: u32) -> Vec<ContourVertex> {
        let pieces = if self.closed { self.points.len() } else { self.points.len() - 3 };
        let count = pieces * PIECES;
        let place = |index: usize| self.at(index as f32 / PIECES as f32);
        let mut lengths = vec![0.0];
        for index in 0..count {
            let [(a, _), (b, _)] = [place(index), place(index + 1)];
            let way = Vec2::new(b[0] - a[0], b[1] - a[1]).length();
            lengths.push(lengths[index] + way);
        }
        let total = lengths[count];
        let sides = sides.max(3);
        let turn = self.turn();
        let direction = self.direction();
        let vertex = |side: u32| {
            let wanted = total * side as f32 / sides as f32;
            let after = lengths.partition_point(|&length| length < wanted).clamp(1, count);
            let step = lengths[after] - lengths[after - 1];
            let share = if step > 0.0 { (wanted - lengths[after - 1]) / step } else { 0.0 };
            let ([x, y, ahead], tangent) = self.at((after as f32 - 1.0 + share) / PIECES as f32);
            let normal = Vec2::new(tangent.y, -tangent.x) * direction;
            ContourVertex {
                point: turn.rotate(Vec2::new(x, y)),
                ahead,
                normal: turn.rotate(normal.normalize_or(Vec2::X)),
                way: side as f32 / sides as f32,
            }
        };
        let mut vertices: Vec<ContourVertex> = (0..=sides).map(vertex).collect();
        if self.closed {
            let first = vertices[0];
            vertices[sides as usize] = ContourVertex { way: 1.0, ..first };
        }
        vertices
    }

    /// What turns the first point of a closed contour to the axis, as a unit complex number.
    fn turn(&self) -> Vec2 {
        let ([x, y, _], _) = self.at(0.0);
        let conjugate = Vec2::new(x, -y);
        if self.closed { conjugate.normalize_or(Vec2::X) } else { Vec2::X }
    }

    /// 1 if the points run counterclockwise, −1 if clockwise.
    fn direction(&self) -> f32 {
        let next = self.points.iter().cycle().skip(1);
        let area: f32 = self.points.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        if area < 0.0 { -1.0 } else { 1.0 }
    }

    /// The point and the tangent (not of unit length) at a parameter that counts control points.
    fn at(&self, t: f32) -> ([f32; 3], Vec2) {
        let count = self.points.len();
        let first = t.floor() as usize;
        let t = t - first as f32;
        let (s, tt) = (1.0 - t, t * t);
        let weights = [
            s * s * s / 6.0,
            (3.0 * tt * t - 6.0 * tt + 4.0) / 6.0,
            (-3.0 * tt * t + 3.0 * tt + 3.0 * t + 1.0) / 6.0,
            tt * t / 6.0,
        ];
        let slopes = [-s * s / 2.0, 1.5 * tt - 2.0 * t, -1.5 * tt + t + 0.5, tt / 2.0];
        let (mut point, mut tangent) = ([0.0; 3], Vec2::ZERO);
        for (offset, (weight, slope)) in weights.into_iter().zip(slopes).enumerate() {
            let control = self.points[(first + offset) % count];
            for axis in 0..3 {
                point[axis] += weight * control[axis];
            }
            tangent += Vec2::new(control[0], control[1]) * slope;
        }
        (point, tangent)
    }
}

/// A curve in space over control points.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    points: Vec<[f64; 3]>,
    /// Whether it begins and ends in its first and last point.
    clamped: bool,
    /// Way from the start to each of equally spaced parameters.
    ways: Vec<f64>,
}

impl Curve {
    /// Reads a curve file; the same formats as contours.
    pub fn parse(bytes: &[u8], file: &str, samples: usize) -> Result<Self, Diagnostics> {
        let (points, _, clamped) = control_points(bytes, file)?;
        if points.len() < 4 {
            return Err(Text::new(bytes, file)?.ends("at least 4 control points"));
        }
        let points = points.iter().map(|point| point.map(f64::from)).collect();
        let mut curve = Self { points, clamped, ways: vec![0.0] };
        let samples = samples.clamp(2, POINTS);
        let mut last = curve.point(0.0);
        for sample in 1..=samples {
            let point = curve.point(sample as f64 / samples as f64);
            let square: f64 = (0..3).map(|axis| (point[axis] - last[axis]).powi(2)).sum();
            curve.ways.push(curve.ways[sample - 1] + square.sqrt());
            last = point;
        }
        Ok(curve)
    }

    /// The point after the share `t` of its length.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let wanted = t.clamp(0.0, 1.0) * self.length();
        let last = self.ways.len() - 1;
        let after = self.ways.partition_point(|&way| way < wanted).clamp(1, last);
        let step = self.ways[after] - self.ways[after - 1];
        let share = if step > 0.0 { (wanted - self.ways[after - 1]) / step } else { 0.0 };
        self.point((after as f64 - 1.0 + share) / last as f64)
    }

    /// Its length.
    pub fn length(&self) -> f64 {
        self.ways[self.ways.len() - 1]
    }

    fn point(&self, t: f64) -> [f64; 3] {
        if self.clamped {
            return clamped_spline(&self.points, t);
        }
        let pieces = self.points.len() - 3;
        let u = t.clamp(0.0, 1.0) * pieces as f64;
        let first = (u.floor() as usize).min(pieces - 1);
        let t = u - first as f64;
        let (s, tt) = (1.0 - t, t * t);
        let weights = [
            s * s * s / 6.0,
            (3.0 * tt * t - 6.0 * tt + 4.0) / 6.0,
            (-3.0 * tt * t + 3.0 * tt + 3.0 * t + 1.0) / 6.0,
            tt * t / 6.0,
        ];
        let mut point = [0.0; 3];
        for (control, weight) in self.points[first..first + 4].iter().zip(weights) {
            for axis in 0..3 {
                point[axis] += weight * control[axis];
            }
        }
        point
    }
}

type ControlPoints = (Vec<[f32; 3]>, bool, bool);

/// The control points of a file, whether they close, and whether the ends are met.
fn control_points(bytes: &[u8], file: &str) -> Result<ControlPoints, Diagnostics> {
    let text = Text::new(bytes, file)?;
    let lines: Vec<Line> = text.lines().collect();
    let Some(head) = lines.first() else { return Err(text.ends("a contour")) };
    let (mut closed, mut clamped, mut flat) = (false, false, false);
    let first = numbers(&head.text);
    let mut body = 0;
    if let [count, dimension, ..] = first[..] {
        // The first format: number of points, dimension, open or closed.
        closed = head.text.trim_end().ends_with("closed");
        flat = dimension < 3.0;
        if !(1.0..=POINTS as f32).contains(&count) {
            return Err(text.error(head, "expected a number of points up to 100000"));
        }
        body = 1;
    }
    let mut points = Vec::new();
    for line in &lines[body..] {
        if let Some((name, value)) = line.command() {
            if name == "type" {
                closed = value.starts_with('c');
                clamped = value.ends_with("endpoint") || value == "oe" || value == "ce";
            }
            continue;
        }
        let row = numbers(&line.text);
        let (point, times) = match row[..] {
            [x, y] | [x, y, _] if flat => ([x, y, 0.0], 1.0),
            [x, y, z] => ([x, y, z], 1.0),
            [x, y, z, times, ..] => ([x, y, z], times),
            _ if line.text.trim_start().starts_with(char::is_alphabetic) => continue,
            _ => return Err(text.error(line, "expected the coordinates of a control point")),
        };
        let times = times.clamp(0.0, 16.0) as usize;
        if points.len() + times > POINTS {
            return Err(text.error(line, "more than 100000 control points"));
        }
        points.extend(std::iter::repeat_n(point, times));
    }
    Ok((points, closed, clamped))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle() -> ContourShape {
        let points = (0..16).map(|index| {
            let angle = index as f32 / 16.0 * std::f32::consts::TAU;
            format!("{} {}", angle.cos(), angle.sin())
        });
        let text = format!("16 2 closed\n{}\n", points.collect::<Vec<_>>().join("\n"));
        ContourShape::parse(text.as_bytes(), "circle.con").unwrap()
    }

    #[test]
    fn a_closed_contour_is_sampled_evenly_and_closes() {
        let vertices = circle().sampled(24);
        assert_eq!(vertices.len(), 25);
        assert_eq!(vertices[0].point, vertices[24].point);
        assert!(vertices[0].point.y.abs() < 1e-6, "the first point lies on the axis");
        let steps = vertices.windows(2).map(|pair| pair[0].point.distance(pair[1].point));
        let steps: Vec<f32> = steps.collect();
        assert!(steps.iter().all(|step| (step / steps[0] - 1.0).abs() < 0.02), "{steps:?}");
        assert!(vertices.iter().all(|one| one.normal.dot(one.point.normalize()) > 0.99));
    }

    #[test]
    fn formats_of_all_versions_are_read() {
        let third = "cver 1 3\nname: leaf.con\npoints: 3 5\ntype: or\nsamples: 8\n\
            -1 0 0 2\n0 1 0 1\n1 0 0 2\n";
        let leaf = ContourShape::parse(third.as_bytes(), "leaf.con").unwrap();
        assert_eq!((leaf.points.len(), leaf.closed), (5, false));
        let fourth = "version: 1.4\nsize: 1\npoints: 4\nrange: 0.0 1.0\ntype: bspline\n\
            0.2 -0.4 0 3\n0.2 -0.1 0 1\n0.1 0.1 0 1\n0 0.2 0 3\n";
        assert_eq!(ContourShape::parse(fourth.as_bytes(), "p.con").unwrap().points.len(), 8);
        let error = ContourShape::parse(b"4 2 open\n1 1\n?\n", "bad.con").unwrap_err();
        assert!(error.to_string().starts_with("bad.con:3:1: expected the coordinates"), "{error}");
    }
}
