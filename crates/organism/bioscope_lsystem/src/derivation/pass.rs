//! One set of productions applied to the modules of one string, from left to right.

use std::time::Instant;

use super::{Choice, DerivationError, Limits, Passed, choosing::Candidate};
use crate::{
    Alphabet, ModuleString,
    context::{Groups, Matcher, Place},
    machine::Machine,
    model::{Action, Production, ProductionSet, System},
};

/// Productions of one of the L-systems of a file, as they are used in this pass.
#[derive(Clone, Copy)]
pub(super) struct Layer<'a> {
    pub system: &'a System,
    pub set: &'a ProductionSet,
    /// Applied to what the others make, and to what they leave.
    pub decomposition: Option<&'a ProductionSet>,
}

/// What all parts of a pass share.
#[derive(Clone, Copy)]
pub(super) struct Task<'a> {
    pub string: &'a ModuleString,
    pub groups: &'a Groups,
    /// One per L-system of the file; the first is the main one.
    pub layers: &'a [Layer<'a>],
    pub arities: &'a [u8; 256],
    pub choice: Choice,
    pub limits: Limits,
    pub deadline: Option<Instant>,
    pub step: u64,
    /// Tells the random numbers of this pass from others.
    pub tick: u64,
    /// Whether it finds out what a string looks like, rather than what becomes of it.
    pub shows: bool,
    /// Kinds of module whose copies are noted.
    pub noted: Option<&'a [bool]>,
    /// Whether it is noted of every module where what becomes of it begins.
    pub traced: bool,
    /// Applies only the production that would be applied as this one, counted from 0.
    pub only: Option<u64>,
}

/// What a pass has made.
#[derive(Default)]
pub(super) struct Made {
    pub kinds: Vec<u8>,
    pub parameters: Vec<f32>,
    /// How many modules each production has made; those of the decomposition after the others.
    pub by_production: Vec<u64>,
    /// Number in the new and in the old string of noted modules; of all, if they are traced.
    pub notes: Vec<(usize, usize)>,
    /// How many productions were applied, or would have been.
    pub applied: u64,
}

impl Made {
    /// Makes room for something else in the same memory.
    pub fn clear(&mut self) {
        self.kinds.clear();
        self.parameters.clear();
        self.by_production.clear();
        self.notes.clear();
        self.applied = 0;
    }
}

/// One set applied to a part of a string.
pub(super) struct Pass<'a, 'm> {
    pub task: Task<'a>,
    pub layer: Layer<'a>,
    pub matcher: Matcher<'a>,
    pub machine: &'m mut Machine,
    pub out: Made,
    pub place: Place,
    /// Productions that apply to the present module, with their weights and bound parameters.
    pub(super) candidates: Vec<Candidate>,
    pub(super) bound: Vec<f64>,
    /// L-systems that the present place is in, as numbers of layers; the innermost last.
    nested: Vec<usize>,
    /// By kind: number of parameters of what is only copied, else [`ACTIVE`].
    copied: [u8; 256],
    countdown: u32,
    /// How many results were treated again, so that each has random numbers of its own.
    pub expansions: u32,
}

/// Marks what is more than copied; no module has so many parameters.
const ACTIVE: u8 = u8::MAX;
/// Up to how many modules and parameters are copied as if they were so many.
const SHORT: usize = 8;
/// How many modules are treated between two looks at the clock.
const CLOCK: u32 = 1 << 14;

impl<'a, 'm> Pass<'a, 'm> {
    /// Begins at `first`; what is made is written into `out`, whatever is in it.
    pub fn new(
        task: Task<'a>,
        machine: &'m mut Machine,
        first: Place,
        looked: u64,
        mut out: Made,
    ) -> Self {
        out.clear();
        let layer = task.layers[0];
        let mut pass = Self {
            matcher: Matcher {
                string: task.string,
                skipped: &layer.system.skipped,
                arities: task.arities,
                groups: task.groups,
                right_context: layer.system.right_context,
                is_ring: layer.system.is_ring,
                depth: 0,
                looked,
                limit: task.limits.operations,
            },
            layer,
            task,
            machine,
            out,
            place: first,
            candidates: Vec::new(),
            bound: Vec::new(),
            nested: vec![0],
            copied: [ACTIVE; 256],
            countdown: CLOCK,
            expansions: 0,
        };
        pass.enter(0);
        pass
    }

    /// Goes on with the productions of one of the L-systems.
    fn enter(&mut self, number: usize) {
        let layer = self.task.layers[number];
        self.layer = layer;
        self.matcher.skipped = &layer.system.skipped;
        self.matcher.right_context = layer.system.right_context;
        self.matcher.is_ring = layer.system.is_ring;
        let inner = layer.decomposition.map_or(0, |set| set.productions.len());
        self.out
            .by_production
            .resize((layer.set.productions.len() + inner).max(self.out.by_production.len()), 0);
        let acts = |set: &ProductionSet, kind: usize| !matches!(set.actions[kind], Action::Keep);
        let all = self.task.layers.len() > 1 || self.task.choice == Choice::Reference;
        for kind in 0..256 {
            let is_active = all
                || acts(layer.set, kind)
                || layer.decomposition.is_some_and(|set| acts(set, kind))
                || self.task.traced
                || self.task.noted.is_some_and(|noted| noted[kind])
                || matches!(kind as u8, Alphabet::CUT | Alphabet::REPORTED_CUT);
            self.copied[kind] = if is_active { ACTIVE } else { self.task.arities[kind] };
        }
    }

    /// Treats the modules up to number `end`.
    pub fn run(&mut self, end: usize) -> Passed<()> {
        self.check()?;
        let kinds = &self.task.string.kinds[..end];
        while let Some(rest) = kinds.get(self.place.module..).filter(|rest| !rest.is_empty()) {
            let (mut count, mut parameters) = (0, 0);
            for &kind in rest {
                let arity = self.copied[kind as usize];
                if arity == ACTIVE {
                    break;
                }
                count += 1;
                parameters += arity as usize;
            }
            if count > 0 {
                self.copy(count, parameters);
            }
            if count < rest.len() {
                if self.task.traced {
                    self.out.notes.push((self.out.kinds.len(), self.place.module));
                }
                self.module()?;
            }
        }
        self.check()
    }

    /// Copies so many modules with so many parameters.
    #[inline]
    fn copy(&mut self, count: usize, parameters: usize) {
        let Place { module, parameter } = self.place;
        let (kinds, values) =
            (&self.task.string.kinds[module..], &self.task.string.parameters[parameter..]);
        append(&mut self.out.kinds, kinds, count);
        append(&mut self.out.parameters, values, parameters);
        self.place = Place { module: module + count, parameter: parameter + parameters };
        self.matcher.looked += count as u64;
    }

    /// Appends what becomes of the next module.
    #[inline]
    fn module(&mut self) -> Passed<()> {
        let set = self.layer.set;
        let kind = self.task.string.kinds[self.place.module];
        self.matcher.looked += 1;
        let number = match &set.actions[kind as usize] {
            Action::Keep => None,
            Action::Replace(number) if self.task.choice != Choice::Reference => Some(*number),
            Action::Replace(number) => self.choose(&[*number])?,
            Action::Try(numbers) => self.choose(numbers)?,
        };
        match number {
            Some(number) if self.may_apply() => self.apply(number)?,
            _ => self.keep(kind)?,
        }
        if self.matcher.looked > self.task.limits.operations {
            return self.check();
        }
        self.countdown -= 1;
        if self.countdown == 0 {
            self.countdown = CLOCK;
            return self.check();
        }
        Ok(())
    }

    /// Whether the production that was found is to be applied, and not only counted.
    #[inline]
    fn may_apply(&mut self) -> bool {
        self.out.applied += 1;
        self.task.only.is_none_or(|only| only + 1 == self.out.applied)
    }

    /// The place after the modules that a production replaces.
    #[inline]
    pub(super) fn after(&self, production: &Production) -> Place {
        let arity: usize = production.strict.iter().map(|pattern| pattern.arity as usize).sum();
        Place {
            module: self.place.module + production.strict.len(),
            parameter: self.place.parameter + arity,
        }
    }

    /// Appends the successor of a production whose parameters are bound.
    fn apply(&mut self, number: u32) -> Passed<()> {
        let set = self.layer.set;
        let production = &set.productions[number as usize];
        let successor = &production.successor;
        let before = self.place;
        let after = self.after(production);
        self.out.by_production[number as usize] += successor.kinds.len() as u64;
        match self.layer.decomposition {
            Some(decomposition) => {
                let mut parameters = Vec::new();
                self.machine.run(&successor.program, &mut parameters);
                self.examine(production)?;
                self.expand(decomposition, &successor.kinds, parameters, (before, after))?;
            }
            None => {
                match successor.kinds[..] {
                    [kind] => self.out.kinds.push(kind),
                    _ => self.out.kinds.extend_from_slice(&successor.kinds),
                }
                if !successor.program.is_empty() {
                    self.matcher.looked += successor.program.cost();
                    self.machine.run(&successor.program, &mut self.out.parameters);
                    self.examine(production)?;
                }
            }
        }
        self.place = after;
        if self.task.layers.len() > 1 {
            self.pass_over(before.module..after.module, before.parameter);
        }
        self.bound_size()
    }

    /// A module to which no production applies.
    fn keep(&mut self, kind: u8) -> Passed<()> {
        if self.task.choice == Choice::Reference {
            self.draw_for_nothing(kind);
        }
        if let Some(decomposition) = self.layer.decomposition
            && self.expand_here(decomposition)?
        {
            return self.bound_size();
        }
        if matches!(kind, Alphabet::CUT | Alphabet::REPORTED_CUT) && !self.task.shows {
            self.cut();
            return Ok(());
        }
        if self.task.noted.is_some_and(|noted| noted[kind as usize]) {
            self.out.notes.push((self.out.kinds.len(), self.place.module));
        }
        let before = self.place;
        self.copy(1, self.task.arities[kind as usize] as usize);
        if self.task.layers.len() > 1 {
            self.pass_over(before.module..before.module + 1, before.parameter);
        }
        Ok(())
    }

    /// The reference program draws a number for every module, and sees the letters of `@o` as two.
    fn draw_for_nothing(&mut self, kind: u8) {
        let mut draws = self.task.string.alphabet.kinds()[kind as usize].symbol.len();
        if !matches!(self.layer.set.actions[kind as usize], Action::Keep) {
            draws -= 1;
        }
        for _ in 0..draws {
            self.machine.random.choice(self.place.module, self.task.tick);
        }
    }

    /// Removes everything up to the end of the branch.
    fn cut(&mut self) {
        let string = self.task.string;
        let (mut depth, mut inner) = (0, 0);
        while let Some(&kind) = string.kinds.get(self.place.module) {
            match kind {
                Alphabet::OPEN => depth += 1,
                Alphabet::CLOSE if depth == 0 => return,
                Alphabet::CLOSE => depth -= 1,
                Alphabet::END if inner == 0 && self.nested.len() > 1 => return,
                Alphabet::END if inner > 0 => inner -= 1,
                _ if self.sub_system(kind) => inner += 1,
                _ => {}
            }
            self.place.module += 1;
            self.place.parameter += self.task.arities[kind as usize] as usize;
        }
    }

    fn sub_system(&self, kind: u8) -> bool {
        let kind = &self.task.string.alphabet.kinds()[kind as usize];
        &*kind.symbol == "?" && kind.arity > 0
    }

    /// Goes into and out of the sub-L-systems that these modules of the old string begin and end.
    fn pass_over(&mut self, modules: std::ops::Range<usize>, mut parameter: usize) {
        let string = self.task.string;
        let mut changed = false;
        for &kind in &string.kinds[modules] {
            if kind == Alphabet::END && self.nested.len() > 1 {
                self.nested.pop();
                changed = true;
            } else if self.sub_system(kind) {
                let label = string.parameters[parameter] as i64;
                let named = |layer: &Layer| layer.system.label == label;
                self.nested.push(self.task.layers.iter().position(named).unwrap_or(0));
                changed = true;
            }
            parameter += self.task.arities[kind as usize] as usize;
        }
        if changed {
            self.enter(self.nested[self.nested.len() - 1]);
        }
    }

    /// An error if the last evaluation of a production failed.
    #[inline]
    pub fn examine(&mut self, production: &Production) -> Passed<()> {
        if self.machine.fault.is_none() { Ok(()) } else { Err(self.fault(production)) }
    }

    #[cold]
    fn fault(&mut self, production: &Production) -> Box<DerivationError> {
        let fault = self.machine.fault.take();
        Box::new(DerivationError::Fault {
            place: production.place.clone(),
            what: fault.map(|fault| fault.to_string()).unwrap_or_default(),
            step: self.task.step,
            production: production.text.clone(),
        })
    }

    /// An error if the string has become too large.
    #[inline]
    pub fn bound_size(&self) -> Passed<()> {
        let modules = self.out.kinds.len();
        if modules <= self.task.limits.modules && self.bytes() <= self.task.limits.bytes {
            return Ok(());
        }
        self.check()
    }

    fn bytes(&self) -> usize {
        self.out.kinds.len() + size_of::<f32>() * self.out.parameters.len()
    }

    /// An error if a limit is exceeded.
    pub fn check(&self) -> Passed<()> {
        let (modules, parameters) = (self.out.kinds.len(), self.out.parameters.len());
        let what = match self.task.limits.exceeded(modules, parameters, self.matcher.looked) {
            Some(what) => what,
            None if self.task.deadline.is_some_and(|deadline| Instant::now() > deadline) => {
                "more time than it was given".to_string()
            }
            None => return Ok(()),
        };
        Err(exceeded(&self.task, &self.out.by_production, what))
    }
}

/// Appends the first `count` values of a slice that may have more.
#[inline]
fn append<T: Copy>(out: &mut Vec<T>, values: &[T], count: usize) {
    // A copy of known length is made without a call.
    match values.first_chunk::<SHORT>() {
        Some(chunk) if count <= SHORT => {
            let length = out.len() + count;
            out.extend_from_slice(chunk);
            out.truncate(length);
        }
        _ => out.extend_from_slice(&values[..count]),
    }
}

/// The error about a limit; it names the production that made most of the string.
#[cold]
pub(super) fn exceeded(task: &Task, by_production: &[u64], what: String) -> Box<DerivationError> {
    let layer = task.layers[0];
    let inner = layer.decomposition.iter().flat_map(|set| &set.productions);
    let productions: Vec<&Production> = layer.set.productions.iter().chain(inner).collect();
    let count = |number: &usize| by_production.get(*number).copied().unwrap_or(0);
    let largest = (0..productions.len()).rev().max_by_key(count);
    let Some(production) = largest.and_then(|number| productions.get(number)) else {
        let place = crate::Place { file: "".into(), line: 1, column: 1 };
        let production = String::new();
        return Box::new(DerivationError::Limit { place, what, step: task.step, production });
    };
    Box::new(DerivationError::Limit {
        place: production.place.clone(),
        what,
        step: task.step,
        production: production.text.clone(),
    })
}
