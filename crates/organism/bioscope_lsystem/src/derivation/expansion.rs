//! Decomposition and homomorphism: a set of productions applied to its own results, depth first.
//!
//! Contexts are looked for in the string that is being rewritten, around the module from which
//! everything stems.

use super::{Choice, DerivationError, Passed, pass::Pass};
use crate::{
    context::Place,
    model::{Action, Production, ProductionSet},
};

/// How deeply results may be nested in one another.
const DEPTH_LIMIT: usize = 100_000;

/// Modules that are still to be treated.
struct Level<'a> {
    kinds: &'a [u8],
    parameters: Vec<f32>,
    module: usize,
    parameter: usize,
}

impl<'a> Pass<'a, '_> {
    /// Appends what these modules become; their contexts end and begin at the two places.
    pub(super) fn expand(
        &mut self,
        set: &'a ProductionSet,
        kinds: &'a [u8],
        parameters: Vec<f32>,
        around: (Place, Place),
    ) -> Passed<()> {
        let level = Level { kinds, parameters, module: 0, parameter: 0 };
        self.expand_levels(set, vec![level], 0, around)
    }

    /// Applies a production of the set to the present module, and goes on with what it makes;
    /// false if none applies.
    pub(super) fn expand_here(&mut self, set: &'a ProductionSet) -> Passed<bool> {
        if set.maximum_depth == 0 {
            return Ok(false);
        }
        let string = self.task.string;
        let place = self.place;
        let kinds = &string.kinds[place.module..];
        let parameters = &string.parameters[place.parameter..];
        if matches!(set.actions[kinds[0] as usize], Action::Keep) {
            return Ok(false);
        }
        let after = Place {
            module: place.module + 1,
            parameter: place.parameter + self.task.arities[kinds[0] as usize] as usize,
        };
        let found = self.production_for(set, kinds, parameters, (place, after))?;
        let Some(number) = found else { return Ok(false) };
        let production = &set.productions[number as usize];
        self.machine.random.swap_homomorphism();
        let level = self.result(set, number)?;
        let expanded = self.expand_levels(set, vec![level], 1, (place, after));
        self.machine.random.swap_homomorphism();
        expanded?;
        let arity: usize = production.strict.iter().map(|pattern| pattern.arity as usize).sum();
        self.place.module += production.strict.len();
        self.place.parameter += arity;
        Ok(true)
    }

    /// Treats the modules of the innermost level first; its results are the next level.
    fn expand_levels(
        &mut self,
        set: &'a ProductionSet,
        mut levels: Vec<Level<'a>>,
        outer: usize,
        around: (Place, Place),
    ) -> Passed<()> {
        while let Some(mut level) = levels.pop() {
            let Some(&kind) = level.kinds.get(level.module) else { continue };
            let depth = outer + levels.len();
            self.matcher.looked += 1;
            let arity = self.task.arities[kind as usize] as usize;
            let mut made = None;
            let (mut modules, mut parameters) = (1, arity);
            if !matches!(set.actions[kind as usize], Action::Keep)
                && depth < set.maximum_depth as usize
            {
                let kinds = &level.kinds[level.module..];
                let values = &level.parameters[level.parameter..];
                if let Some(number) = self.production_for(set, kinds, values, around)? {
                    let production = &set.productions[number as usize];
                    modules = production.strict.len();
                    parameters =
                        production.strict.iter().map(|pattern| pattern.arity as usize).sum();
                    made = Some(self.result(set, number)?);
                }
            }
            if made.is_none() {
                self.out.kinds.push(kind);
                let values = &level.parameters[level.parameter..level.parameter + arity];
                self.out.parameters.extend_from_slice(values);
                self.bound_size()?;
            }
            level.module += modules;
            level.parameter += parameters;
            levels.push(level);
            levels.extend(made);
            if levels.len() > DEPTH_LIMIT {
                return Err(self.too_deep(set));
            }
            if self.matcher.looked > self.task.limits.operations {
                self.check()?;
            }
        }
        Ok(())
    }

    /// The production of a set to apply to the first of these modules, its parameters bound.
    fn production_for(
        &mut self,
        set: &'a ProductionSet,
        kinds: &[u8],
        parameters: &[f32],
        around: (Place, Place),
    ) -> Passed<Option<u32>> {
        let single;
        let numbers: &[u32] = match &set.actions[kinds[0] as usize] {
            Action::Keep => return Ok(None),
            Action::Replace(number) => {
                single = [*number];
                &single
            }
            Action::Try(numbers) => numbers,
        };
        let mut found: Vec<(u32, f64)> = Vec::new();
        self.expansions = self.expansions.wrapping_add(1);
        let own = self.expansions.wrapping_mul(0x9E37_79B1);
        for &number in numbers {
            let production = &set.productions[number as usize];
            self.matcher.looked += production.cost;
            if !self.binds(production, kinds, parameters)
                || !self.holds(production, own ^ number, around.0, around.1)?
            {
                continue;
            }
            let weight = match &production.probability {
                Some(program) if self.is_weighted() => {
                    let weight = self.machine.run(program, &mut Vec::new());
                    self.examine(production)?;
                    weight.max(0.0)
                }
                // The reference program has no chance in a decomposition: the first is taken.
                _ if found.is_empty() => return Ok(Some(number)),
                _ => 1.0,
            };
            found.push((number, weight));
        }
        let Some(number) = self.drawn(&found) else { return Ok(None) };
        // Bind its parameters again: those of later candidates are in their place.
        let production = &set.productions[number as usize];
        self.binds(production, kinds, parameters);
        self.holds(production, own ^ number, around.0, around.1)?;
        Ok(Some(number))
    }

    fn is_weighted(&self) -> bool {
        matches!(self.task.choice, Choice::FirstOrWeighted | Choice::Weighted)
    }

    fn drawn(&mut self, found: &[(u32, f64)]) -> Option<u32> {
        let total: f64 = found.iter().map(|(_, weight)| weight).sum();
        let mut rest = self.machine.random.uniform_or_zero(!found.is_empty()) * total;
        let mut last = None;
        for &(number, weight) in found.iter().filter(|(_, weight)| *weight > 0.0) {
            last = Some(number);
            if rest < weight {
                break;
            }
            rest -= weight;
        }
        last
    }

    /// Whether these modules begin with the predecessor of a production; binds its parameters.
    fn binds(&mut self, production: &Production, kinds: &[u8], parameters: &[f32]) -> bool {
        let strict = &production.strict;
        if kinds.len() < strict.len()
            || kinds.iter().zip(strict).any(|(&kind, pattern)| kind != pattern.kind)
        {
            return false;
        }
        let count: usize = strict.iter().map(|pattern| pattern.arity as usize).sum();
        // The parameters of the strict predecessor have the first slots.
        for (slot, &value) in self.machine.slots()[..count].iter_mut().zip(parameters) {
            *slot = f64::from(value);
        }
        true
    }

    /// What a production makes whose parameters are bound.
    fn result(&mut self, set: &'a ProductionSet, number: u32) -> Passed<Level<'a>> {
        let production = &set.productions[number as usize];
        let successor = &production.successor;
        let mut parameters = Vec::new();
        self.machine.run(&successor.program, &mut parameters);
        self.examine(production)?;
        let index = self.layer.set.productions.len() + number as usize;
        if let Some(count) = self.out.by_production.get_mut(index) {
            *count += successor.kinds.len() as u64;
        }
        Ok(Level { kinds: &successor.kinds, parameters, module: 0, parameter: 0 })
    }

    #[cold]
    fn too_deep(&self, set: &ProductionSet) -> Box<DerivationError> {
        let production = &set.productions[0];
        Box::new(DerivationError::Limit {
            place: production.place.clone(),
            what: format!("results nested more than {DEPTH_LIMIT} deep"),
            step: self.task.step,
            production: production.text.clone(),
        })
    }
}
