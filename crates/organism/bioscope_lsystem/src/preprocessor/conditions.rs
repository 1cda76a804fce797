//! `#if` and its companions.

use crate::{
    lexer::{Cursor, Term},
    parser::constant_value,
    source::Origin,
};

/// The conditions that the present line stands in, outermost first.
#[derive(Debug, Default)]
pub(super) struct Conditions(Vec<Condition>);

#[derive(Debug)]
struct Condition {
    origin: Origin,
    holds: bool,
    /// Whether an earlier branch held.
    held: bool,
    /// Whether the surroundings are left out.
    outside: bool,
    in_else: bool,
}

impl Conditions {
    /// Whether the present line is part of the text.
    pub fn hold(&self) -> bool {
        self.0.last().is_none_or(|condition| condition.holds && !condition.outside)
    }

    /// Whether another branch of the innermost condition could hold.
    pub fn may_hold(&self) -> bool {
        self.0.last().is_some_and(|condition| {
            !condition.outside && !condition.held && !condition.holds && !condition.in_else
        })
    }

    pub fn begin(&mut self, origin: Origin, holds: bool) {
        let outside = !self.hold();
        self.0.push(Condition { origin, holds, held: false, outside, in_else: false });
    }

    /// `#elif` or `#else`.
    pub fn otherwise(&mut self, holds: bool, is_else: bool) -> Result<(), String> {
        let condition = self.0.last_mut().ok_or("without '#if'")?;
        if condition.in_else {
            return Err("after '#else'".into());
        }
        condition.held |= condition.holds;
        condition.holds = holds && !condition.held;
        condition.in_else = is_else;
        Ok(())
    }

    pub fn end(&mut self) -> Result<(), String> {
        self.0.pop().map(|_| ()).ok_or_else(|| "without '#if'".into())
    }

    /// Where a condition begins that is not ended.
    pub fn unfinished(&self) -> Option<Origin> {
        self.0.last().map(|condition| condition.origin.clone())
    }
}

/// Value of an expression; unknown names count as zero.
pub(super) fn value(text: &str) -> Result<f64, String> {
    let mut cursor = Cursor::new(text, 0..text.len());
    if cursor.peek_term().0 == Term::End {
        return Err("expected an expression".into());
    }
    constant_value(&mut cursor).ok_or_else(|| format!("'{}' is no expression", text.trim()))
}
