//! Cuts: `%` in models of our own notation, `%(n)` in timed ones.

use crate::{Alphabet, ModuleString, context::Place};

/// The parameter of a timed cut that removes the whole branch.
const BRANCH: f32 = 100.0;

/// The string without what follows each `%` up to the end of its branch, and the numbers that its modules had.
pub(super) fn without_cut_branches(string: &ModuleString) -> (ModuleString, Vec<usize>) {
    let mut numbers = Vec::new();
    let mut kept = ModuleString::new(string.alphabet.clone());
    let mut parameter = 0;
    let mut depth_of_cut = None;
    let mut depth = 0_i64;
    for (number, &kind) in string.kinds.iter().enumerate() {
        let arity = string.alphabet.kinds()[kind as usize].arity as usize;
        depth += i64::from(kind == Alphabet::OPEN) - i64::from(kind == Alphabet::CLOSE);
        if depth_of_cut.is_some_and(|cut| depth < cut) {
            depth_of_cut = None;
        }
        let is_cut = matches!(kind, Alphabet::CUT | Alphabet::REPORTED_CUT);
        if is_cut && depth_of_cut.is_none() {
            depth_of_cut = Some(depth);
        }
        if depth_of_cut.is_none() {
            kept.kinds.push(kind);
            numbers.push(number);
            kept.parameters.extend_from_slice(&string.parameters[parameter..parameter + arity]);
        }
        parameter += arity;
    }
    (kept, numbers)
}

/// Obeys `%(n)` that replaced a module of a timed model; where the old string goes on.
///
/// With 100 (or −100) the branch that the module was in goes, with its brackets: what of it has been
/// made, and what is to come. With −n the next n modules after it go, a branch counting as one,
/// but none beyond the end of its own branch. H. Noser, EPFL thesis 1609 (1997), `]` in appendix C.
pub(super) fn cut(
    made: &mut ModuleString,
    ids: &mut Vec<u64>,
    old: &ModuleString,
    after: Place,
    amount: f32,
) -> Place {
    if amount.abs() == BRANCH {
        let Some(start) = open_branch(made) else { return after };
        let parameters: usize = made.kinds[start..].iter().map(|&kind| arity(made, kind)).sum();
        made.kinds.truncate(start);
        ids.truncate(start);
        made.parameters.truncate(made.parameters.len() - parameters);
        return after_module(old, after_units(old, after, usize::MAX));
    }
    let units = if amount < 0.0 { -amount as usize } else { 0 };
    after_units(old, after, units)
}

/// Number of the bracket that opened the branch in which a string ends.
fn open_branch(string: &ModuleString) -> Option<usize> {
    let mut closed = 0;
    for (module, &kind) in string.kinds.iter().enumerate().rev() {
        match kind {
            Alphabet::OPEN if closed == 0 => return Some(module),
            Alphabet::OPEN => closed -= 1,
            Alphabet::CLOSE => closed += 1,
            _ => {}
        }
    }
    None
}

/// The place after so many modules and branches, or where the present branch ends.
fn after_units(string: &ModuleString, mut place: Place, units: usize) -> Place {
    let (mut depth, mut passed) = (0_usize, 0);
    while passed < units
        && let Some(&kind) = string.kinds.get(place.module)
    {
        match kind {
            Alphabet::CLOSE if depth == 0 => break,
            Alphabet::CLOSE => depth -= 1,
            Alphabet::OPEN => depth += 1,
            _ => {}
        }
        passed += usize::from(depth == 0);
        place = after_module(string, place);
    }
    place
}

fn after_module(string: &ModuleString, place: Place) -> Place {
    let Some(&kind) = string.kinds.get(place.module) else { return place };
    Place { module: place.module + 1, parameter: place.parameter + arity(string, kind) }
}

fn arity(string: &ModuleString, kind: u8) -> usize {
    string.alphabet.kinds()[kind as usize].arity as usize
}
