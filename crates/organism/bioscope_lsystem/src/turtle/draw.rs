//! What the turtle leaves behind: strokes, polygons, surfaces, balls, discs, labels.

use bioscope_core::Vec3;

use super::command::Disc as DiscCommand;
use super::{Turtle, finite, vector};
use crate::interpretation::{Anchor, Axis, Ball, Contour, Disc, Label, Polygon, Segment, Surface};

impl Turtle<'_> {
    /// Goes ahead and draws; `corner` if the end is also a corner of the polygon.
    pub(super) fn draw(&mut self, length: f64, corner: bool) {
        let polygon = corner && !self.polygons.is_empty();
        if polygon && !self.is_cpfg() {
            self.go(length, true);
            return;
        }
        self.end_stroke();
        self.give_way();
        let start = self.state.position;
        let end = start + self.state.axes.heading * length;
        if !end.is_finite() || length == 0.0 {
            return;
        }
        if self.draws {
            self.stroke(start.as_vec3(), end.as_vec3());
        }
        self.state.position = end;
        self.grow_towards_tropism();
        if polygon {
            self.corner();
        } else if corner && self.spline.is_some() {
            self.step_point();
        }
        self.remember_twist();
    }

    fn stroke(&mut self, start: Vec3, end: Vec3) {
        let radius = self.state.width / 2.0;
        let last = self.state.axis.map(|axis| self.out.axes[axis as usize].last);
        let last = last.map(|index| &self.out.segments[index as usize]);
        let (start_radius, start_color) = match (last, self.state.beginning.take()) {
            (Some(segment), _) => (segment.end_radius, segment.color),
            (None, Some((width, color))) => (width / 2.0, color),
            (None, None) => (radius, self.state.color),
        };
        let start_radius = if self.is_cpfg() { radius } else { start_radius };
        self.add_segment(Segment {
            start,
            end,
            start_radius,
            end_radius: radius,
            start_color,
            color: self.state.color,
            axis: 0,
            depth: self.state.depth,
            left: self.state.axes.left.as_vec3(),
        });
        if self.is_cpfg() && self.options.tapered {
            self.tapering = Some(self.out.segments.len() as u32 - 1);
        }
    }

    /// Adds a segment to the present axis, or to a new one.
    pub(super) fn add_segment(&mut self, segment: Segment) {
        let index = self.out.segments.len() as u32;
        let state = &self.state;
        let axis = state.axis.unwrap_or_else(|| {
            self.out.axes.push(Axis {
                parent: state.anchor,
                contour: state.contour,
                texture: state.texture,
                sides: state.sides,
                segments: 0,
                last: index,
            });
            self.out.axes.len() as u32 - 1
        });
        self.out.axes[axis as usize].segments += 1;
        self.out.axes[axis as usize].last = index;
        self.out.segments.push(Segment { axis, ..segment });
        self.state.axis = Some(axis);
    }

    /// Lets the last stroke taper to the present width (cpfg).
    pub(super) fn end_stroke(&mut self) {
        if let Some(index) = self.tapering.take() {
            self.out.segments[index as usize].end_radius = self.state.width / 2.0;
        }
    }

    /// What is drawn next begins a new axis that grows out of the present one.
    pub(super) fn leave_axis(&mut self) {
        self.state.anchor = self.anchor();
        self.state.axis = None;
        self.state.beginning = None;
    }

    /// The place of the turtle on the plant.
    pub(super) fn anchor(&self) -> Option<Anchor> {
        let on_axis = |axis: u32| Anchor { axis, node: self.out.axes[axis as usize].segments };
        self.state.axis.map(on_axis).or(self.state.anchor)
    }

    fn give_way(&mut self) {
        if !self.options.movements.is_empty() {
            self.state.give_way(&self.options.movements);
        }
    }

    fn grow_towards_tropism(&mut self) {
        if self.state.susceptibility == 0.0 {
        } else if self.is_cpfg() {
            self.state.bend_as_cpfg();
        } else {
            self.state.bend();
        }
    }

    /// Goes ahead and does not draw.
    pub(super) fn go(&mut self, length: f64, corner: bool) {
        self.end_stroke();
        self.give_way();
        let end = self.state.position + self.state.axes.heading * length;
        if !end.is_finite() {
            return;
        }
        self.leave_axis();
        self.state.position = end;
        if self.is_cpfg() {
            self.grow_towards_tropism();
        }
        if corner && !self.polygons.is_empty() {
            self.corner();
        } else if corner && self.spline.is_some() {
            self.step_point();
        }
    }

    pub(super) fn corner(&mut self) {
        let position = self.state.position.as_vec3();
        if let Some(corners) = self.polygons.last_mut() {
            corners.push(position);
            self.corners += 1;
        }
    }

    pub(super) fn end_polygon(&mut self) {
        self.end_stroke();
        let Some(corners) = self.polygons.pop() else { return };
        if corners.len() >= 3 && self.draws {
            self.out.polygons.push(Polygon {
                corners,
                color: self.state.color,
                texture: self.state.texture,
                anchor: self.anchor(),
            });
        }
    }

    pub(super) fn surface(&mut self, name: char, parameters: &[f32]) {
        self.end_stroke();
        let scale = match parameters {
            [] => Vec3::ONE,
            [one] | [one, _] => Vec3::splat(finite(*one)),
            _ => vector(parameters, 0).unwrap_or(Vec3::ONE),
        };
        let scale = scale * self.state.scale * self.growing;
        let frame = self.state.axes.rounded();
        if self.draws {
            self.out.surfaces.push(Surface {
                name,
                position: self.state.position.as_vec3(),
                frame,
                scale,
                color: self.state.color,
                texture: self.state.texture,
                anchor: self.anchor(),
            });
        }
        if let Some(shape) = self.options.shapes.surfaces.get(&name) {
            // cpfg scales the way to the end by the first factor alone.
            let way = (frame.left * shape.end.x + frame.heading * shape.end.y
                - frame.up * shape.end.z)
                * scale.x;
            if way.is_finite() && way != Vec3::ZERO {
                self.leave_axis();
                self.state.position += way.as_dvec3();
            }
        }
    }

    /// A radius that a symbol gives: cpfg means diameters.
    fn radius(&self, first: Option<f32>) -> f32 {
        let half = self.state.width / 2.0;
        let factor = if self.is_cpfg() { 0.5 } else { 1.0 } * self.state.scale;
        first.map_or(half, |size| size * factor).abs() * self.growing
    }

    pub(super) fn ball(&mut self, first: Option<f32>) {
        let radius = self.radius(first);
        if self.draws {
            self.out.balls.push(Ball {
                center: self.state.position.as_vec3(),
                radius,
                axis: self.state.axes.heading.as_vec3(),
                color: self.state.color,
                anchor: self.anchor(),
            });
        }
    }

    pub(super) fn disc(&mut self, disc: DiscCommand, first: Option<f32>) {
        let radius = self.radius(first);
        let (normal, rim) = match disc {
            DiscCommand::Flat { rim } => (Vec3::Z, rim),
            DiscCommand::Turned { rim } => (self.state.axes.up.as_vec3(), rim),
        };
        if self.draws {
            self.out.discs.push(Disc {
                center: self.state.position.as_vec3(),
                radius,
                rim: rim.then_some(self.state.width),
                normal,
                color: self.state.color,
                anchor: self.anchor(),
            });
        }
    }

    pub(super) fn label(&mut self, parameters: &[f32]) {
        if self.draws {
            self.out.labels.push(Label {
                position: self.state.position.as_vec3(),
                parameters: parameters.to_vec(),
                color: self.state.color,
            });
        }
    }

    pub(super) fn contour(&mut self, first: Option<f32>) {
        let number = first.unwrap_or(0.0) as i32;
        let known = self.options.shapes.contours.contains_key(&number);
        let contour = match number {
            _ if known => Contour::Profile(number),
            1 if !self.is_cpfg() => Contour::Ribbon,
            2 if !self.is_cpfg() => Contour::Ruffle,
            _ => Contour::Round,
        };
        if contour != self.state.contour {
            if self.spline.is_none() {
                self.leave_axis();
            }
            self.state.contour = contour;
        }
    }
}
