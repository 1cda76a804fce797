use bioscope_dynamics::spring_body::{Body, Lanes, Real};
use rayon::prelude::*;

use super::Swimmers;
use super::individual::{Desk, Group};

/// Fishes side by side in one computation.
const LANES: usize = <Lanes as Real>::LANES;

impl Swimmers<Lanes> {
    /// Advances fishes that are kept one by one, each exactly as [`advance`](Self::advance) would, but neighbors of one
    /// kind side by side and all in parallel.
    pub fn advance_together(fishes: &mut [&mut Self], dt: f64) {
        fishes.par_chunks_mut(LANES).for_each(|some| advance_some(some, dt));
    }

    /// Whether the two can be computed side by side.
    fn is_like(&self, other: &Self) -> bool {
        std::sync::Arc::ptr_eq(&self.model, &other.model)
            && self.time_unit == other.time_unit
            && self.len() == 1
            && other.len() == 1
    }
}

fn advance_some(fishes: &mut [&mut Swimmers<Lanes>], dt: f64) {
    let Some((first, others)) = fishes.split_first() else { return };
    if others.is_empty() || !others.iter().all(|other| first.is_like(other)) {
        fishes.iter_mut().for_each(|fish| fish.advance(dt));
        return;
    }
    let model = first.model.clone();
    let (steps, step) = first.steps(dt);
    let mut group: Group<Lanes> = Group::new(&model);
    for (lane, fish) in fishes.iter_mut().enumerate() {
        let alone = &mut fish.groups[0];
        copy((&mut group.body, lane), (&alone.body, 0));
        group.members.append(&mut alone.members);
    }
    group.advance(&model, steps, step, &mut Desk::new(&model));
    for (lane, (fish, member)) in fishes.iter_mut().zip(group.members).enumerate() {
        let alone = &mut fish.groups[0];
        copy((&mut alone.body, 0), (&group.body, lane));
        alone.members.push(member);
    }
}

/// Copies one body of several.
fn copy(to: (&mut Body<Lanes>, usize), from: (&Body<Lanes>, usize)) {
    let ((mine, lane), (theirs, other)) = (to, from);
    let places = mine.position.iter_mut().zip(&theirs.position);
    for (mine, theirs) in places.chain(mine.velocity.iter_mut().zip(&theirs.velocity)) {
        for (mine, theirs) in mine.iter_mut().zip(theirs) {
            mine.set_lane(lane, theirs.lane(other));
        }
    }
    for (mine, theirs) in mine.contraction.iter_mut().zip(&theirs.contraction) {
        mine.set_lane(lane, theirs.lane(other));
    }
}
