use crate::{Interpretation, interpretation::Anchor};

/// Distances along the axes of a plant.
pub(super) struct Layout {
    /// Numbers of the segments, axis by axis, each from its base on.
    pub list: Vec<u32>,
    /// Where each axis begins in `list`; one more at the end.
    pub starts: Vec<usize>,
    /// Distance from the base of its axis to the end of each segment in `list`, metres.
    pub arcs: Vec<f32>,
    /// Way from the root to the base of each axis, metres.
    pub bases: Vec<f32>,
}

impl Layout {
    pub fn new(interpretation: &Interpretation) -> Self {
        let (list, starts) = interpretation.segments_by_axis();
        let mut layout =
            Self { arcs: Vec::with_capacity(list.len()), list, starts, bases: Vec::new() };
        for (number, axis) in interpretation.axes.iter().enumerate() {
            // Parents come before their children.
            let base = axis.parent.map_or(0.0, |anchor| layout.path(anchor));
            layout.bases.push(base);
            let mut arc = 0.0;
            for index in layout.starts[number]..layout.starts[number + 1] {
                let segment = &interpretation.segments[layout.list[index] as usize];
                arc += segment.start.distance(segment.end);
                layout.arcs.push(arc);
            }
        }
        layout
    }

    /// Way from the root to a node, metres.
    pub fn path(&self, anchor: Anchor) -> f32 {
        let axis = anchor.axis as usize;
        let arc = match anchor.node {
            0 => 0.0,
            node => self.arcs[self.starts[axis] + node as usize - 1],
        };
        self.bases[axis] + arc
    }

    /// Length of an axis, metres.
    pub fn length(&self, axis: u32) -> f32 {
        let end = self.starts[axis as usize + 1];
        if end > self.starts[axis as usize] { self.arcs[end - 1] } else { 0.0 }
    }
}
