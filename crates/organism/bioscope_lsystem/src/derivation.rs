//! Rewriting: what a string becomes in one step, and in many.
//!
//! All modules are replaced at once, each by the first production that applies to it. If that
//! production has a probability, one is drawn among all that apply, by their probabilities; the
//! draw depends only on seed, step and the module's number, so it does not depend on threads.
//!
//! Files of the cpfg dialect that are derived without a seed give the strings of the reference
//! program: they draw from its streams, module after module. With a seed they use ours.

mod choosing;
mod cuts;
mod error;
mod exchange;
mod expansion;
mod fragments;
mod lineage;
mod options;
mod parallel;
mod pass;
mod progress;
mod showing;
mod timed;

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use cuts::without_cut_branches;
pub use error::{DerivationError, Limits};
pub use fragments::Fragment;
pub use lineage::{Lineage, Shown};
pub use options::DerivationOptions;
use parallel::Space;
use pass::{Layer, Made, Task};
pub use progress::{Placed, Progress};
use showing::Noted;

use crate::{
    Alphabet, LSystem, ModuleString,
    context::Groups,
    machine::{Machine, Program, Randomness},
    model::{Order, ProductionSet, System},
};

type Derived<T> = Result<T, DerivationError>;
/// Boxed, so that what goes well is returned in registers.
type Passed<T> = Result<T, Box<DerivationError>>;

/// How a production is chosen among those that apply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    /// The first.
    First,
    /// The first, but if it has a weight then by weight among all.
    FirstOrWeighted,
    /// By weight among all; 1 where there is none.
    Weighted,
    /// Likewise, with the random numbers of the reference program.
    Reference,
}

impl LSystem {
    /// The string after so many steps from the axiom, within the default [`Limits`]. Without a
    /// seed, files of the cpfg dialect give the string of the reference program.
    pub fn derive(&self, steps: u64, seed: impl Into<Option<u64>>) -> Derived<ModuleString> {
        self.derive_within(steps, seed, &Limits::default())
    }

    /// The string after so many steps from the axiom, within `limits`.
    pub fn derive_within(
        &self,
        steps: u64,
        seed: impl Into<Option<u64>>,
        limits: &Limits,
    ) -> Derived<ModuleString> {
        let mut derivation = Derivation::new(self, seed, *limits)?;
        for _ in 0..steps {
            derivation.advance()?;
        }
        derivation.finish()
    }
}

/// Tells the random numbers of the parts of a step apart.
const REWRITING: u64 = 0;
/// How many instructions of loops a model may run: a few seconds.
const LOOPS: u64 = 2_000_000_000;
/// What a step costs at least, in operations.
const STEP_COST: u64 = 256;

/// A string that is being derived step by step.
pub struct Derivation<'a> {
    system: &'a LSystem,
    string: ModuleString,
    step: u64,
    machine: Machine,
    options: DerivationOptions,
    operations: u64,
    space: Space,
    deadline: Option<Instant>,
    arities: [u8; 256],
    /// Of a timed model: identities of the modules, seconds so far, and of the next step.
    ids: Vec<u64>,
    time: f64,
    span: f64,
}

impl<'a> Derivation<'a> {
    /// Begins with the axiom, in the environment that the file asks for.
    pub fn new(system: &'a LSystem, seed: impl Into<Option<u64>>, limits: Limits) -> Derived<Self> {
        let options = DerivationOptions::of(system)
            .map_err(|error| DerivationError::Environment { error, step: 0 })?;
        Self::with_options(system, DerivationOptions { seed: seed.into(), limits, ..options })
    }

    /// Begins with the axiom: runs the start blocks of the file and fills its queries.
    pub fn with_options(system: &'a LSystem, options: DerivationOptions) -> Derived<Self> {
        let mut derivation = Self::begin(system, options);
        for part in &system.systems {
            derivation.block(&part.blocks.start, "start:")?;
        }
        derivation.take_axiom()?;
        derivation.identify();
        derivation.exchange()?;
        derivation.remember();
        Ok(derivation)
    }

    /// Begins with the axiom of the file, or with the string that stands in its place.
    fn take_axiom(&mut self) -> Derived<()> {
        if let Some(start) = self.options.start.take() {
            if start.alphabet.kinds() != self.system.alphabet.kinds() {
                let what = "the string to start with is one of another model";
                return Err(self.fault(what.into(), "axiom:"));
            }
            self.string.kinds = start.kinds;
            self.string.parameters = start.parameters;
            return Ok(());
        }
        let axiom = &self.system.axiom;
        self.string.kinds.extend_from_slice(&axiom.kinds);
        self.machine.run(&axiom.program, &mut self.string.parameters);
        self.examine("axiom:")
    }

    fn begin(system: &'a LSystem, mut options: DerivationOptions) -> Self {
        let mut arities = [0; 256];
        for (arity, kind) in arities.iter_mut().zip(system.alphabet.kinds()) {
            *arity = kind.arity;
        }
        let random = match options.seed {
            Some(seed) => Randomness::counter(seed),
            None if system.is_own() => Randomness::counter(0),
            None => Randomness::reference(system.systems[0].homomorphism_seed),
        };
        let length = f64::from(system.derivation_length);
        let fuel = options.limits.operations.min(LOOPS);
        let mut machine = Machine::new(system.pool.clone(), length, random, fuel);
        machine.functions = options.functions.take();
        machine.output.folder = options.folder.take();
        Self {
            system,
            string: ModuleString::new(system.alphabet.clone()),
            step: 0,
            machine,
            operations: 0,
            space: Space::default(),
            deadline: options.seconds.map(|seconds| {
                // A day is as good as for ever, and cannot overflow.
                Instant::now() + Duration::from_secs_f64(seconds.clamp(0.0, 86_400.0))
            }),
            options,
            arities,
            ids: Vec::new(),
            time: 0.0,
            span: system.timing.as_ref().map_or(0.0, |timing| timing.step),
        }
    }

    /// The string so far.
    pub fn string(&self) -> &ModuleString {
        &self.string
    }

    /// How many steps were made.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// After how many steps the model is complete: what the file says, unless a block of it has
    /// set another length.
    pub fn length(&self) -> u64 {
        self.machine.length as u64
    }

    /// What the model has printed so far.
    pub fn output(&self) -> &str {
        &self.machine.output.text
    }

    /// What was tolerated but is doubtful, such as divisions by zero.
    pub fn remarks(&self) -> Vec<String> {
        let oddities = self.machine.oddities;
        let remark =
            |count: u64, what: &str| (count > 0).then(|| format!("{what} ({count} times)"));
        let divided = self.system.productions().find(|production| {
            production.programs().any(|program| oddities.divided_first(program))
        });
        let division = match divided {
            Some(production) => {
                format!("{}: division by zero in '{}'", production.place, production.text)
            }
            None => "division by zero".into(),
        };
        [
            remark(oddities.divisions_by_zero, &division),
            remark(oddities.indices_out_of_range, "index out of the range of its array"),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Makes one step.
    pub fn advance(&mut self) -> Derived<()> {
        self.make_step(false).map(drop)
    }

    /// Makes one step; what has become of each module. Nothing is known of those of timed models.
    pub fn advance_traced(&mut self) -> Derived<Lineage> {
        self.make_step(true)
    }

    fn make_step(&mut self, traced: bool) -> Derived<Lineage> {
        let mut lineage = Lineage::default();
        self.step += 1;
        self.machine.begin_step(self.step);
        for part in &self.system.systems {
            self.block(&part.blocks.start_each, "startEach:")?;
        }
        let is_cut = |&kind: &u8| matches!(kind, Alphabet::CUT | Alphabet::REPORTED_CUT);
        if self.system.is_own() && self.string.kinds.iter().any(is_cut) {
            let (kept, numbers) = without_cut_branches(&self.string);
            self.string = kept;
            lineage.old_numbers(numbers);
        }
        let system = self.system;
        if let Some(timing) = &system.timing {
            let set = self.table(&system.systems[0])?;
            self.grow_older(timing, set)?;
        } else {
            let mut next = self.rewritten(traced)?;
            lineage.note(&next.notes);
            std::mem::swap(&mut self.string.kinds, &mut next.kinds);
            std::mem::swap(&mut self.string.parameters, &mut next.parameters);
            self.space.whole = next;
        }
        for part in &self.system.systems {
            self.block(&part.blocks.end_each, "endEach:")?;
        }
        self.exchange()?;
        self.remember();
        Ok(lineage)
    }

    /// Ends the derivation: runs the end blocks of the file, and writes its files out.
    pub fn finish(self) -> Derived<ModuleString> {
        Ok(self.finish_with_output()?.0)
    }

    /// Likewise, with everything that the model has printed.
    pub fn finish_with_output(mut self) -> Derived<(ModuleString, String)> {
        for part in &self.system.systems {
            self.block(&part.blocks.end, "end:")?;
        }
        if let Err(message) = self.machine.output.finish() {
            return Err(self.fault(message, "end:"));
        }
        Ok((self.string, self.machine.output.text))
    }

    /// What becomes of the string in this step.
    fn rewritten(&mut self, traced: bool) -> Derived<Made> {
        let mut layers = Vec::new();
        for system in &self.system.systems {
            let set = self.table(system)?;
            layers.push(Layer { system, set, decomposition: system.decomposition.as_ref() });
        }
        let groups = Groups::default();
        let task = Task {
            string: &self.string,
            groups: &groups,
            layers: &layers,
            arities: &self.arities,
            choice: self.choice(),
            limits: self.options.limits,
            deadline: self.deadline,
            step: self.step,
            tick: (self.step << 22) | REWRITING,
            shows: false,
            noted: None,
            traced,
            only: None,
        };
        let looked = self.operations + STEP_COST;
        let (made, looked) = match self.system.systems[0].order {
            Order::Parallel => {
                let threads = self.options.threads;
                parallel::rewrite(task, &mut self.machine, looked, threads, &mut self.space)?
            }
            Order::Leftmost => {
                let only = Task { only: Some(0), ..task };
                parallel::one_after_the_other(only, &mut self.machine, looked, Made::default())?
            }
            Order::Random => {
                let count = Task { only: Some(u64::MAX - 1), ..task };
                let out = Made::default();
                let (counted, looked) =
                    parallel::one_after_the_other(count, &mut self.machine, looked, out)?;
                let draw = self.machine.random.choice(usize::MAX, task.tick);
                let only = Some((draw * counted.applied as f64) as u64);
                let only = Task { only, ..task };
                let out = counted;
                parallel::one_after_the_other(only, &mut self.machine, looked, out)?
            }
        };
        self.operations = looked;
        Ok(made)
    }

    /// The productions that are active in this step.
    fn table(&mut self, system: &'a System) -> Derived<&'a ProductionSet> {
        for (test, number) in &system.selections {
            let selected = self.machine.run(test, &mut Vec::new());
            self.examine("select:")?;
            if selected != 0.0 && !selected.is_nan() {
                return Ok(&system.tables[*number]);
            }
        }
        Ok(&system.tables[0])
    }

    fn choice(&self) -> Choice {
        let is_stochastic = self.system.systems[0].is_stochastic;
        match (self.machine.random.is_reference(), is_stochastic) {
            (true, true) => Choice::Reference,
            (true, false) => Choice::First,
            (false, true) if !self.system.is_own() => Choice::Weighted,
            (false, _) => Choice::FirstOrWeighted,
        }
    }

    fn block(&mut self, program: &Program, name: &str) -> Derived<()> {
        if program.is_empty() {
            return Ok(());
        }
        // Blocks draw numbers of their own.
        self.machine.random.begin(u32::MAX as usize, self.step << 22, name.len() as u32);
        self.machine.run(program, &mut Vec::new());
        self.examine(name)
    }

    /// An error if a block has failed.
    fn examine(&mut self, name: &str) -> Derived<()> {
        match self.machine.fault.take() {
            Some(fault) => Err(self.fault(fault.to_string(), name)),
            None => Ok(()),
        }
    }

    fn fault(&self, what: String, name: &str) -> DerivationError {
        DerivationError::Fault {
            place: self.system.axiom_place.clone(),
            what,
            step: self.step,
            production: name.into(),
        }
    }

    /// Keeps with the string what its homomorphism may depend on.
    fn remember(&mut self) {
        let looks_else = self.system.systems.iter().any(|system| system.homomorphism.is_some());
        if looks_else || self.system.timing.is_some() {
            self.string.memory = Some(Arc::new(self.machine.memory(self.step)));
        }
    }
}
