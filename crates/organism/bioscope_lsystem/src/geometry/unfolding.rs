//! Growth between two steps: what is new unfolds from where it is attached.

use std::collections::BTreeSet;

use bioscope_core::Vec3;
use serde::{Deserialize, Serialize};

use crate::Interpretation;
use crate::interpretation::Anchor;

/// Places are the same if they agree to this, in units of the model.
const GRAIN: f32 = 1e-3;

/// Numbers of the segments and surfaces of a drawing that an earlier drawing did not have.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Young {
    /// Numbers of segments, ascending.
    pub segments: Vec<u32>,
    /// Numbers of surfaces, ascending.
    pub surfaces: Vec<u32>,
}

impl Young {
    /// Whether nothing is new.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty() && self.surfaces.is_empty()
    }
}

impl Interpretation {
    /// What is here but was not in an earlier drawing of the plant: segments by their ends, surfaces by their places.
    pub fn young_since(&self, before: &Self) -> Young {
        let segments: BTreeSet<[i32; 6]> =
            before.segments.iter().map(|one| key(one.start, one.end)).collect();
        let surfaces: BTreeSet<[i32; 6]> =
            before.surfaces.iter().map(|one| key(one.position, one.frame.heading)).collect();
        let own = self.segments.iter().map(|one| !segments.contains(&key(one.start, one.end)));
        let leaves = self.surfaces.iter();
        let leaves = leaves.map(|one| !surfaces.contains(&key(one.position, one.frame.heading)));
        Young { segments: numbers(own), surfaces: numbers(leaves) }
    }

    /// Draws what is young smaller, each new part towards the place where it is attached to the old: a share of 0
    /// makes it a point, 1 leaves it as it is.
    pub fn unfold(&mut self, young: &Young, share: f32) {
        let mut is_young = vec![false; self.segments.len()];
        for &number in &young.segments {
            if let Some(one) = is_young.get_mut(number as usize) {
                *one = true;
            }
        }
        // Where each node of each axis shrinks towards, if it does; parents come before their children.
        let (list, starts) = self.segments_by_axis();
        let mut pivots: Vec<Vec<Option<Vec3>>> = Vec::with_capacity(self.axes.len());
        let toward = |pivots: &[Vec<Option<Vec3>>], anchor: Option<Anchor>| {
            let anchor = anchor?;
            *pivots.get(anchor.axis as usize)?.get(anchor.node as usize)?
        };
        for (number, axis) in self.axes.iter().enumerate() {
            let mut pivot = toward(&pivots, axis.parent);
            let mut nodes = vec![pivot];
            for &segment in &list[starts[number]..starts[number + 1]] {
                let segment = segment as usize;
                let start = self.segments[segment].start;
                pivot = is_young[segment].then(|| pivot.unwrap_or(start));
                nodes.push(pivot);
            }
            pivots.push(nodes);
        }
        let thinner = share.max(0.0).sqrt();
        for number in 0..self.axes.len() {
            for (node, &segment) in list[starts[number]..starts[number + 1]].iter().enumerate() {
                let one = &mut self.segments[segment as usize];
                let (start, end) = (pivots[number][node], pivots[number][node + 1]);
                one.start = shrunk(one.start, start, share);
                one.end = shrunk(one.end, end, share);
                if end.is_some() {
                    one.start_radius *= thinner;
                    one.end_radius *= thinner;
                }
            }
        }
        let mut new_leaves = young.surfaces.iter().peekable();
        for (number, one) in self.surfaces.iter_mut().enumerate() {
            let is_new = new_leaves.next_if(|&&leaf| leaf as usize == number).is_some();
            let pivot = toward(&pivots, one.anchor);
            one.position = shrunk(one.position, pivot, share);
            if is_new || pivot.is_some() {
                one.scale *= share;
            }
        }
        for one in &mut self.polygons {
            if let Some(pivot) = toward(&pivots, one.anchor) {
                one.corners
                    .iter_mut()
                    .for_each(|place| *place = shrunk(*place, Some(pivot), share));
            }
        }
        for one in &mut self.balls {
            if let Some(pivot) = toward(&pivots, one.anchor) {
                one.center = shrunk(one.center, Some(pivot), share);
                one.radius *= share;
            }
        }
        for one in &mut self.discs {
            if let Some(pivot) = toward(&pivots, one.anchor) {
                one.center = shrunk(one.center, Some(pivot), share);
                one.radius *= share;
            }
        }
        for one in &mut self.patches {
            if let Some(pivot) = toward(&pivots, one.anchor) {
                let places = one.points.iter_mut().flatten();
                places.for_each(|place| *place = shrunk(*place, Some(pivot), share));
            }
        }
    }
}

fn shrunk(place: Vec3, pivot: Option<Vec3>, share: f32) -> Vec3 {
    pivot.map_or(place, |pivot| pivot + (place - pivot) * share)
}

fn numbers(flags: impl Iterator<Item = bool>) -> Vec<u32> {
    flags.enumerate().filter(|(_, flag)| *flag).map(|(number, _)| number as u32).collect()
}

fn key(a: Vec3, b: Vec3) -> [i32; 6] {
    [a.x, a.y, a.z, b.x, b.y, b.z].map(|part| (part / GRAIN).round() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LSystem, Turtle, TurtleOptions};

    fn drawn(steps: u64) -> Interpretation {
        let text =
            "lsystem: fork\nangle: 30\naxiom: F(1)A\nA --> [+F(1)~l(0.5)A]F(1)A\nendlsystem\n";
        let string = LSystem::parse(text, "fork.lsys").unwrap().derive(steps, 0).unwrap();
        Turtle::interpret(&string, &TurtleOptions::default()).unwrap()
    }

    #[test]
    fn only_what_is_new_unfolds_and_from_the_old() {
        let (before, mut after) = (drawn(1), drawn(2));
        let young = after.young_since(&before);
        assert_eq!(young.segments.len(), after.segments.len() - before.segments.len());
        assert!(after.young_since(&after).is_empty());
        let full = after.clone();
        after.unfold(&young, 0.25);
        for (number, (now, then)) in after.segments.iter().zip(&full.segments).enumerate() {
            let length = now.start.distance(now.end) / then.start.distance(then.end);
            let is_young = young.segments.contains(&(number as u32));
            assert!(
                (length - if is_young { 0.25 } else { 1.0 }).abs() < 1e-5,
                "{number}: {length}"
            );
            // Nothing comes apart.
            let (axis, parent) = (now.axis as usize, after.axes[now.axis as usize].parent);
            let is_first =
                after.segments.iter().position(|one| one.axis == now.axis) == Some(number);
            if let (true, Some(anchor)) = (is_first && axis > 0, parent) {
                let on = after.segments.iter().filter(|one| one.axis == anchor.axis);
                let on = on.flat_map(|one| [one.start, one.end]);
                let gap = on.map(|place| place.distance(now.start)).fold(f32::INFINITY, f32::min);
                assert!(gap < 1e-5, "{number} is {gap} away");
            }
        }
        let mut whole = full.clone();
        whole.unfold(&young, 1.0);
        let far = whole.segments.iter().zip(&full.segments).map(|(a, b)| a.end.distance(b.end));
        assert!(far.fold(0.0, f32::max) < 1e-6);
    }
}
