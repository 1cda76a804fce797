//! A pass on one thread, or on several.

use rayon::prelude::*;

use super::{
    Choice, Passed,
    pass::{Made, Pass, Task, exceeded},
};
use crate::{context::Place, machine::Machine};

/// How many modules one thread treats at a time.
const CHUNK: usize = 1 << 15;

/// Treats a whole string; what it becomes, and how many operations were used so far.
pub(super) fn rewrite(
    task: Task,
    machine: &mut Machine,
    looked: u64,
    threads: bool,
) -> Passed<(Made, u64)> {
    if threads && task.string.kinds.len() >= 2 * CHUNK && may_split(&task, machine) {
        return on_threads(task, machine, looked);
    }
    one_after_the_other(task, machine, looked)
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

/// Treats a whole string from left to right.
pub(super) fn one_after_the_other(
    task: Task,
    machine: &mut Machine,
    looked: u64,
) -> Passed<(Made, u64)> {
    let string = task.string;
    let mut pass = Pass::new(task, machine, Place { module: 0, parameter: 0 }, looked);
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

fn on_threads(task: Task, machine: &Machine, looked: u64) -> Passed<(Made, u64)> {
    let starts = chunk_starts(&task);
    let length = task.string.kinds.len();
    let parts: Vec<(Made, u64)> = starts
        .par_iter()
        .map_init(
            || machine.worker(),
            |machine, &start| {
                let mut pass = Pass::new(task, machine, start, looked);
                pass.run((start.module + CHUNK).min(length))?;
                let used = pass.matcher.looked - looked;
                Ok((pass.out, used))
            },
        )
        .collect::<Passed<_>>()?;
    let looked = looked + parts.iter().map(|(_, used)| used).sum::<u64>();
    let made = joined(&task, parts)?;
    if looked > task.limits.operations {
        let what = format!("more than {} operations", task.limits.operations);
        return Err(exceeded(&task, &made.by_production, what));
    }
    Ok((made, looked))
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

/// The parts, one after the other.
fn joined(task: &Task, parts: Vec<(Made, u64)>) -> Passed<Made> {
    let mut made = Made::default();
    let (mut modules, mut parameters) = (0, 0);
    for (part, _) in &parts {
        modules += part.kinds.len();
        parameters += part.parameters.len();
        made.by_production.resize(part.by_production.len(), 0);
        for (sum, count) in made.by_production.iter_mut().zip(&part.by_production) {
            *sum += count;
        }
    }
    let bytes = modules + size_of::<f32>() * parameters;
    if modules > task.limits.modules {
        let what = format!("more than {} modules", task.limits.modules);
        return Err(exceeded(task, &made.by_production, what));
    }
    if bytes > task.limits.bytes {
        let what = format!("more than {} bytes of modules and parameters", task.limits.bytes);
        return Err(exceeded(task, &made.by_production, what));
    }
    made.kinds = vec![0; modules];
    made.parameters = vec![0.0; parameters];
    let mut places = Vec::with_capacity(parts.len());
    let (mut kinds, mut values) = (&mut made.kinds[..], &mut made.parameters[..]);
    for (part, _) in parts {
        let (kinds_here, values_here);
        (kinds_here, kinds) = kinds.split_at_mut(part.kinds.len());
        (values_here, values) = values.split_at_mut(part.parameters.len());
        places.push((part, kinds_here, values_here));
    }
    places.into_par_iter().for_each(|(part, kinds, values)| {
        kinds.copy_from_slice(&part.kinds);
        values.copy_from_slice(&part.parameters);
    });
    Ok(made)
}
