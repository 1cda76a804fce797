//! What stands before and after a module, branches taken into account.
//!
//! Leftward, complete side branches are passed over and an opening bracket is climbed out of.
//! Rightward there are three ways, see [`RightContext`]. `ignore:` and `consider:` say what else
//! is passed over.

use std::sync::OnceLock;

use crate::{
    Alphabet, ModuleString,
    model::{Pattern, RightContext},
};

/// A module's place in a string.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Its number.
    pub module: usize,
    /// Number of its first parameter.
    pub parameter: usize,
}

/// How deeply a search for a right context may go into branches of branches.
const DEPTH_LIMIT: usize = 1000;

/// How far the other bracket of a group is looked for before all groups are tabulated.
const NEAR: usize = 8;

/// The brackets of a string, tabulated as soon as a search passes a long group.
#[derive(Default)]
pub(crate) struct Groups {
    table: OnceLock<Table>,
}

/// By module: the number of the group that a bracket opens or closes.
struct Table {
    group: Vec<u32>,
    /// Places of the brackets that open and close each group.
    ends: Vec<(Place, Place)>,
}

impl Table {
    fn new(string: &ModuleString, arities: &[u8; 256]) -> Self {
        let mut group = vec![0; string.kinds.len()];
        let (mut ends, mut open): (Vec<(Place, Place)>, Vec<u32>) = (Vec::new(), Vec::new());
        let first = Place { module: 0, parameter: 0 };
        let mut place = first;
        for &kind in &string.kinds {
            if kind == Alphabet::OPEN {
                group[place.module] = ends.len() as u32;
                open.push(ends.len() as u32);
                ends.push((place, place));
            } else if kind == Alphabet::CLOSE {
                let number = open.pop().unwrap_or_else(|| {
                    ends.push((first, place));
                    ends.len() as u32 - 1
                });
                group[place.module] = number;
                ends[number as usize].1 = place;
            }
            place.module += 1;
            place.parameter += arities[kind as usize] as usize;
        }
        for number in open {
            ends[number as usize].1 = place;
        }
        Self { group, ends }
    }
}

/// Looks for contexts in one string.
pub(crate) struct Matcher<'a> {
    pub string: &'a ModuleString,
    pub skipped: &'a [bool; 256],
    /// Number of parameters of each kind.
    pub arities: &'a [u8; 256],
    pub groups: &'a Groups,
    pub right_context: RightContext,
    pub is_ring: bool,
    /// How many searches within searches are going on.
    pub depth: usize,
    /// Modules looked at, for the bound on the work of a derivation.
    pub looked: u64,
    /// What `looked` must not exceed: no context matches then.
    pub limit: u64,
}

impl Matcher<'_> {
    /// Whether these patterns stand directly one after the other from `place` on; binds them.
    #[inline]
    pub fn follows(&self, patterns: &[Pattern], place: Place, slots: &mut [f64]) -> bool {
        let Place { module, mut parameter } = place;
        let Some(kinds) = self.string.kinds.get(module..module + patterns.len()) else {
            return false;
        };
        if kinds.iter().zip(patterns).any(|(&kind, pattern)| kind != pattern.kind) {
            return false;
        }
        for pattern in patterns {
            self.bind(pattern, parameter, slots);
            parameter += pattern.arity as usize;
        }
        true
    }

    /// Whether these patterns precede `place` on its way to the root; binds them.
    pub fn precedes(&mut self, patterns: &[Pattern], place: Place, slots: &mut [f64]) -> bool {
        let Place { mut module, mut parameter } = place;
        let mut turned = false;
        for pattern in patterns.iter().rev() {
            loop {
                if module == 0 {
                    if !self.is_ring || turned {
                        return false;
                    }
                    turned = true;
                    module = self.string.kinds.len();
                    parameter = self.string.parameters.len();
                    continue;
                }
                module -= 1;
                self.looked += 1;
                let kind = self.string.kinds[module];
                parameter -= self.arities[kind as usize] as usize;
                if kind == Alphabet::CLOSE {
                    Place { module, parameter } = self.group_start(Place { module, parameter });
                } else if kind == Alphabet::OPEN {
                    // Climbs out of the branch.
                } else if self.skipped[kind as usize] {
                    if self.looked > self.limit {
                        return false;
                    }
                } else if kind == pattern.kind {
                    self.bind(pattern, parameter, slots);
                    break;
                } else {
                    return false;
                }
            }
        }
        true
    }

    /// Whether these patterns succeed the module that ends before `place`; binds them.
    pub fn succeeds(&mut self, patterns: &[Pattern], place: Place, slots: &mut [f64]) -> bool {
        if patterns.is_empty() {
            return true;
        }
        match self.right_context {
            RightContext::Reference => self.succeeds_literally(patterns, place, slots),
            _ => self.succeeds_in_branches(patterns, place, slots),
        }
    }

    fn succeeds_literally(
        &mut self,
        patterns: &[Pattern],
        mut place: Place,
        slots: &mut [f64],
    ) -> bool {
        let mut turned = false;
        for pattern in patterns {
            if pattern.kind == Alphabet::REST {
                place = self.after_group(place);
                place.module = place.module.saturating_sub(1);
                continue;
            }
            loop {
                if self.is_ring && !turned && place.module == self.string.kinds.len() {
                    turned = true;
                    place = Place { module: 0, parameter: 0 };
                }
                let Some(&kind) = self.string.kinds.get(place.module) else { return false };
                self.looked += 1;
                if kind == Alphabet::REPORTED_CUT || self.looked > self.limit {
                    return false;
                }
                let after = self.after(place, kind);
                if self.skipped[kind as usize] {
                    place = after;
                } else if kind == Alphabet::OPEN && pattern.kind != Alphabet::OPEN {
                    place = self.group_end(place);
                } else if kind == pattern.kind {
                    self.bind(pattern, place.parameter, slots);
                    place = after;
                    break;
                } else {
                    return false;
                }
            }
        }
        true
    }

    fn succeeds_in_branches(
        &mut self,
        patterns: &[Pattern],
        place: Place,
        slots: &mut [f64],
    ) -> bool {
        let Some(pattern) = patterns.first() else { return true };
        if self.looked > self.limit || self.depth > DEPTH_LIMIT {
            return false;
        }
        self.depth += 1;
        let succeeds = if pattern.kind == Alphabet::OPEN {
            self.succeeds_in_group(patterns, place, slots)
        } else {
            self.succeeds_on_axis(patterns, place, slots)
        };
        self.depth -= 1;
        succeeds
    }

    /// The next module on the axis matches the first pattern, and what follows it the others.
    fn succeeds_on_axis(&mut self, patterns: &[Pattern], place: Place, slots: &mut [f64]) -> bool {
        let pattern = &patterns[0];
        let mut here = place;
        while let Some(&kind) = self.string.kinds.get(here.module) {
            self.looked += 1;
            let after = self.after(here, kind);
            if kind == Alphabet::OPEN {
                here = self.group_end(here);
            } else if kind == Alphabet::CLOSE {
                break;
            } else if kind == pattern.kind {
                self.bind(pattern, here.parameter, slots);
                if self.succeeds_in_branches(&patterns[1..], after, slots) {
                    return true;
                }
                break;
            } else if self.skipped[kind as usize] {
                here = after;
            } else {
                break;
            }
        }
        self.right_context == RightContext::Tree
            && self.succeeds_in_passed(patterns, place, here.module, slots)
    }

    /// One of the branches from `place` to module number `end` begins with what matches.
    fn succeeds_in_passed(
        &mut self,
        patterns: &[Pattern],
        mut place: Place,
        end: usize,
        slots: &mut [f64],
    ) -> bool {
        while place.module < end {
            let kind = self.string.kinds[place.module];
            self.looked += 1;
            let after = self.after(place, kind);
            if kind == Alphabet::OPEN {
                if self.succeeds_in_branches(patterns, after, slots) {
                    return true;
                }
                place = self.group_end(place);
            } else {
                place = after;
            }
        }
        false
    }

    /// `[v]w`: the beginning of one of the groups that stand here matches v, what follows it w.
    fn succeeds_in_group(
        &mut self,
        patterns: &[Pattern],
        mut place: Place,
        slots: &mut [f64],
    ) -> bool {
        let mut depth = 0;
        let close = patterns.iter().position(|pattern| {
            depth += i32::from(pattern.kind == Alphabet::OPEN)
                - i32::from(pattern.kind == Alphabet::CLOSE);
            depth == 0
        });
        let close = close.unwrap_or(patterns.len() - 1);
        let (inside, rest) = (&patterns[1..close], &patterns[close + 1..]);
        while let Some(&kind) = self.string.kinds.get(place.module) {
            self.looked += 1;
            let after = self.after(place, kind);
            if kind == Alphabet::OPEN {
                let end = self.group_end(place);
                if self.succeeds_in_branches(inside, after, slots)
                    && self.succeeds_in_branches(rest, end, slots)
                {
                    return true;
                }
                place = end;
            } else if kind != Alphabet::CLOSE && self.skipped[kind as usize] {
                place = after;
            } else {
                return false;
            }
        }
        false
    }

    #[inline]
    fn after(&self, place: Place, kind: u8) -> Place {
        Place {
            module: place.module + 1,
            parameter: place.parameter + self.arities[kind as usize] as usize,
        }
    }

    /// The place after the bracket that closes the group that `place` is in.
    fn after_group(&self, mut place: Place) -> Place {
        while let Some(&kind) = self.string.kinds.get(place.module) {
            match kind {
                Alphabet::OPEN => place = self.group_end(place),
                Alphabet::CLOSE => return self.after(place, kind),
                kind => place = self.after(place, kind),
            }
        }
        place
    }

    /// The place after the group whose opening bracket is at `open`.
    #[inline]
    fn group_end(&self, open: Place) -> Place {
        let kinds = &self.string.kinds[open.module..];
        let mut place = open;
        let mut depth = 0;
        for &kind in kinds.iter().take(NEAR) {
            depth += i32::from(kind == Alphabet::OPEN) - i32::from(kind == Alphabet::CLOSE);
            place = self.after(place, kind);
            if depth == 0 {
                return place;
            }
        }
        let table = self.table();
        let close = table.ends[table.group[open.module] as usize].1;
        let module = (close.module + 1).min(self.string.kinds.len());
        Place { module, parameter: close.parameter }
    }

    /// The place of the bracket that opens the group whose closing bracket is at `close`.
    #[inline]
    fn group_start(&self, close: Place) -> Place {
        let mut place = close;
        let mut depth = 1;
        for &kind in self.string.kinds[..close.module].iter().rev().take(NEAR) {
            depth += i32::from(kind == Alphabet::CLOSE) - i32::from(kind == Alphabet::OPEN);
            place.module -= 1;
            place.parameter -= self.arities[kind as usize] as usize;
            if depth == 0 {
                return place;
            }
        }
        let table = self.table();
        table.ends[table.group[close.module] as usize].0
    }

    fn table(&self) -> &Table {
        self.groups.table.get_or_init(|| Table::new(self.string, self.arities))
    }

    #[inline]
    fn bind(&self, pattern: &Pattern, parameter: usize, slots: &mut [f64]) {
        let slot = pattern.slot as usize;
        let arity = pattern.arity as usize;
        let values = &self.string.parameters[parameter..parameter + arity];
        for (slot, &value) in slots[slot..slot + arity].iter_mut().zip(values) {
            *slot = f64::from(value);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Near and far: the ends that are looked up are those that one counts.
        #[test]
        fn groups_end_where_one_counts(kinds in prop::collection::vec(0..4_u8, 0..200)) {
            let letters = [Alphabet::OPEN, Alphabet::CLOSE, b'a', b'b'];
            let mut string = ModuleString::new(Arc::new(Alphabet::default()));
            string.kinds = kinds.into_iter().map(|letter| letters[letter as usize]).collect();
            let mut arities = [0; 256];
            arities[b'b' as usize] = 2;
            let matcher = Matcher {
                string: &string,
                skipped: &[false; 256],
                arities: &arities,
                groups: &Groups::default(),
                right_context: RightContext::Tree,
                is_ring: false,
                depth: 0,
                looked: 0,
                limit: u64::MAX,
            };
            let mut open = Vec::new();
            let mut place = Place { module: 0, parameter: 0 };
            for &kind in &string.kinds {
                let after = matcher.after(place, kind);
                if kind == Alphabet::OPEN {
                    open.push(place);
                } else if kind == Alphabet::CLOSE && let Some(open) = open.pop() {
                    let (start, end) = (matcher.group_start(place), matcher.group_end(open));
                    prop_assert_eq!((start.module, start.parameter), (open.module, open.parameter));
                    prop_assert_eq!((end.module, end.parameter), (after.module, after.parameter));
                }
                place = after;
            }
            for open in open {
                prop_assert_eq!(matcher.group_end(open).module, string.kinds.len());
            }
        }
    }
}
