//! Symbols of several letters, `@o` and `~l`, as the reference program reads them: a module per letter.
//!
//! That matters only to models whose productions name one of these letters alone, such as
//! `K(s) --> K(s*1.1)` for the flower `~K(1)`. For all others a symbol is one module here.

use std::{collections::BTreeSet, ops::Range};

use super::{Parser, SyntaxError};
use crate::{diagnostic::suggestion, lexer::Cursor};

/// What begins a symbol of several letters.
pub(crate) const PREFIXES: [char; 2] = ['@', '~'];

impl Parser<'_> {
    /// Whether a production of a model of the reference dialect sees a single letter of a symbol of
    /// several letters, or such a symbol is written in parts.
    pub(super) fn splits_symbols(&self) -> bool {
        if self.is_own() {
            return false;
        }
        if !self.errors.is_empty() {
            return self.source.expanded.contains(PREFIXES);
        }
        let kinds = self.alphabet.kinds();
        let letters: BTreeSet<char> = kinds
            .iter()
            .filter(|kind| kind.symbol.len() > 1 && kind.symbol.starts_with(PREFIXES))
            .flat_map(|kind| kind.symbol.chars())
            .collect();
        let is_letter = |code: u8| {
            let mut symbol = kinds[code as usize].symbol.chars();
            symbol.next().is_some_and(|letter| letters.contains(&letter)) && symbol.next().is_none()
        };
        self.drafts.iter().any(|draft| {
            let rewriting = draft.rewriting.iter().map(|(_, production)| production);
            let others = draft.decomposition.list.iter().chain(&draft.homomorphism.list);
            rewriting.chain(others).any(|production| {
                let patterns = production.left.iter().chain(&production.strict);
                patterns.chain(&production.right).any(|pattern| is_letter(pattern.kind))
            })
        })
    }

    /// Warns of letters in a row that are nearly the name of a declared module; `word` are those so
    /// far.
    pub(super) fn spelled(
        &mut self,
        cursor: &Cursor,
        word: &mut Range<usize>,
        letter: Range<usize>,
    ) {
        let is_letter = letter.len() == 1
            && cursor.slice(letter.clone()).starts_with(|one: char| one.is_ascii_alphabetic());
        let start = if word.end == letter.start && word.start < word.end {
            word.start
        } else {
            letter.start
        };
        *word = if is_letter { start..letter.end } else { letter.end..letter.end };
        let goes_on = cursor.rest().starts_with(|one: char| one.is_ascii_alphabetic());
        if goes_on || word.len() < 2 {
            return;
        }
        let name = cursor.slice(word.clone());
        let known = self.declared.iter().map(|(known, _)| known.as_str());
        if let Some(meant) = suggestion(name, known) {
            let message = format!("'{name}' is read as {} modules of one letter", name.len());
            let mut warning = SyntaxError::new(word.clone(), message);
            warning.help = Some(format!("did you mean '{meant}'?"));
            self.warn(warning);
        }
    }

    /// Warns of a declared module with another number of parameters.
    pub(super) fn check_arity(&mut self, symbol: &str, arity: usize, span: Range<usize>) {
        let declared = self.declared.iter().find(|(known, _)| known == symbol);
        // The age of a timed module is declared for it, and never given.
        let given = |names: &Vec<String>| names.len() - usize::from(self.timed.is_some());
        let Some(count) = declared.map(|(_, names)| given(names)).filter(|&count| count != arity)
        else {
            return;
        };
        let parameters = if count == 1 { "parameter" } else { "parameters" };
        let message = format!("'{symbol}' is declared with {count} {parameters}, found {arity}");
        self.warn(SyntaxError::new(span, message));
    }
}
