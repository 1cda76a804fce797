//! Timed modules: `timed:`, `growth:` and `after`.

use super::{Parsed, Parser, SyntaxError, names::Scope};
use crate::{
    lexer::{Cursor, Term},
    machine::{Instruction, Program},
    model::Timing,
};

/// Between a predecessor and the age at which it is replaced.
const AFTER: &str = "after ";

impl Parser<'_> {
    /// Seconds per step; the modules that are declared from here on have an age.
    pub(super) fn timed(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let span = cursor.peek_term().1;
        let step = self.number(cursor)?;
        if !(0.0..=1e9).contains(&step) || !self.is_own() {
            let message = "expected seconds per step, in a file of our own notation (.lsys)";
            return Err(SyntaxError::new(span, message));
        }
        self.timed = Some(step);
        self.names.is_timed = true;
        Ok(())
    }

    /// `module = expression, …`: what a timed module shows in place of its age and parameters.
    pub(super) fn growth(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let (token, span) = cursor.peek_term();
        let symbol = cursor.slice(span.clone()).to_string();
        let declared = self.declared.iter().find(|(known, _)| *known == symbol);
        let Some((_, names)) = declared.filter(|_| token == Term::Name && self.timed.is_some())
        else {
            return Err(SyntaxError::unexpected(cursor, span, "the name of a timed module"));
        };
        let mut scope: Scope = names.clone();
        let arity = scope.len();
        cursor.position = span.end;
        let (token, equals) = cursor.peek_term();
        if token != Term::Assign {
            return Err(SyntaxError::unexpected(cursor, equals, "'='"));
        }
        cursor.position = equals.end;
        let mut compiler = self.compiler(cursor, &mut scope);
        let mut count = 0;
        loop {
            let value = compiler.expression()?;
            let from = compiler.register(value)?;
            compiler.emit(Instruction::Emit { from })?;
            compiler.temporaries = 0;
            count += 1;
            match compiler.cursor.peek_term().0 {
                Term::Comma => compiler.take(),
                Term::End => break,
                _ => return Err(compiler.unexpected("',' or the end of the line")),
            }
        }
        let program = Program(compiler.code.into());
        let kind = self.kind(&symbol, arity, span.clone())?;
        let shown = self.kind(&symbol, count, span)?;
        self.growth.push((kind, shown, program));
        Ok(())
    }

    /// Whether the word `after` of a timed model comes next.
    pub(super) fn is_after(&self, cursor: &Cursor) -> bool {
        self.timed.is_some() && cursor.words().starts_with(AFTER)
    }

    /// The age at which the predecessor is replaced, if it is given.
    pub(super) fn after(
        &mut self,
        cursor: &mut Cursor,
        scope: &mut Scope,
    ) -> Parsed<Option<Program>> {
        if !self.is_after(cursor) {
            return Ok(None);
        }
        let rest = cursor.rest();
        cursor.position += rest.len() - rest.trim_start().len() + AFTER.len();
        let mut compiler = self.compiler(cursor, scope);
        let value = compiler.expression()?;
        Ok(Some(compiler.returning(value)?))
    }

    pub(super) fn timing(&mut self) -> Option<Timing> {
        let step = self.timed?;
        let mut is_timed = Box::new([false; 256]);
        for (code, kind) in self.alphabet.kinds().iter().enumerate() {
            let declared = self.declared.iter();
            is_timed[code] = declared.into_iter().any(|(name, parameters)| {
                **name == *kind.symbol && parameters.len() == kind.arity as usize
            });
        }
        let mut growth = vec![None; 256];
        for (kind, shown, program) in std::mem::take(&mut self.growth) {
            growth[kind as usize] = Some((shown, program));
        }
        Some(Timing { step, is_timed, growth })
    }
}
