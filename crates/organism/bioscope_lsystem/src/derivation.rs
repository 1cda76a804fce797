//! Rewriting: what a string becomes in one step, and in many.
//!
//! All modules are replaced at once, each by the first production that applies to it. If that
//! production has a probability, one is drawn among all that apply, by their probabilities; the
//! draw depends only on seed, step and the module's number, so it does not depend on threads.

use std::sync::Arc;

use bioscope_core::{Purpose, Random};

use crate::{
    Alphabet, LSystem, ModuleString, Place,
    context::{self, Matcher},
    expression::{Bindings, is_true, run},
    model::{Action, Production, ProductionSet, Successor},
};

const CHOICE: Purpose = Purpose::new("lsystem production");

/// What a derivation may use before it is stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Modules in one string.
    pub modules: usize,
    /// Bytes of one string, its parameters included.
    pub bytes: usize,
    /// Modules looked at in all steps together.
    pub operations: u64,
}

impl Default for Limits {
    /// 200 million modules, 2 GiB, 20 thousand million operations.
    fn default() -> Self {
        Self { modules: 200_000_000, bytes: 2 << 30, operations: 20_000_000_000 }
    }
}

/// Why a derivation stopped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DerivationError {
    /// A bound was reached.
    #[error("{place}: {what} at step {step}; the string grows most by '{production}'")]
    Limit {
        /// Where the production stands that made most of the string.
        place: Place,
        /// The bound.
        what: String,
        /// The derivation step, from 1.
        step: u64,
        /// The production, as it is written.
        production: String,
    },
    /// A production could not be evaluated.
    #[error("{place}: {what} at step {step} in '{production}'")]
    Fault {
        /// Where the production stands.
        place: Place,
        /// What went wrong.
        what: String,
        /// The derivation step, from 1; 0 for the axiom.
        step: u64,
        /// The production, as it is written.
        production: String,
    },
}

impl From<DerivationError> for bioscope_core::Error {
    fn from(error: DerivationError) -> Self {
        match error {
            DerivationError::Limit { place, what, step, production } => Self::Format {
                place: place.to_string(),
                message: format!("{what} at step {step}; the string grows most by '{production}'"),
            },
            DerivationError::Fault { place, what, step, production } => Self::Format {
                place: place.to_string(),
                message: format!("{what} at step {step} in '{production}'"),
            },
        }
    }
}

type Derived<T> = Result<T, DerivationError>;

impl LSystem {
    /// The string after so many steps from the axiom, within the default [`Limits`].
    pub fn derive(&self, steps: u64, seed: u64) -> Derived<ModuleString> {
        self.derive_within(steps, seed, &Limits::default())
    }

    /// The string after so many steps from the axiom, within `limits`.
    pub fn derive_within(&self, steps: u64, seed: u64, limits: &Limits) -> Derived<ModuleString> {
        let mut derivation = Derivation::new(self, seed, *limits)?;
        for _ in 0..steps {
            derivation.advance()?;
        }
        Ok(derivation.string)
    }

    /// What the modules of a string look like: the string after the productions of the file's
    /// `homomorphism:` part, or the string itself if there is none.
    pub fn appearance(&self, string: &ModuleString, seed: u64) -> Derived<ModuleString> {
        let Some(set) = &self.homomorphism else { return Ok(string.clone()) };
        let limits = Limits::default();
        let mut rewriter = Rewriter::new(self, seed, &limits);
        rewriter.repeat(set, string.clone(), 0, APPEARANCE)
    }
}

/// Tells the random numbers of the parts of a step apart.
const REWRITING: u64 = 0;
const DECOMPOSITION: u64 = 1 << 20;
const APPEARANCE: u64 = 2 << 20;

/// A string that is being derived step by step.
pub struct Derivation<'a> {
    system: &'a LSystem,
    string: ModuleString,
    step: u64,
    rewriter: Rewriter<'a>,
}

impl<'a> Derivation<'a> {
    /// Begins with the axiom.
    pub fn new(system: &'a LSystem, seed: u64, limits: Limits) -> Derived<Self> {
        let mut rewriter = Rewriter::new(system, seed, &limits);
        let mut string = ModuleString::new(system.alphabet.clone());
        append(&system.axiom, &mut string, &mut rewriter.bindings);
        if let Some(fault) = rewriter.bindings.fault.take() {
            return Err(DerivationError::Fault {
                place: system.axiom_place.clone(),
                what: fault.to_string(),
                step: 0,
                production: "axiom".into(),
            });
        }
        Ok(Self { system, string, step: 0, rewriter })
    }

    /// The string so far.
    pub fn string(&self) -> &ModuleString {
        &self.string
    }

    /// How many steps were made.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Makes one step.
    pub fn advance(&mut self) -> Derived<()> {
        self.step += 1;
        let cut;
        let string = if self.string.kinds.contains(&Alphabet::CUT) {
            cut = without_cut_branches(&self.string);
            &cut
        } else {
            &self.string
        };
        let mut next =
            self.rewriter.rewrite(&self.system.rewriting, string, self.step, REWRITING)?;
        if let Some(set) = &self.system.decomposition {
            next = self.rewriter.repeat(set, next, self.step, DECOMPOSITION)?;
        }
        self.string = next;
        Ok(())
    }
}

/// The string without what follows each `%` up to the end of its branch.
fn without_cut_branches(string: &ModuleString) -> ModuleString {
    let mut kept = ModuleString::new(string.alphabet.clone());
    let mut parameter = 0;
    let mut depth_of_cut = None;
    let mut depth = 0_i64;
    for &kind in &string.kinds {
        let arity = string.alphabet.kinds()[kind as usize].arity as usize;
        depth += i64::from(kind == Alphabet::OPEN) - i64::from(kind == Alphabet::CLOSE);
        if depth_of_cut.is_some_and(|cut| depth < cut) {
            depth_of_cut = None;
        }
        if kind == Alphabet::CUT && depth_of_cut.is_none() {
            depth_of_cut = Some(depth);
        }
        if depth_of_cut.is_none() {
            kept.kinds.push(kind);
            kept.parameters.extend_from_slice(&string.parameters[parameter..parameter + arity]);
        }
        parameter += arity;
    }
    kept
}

/// Applies sets of productions to strings and counts what that costs.
struct Rewriter<'a> {
    system: &'a LSystem,
    seed: u64,
    limits: Limits,
    bindings: Bindings,
    operations: u64,
    arities: Vec<u8>,
}

impl<'a> Rewriter<'a> {
    fn new(system: &'a LSystem, seed: u64, limits: &Limits) -> Self {
        let mut arities: Vec<u8> = system.alphabet.kinds().iter().map(|kind| kind.arity).collect();
        arities.resize(256, 0);
        let bindings = Bindings::new(seed, f64::from(system.derivation_length));
        Self { system, seed, limits: *limits, bindings, operations: 0, arities }
    }

    /// Applies a set to its own results until nothing changes or its depth is reached.
    fn repeat(
        &mut self,
        set: &ProductionSet,
        mut string: ModuleString,
        step: u64,
        part: u64,
    ) -> Derived<ModuleString> {
        for depth in 0..u64::from(set.maximum_depth) {
            let applies = |&kind: &u8| !matches!(set.actions[kind as usize], Action::Keep);
            if !string.kinds.iter().any(applies) {
                break;
            }
            string = self.rewrite(set, &string, step, part + depth)?;
        }
        Ok(string)
    }

    /// Replaces all modules of a string at once.
    fn rewrite(
        &mut self,
        set: &ProductionSet,
        string: &ModuleString,
        step: u64,
        part: u64,
    ) -> Derived<ModuleString> {
        let mut next = ModuleString::new(Arc::clone(&string.alphabet));
        next.kinds.reserve(string.kinds.len());
        next.parameters.reserve(string.parameters.len());
        self.bindings.step = step as f64;
        let looked = self.operations + string.kinds.len() as u64 + STEP_COST;
        let mut pass = Pass {
            set,
            matcher: Matcher {
                string,
                skipped: &self.system.skipped,
                arities: &self.arities,
                looked,
            },
            bindings: &mut self.bindings,
            next,
            place: context::Place { module: 0, parameter: 0 },
            limits: self.limits,
            seed: self.seed,
            step,
            tick: (step << 22) | part,
            made: vec![0; set.productions.len()],
            candidates: Vec::new(),
        };
        pass.check()?;
        while pass.place.module < string.kinds.len() {
            pass.module()?;
        }
        self.operations = pass.matcher.looked;
        Ok(pass.next)
    }
}

fn append(successor: &Successor, string: &mut ModuleString, bindings: &mut Bindings) {
    string.kinds.extend_from_slice(&successor.kinds);
    for argument in &successor.arguments {
        string.parameters.push(argument.evaluate(bindings) as f32);
    }
}

/// What a step costs at least, in operations.
const STEP_COST: u64 = 256;

/// One set applied to one string.
struct Pass<'a> {
    set: &'a ProductionSet,
    matcher: Matcher<'a>,
    bindings: &'a mut Bindings,
    next: ModuleString,
    place: context::Place,
    limits: Limits,
    seed: u64,
    step: u64,
    tick: u64,
    /// How many modules each production has made.
    made: Vec<u64>,
    /// Productions that apply to the present module, with their probabilities.
    candidates: Vec<(u32, f64)>,
}

impl Pass<'_> {
    /// Appends what becomes of the next module.
    #[inline]
    fn module(&mut self) -> Derived<()> {
        let set = self.set;
        let kind = self.matcher.string.kinds[self.place.module];
        match &set.actions[kind as usize] {
            Action::Keep => {
                self.keep(kind);
                Ok(())
            }
            Action::Replace(number) => {
                let successor = &set.productions[*number as usize].successor;
                self.next.kinds.extend_from_slice(&successor.kinds);
                self.made[*number as usize] += successor.kinds.len() as u64;
                self.place.module += 1;
                self.place.parameter += self.matcher.arities[kind as usize] as usize;
                self.check()
            }
            Action::Try(numbers) => match self.choose(numbers)? {
                Some(number) => self.apply(number),
                None => {
                    self.keep(kind);
                    Ok(())
                }
            },
        }
    }

    #[inline]
    fn keep(&mut self, kind: u8) {
        self.next.kinds.push(kind);
        let end = self.place.parameter + self.matcher.arities[kind as usize] as usize;
        let parameters = &self.matcher.string.parameters[self.place.parameter..end];
        self.next.parameters.extend_from_slice(parameters);
        self.place.module += 1;
        self.place.parameter = end;
    }

    /// The production to apply among those of these numbers, its parameters bound.
    fn choose(&mut self, numbers: &[u32]) -> Derived<Option<u32>> {
        self.candidates.clear();
        for &number in numbers {
            if !self.applies(number)? {
                continue;
            }
            let probability = match &self.set.productions[number as usize].probability {
                None if self.candidates.is_empty() => return Ok(Some(number)),
                None => 1.0,
                Some(expression) => expression.evaluate(self.bindings).max(0.0),
            };
            self.examine(number)?;
            self.candidates.push((number, probability));
        }
        let Some(number) = self.draw() else { return Ok(None) };
        // Bind its parameters again: those of later candidates are in their place.
        self.applies(number)?;
        Ok(Some(number))
    }

    /// Draws one of the candidates; none if their probabilities are all zero.
    fn draw(&self) -> Option<u32> {
        let total: f64 = self.candidates.iter().map(|(_, probability)| probability).sum();
        if total.is_nan() || total <= 0.0 {
            return None;
        }
        let module = self.place.module as u32;
        let mut random = Random::new(self.seed, module, self.tick, CHOICE);
        let mut rest = f64::from(random.uniform()) * total;
        let mut last = None;
        for &(number, probability) in &self.candidates {
            if probability > 0.0 {
                last = Some(number);
                if rest < probability {
                    break;
                }
                rest -= probability;
            }
        }
        last
    }

    /// Whether a production applies to the present module; binds its parameters.
    fn applies(&mut self, number: u32) -> Derived<bool> {
        let production = &self.set.productions[number as usize];
        self.matcher.looked += production.cost;
        let place = self.place;
        if !self.matcher.follows(&production.strict, place, self.bindings)
            || !self.matcher.precedes(&production.left, place, self.bindings)
            || !self.matcher.succeeds(&production.right, self.after(production), self.bindings)
        {
            self.check()?;
            return Ok(false);
        }
        self.bindings.begin(place.module, self.tick, number);
        run(&production.before, self.bindings);
        let condition = production.condition.as_ref();
        let applies = condition.is_none_or(|condition| is_true(condition.evaluate(self.bindings)));
        if applies {
            run(&production.after, self.bindings);
        }
        self.examine(number)?;
        self.check()?;
        Ok(applies)
    }

    /// The place after the modules that a production replaces.
    fn after(&self, production: &Production) -> context::Place {
        let arity: usize = production.strict.iter().map(|pattern| pattern.arity as usize).sum();
        context::Place {
            module: self.place.module + production.strict.len(),
            parameter: self.place.parameter + arity,
        }
    }

    /// Appends the successor of a production whose parameters are bound.
    fn apply(&mut self, number: u32) -> Derived<()> {
        let production = &self.set.productions[number as usize];
        append(&production.successor, &mut self.next, self.bindings);
        self.made[number as usize] += production.successor.kinds.len() as u64;
        self.place = self.after(production);
        self.examine(number)?;
        self.check()
    }

    /// An error if the last evaluation of a production failed.
    #[inline]
    fn examine(&mut self, number: u32) -> Derived<()> {
        let Some(fault) = self.bindings.fault.take() else { return Ok(()) };
        let production = &self.set.productions[number as usize];
        Err(DerivationError::Fault {
            place: production.place.clone(),
            what: fault.to_string(),
            step: self.step,
            production: production.text.clone(),
        })
    }

    /// An error if a limit is exceeded.
    #[inline]
    fn check(&self) -> Derived<()> {
        let modules = self.next.kinds.len();
        let bytes = modules + size_of::<f32>() * self.next.parameters.len();
        if modules <= self.limits.modules
            && bytes <= self.limits.bytes
            && self.matcher.looked <= self.limits.operations
        {
            return Ok(());
        }
        Err(self.exceeded(modules, bytes))
    }

    #[cold]
    fn exceeded(&self, modules: usize, bytes: usize) -> DerivationError {
        let Limits { modules: most, bytes: most_bytes, operations } = self.limits;
        let what = if modules > most {
            format!("more than {most} modules")
        } else if bytes > most_bytes {
            format!("more than {most_bytes} bytes of modules and parameters")
        } else {
            format!("more than {operations} operations")
        };
        let largest = (0..self.made.len()).rev().max_by_key(|&number| self.made[number]);
        let production = &self.set.productions[largest.unwrap_or(0)];
        DerivationError::Limit {
            place: production.place.clone(),
            what,
            step: self.step,
            production: production.text.clone(),
        }
    }
}
