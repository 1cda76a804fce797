use std::sync::Arc;

use bioscope_core::Vec3;

use crate::files::Shapes;
use crate::turtle::Frame;

/// What the turtle has drawn: segments that form axes, polygons, surfaces and balls.
#[derive(Clone, Debug, Default)]
pub struct Interpretation {
    /// All segments, in the order they were drawn.
    pub segments: Vec<Segment>,
    /// The axes that the segments form; each begins on an earlier one, or nowhere.
    pub axes: Vec<Axis>,
    /// Filled polygons.
    pub polygons: Vec<Polygon>,
    /// Predefined surfaces.
    pub surfaces: Vec<Surface>,
    /// Balls.
    pub balls: Vec<Ball>,
    /// Discs.
    pub discs: Vec<Disc>,
    /// Bicubic patches whose control points the turtle set.
    pub patches: Vec<Patch>,
    /// Texts at places of the plant.
    pub labels: Vec<Label>,
    /// The surfaces and contours that the parts name.
    pub shapes: Arc<Shapes>,
}

/// One step of the turtle with the pen down.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Where it begins, metres.
    pub start: Vec3,
    /// Where it ends, metres.
    pub end: Vec3,
    /// Half its width at the start, metres.
    pub start_radius: f32,
    /// Half its width at the end, metres.
    pub end_radius: f32,
    /// Index of its color at the start.
    pub start_color: i32,
    /// Index of its color.
    pub color: i32,
    /// Number of its axis.
    pub axis: u32,
    /// How many brackets were open.
    pub depth: u32,
    /// Left of the turtle, a unit vector.
    pub left: Vec3,
}

/// Segments that continue each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Where it grows out of another axis.
    pub parent: Option<Anchor>,
    /// Its cross-section.
    pub contour: Contour,
    /// Number of its texture; 0 is none.
    pub texture: u16,
    /// Sides of its cross-section; 0 leaves them to the mesh.
    pub sides: u16,
    /// How many segments it has.
    pub segments: u32,
    /// Number of its last segment.
    pub(crate) last: u32,
}

/// A node of an axis: 0 is its base, n the end of its n-th segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Anchor {
    /// Number of the axis.
    pub axis: u32,
    /// Number of the node.
    pub node: u32,
}

/// The cross-section of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Contour {
    /// A circle.
    #[default]
    Round,
    /// Flat, as wide as the axis to the turtle's left and right.
    Ribbon,
    /// Flat, its edges bent up and down in turn.
    Ruffle,
    /// The contour of this number in [`Shapes`].
    Profile(i32),
}

impl Contour {
    /// A number that no other contour has.
    pub(crate) fn number(self) -> i32 {
        match self {
            Self::Round => -1,
            Self::Ribbon => -2,
            Self::Ruffle => -3,
            Self::Profile(number) => number,
        }
    }
}

/// A filled polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Its corners, metres.
    pub corners: Vec<Vec3>,
    /// Index of its color.
    pub color: i32,
    /// Number of its texture; 0 is none.
    pub texture: u16,
    /// Where it sits on the plant.
    pub anchor: Option<Anchor>,
}

/// A predefined surface, such as a leaf.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The letter after `~`.
    pub name: char,
    /// Where its base is, metres.
    pub position: Vec3,
    /// How it is turned.
    pub frame: Frame,
    /// Its size to the left, ahead and up.
    pub scale: Vec3,
    /// Index of its color.
    pub color: i32,
    /// Number of its texture; 0 is none.
    pub texture: u16,
    /// Where it sits on the plant.
    pub anchor: Option<Anchor>,
}

/// A ball.
#[derive(Clone, Debug, PartialEq)]
pub struct Ball {
    /// Its center, metres.
    pub center: Vec3,
    /// Its radius, metres.
    pub radius: f32,
    /// The axis of its poles.
    pub axis: Vec3,
    /// Index of its color.
    pub color: i32,
    /// Where it sits on the plant.
    pub anchor: Option<Anchor>,
}

/// A disc, or a ring if it has a rim.
#[derive(Clone, Debug, PartialEq)]
pub struct Disc {
    /// Its center, metres.
    pub center: Vec3,
    /// Its radius, metres.
    pub radius: f32,
    /// Width of its rim, metres; a disc without rim is filled.
    pub rim: Option<f32>,
    /// Perpendicular to it, a unit vector.
    pub normal: Vec3,
    /// Index of its color.
    pub color: i32,
    /// Where it sits on the plant.
    pub anchor: Option<Anchor>,
}

/// A bicubic patch over 16 points.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Its control points by row and column, metres.
    pub points: [[Vec3; 4]; 4],
    /// How the points are blended.
    pub basis: Basis,
    /// Quads along the rows and columns.
    pub quads: [u32; 2],
    /// Index of its color.
    pub color: i32,
    /// Number of its texture; 0 is none.
    pub texture: u16,
    /// Where it sits on the plant.
    pub anchor: Option<Anchor>,
}

/// How four points in a row are blended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// The patch begins and ends in points.
    #[default]
    Bezier,
    /// Uniform B-spline.
    BSpline,
    /// Catmull and Rom's spline (cardinal, tension 1/2): through the inner points.
    Cardinal,
}

/// A text at a place of the plant.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Where it stands, metres.
    pub position: Vec3,
    /// The numbers of `@L`: which text, and what to write into it.
    pub parameters: Vec<f32>,
    /// Index of its color.
    pub color: i32,
}

impl Interpretation {
    /// The numbers of each axis's segments from its base on: of axis `a` those in
    /// `list[starts[a]..starts[a + 1]]`.
    pub(crate) fn segments_by_axis(&self) -> (Vec<u32>, Vec<usize>) {
        let mut starts = Vec::with_capacity(self.axes.len() + 1);
        let mut total = 0;
        starts.push(0);
        for axis in &self.axes {
            total += axis.segments as usize;
            starts.push(total);
        }
        let mut next = starts.clone();
        let mut list = vec![0; self.segments.len()];
        for (number, segment) in self.segments.iter().enumerate() {
            let place = &mut next[segment.axis as usize];
            list[*place] = number as u32;
            *place += 1;
        }
        (list, starts)
    }
}
