//! A derivation that is interrupted, saved, changed from outside, and continued.

use bioscope_core::{Error, Result, Vec3};
use serde::{Deserialize, Serialize};

use super::{Derivation, DerivationOptions, Shown};
use crate::{Alphabet, LSystem, ModuleString, Pose, Turtle, TurtleOptions};

/// How far a derivation has come: all that is needed to go on with it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    step: u64,
    kinds: Vec<u8>,
    parameters: Vec<f32>,
    ids: Vec<u64>,
    time: f64,
    span: f64,
    length: f64,
    variables: Vec<f64>,
    arrays: Vec<Vec<f64>>,
    offset: u64,
}

/// A module of a string and where the turtle stands at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Number of the module.
    pub module: usize,
    /// Code of its kind.
    pub kind: u8,
    /// How many brackets are open.
    pub depth: u32,
    /// Where the turtle is, metres.
    pub position: Vec3,
    /// Where the turtle looks; unit vector.
    pub heading: Vec3,
}

impl<'a> Derivation<'a> {
    /// How far it has come. The seed is not part of it.
    pub fn progress(&self) -> Progress {
        Progress {
            step: self.step,
            kinds: self.string.kinds.clone(),
            parameters: self.string.parameters.clone(),
            ids: self.ids.clone(),
            time: self.time,
            span: self.span,
            length: self.machine.length,
            variables: self.machine.variables(),
            arrays: self.machine.arrays().to_vec(),
            offset: self.machine.random.offset(),
        }
    }

    /// Goes on from there; the options must have the seed that it began with.
    pub fn resume(
        system: &'a LSystem,
        options: DerivationOptions,
        progress: &Progress,
    ) -> Result<Self> {
        progress.check(system)?;
        let mut derivation = Self::begin(system, options);
        if !derivation.machine.set_variables(&progress.variables, &progress.arrays) {
            return Err(Error::format("derivation", "variables of another model"));
        }
        derivation.machine.random.set_offset(progress.offset);
        derivation.machine.length = progress.length;
        derivation.step = progress.step;
        derivation.string.kinds.clone_from(&progress.kinds);
        derivation.string.parameters.clone_from(&progress.parameters);
        derivation.ids.clone_from(&progress.ids);
        (derivation.time, derivation.span) = (progress.time, progress.span);
        Ok(derivation)
    }
}

impl Progress {
    /// How many steps were made.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// How many modules the string has.
    pub fn modules(&self) -> usize {
        self.kinds.len()
    }

    /// An error if this is no string of this model.
    pub fn check(&self, system: &LSystem) -> Result<()> {
        let kinds = system.alphabet.kinds();
        let arity = |&kind: &u8| kinds.get(kind as usize).map(|one| one.arity as usize);
        let arities: Option<Vec<usize>> = self.kinds.iter().map(arity).collect();
        let fits = arities.is_some_and(|list| list.iter().sum::<usize>() == self.parameters.len())
            && (self.ids.is_empty() || self.ids.len() == self.kinds.len());
        if fits { Ok(()) } else { Err(Error::format("derivation", "a string of another model")) }
    }

    /// The string.
    pub fn string(&self, system: &LSystem) -> ModuleString {
        let mut string = ModuleString::new(system.alphabet.clone());
        string.kinds.clone_from(&self.kinds);
        string.parameters.clone_from(&self.parameters);
        string
    }

    /// What the string looks like: after the `homomorphism:` part.
    pub fn appearance(&self, system: &LSystem, seed: u64) -> Result<ModuleString> {
        let options = DerivationOptions { seed: Some(seed), ..DerivationOptions::default() };
        Ok(Derivation::resume(system, options, self)?.appearance()?)
    }

    /// What the string looks like, and what each of its modules does.
    pub fn shown_by_module(&self, system: &LSystem, seed: u64) -> Result<Shown> {
        let options = DerivationOptions { seed: Some(seed), ..DerivationOptions::default() };
        Ok(Derivation::resume(system, options, self)?.shown_by_module()?)
    }

    /// Codes of the kinds of its modules.
    pub fn kinds(&self) -> &[u8] {
        &self.kinds
    }

    /// Writes the parameters of modules, given in the order of the string.
    pub fn answer(&mut self, system: &LSystem, answers: &[(usize, Vec<f32>)]) {
        let kinds = system.alphabet.kinds();
        let arity = |&kind: &u8| kinds[kind as usize].arity as usize;
        let (mut module, mut first) = (0, 0);
        for (number, answer) in answers {
            first += self.kinds[module..*number].iter().map(arity).sum::<usize>();
            module = *number;
            self.parameters[first..first + answer.len()].copy_from_slice(answer);
        }
    }

    /// Where the turtle stands at every module (before the `homomorphism:` part).
    pub fn places(&self, system: &LSystem, turtle: &TurtleOptions) -> Result<Vec<Placed>> {
        let mut walk = Turtle::walking(&system.alphabet, turtle);
        let kinds = system.alphabet.kinds();
        let mut rest = &self.parameters[..];
        let mut depth = 0_u32;
        let mut placed = Vec::with_capacity(self.kinds.len());
        for (module, &kind) in self.kinds.iter().enumerate() {
            let (parameters, after) = rest.split_at(kinds[kind as usize].arity as usize);
            rest = after;
            if kind == Alphabet::CLOSE {
                depth = depth.saturating_sub(1);
            }
            let Pose { position, frame, .. } = walk.pose();
            placed.push(Placed { module, kind, depth, position, heading: frame.heading });
            depth += u32::from(kind == Alphabet::OPEN);
            walk.read(kind, parameters)?;
        }
        Ok(placed)
    }

    /// Removes modules for which `keep` is false.
    pub fn retain(&mut self, system: &LSystem, keep: impl Fn(usize) -> bool) {
        let kinds = system.alphabet.kinds();
        let (mut parameters, mut first) = (Vec::with_capacity(self.parameters.len()), 0);
        for (module, &kind) in self.kinds.iter().enumerate() {
            let after = first + kinds[kind as usize].arity as usize;
            if keep(module) {
                parameters.extend_from_slice(&self.parameters[first..after]);
            }
            first = after;
        }
        self.parameters = parameters;
        let numbers = 0..self.kinds.len();
        let kept: Vec<usize> = numbers.filter(|&module| keep(module)).collect();
        if !self.ids.is_empty() {
            self.ids = kept.iter().map(|&module| self.ids[module]).collect();
        }
        self.kinds = kept.iter().map(|&module| self.kinds[module]).collect();
    }

    /// Cuts a branch off at a module: removes it and what follows it up to the end of its branch.
    pub fn cut(&mut self, system: &LSystem, module: usize) {
        let end = self.end_of_branch(module);
        self.retain(system, |one| one < module || one >= end);
    }

    /// Number of the bracket that closes the branch of a module; that of modules on the stem.
    pub fn end_of_branch(&self, module: usize) -> usize {
        let mut depth = 0_i64;
        for (number, &kind) in self.kinds.iter().enumerate().skip(module) {
            depth += i64::from(kind == Alphabet::OPEN) - i64::from(kind == Alphabet::CLOSE);
            if depth < 0 {
                return number;
            }
        }
        self.kinds.len()
    }
}
