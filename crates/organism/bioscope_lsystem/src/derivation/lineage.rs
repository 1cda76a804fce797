//! What comes from what: which modules of a string have become which in the next, and what each looks like.

use crate::ModuleString;

/// What became of the modules of a string in one step.
#[derive(Clone, Debug, Default)]
pub struct Lineage {
    /// Where what became of some old modules begins, and the first of those; the next entry begins after the last.
    starts: Vec<(usize, usize)>,
    /// Numbers of the old modules before some were cut off; empty if none were.
    numbers: Vec<usize>,
}

impl Lineage {
    pub(super) fn note(&mut self, notes: &[(usize, usize)]) {
        let number = |old: usize| self.numbers.get(old).copied().unwrap_or(old);
        self.starts = notes.iter().map(|&(new, old)| (new, number(old))).collect();
    }

    pub(super) fn old_numbers(&mut self, numbers: Vec<usize>) {
        self.numbers = numbers;
    }

    /// Takes away new modules for which `keep` is false.
    pub fn retain(&mut self, keep: impl Fn(usize) -> bool) {
        let (mut seen, mut left) = (0, 0);
        for (new, _) in &mut self.starts {
            left += (seen..*new).filter(|&module| keep(module)).count();
            seen = *new;
            *new = left;
        }
    }

    /// Every group of old modules with what became of them: both as ranges of numbers. The strings have so many.
    pub(crate) fn groups(
        &self,
        old: usize,
        new: usize,
    ) -> impl Iterator<Item = (std::ops::Range<usize>, std::ops::Range<usize>)> {
        let ends = self.starts.iter().skip(1).copied().chain([(new, old)]);
        self.starts.iter().zip(ends).map(|(&(made, first), (end, last))| (first..last, made..end))
    }
}

/// What a string looks like, and where in that each of its modules begins.
#[derive(Clone, Debug)]
pub struct Shown {
    /// What the turtle reads.
    pub string: ModuleString,
    /// By module of the string that is shown; one more at the end.
    first: Vec<usize>,
}

impl Shown {
    pub(super) fn new(string: ModuleString, notes: &[(usize, usize)], modules: usize) -> Self {
        let mut first = vec![string.len(); modules + 1];
        let mut end = modules;
        for &(shown, module) in notes.iter().rev() {
            // Modules that were replaced together with this one have nothing of their own.
            let next = first[end];
            first[module + 1..end].fill(next);
            first[module] = shown;
            end = module;
        }
        Self { string, first }
    }

    /// How many modules the string has that is shown.
    pub(crate) fn modules(&self) -> usize {
        self.first.len() - 1
    }

    /// What these modules look like, as numbers in [`Self::string`].
    pub(crate) fn of(&self, modules: std::ops::Range<usize>) -> std::ops::Range<usize> {
        self.first[modules.start]..self.first[modules.end]
    }
}
