use std::cell::Cell;
use std::sync::Arc;

use bioscope_core::Quat;
use bioscope_dynamics::spring_body::{Body, Lanes, Real};
use rayon::prelude::*;

use super::individual::{Desk, Group};
use super::{FishModel, Swimmers};

/// Fishes side by side in one computation.
const LANES: usize = <Lanes as Real>::LANES;

/// Fishes up to which a second thread is not worth waking (measured: it costs as much as eight of them).
const FEW: usize = 2 * LANES;

impl Swimmers<f32> {
    /// Advances fishes that are kept one by one, each exactly as [`advance`](Self::advance) would, but neighbors of one
    /// kind side by side, and many in parallel.
    pub fn advance_together(fishes: &mut [&mut Self], dt: f64) {
        if fishes.len() <= FEW {
            fishes.chunks_mut(LANES).for_each(|some| advance_some(some, dt));
        } else {
            fishes.par_chunks_mut(LANES).for_each(|some| advance_some(some, dt));
        }
    }

    /// Whether the two can be computed side by side.
    fn is_like(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.model, &other.model)
            && self.time_unit == other.time_unit
            && self.len() == 1
            && other.len() == 1
    }
}

/// Where a thread computes fishes of a model side by side, used again for the next ones.
struct Bench {
    model: Arc<FishModel>,
    group: Group<Lanes>,
    desk: Desk<Lanes>,
}

thread_local! {
    static BENCH: Cell<Option<Bench>> = const { Cell::new(None) };
}

impl Bench {
    fn of(model: &Arc<FishModel>) -> Self {
        Self { model: Arc::clone(model), group: Group::new(model), desk: Desk::new(model) }
    }

    /// The bench of this thread for `count` fishes of this model; lanes without a fish rest in still water.
    fn take(model: &Arc<FishModel>, count: usize) -> Self {
        let known = BENCH.take().filter(|one| Arc::ptr_eq(&one.model, model));
        let Some(mut bench) = known else { return Self::of(model) };
        if count < LANES {
            (count..LANES).for_each(|lane| bench.group.put(model, lane, Quat::IDENTITY));
            bench.desk.still();
        }
        bench
    }
}

fn advance_some(fishes: &mut [&mut Swimmers<f32>], dt: f64) {
    let Some((first, others)) = fishes.split_first() else { return };
    if others.is_empty() || !others.iter().all(|other| first.is_like(other)) {
        fishes.iter_mut().for_each(|fish| fish.advance(dt));
        return;
    }
    let (steps, step) = first.steps(dt);
    let mut bench = Bench::take(&first.model, fishes.len());
    let Bench { model, group, desk } = &mut bench;
    for (lane, fish) in fishes.iter_mut().enumerate() {
        let alone = &mut fish.groups[0];
        for_each_number((&mut group.body, &mut alone.body), |lanes, number| {
            lanes.0[lane] = *number
        });
        group.members.append(&mut alone.members);
    }
    group.advance(model, steps, step, desk);
    for (lane, (fish, member)) in fishes.iter_mut().zip(group.members.drain(..)).enumerate() {
        let alone = &mut fish.groups[0];
        for_each_number((&mut group.body, &mut alone.body), |lanes, number| {
            *number = lanes.0[lane]
        });
        alone.members.push(member);
    }
    BENCH.set(Some(bench));
}

/// Calls `visit` with each number of several bodies and the like one of a single body.
fn for_each_number(
    (several, one): (&mut Body<Lanes>, &mut Body<f32>),
    mut visit: impl FnMut(&mut Lanes, &mut f32),
) {
    let places = several.position.iter_mut().zip(&mut one.position);
    let nodes = places.chain(several.velocity.iter_mut().zip(&mut one.velocity));
    nodes.flat_map(|(several, one)| several.iter_mut().zip(one)).for_each(|(a, b)| visit(a, b));
    several.contraction.iter_mut().zip(&mut one.contraction).for_each(|(a, b)| visit(a, b));
}
