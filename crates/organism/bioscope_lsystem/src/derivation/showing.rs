//! What a string looks like: after the productions of the `homomorphism:` part.

use super::{
    Choice, Derivation, DerivationOptions, Derived, Shown, parallel,
    pass::{Layer, Made, Task},
};
use crate::{LSystem, ModuleString, context::Groups, model::ProductionSet};

/// Tells the random numbers of this from those of the step.
const APPEARANCE: u64 = 2 << 20;

/// Which modules are noted of what they look like.
#[derive(Clone, Copy)]
pub(super) enum Noted<'a> {
    Nothing,
    /// Copies of modules of these kinds.
    Kinds(&'a [bool]),
    /// Where what each module looks like begins.
    All,
}

impl LSystem {
    /// What the modules of a string look like: the string after the productions of the file's
    /// `homomorphism:` part, or the string itself if there is none.
    pub fn appearance(
        &self,
        string: &ModuleString,
        seed: impl Into<Option<u64>>,
    ) -> Derived<ModuleString> {
        let is_plain = self.systems.iter().all(|system| system.homomorphism.is_none());
        if is_plain && self.timing.is_none() {
            return Ok(string.clone());
        }
        let options = DerivationOptions { seed: seed.into(), ..Default::default() };
        let mut derivation = Derivation::begin(self, options);
        if let Some(memory) = &string.memory {
            derivation.machine.recall(memory);
            derivation.step = memory.step;
        }
        Ok(derivation.shown(string, Noted::Nothing)?.0)
    }
}

impl<'a> Derivation<'a> {
    /// What the string looks like now: after the productions of the `homomorphism:` part.
    pub fn appearance(&self) -> Derived<ModuleString> {
        Ok(self.to_show().shown(&self.string, Noted::Nothing)?.0)
    }

    /// What the string looks like now, and what each of its modules does.
    pub fn shown_by_module(&self) -> Derived<Shown> {
        let (string, notes) = self.to_show().shown(&self.string, Noted::All)?;
        Ok(Shown::new(string, &notes, self.string.len()))
    }

    /// A derivation at the same place that may be spoiled.
    fn to_show(&self) -> Derivation<'a> {
        let mut show = Self::begin(
            self.system,
            DerivationOptions { seed: self.options.seed, ..Default::default() },
        );
        show.machine.recall(&self.machine.memory(self.step));
        show.machine.functions = self.machine.functions.clone();
        show.step = self.step;
        show
    }

    /// What a string looks like; with the numbers of noted modules in that and in the string.
    pub(super) fn shown(
        &mut self,
        string: &ModuleString,
        noted: Noted,
    ) -> Derived<(ModuleString, Vec<(usize, usize)>)> {
        let nothing = ProductionSet::new(Vec::new(), 1);
        let grown = self.grown(string);
        let string = &grown;
        let systems = self.system.systems.iter();
        let layers: Vec<Layer> = systems
            .map(|system| Layer {
                system,
                set: &nothing,
                decomposition: system.homomorphism.as_ref(),
            })
            .collect();
        let groups = Groups::default();
        let task = Task {
            string,
            groups: &groups,
            layers: &layers,
            arities: &self.arities,
            choice: match self.choice() {
                // What has no production draws no number here.
                Choice::Reference => Choice::First,
                other => other,
            },
            limits: self.options.limits,
            deadline: self.deadline,
            step: self.step,
            tick: (self.step << 22) | APPEARANCE,
            shows: true,
            noted: match noted {
                Noted::Kinds(kinds) => Some(kinds),
                _ => None,
            },
            traced: matches!(noted, Noted::All),
            only: None,
        };
        let (made, looked) = parallel::one_after_the_other(
            task,
            &mut self.machine,
            self.operations,
            Made::default(),
        )?;
        self.operations = looked;
        let mut shown = ModuleString::new(self.system.alphabet.clone());
        shown.kinds = made.kinds;
        shown.parameters = made.parameters;
        Ok((shown, made.notes))
    }
}
