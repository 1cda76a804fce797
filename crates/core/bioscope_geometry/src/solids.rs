use std::ops::{Deref, Range};
use std::sync::OnceLock;

use bioscope_core::Vec3;

use crate::Obstacle;

/// Metres by which bounds are wider than they need be, and share of the greatest coordinate: more than is lost in
/// rounding.
const ROUNDING: (f32, f32) = (1e-3, 1e-5);

/// All solids of a world, in the order in which they came, with an index of where they are: who asks for those near a
/// place pays for what is there, not for all.
#[derive(Clone, Debug, Default)]
pub struct Solids {
    all: Vec<Obstacle>,
    /// Made when it is asked for first after a change.
    tree: OnceLock<Tree>,
}

impl From<Vec<Obstacle>> for Solids {
    fn from(all: Vec<Obstacle>) -> Self {
        Self { all, tree: OnceLock::new() }
    }
}

impl Deref for Solids {
    type Target = [Obstacle];

    fn deref(&self) -> &[Obstacle] {
        &self.all
    }
}

impl Solids {
    /// None yet.
    pub const fn new() -> Self {
        Self { all: Vec::new(), tree: OnceLock::new() }
    }

    /// All of them, for changing.
    pub fn edit(&mut self) -> &mut Vec<Obstacle> {
        self.tree.take();
        &mut self.all
    }

    /// Those that may reach into the box between these corners (metres), in their order; some that do not are among
    /// them.
    pub fn within(&self, low: Vec3, high: Vec3) -> impl ExactSizeIterator<Item = &Obstacle> {
        let mut found = Vec::new();
        if !self.all.is_empty() {
            self.tree.get_or_init(|| Tree::new(&self.all)).find(&Bounds { low, high }, &mut found);
        }
        found.sort_unstable();
        found.into_iter().map(|index| &self.all[index as usize])
    }
}

/// A box along the world's axes.
#[derive(Clone, Copy, Debug, Default)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    /// Round a solid; none if it has no end.
    fn of(solid: &Obstacle) -> Option<Self> {
        let (low, high, radius) = match *solid {
            Obstacle::Sphere { center, radius } => (center, center, radius),
            Obstacle::Cylinder { base, top, radius } => (base.min(top), base.max(top), radius),
            Obstacle::Box { low, high } => (low.min(high), low.max(high), 0.0),
            Obstacle::Plane { .. } => return None,
        };
        let farthest = low.abs().max(high.abs()).max_element();
        let margin = radius + ROUNDING.0 + ROUNDING.1 * farthest;
        let bounds = Self { low: low - margin, high: high + margin };
        (bounds.low.is_finite() && bounds.high.is_finite()).then_some(bounds)
    }

    fn joined(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }
}

/// Solids halved by place again and again. The halves of part `n` are the parts `2 n + 1` and `2 n + 2`.
#[derive(Clone, Debug, Default)]
struct Tree {
    /// The solids, so that those of each part lie side by side.
    order: Vec<u32>,
    /// What each part needs of space.
    parts: Vec<Bounds>,
    /// Solids without end, which are everywhere.
    endless: Vec<u32>,
}

impl Tree {
    fn new(solids: &[Obstacle]) -> Self {
        let bounds: Vec<Option<Bounds>> = solids.iter().map(Bounds::of).collect();
        let indices = 0..solids.len() as u32;
        let (order, endless) = indices.partition(|&index| bounds[index as usize].is_some());
        let mut tree = Self { order, parts: Vec::new(), endless };
        let bounds: Vec<Bounds> = bounds.into_iter().map(Option::unwrap_or_default).collect();
        if !tree.order.is_empty() {
            tree.halve(0, 0..tree.order.len(), &bounds);
        }
        tree
    }

    fn halve(&mut self, part: usize, range: Range<usize>, bounds: &[Bounds]) {
        let some = &mut self.order[range.clone()];
        let each = some.iter().map(|&index| bounds[index as usize]);
        let whole = each.reduce(Bounds::joined).unwrap_or_default();
        if self.parts.len() <= part {
            self.parts.resize(part + 1, Bounds::default());
        }
        self.parts[part] = whole;
        if some.len() == 1 {
            return;
        }
        let axis = (whole.high - whole.low).max_position();
        let place = |index: u32| {
            let Bounds { low, high } = bounds[index as usize];
            low[axis] + high[axis]
        };
        let half = some.len() / 2;
        some.select_nth_unstable_by(half, |&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
        let middle = range.start + half;
        self.halve(2 * part + 1, range.start..middle, bounds);
        self.halve(2 * part + 2, middle..range.end, bounds);
    }

    fn find(&self, space: &Bounds, found: &mut Vec<u32>) {
        found.extend_from_slice(&self.endless);
        if !self.order.is_empty() {
            self.find_in(0, 0..self.order.len(), space, found);
        }
    }

    fn find_in(&self, part: usize, range: Range<usize>, space: &Bounds, found: &mut Vec<u32>) {
        if !self.parts[part].meets(space) {
            return;
        }
        if range.len() == 1 {
            found.push(self.order[range.start]);
            return;
        }
        let middle = range.start + range.len() / 2;
        self.find_in(2 * part + 1, range.start..middle, space, found);
        self.find_in(2 * part + 2, middle..range.end, space, found);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn solid() -> impl Strategy<Value = Obstacle> {
        let place = || prop::array::uniform3(-20f32..20.0).prop_map(Vec3::from);
        prop_oneof![
            (place(), 0f32..3.0).prop_map(|(center, radius)| Obstacle::Sphere { center, radius }),
            (place(), place(), 0f32..3.0).prop_map(|(base, top, radius)| Obstacle::Cylinder {
                base,
                top,
                radius
            }),
            (place(), place())
                .prop_map(|(low, size)| Obstacle::Box { low, high: low + size.abs() }),
            place().prop_map(|point| Obstacle::Plane { point, normal: Vec3::Y }),
        ]
    }

    proptest! {
        #[test]
        fn whatever_is_near_is_found_in_its_order(
            solids in prop::collection::vec(solid(), 0..60),
            place in prop::array::uniform3(-25f32..25.0).prop_map(Vec3::from),
            reach in 0f32..8.0,
        ) {
            let mut known = Solids::from(solids);
            for _ in 0..2 {
                let found: Vec<_> = known.within(place - reach, place + reach).collect();
                let mut rest = found.iter();
                for solid in known.iter().filter(|one| one.distance(place) <= reach) {
                    prop_assert!(rest.any(|one| std::ptr::eq(*one, solid)), "{:?}", solid);
                }
                known.edit().push(Obstacle::Sphere { center: place, radius: 0.1 });
            }
        }
    }

    #[test]
    fn solids_far_away_are_not_visited() {
        let at = |x: u16| Obstacle::Sphere { center: Vec3::X * f32::from(x), radius: 0.4 };
        let row = Solids::from((0..1000).map(at).collect::<Vec<_>>());
        let found: Vec<_> = row.within(Vec3::splat(6.7), Vec3::splat(7.2)).collect();
        assert_eq!(found, Vec::<&Obstacle>::new(), "above it");
        let found: Vec<_> =
            row.within(Vec3::new(6.7, -1.0, 0.0), Vec3::new(7.2, 1.0, 0.1)).collect();
        assert_eq!(found, [&row[7]]);
    }

    #[test]
    fn senseless_solids_and_places_do_no_harm() {
        let odd = [f32::NAN, f32::INFINITY];
        let odd = odd.map(|one| Obstacle::Sphere { center: Vec3::splat(one), radius: one });
        let solids = Solids::from(odd.to_vec());
        assert_eq!(solids.within(Vec3::ZERO, Vec3::ONE).count(), 2);
        let ball = Solids::from(vec![Obstacle::Sphere { center: Vec3::ZERO, radius: 1.0 }]);
        assert_eq!(ball.within(Vec3::NAN, Vec3::NAN).count(), 0);
    }
}
