//! Timed modules: each has an age, which grows continuously.
//!
//! When a module is as old as its production says (`after`), it is replaced; what it was too old
//! passes to its successors, which may be replaced at once too. So one step over a long time
//! gives the same string as many short ones if nothing depends on context or on the whole: the
//! iterative engine S and the recursive engine D are one.
//!
//! Every module has an identity that it keeps for life: a hash of its parent's and of its place
//! among its siblings. Random choices depend on the identity alone, so that they do not change
//! with time or with the length of steps.
//!
//! Source: H. Noser, *A Behavioral Animation System Based on L-systems and Synthetic Sensors for
//! Actors*, EPFL thesis 1609 (1997), sections on timed L-systems.

use bioscope_core::{Purpose, Random};

use super::{Derivation, DerivationError, Derived, cuts::cut};
use crate::{
    Alphabet, ModuleString,
    context::{Groups, Matcher, Place},
    machine::{Machine, is_true},
    model::{Action, Production, ProductionSet, Timing},
};

const CHOICE: Purpose = Purpose::new("lsystem timed production");
/// How many times in one step a module and its successors may be replaced.
const REPLACEMENTS: u32 = 10_000;

/// What a module costs at most, beside its parameters.
const BYTES_PER_MODULE: usize = 64;

/// A module with its identity.
struct Being {
    kind: u8,
    parameters: Vec<f32>,
    id: u64,
    /// How many replacements in this step led to it.
    replaced: u32,
}

/// The identity of a child: mixes the parent's with the child's place (SplitMix64).
fn child(parent: u64, place: usize) -> u64 {
    let mut mixed = parent.wrapping_add((place as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ (mixed >> 31)
}

impl Derivation<'_> {
    /// Identities of the modules, in the order of the string; empty if the model is not timed.
    pub fn ids(&self) -> &[u64] {
        &self.ids
    }

    /// Seconds since the beginning; 0 if the model is not timed.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Seconds of the next step; 0 if the model is not timed.
    pub fn span(&self) -> f64 {
        self.span
    }

    /// Lets so many seconds pass in one step of a timed model.
    pub fn pass(&mut self, seconds: f64) -> Derived<()> {
        self.span = seconds;
        let passed = self.advance();
        self.span = self.system.timing.as_ref().map_or(0.0, |timing| timing.step);
        passed
    }

    /// Gives the modules of the axiom their identities.
    pub(super) fn identify(&mut self) {
        if self.system.timing.is_some() {
            self.ids = (0..self.string.kinds.len()).map(|place| child(0, place)).collect();
        }
    }

    /// Every module grows older, and those that are old enough are replaced.
    pub(super) fn grow_older(&mut self, timing: &Timing, set: &ProductionSet) -> Derived<()> {
        self.time += self.span;
        self.machine.set_time(self.time);
        let old =
            std::mem::replace(&mut self.string, ModuleString::new(self.system.alphabet.clone()));
        let old_ids = std::mem::take(&mut self.ids);
        let groups = Groups::default();
        let system = &self.system.systems[0];
        let mut matcher = Matcher {
            string: &old,
            skipped: &system.skipped,
            arities: &self.arities,
            groups: &groups,
            right_context: system.right_context,
            is_ring: system.is_ring,
            depth: 0,
            looked: self.operations,
            limit: self.options.limits.operations,
        };
        let mut place = Place { module: 0, parameter: 0 };
        let mut waiting = Vec::new();
        while let Some(&kind) = old.kinds.get(place.module) {
            let arity = self.arities[kind as usize] as usize;
            let mut after = Place { module: place.module + 1, parameter: place.parameter + arity };
            let mut parameters = old.parameters[place.parameter..after.parameter].to_vec();
            if timing.is_timed[kind as usize] {
                parameters[0] = (f64::from(parameters[0]) + self.span) as f32;
            }
            let id = old_ids[place.module];
            waiting.push(Being { kind, parameters, id, replaced: 0 });
            let mut context = Some((place, after));
            while let Some(being) = waiting.pop() {
                if being.kind == Alphabet::REPORTED_CUT && being.replaced > 0 {
                    let amount = being.parameters[0];
                    after = cut(&mut self.string, &mut self.ids, &old, after, amount);
                    continue;
                }
                // What is new has no context yet.
                let around = context.take();
                matcher.looked += 1;
                let step = self.step;
                let seed = self.options.seed.unwrap_or(0);
                let mut life = Life {
                    set,
                    timing,
                    machine: &mut self.machine,
                    matcher: &mut matcher,
                    seed,
                    step,
                };
                match life.replaced(&being, around)? {
                    Some(successors) => waiting.extend(successors.into_iter().rev()),
                    None => {
                        self.string.kinds.push(being.kind);
                        self.string.parameters.extend_from_slice(&being.parameters);
                        self.ids.push(being.id);
                    }
                }
                let limits = self.options.limits;
                let modules = self.string.kinds.len() + waiting.len();
                let bytes = BYTES_PER_MODULE * modules + 4 * self.string.parameters.len();
                if modules > limits.modules
                    || bytes > limits.bytes
                    || matcher.looked > limits.operations
                {
                    return Err(too_much(set, self.step));
                }
            }
            place = after;
        }
        self.operations = matcher.looked;
        Ok(())
    }

    /// The string with the values that the modules' growth functions have now in place of their
    /// age and parameters.
    pub(super) fn grown(&mut self, string: &ModuleString) -> ModuleString {
        let Some(timing) = &self.system.timing else { return string.clone() };
        let mut grown = ModuleString::new(self.system.alphabet.clone());
        let mut first = 0;
        for &kind in &string.kinds {
            let arity = self.arities[kind as usize] as usize;
            let parameters = &string.parameters[first..first + arity];
            first += arity;
            match &timing.growth[kind as usize] {
                Some((shown, program)) => {
                    bind(&mut self.machine, parameters);
                    grown.kinds.push(*shown);
                    self.machine.run(program, &mut grown.parameters);
                }
                None => {
                    grown.kinds.push(kind);
                    grown.parameters.extend_from_slice(parameters);
                }
            }
        }
        grown
    }
}

fn bind(machine: &mut Machine, parameters: &[f32]) {
    for (slot, &value) in machine.slots().iter_mut().zip(parameters) {
        *slot = f64::from(value);
    }
}

/// What decides about one module.
struct Life<'l, 'a> {
    set: &'l ProductionSet,
    timing: &'l Timing,
    machine: &'l mut Machine,
    matcher: &'l mut Matcher<'a>,
    seed: u64,
    step: u64,
}

impl Life<'_, '_> {
    /// What replaces a module; none if it stays.
    fn replaced(
        &mut self,
        being: &Being,
        around: Option<(Place, Place)>,
    ) -> Derived<Option<Vec<Being>>> {
        let single;
        let numbers: &[u32] = match &self.set.actions[being.kind as usize] {
            Action::Keep => return Ok(None),
            Action::Replace(number) => {
                single = [*number];
                &single
            }
            Action::Try(numbers) => numbers,
        };
        let is_timed = self.timing.is_timed[being.kind as usize];
        if (!is_timed && being.replaced > 0) || being.replaced > REPLACEMENTS {
            return Ok(None);
        }
        let mut found: Vec<(&Production, f64, f64)> = Vec::new();
        for &number in numbers {
            let production = &self.set.productions[number as usize];
            let Some(excess) = self.excess(production, being, around)? else { continue };
            let weight = match &production.probability {
                None if found.is_empty() => {
                    found.push((production, 1.0, excess));
                    break;
                }
                None => 1.0,
                Some(program) => self.machine.run(program, &mut Vec::new()).max(0.0),
            };
            found.push((production, weight, excess));
        }
        let Some((production, excess)) = self.drawn(being, &found) else { return Ok(None) };
        bind(self.machine, &being.parameters);
        self.excess(production, being, around)?;
        self.successors(production, being, excess).map(Some)
    }

    /// By how much a module is older than a production asks for; none if it does not apply.
    fn excess(
        &mut self,
        production: &Production,
        being: &Being,
        around: Option<(Place, Place)>,
    ) -> Derived<Option<f64>> {
        bind(self.machine, &being.parameters);
        self.machine.random.begin(being.id as usize, being.id >> 32, self.step as u32);
        let has_context = !production.left.is_empty() || !production.right.is_empty();
        match around {
            None if has_context => return Ok(None),
            Some((before, after)) if has_context => {
                let slots = self.machine.slots();
                if !self.matcher.precedes(&production.left, before, slots)
                    || !self.matcher.succeeds(&production.right, after, slots)
                {
                    return Ok(None);
                }
            }
            _ => {}
        }
        let mut excess = 0.0;
        if let Some(after) = &production.after {
            excess = f64::from(being.parameters[0]) - self.machine.run(after, &mut Vec::new());
        }
        if excess < 0.0 {
            return Ok(None);
        }
        let holds = production.test.is_empty() || {
            let value = self.machine.run(&production.test, &mut Vec::new());
            is_true(value, self.machine.pool.rules)
        };
        self.examine(production)?;
        Ok(holds.then_some(excess))
    }

    /// The production that is chosen; if the weights add up to less than 1, perhaps none.
    fn drawn<'p>(
        &self,
        being: &Being,
        found: &[(&'p Production, f64, f64)],
    ) -> Option<(&'p Production, f64)> {
        if let [(production, _, excess)] = found
            && production.probability.is_none()
        {
            return Some((production, *excess));
        }
        let total: f64 = found.iter().map(|(_, weight, _)| weight).sum();
        let mut random = Random::new(self.seed, being.id as u32, being.id >> 32, CHOICE);
        let mut rest = f64::from(random.uniform()) * total;
        for (production, weight, excess) in found {
            if rest < *weight {
                return Some((production, *excess));
            }
            rest -= weight;
        }
        None
    }

    fn successors(
        &mut self,
        production: &Production,
        being: &Being,
        excess: f64,
    ) -> Derived<Vec<Being>> {
        let mut parameters = Vec::new();
        self.machine.run(&production.successor.program, &mut parameters);
        self.examine(production)?;
        let mut rest = &parameters[..];
        let mut made = Vec::with_capacity(production.successor.kinds.len());
        for (place, &kind) in production.successor.kinds.iter().enumerate() {
            let (own, after) = rest.split_at(self.matcher.arities[kind as usize] as usize);
            rest = after;
            let mut parameters = own.to_vec();
            if self.timing.is_timed[kind as usize] {
                parameters[0] = (f64::from(parameters[0]) + excess) as f32;
            }
            let id = child(being.id, place);
            made.push(Being { kind, parameters, id, replaced: being.replaced + 1 });
        }
        Ok(made)
    }

    fn examine(&mut self, production: &Production) -> Derived<()> {
        let Some(fault) = self.machine.fault.take() else { return Ok(()) };
        Err(DerivationError::Fault {
            place: production.place.clone(),
            what: fault.to_string(),
            step: self.step,
            production: production.text.clone(),
        })
    }
}

#[cold]
fn too_much(set: &ProductionSet, step: u64) -> DerivationError {
    let production = &set.productions[0];
    DerivationError::Limit {
        place: production.place.clone(),
        what: "more modules or operations than allowed".into(),
        step,
        production: production.text.clone(),
    }
}
