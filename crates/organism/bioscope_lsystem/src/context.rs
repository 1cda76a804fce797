//! What stands before and after a module, branches taken into account.
//!
//! Leftward, complete side branches are passed over and an opening bracket is climbed out of.
//! Rightward, side branches are passed over where the context does not name a bracket; a
//! bracket in the context must be there. `ignore:` and `consider:` say what else is passed over.

use crate::{Alphabet, ModuleString, expression::Bindings, model::Pattern};

/// A module's place in a string.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Its number.
    pub module: usize,
    /// Number of its first parameter.
    pub parameter: usize,
}

/// Looks for contexts in one string.
pub(crate) struct Matcher<'a> {
    pub string: &'a ModuleString,
    pub skipped: &'a [bool],
    /// Number of parameters of each kind.
    pub arities: &'a [u8],
    /// Modules looked at, for the bound on the work of a derivation.
    pub looked: u64,
}

impl Matcher<'_> {
    /// Whether these patterns stand directly one after the other from `place` on; binds them.
    pub fn follows(&self, patterns: &[Pattern], place: Place, bindings: &mut Bindings) -> bool {
        let Place { module, mut parameter } = place;
        let Some(kinds) = self.string.kinds.get(module..module + patterns.len()) else {
            return false;
        };
        if kinds.iter().zip(patterns).any(|(&kind, pattern)| kind != pattern.kind) {
            return false;
        }
        for pattern in patterns {
            self.bind(pattern, parameter, bindings);
            parameter += pattern.arity as usize;
        }
        true
    }

    /// Whether these patterns precede `place` on its way to the root; binds them.
    pub fn precedes(
        &mut self,
        patterns: &[Pattern],
        place: Place,
        bindings: &mut Bindings,
    ) -> bool {
        let Place { mut module, mut parameter } = place;
        for pattern in patterns.iter().rev() {
            loop {
                if module == 0 {
                    return false;
                }
                module -= 1;
                self.looked += 1;
                let kind = self.string.kinds[module];
                parameter -= self.arities[kind as usize] as usize;
                if kind == Alphabet::CLOSE {
                    (module, parameter) = self.group_start(module, parameter);
                } else if kind == pattern.kind {
                    self.bind(pattern, parameter, bindings);
                    break;
                } else if kind != Alphabet::OPEN && !self.skipped[kind as usize] {
                    return false;
                }
            }
        }
        true
    }

    /// Whether these patterns succeed the module that ends before `place`; binds them.
    pub fn succeeds(
        &mut self,
        patterns: &[Pattern],
        place: Place,
        bindings: &mut Bindings,
    ) -> bool {
        let mut place = place;
        for pattern in patterns {
            let found = match pattern.kind {
                Alphabet::CLOSE => Some(self.after_group(place)),
                _ => self.next(pattern, place),
            };
            let Some(found) = found else { return false };
            place = found;
            if pattern.kind > Alphabet::CLOSE {
                self.bind(pattern, found.parameter, bindings);
                place.module += 1;
                place.parameter += pattern.arity as usize;
            } else if pattern.kind == Alphabet::OPEN {
                place.module += 1;
            }
        }
        true
    }

    /// The next module on the axis from `place` on, if it matches.
    fn next(&mut self, pattern: &Pattern, mut place: Place) -> Option<Place> {
        loop {
            let &kind = self.string.kinds.get(place.module)?;
            self.looked += 1;
            if kind == pattern.kind {
                return Some(place);
            }
            if kind == Alphabet::OPEN && pattern.kind != Alphabet::OPEN {
                place.module += 1;
                place = self.after_group(place);
            } else if kind > Alphabet::CLOSE && self.skipped[kind as usize] {
                place.module += 1;
                place.parameter += self.arities[kind as usize] as usize;
            } else {
                return None;
            }
        }
    }

    /// The place after the bracket that closes the group that `place` is in.
    fn after_group(&mut self, mut place: Place) -> Place {
        let mut depth = 1;
        while depth > 0 && place.module < self.string.kinds.len() {
            self.looked += 1;
            let kind = self.string.kinds[place.module];
            depth += i32::from(kind == Alphabet::OPEN) - i32::from(kind == Alphabet::CLOSE);
            place.module += 1;
            place.parameter += self.arities[kind as usize] as usize;
        }
        place
    }

    /// The bracket that opens the group whose closing bracket is `module`.
    fn group_start(&mut self, mut module: usize, mut parameter: usize) -> (usize, usize) {
        let mut depth = 1;
        while depth > 0 && module > 0 {
            module -= 1;
            self.looked += 1;
            let kind = self.string.kinds[module];
            depth += i32::from(kind == Alphabet::CLOSE) - i32::from(kind == Alphabet::OPEN);
            parameter -= self.arities[kind as usize] as usize;
        }
        (module, parameter)
    }

    fn bind(&self, pattern: &Pattern, parameter: usize, bindings: &mut Bindings) {
        let slot = pattern.slot as usize;
        let arity = pattern.arity as usize;
        let values = &self.string.parameters[parameter..parameter + arity];
        for (slot, &value) in bindings.slots[slot..slot + arity].iter_mut().zip(values) {
            *slot = f64::from(value);
        }
    }
}
