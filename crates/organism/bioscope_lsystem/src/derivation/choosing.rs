//! Which production is applied to a module.

use super::{Choice, Passed, pass::Pass};
use crate::{context::Place, machine::is_true, model::Production};

/// A production that may be applied.
pub(super) struct Candidate {
    pub number: u32,
    pub weight: f64,
    /// Where its parameters begin among those that are kept.
    pub bound: usize,
}

impl Pass<'_, '_> {
    /// The production to apply among those of these numbers, its parameters bound.
    pub(super) fn choose(&mut self, numbers: &[u32]) -> Passed<Option<u32>> {
        let set = self.layer.set;
        if let &[number] = numbers
            && set.productions[number as usize].is_simple
            && self.task.choice != Choice::Reference
        {
            return self.simple(number);
        }
        self.candidates.clear();
        self.bound.clear();
        let mut is_bound = false;
        for &number in numbers {
            let production = &set.productions[number as usize];
            if !is_bound
                && !self.matcher.follows(&production.strict, self.place, self.machine.slots())
            {
                continue;
            }
            is_bound = production.keeps_parameters;
            let after = self.after(production);
            if !self.holds(production, number, self.place, after)? {
                continue;
            }
            if self.task.choice == Choice::First {
                return Ok(Some(number));
            }
            let Some(weight) = self.weight(production)? else { return Ok(Some(number)) };
            let bound = self.bound.len();
            self.bound.extend_from_slice(&self.machine.slots()[..production.slots]);
            self.candidates.push(Candidate { number, weight, bound });
        }
        let chosen = match self.task.choice {
            Choice::Reference => self.draw_as_reference(),
            _ if self.candidates.is_empty() => None,
            _ => self.draw(),
        };
        let Some(Candidate { number, bound, .. }) = chosen else { return Ok(None) };
        let slots = set.productions[number as usize].slots;
        self.machine.slots()[..slots].copy_from_slice(&self.bound[bound..bound + slots]);
        Ok(Some(number))
    }

    /// A production without context and chance that alone can replace the present module.
    #[inline]
    fn simple(&mut self, number: u32) -> Passed<Option<u32>> {
        let production = &self.layer.set.productions[number as usize];
        let first = self.place.parameter;
        let values =
            &self.task.string.parameters[first..first + production.strict[0].arity as usize];
        for (slot, &value) in self.machine.slots().iter_mut().zip(values) {
            *slot = f64::from(value);
        }
        Ok(self.passes(production)?.then_some(number))
    }

    /// Weight of a production that applies; none if it is taken without a draw.
    fn weight(&mut self, production: &Production) -> Passed<Option<f64>> {
        let is_first = self.candidates.is_empty();
        match (&production.probability, self.task.choice) {
            (None, Choice::FirstOrWeighted) if is_first => Ok(None),
            (None, _) => Ok(Some(1.0)),
            (Some(program), choice) => {
                let weight = self.machine.run(program, &mut Vec::new());
                self.examine(production)?;
                // The reference program takes negative weights as they are.
                Ok(Some(if choice == Choice::Reference { weight } else { weight.max(0.0) }))
            }
        }
    }

    /// Draws one of the candidates; none if their weights are all zero.
    fn draw(&mut self) -> Option<Candidate> {
        let total: f64 = self.candidates.iter().map(|candidate| candidate.weight).sum();
        if total.is_nan() || total <= 0.0 {
            return None;
        }
        let draw = self.machine.random.choice(self.place.module, self.task.tick);
        let mut rest = draw * total;
        let mut last = None;
        for candidate in self.candidates.drain(..) {
            if candidate.weight > 0.0 {
                let weight = candidate.weight;
                last = Some(candidate);
                if rest < weight {
                    break;
                }
                rest -= weight;
            }
        }
        last
    }

    /// Draws as the reference program does: with its precision, and one number also for modules
    /// to which nothing applies.
    fn draw_as_reference(&mut self) -> Option<Candidate> {
        let mut total = 0.0_f32;
        for candidate in &self.candidates {
            total += candidate.weight as f32;
        }
        let draw = self.machine.random.choice(self.place.module, self.task.tick);
        let mut rest = (f64::from(total) * draw) as f32;
        for candidate in self.candidates.drain(..) {
            rest -= candidate.weight as f32;
            if rest <= 0.0 {
                return Some(candidate);
            }
        }
        None
    }

    /// Whether the contexts and the condition of a production hold whose predecessor is bound;
    /// the left context ends before `before`, the right one begins at `after`.
    #[inline]
    pub fn holds(
        &mut self,
        production: &Production,
        number: u32,
        before: Place,
        after: Place,
    ) -> Passed<bool> {
        if !production.left.is_empty()
            && !self.matcher.precedes(&production.left, before, self.machine.slots())
        {
            return Ok(false);
        }
        if !production.right.is_empty()
            && !self.matcher.succeeds(&production.right, after, self.machine.slots())
        {
            return Ok(false);
        }
        if production.is_random {
            self.machine.random.begin(self.place.module, self.task.tick, number);
        }
        self.passes(production)
    }

    /// Whether the condition of a production holds whose parameters are bound.
    #[inline]
    fn passes(&mut self, production: &Production) -> Passed<bool> {
        if production.test.is_empty() {
            return Ok(true);
        }
        self.matcher.looked += production.cost;
        let value = self.machine.run(&production.test, &mut self.out.parameters);
        self.examine(production)?;
        Ok(is_true(value, self.machine.pool.rules))
    }
}
