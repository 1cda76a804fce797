//! Productions, their predecessors and successors.

use super::{
    Parsed, Parser, Part, SyntaxError,
    expression::{ExpressionParser, Scope},
};
use crate::{
    expression::{Expression, Instruction, SLOT_LIMIT},
    lexer::{Cursor, Term, Word},
    model::{Pattern, Production, Successor},
};

/// How many parameters one module may have.
const ARITY_LIMIT: usize = 64;

impl Parser<'_> {
    pub(super) fn production_statement(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        skip_label(cursor);
        let span = cursor.peek_word().1;
        let start = span.start;
        let production = self.production(cursor)?;
        let context = !production.left.is_empty() || !production.right.is_empty();
        if self.part != Part::Rewriting && (context || production.strict.len() != 1) {
            let message = "not supported: context in a decomposition or homomorphism";
            return Err(SyntaxError::new(start..start + 1, message));
        }
        self.sets[self.part as usize].list.push(production);
        Ok(())
    }

    fn production(&mut self, cursor: &mut Cursor) -> Parsed<Production> {
        let place = self.source.place(cursor.peek_word().1.start);
        let text = first_line(cursor.rest());
        let mut scope = Scope::new();
        let (left, strict, right) = self.predecessor(cursor, &mut scope)?;
        let (mut before, mut after, mut condition) = (Vec::new(), Vec::new(), None);
        if cursor.peek_word().0 == Word::Colon {
            cursor.position = cursor.peek_word().1.end;
            before = self.block(cursor, &mut scope)?;
            condition = self.condition(cursor, &scope)?;
            after = self.block(cursor, &mut scope)?;
        }
        match cursor.peek_word() {
            (Word::Arrow, span) => cursor.position = span.end,
            (Word::ObjectArrow, span) => {
                return Err(SyntaxError::new(span, "not supported: object productions"));
            }
            (_, span) => return Err(SyntaxError::unexpected(cursor, span, "'-->'")),
        }
        let successor = self.successor(cursor, &scope)?;
        let mut probability = None;
        if cursor.peek_word().0 == Word::Colon {
            cursor.position = cursor.peek_word().1.end;
            probability = Some(self.expression(cursor, &scope)?);
        }
        match cursor.peek_term() {
            (Term::End, _) => {}
            (_, span) => {
                let expected = "a module, ':' or the end of the line";
                return Err(SyntaxError::unexpected(cursor, span, expected));
            }
        }
        let expressions = condition.iter().chain(&probability).chain(&successor.arguments);
        let programs = before.len() + after.len() + left.len() + strict.len() + right.len();
        let cost = programs as u64 + expressions.map(Expression::cost).sum::<u64>();
        Ok(Production {
            cost,
            left,
            strict,
            right,
            before,
            condition,
            after,
            successor,
            probability,
            place,
            text,
        })
    }

    fn predecessor(
        &mut self,
        cursor: &mut Cursor,
        scope: &mut Scope,
    ) -> Parsed<(Vec<Pattern>, Vec<Pattern>, Vec<Pattern>)> {
        let start = cursor.peek_word().1;
        let (mut left, mut right) = (Vec::new(), Vec::new());
        let mut strict = self.patterns(cursor, scope)?;
        if cursor.peek_word().0 == Word::Less {
            cursor.position = cursor.peek_word().1.end;
            left = std::mem::replace(&mut strict, self.patterns(cursor, scope)?);
            if left.iter().any(|pattern| pattern.is_bracket()) {
                return Err(SyntaxError::new(start, "brackets are allowed in right contexts only"));
            }
        }
        if cursor.peek_word().0 == Word::Greater {
            cursor.position = cursor.peek_word().1.end;
            right = self.patterns(cursor, scope)?;
        }
        if strict.is_empty() {
            return Err(SyntaxError::unexpected(cursor, start, "a module to be replaced"));
        }
        Ok((left, strict, right))
    }

    /// Modules with names as parameters, up to something else.
    fn patterns(&mut self, cursor: &mut Cursor, scope: &mut Scope) -> Parsed<Vec<Pattern>> {
        let mut patterns = Vec::new();
        if cursor.peek_word().0 == Word::Star {
            cursor.position = cursor.peek_word().1.end;
            return Ok(patterns);
        }
        while let (Word::Symbol, span) = cursor.peek_word() {
            cursor.position = span.end;
            let slot = scope.len();
            if cursor.peek_word().0 == Word::Open {
                self.formals(cursor, scope)?;
            }
            let arity = scope.len() - slot;
            let kind = self.kind(cursor.slice(span.clone()), arity, span)?;
            patterns.push(Pattern { kind, arity: arity as u8, slot: slot as u8 });
        }
        Ok(patterns)
    }

    fn formals(&mut self, cursor: &mut Cursor, scope: &mut Scope) -> Parsed<()> {
        cursor.position = cursor.peek_term().1.end;
        loop {
            let (token, span) = cursor.peek_term();
            if token != Term::Name {
                let expected = "the name of a parameter";
                return Err(SyntaxError::unexpected(cursor, span, expected));
            }
            declare(cursor, scope, cursor.slice(span.clone()))?;
            cursor.position = span.end;
            let (token, span) = cursor.peek_term();
            match token {
                Term::Comma => cursor.position = span.end,
                Term::Close => {
                    cursor.position = span.end;
                    return Ok(());
                }
                _ => return Err(SyntaxError::unexpected(cursor, span, "',' or ')'")),
            }
        }
    }

    fn condition(&mut self, cursor: &mut Cursor, scope: &Scope) -> Parsed<Option<Expression>> {
        match cursor.peek_term() {
            (Term::Arrow | Term::OpenBlock, _) => Ok(None),
            (Term::Star, span) => {
                cursor.position = span.end;
                Ok(None)
            }
            _ => self.expression(cursor, scope).map(Some),
        }
    }

    fn expression(&mut self, cursor: &mut Cursor, scope: &Scope) -> Parsed<Expression> {
        ExpressionParser::new(cursor, scope, &mut self.unknown).parse()
    }

    /// `{ name = expression; … }`, if there is one.
    fn block(&mut self, cursor: &mut Cursor, scope: &mut Scope) -> Parsed<Vec<Instruction>> {
        let mut program = Vec::new();
        if cursor.peek_term().0 != Term::OpenBlock {
            return Ok(program);
        }
        cursor.position = cursor.peek_term().1.end;
        loop {
            let (token, span) = cursor.peek_term();
            cursor.position = span.end;
            match token {
                Term::CloseBlock => return Ok(program),
                Term::Semicolon => continue,
                Term::Name => {}
                _ => return Err(SyntaxError::unexpected(cursor, span, "a name or '}'")),
            }
            let name = cursor.slice(span.clone());
            let (token, next) = cursor.peek_term();
            if token != Term::Assign {
                let message = format!("not supported: '{name}' other than an assignment");
                return Err(SyntaxError::new(span, message));
            }
            cursor.position = next.end;
            let value = ExpressionParser::new(cursor, scope, &mut self.unknown).parse_program()?;
            program.extend(value);
            if !scope.iter().any(|known| known == name) {
                declare(cursor, scope, name)?;
            }
            let slot = scope.iter().position(|known| known == name).unwrap_or(0);
            program.push(Instruction::Store(slot as u8));
            let (token, span) = cursor.peek_term();
            if !matches!(token, Term::Semicolon | Term::CloseBlock) {
                return Err(SyntaxError::unexpected(cursor, span, "';'"));
            }
        }
    }

    /// Modules with expressions as parameters, up to something else; `*` for none.
    pub(super) fn successor(&mut self, cursor: &mut Cursor, scope: &Scope) -> Parsed<Successor> {
        let mut successor = Successor::default();
        let (token, span) = cursor.peek_word();
        if token == Word::Star {
            cursor.position = span.end;
            return Ok(successor);
        }
        let start = span;
        while let (Word::Symbol, span) = cursor.peek_word() {
            cursor.position = span.end;
            let before = successor.arguments.len();
            if cursor.peek_word().0 == Word::Open {
                self.arguments(cursor, scope, &mut successor.arguments)?;
            }
            let arity = successor.arguments.len() - before;
            successor.kinds.push(self.kind(cursor.slice(span.clone()), arity, span)?);
        }
        if successor.kinds.is_empty() {
            let (_, span) = cursor.peek_word();
            return Err(SyntaxError::unexpected(cursor, span, "a module, or '*' for nothing"));
        }
        if !is_balanced(&successor.kinds) {
            let message = "the brackets of this string do not match";
            self.unknown_brackets(SyntaxError::new(start.start..cursor.position, message));
        }
        Ok(successor)
    }

    fn unknown_brackets(&mut self, warning: SyntaxError) {
        if self.warnings.len() < super::REPORT_LIMIT {
            self.warnings.push(self.diagnostic(warning));
        }
    }

    fn arguments(
        &mut self,
        cursor: &mut Cursor,
        scope: &Scope,
        arguments: &mut Vec<Expression>,
    ) -> Parsed<()> {
        cursor.position = cursor.peek_term().1.end;
        loop {
            let argument = self.expression(cursor, scope)?;
            arguments.push(argument);
            let (token, span) = cursor.peek_term();
            match token {
                Term::Comma => cursor.position = span.end,
                Term::Close => {
                    cursor.position = span.end;
                    return Ok(());
                }
                _ => {
                    let expected = "',' or ')' after a parameter";
                    return Err(SyntaxError::unexpected(cursor, span, expected));
                }
            }
        }
    }

    fn kind(&mut self, symbol: &str, arity: usize, span: std::ops::Range<usize>) -> Parsed<u8> {
        if arity > ARITY_LIMIT {
            let message = format!("a module with {arity} parameters; at most {ARITY_LIMIT}");
            return Err(SyntaxError::new(span, message));
        }
        if let Some(feature) = unsupported(symbol, arity) {
            return Err(SyntaxError::new(span, format!("not supported: {feature}")));
        }
        let code = self.alphabet.intern(symbol, arity as u8);
        code.ok_or_else(|| SyntaxError::new(span, "more than 256 different kinds of module"))
    }
}

impl Pattern {
    fn is_bracket(&self) -> bool {
        matches!(self.kind, crate::Alphabet::OPEN | crate::Alphabet::CLOSE)
    }
}

/// Symbols of the reference program whose meaning this engine would silently miss.
fn unsupported(symbol: &str, arity: usize) -> Option<&'static str> {
    match symbol {
        "%" if arity > 0 => Some("messages about what a cut removes"),
        "?P" | "?H" | "?L" | "?U" => Some("query modules"),
        "?E" => Some("communication modules"),
        "$" => Some("sub-L-systems"),
        "@PS" | "@PC" | "@PD" => Some("string-defined patches"),
        "@L" => Some("labels"),
        _ => None,
    }
}

/// Passes over the number of a production, as in `p12: A --> B`.
fn skip_label(cursor: &mut Cursor) {
    let rest = cursor.rest();
    let Some(colon) = rest.find(':') else { return };
    let label = rest[..colon].trim();
    let mut letters = label.chars();
    let numbered =
        letters.next() == Some('p') && letters.next().is_some_and(|c| c.is_ascii_digit());
    if numbered && letters.all(|letter| letter.is_ascii_alphanumeric()) {
        cursor.position += colon + 1;
    }
}

fn declare(cursor: &Cursor, scope: &mut Scope, name: &str) -> Parsed<()> {
    let span = cursor.peek_term().1;
    if scope.iter().any(|known| known == name) {
        return Err(SyntaxError::new(span, format!("parameter '{name}' has a namesake here")));
    }
    if scope.len() >= SLOT_LIMIT {
        let message = format!("more than {SLOT_LIMIT} parameters and variables in a production");
        return Err(SyntaxError::new(span, message));
    }
    scope.push(name.to_string());
    Ok(())
}

fn is_balanced(kinds: &[u8]) -> bool {
    let mut depth = 0_i64;
    for &kind in kinds {
        depth +=
            i64::from(kind == crate::Alphabet::OPEN) - i64::from(kind == crate::Alphabet::CLOSE);
        if depth < 0 {
            return false;
        }
    }
    depth == 0
}

fn first_line(text: &str) -> String {
    const LONGEST: usize = 100;
    text.trim_start().lines().next().unwrap_or("").trim_end().chars().take(LONGEST).collect()
}
