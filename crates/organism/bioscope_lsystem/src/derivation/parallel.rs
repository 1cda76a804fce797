//! A pass on one thread, or on several.

use rayon::prelude::*;

use super::{
    Choice, Passed,
    pass::{Made, Pass, Task, exceeded},
};
use crate::{
    context::Place,
    machine::{Machine, Oddities},
};

/// How many modules one thread treats at a time.
const CHUNK: usize = 1 << 15;

/// How many chunks are treated before they are put together; bounds the memory beside the string.
const WINDOW: usize = 32;

/// Memory that one step leaves to the next.
#[derive(Default)]
pub(super) struct Space {
    /// For the whole string.
    pub whole: Made,
    /// For chunks that are being treated, and for those that are put together meanwhile.
    parts: [Vec<Made>; 2],
}

/// Treats a whole string; what it becomes, and how many operations were used so far.
pub(super) fn rewrite(
    task: Task,
    machine: &mut Machine,
    looked: u64,
    threads: bool,
    space: &mut Space,
) -> Passed<(Made, u64)> {
    if threads && !task.traced && task.string.kinds.len() >= 2 * CHUNK && may_split(&task, machine)
    {
        return on_threads(task, machine, looked, space);
    }
    one_after_the_other(task, machine, looked, std::mem::take(&mut space.whole))
}

/// Whether the parts of a string can be treated independently of each other.
fn may_split(task: &Task, machine: &Machine) -> bool {
    let [layer] = task.layers else { return false };
    let in_order = task.choice == Choice::Reference || machine.random.is_reference();
    let splits = |set: &crate::model::ProductionSet| {
        !set.has_effects && set.longest <= 1 && !(in_order && set.is_random)
    };
    let is_cut = |kind: &u8| matches!(*kind, crate::Alphabet::CUT | crate::Alphabet::REPORTED_CUT);
    task.choice != Choice::Reference
        && splits(layer.set)
        && layer.decomposition.is_none_or(splits)
        && rayon::current_num_threads() > 1
        && !task.string.kinds.iter().any(is_cut)
}

/// Treats a whole string from left to right; what it becomes is written into `out`.
pub(super) fn one_after_the_other(
    task: Task,
    machine: &mut Machine,
    looked: u64,
    out: Made,
) -> Passed<(Made, u64)> {
    let string = task.string;
    let mut pass = Pass::new(task, machine, Place { module: 0, parameter: 0 }, looked, out);
    if task.layers[0].set.productions.iter().all(|one| one.successor.program.is_empty()) {
        pass.out.kinds.reserve_exact(grown(&task));
    } else {
        pass.out.kinds.reserve(string.kinds.len());
    }
    pass.out.parameters.reserve(string.parameters.len());
    pass.run(string.kinds.len())?;
    let looked = pass.matcher.looked;
    Ok((pass.out, looked))
}

/// How many modules the string has after this step at most, if nothing is decomposed; within the
/// limits.
fn grown(task: &Task) -> usize {
    let layer = task.layers[0];
    let mut lengths = [1_usize; 256];
    for production in &layer.set.productions {
        if let Some(first) = production.strict.first() {
            let length = &mut lengths[first.kind as usize];
            *length = (*length).max(production.successor.kinds.len());
        }
    }
    let total: usize = task.string.kinds.iter().map(|&kind| lengths[kind as usize]).sum();
    total.min(task.limits.modules.saturating_add(1)).min(task.limits.bytes)
}

/// While some chunks are treated, those before them are put together.
fn on_threads(
    task: Task,
    machine: &mut Machine,
    mut looked: u64,
    space: &mut Space,
) -> Passed<(Made, u64)> {
    let mut out = std::mem::take(&mut space.whole);
    out.clear();
    let [mut coming, mut ready] = std::mem::take(&mut space.parts);
    ready.clear();
    for starts in chunk_starts(&task).chunks(WINDOW) {
        coming.resize_with(starts.len(), Made::default);
        let (used, ()) = rayon::join(
            || rewrite_chunks(task, machine, starts, looked, &mut coming),
            || put_together(&mut out, &ready),
        );
        let (used, oddities) = used?;
        looked += used;
        machine.oddities.add(oddities);
        std::mem::swap(&mut coming, &mut ready);
        bound(&task, &out, looked)?;
    }
    put_together(&mut out, &ready);
    bound(&task, &out, looked)?;
    space.parts = [coming, ready];
    Ok((out, looked))
}

/// Treats the chunks that begin at `starts`; how many operations that took, and what was odd.
fn rewrite_chunks(
    task: Task,
    machine: &Machine,
    starts: &[Place],
    looked: u64,
    parts: &mut [Made],
) -> Passed<(u64, Oddities)> {
    let length = task.string.kinds.len();
    let used: Vec<(u64, Oddities)> = starts
        .par_iter()
        .zip(parts)
        .map_init(
            || machine.worker(),
            |machine, (&start, part)| {
                let out = std::mem::take(part);
                let mut pass = Pass::new(task, machine, start, looked, out);
                pass.run((start.module + CHUNK).min(length))?;
                let used = pass.matcher.looked - looked;
                *part = pass.out;
                Ok((used, std::mem::take(&mut machine.oddities)))
            },
        )
        .collect::<Passed<_>>()?;
    let mut oddities = Oddities::default();
    used.iter().for_each(|&(_, later)| oddities.add(later));
    Ok((used.iter().map(|&(used, _)| used).sum(), oddities))
}

/// Where each chunk begins.
fn chunk_starts(task: &Task) -> Vec<Place> {
    let counts: Vec<usize> = task
        .string
        .kinds
        .par_chunks(CHUNK)
        .map(|kinds| kinds.iter().map(|&kind| task.arities[kind as usize] as usize).sum())
        .collect();
    let mut place = Place { module: 0, parameter: 0 };
    let mut starts = Vec::with_capacity(counts.len());
    for count in counts {
        starts.push(place);
        place.module += CHUNK;
        place.parameter += count;
    }
    starts
}

/// Appends the parts, one after the other.
fn put_together(out: &mut Made, parts: &[Made]) {
    for part in parts {
        out.kinds.extend_from_slice(&part.kinds);
        out.parameters.extend_from_slice(&part.parameters);
        out.by_production.resize(part.by_production.len(), 0);
        for (sum, count) in out.by_production.iter_mut().zip(&part.by_production) {
            *sum += count;
        }
    }
}

/// An error if there is too much of something.
fn bound(task: &Task, made: &Made, looked: u64) -> Passed<()> {
    match task.limits.exceeded(made.kinds.len(), made.parameters.len(), looked) {
        Some(what) => Err(exceeded(task, &made.by_production, what)),
        None => Ok(()),
    }
}
