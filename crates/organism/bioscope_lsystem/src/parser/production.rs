//! Productions, their predecessors and successors.

use std::ops::Range;

use super::{
    Parsed, Parser, Part, SyntaxError,
    expression::{Compiler, Operand},
    names::Scope,
};
use crate::{
    Alphabet,
    lexer::{Cursor, Term, Word},
    machine::{Instruction, Program, SLOT_LIMIT, end_with_emission, with_early_ends},
    model::{Pattern, Production, RightContext, Successor},
};

/// How many parameters one module may have.
const ARITY_LIMIT: usize = 64;

/// The three parts of a predecessor.
struct Predecessor {
    left: Vec<Pattern>,
    strict: Vec<Pattern>,
    right: Vec<Pattern>,
}

/// A module of a predecessor before its parameters have slots.
struct Formal {
    kind: u8,
    names: Vec<(String, Range<usize>)>,
}

impl Parser<'_> {
    pub(super) fn production_statement(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        skip_label(cursor, self.is_own());
        let production = self.production(cursor)?;
        let part = self.part;
        self.draft().add(part, production);
        Ok(())
    }

    fn production(&mut self, cursor: &mut Cursor) -> Parsed<Production> {
        let place = self.source.place(cursor.peek_word().1.start);
        let text = first_line(cursor.rest());
        let mut scope = Scope::new();
        let Predecessor { left, strict, right } = self.predecessor(cursor, &mut scope)?;
        let after = self.after(cursor, &mut scope)?;
        let (test, mut rest) = match cursor.peek_word() {
            (Word::Colon, span) => {
                cursor.position = span.end;
                self.condition(cursor, &mut scope)?
            }
            _ => Default::default(),
        };
        match cursor.peek_word() {
            (Word::Arrow | Word::ObjectArrow, span) => cursor.position = span.end,
            (_, span) => return Err(without_arrow(cursor, span)),
        }
        let kinds = self.successor(cursor, &mut scope, &mut rest)?;
        let mut probability = None;
        if let (Word::Colon, span) = cursor.peek_word() {
            cursor.position = span.end;
            let mut compiler = self.compiler(cursor, &mut scope);
            let value = compiler.expression()?;
            probability = Some(compiler.returning(value)?);
        }
        if let (token, span) = cursor.peek_term()
            && token != Term::End
        {
            let expected = "a module, ':' or the end of the line";
            return Err(SyntaxError::unexpected(cursor, span, expected));
        }
        let program = Program(rest.into());
        let parameters: usize = strict.iter().map(|pattern| pattern.arity as usize).sum();
        let keeps_parameters = strict.len() == 1
            && !test.writes_below(parameters)
            && !probability.as_ref().is_some_and(|program| program.writes_below(parameters));
        let is_random = test.is_random()
            || program.is_random()
            || probability.as_ref().is_some_and(Program::is_random);
        let patterns = left.len() + strict.len() + right.len();
        let is_simple = patterns == 1 && strict.len() == 1 && probability.is_none() && !is_random;
        let cost = test.cost() + program.cost() + probability.as_ref().map_or(0, Program::cost);
        Ok(Production {
            left,
            strict,
            right,
            test,
            probability,
            after,
            successor: Successor { kinds, program },
            slots: scope.len(),
            keeps_parameters,
            is_simple,
            is_random,
            place,
            text,
            cost: cost + patterns as u64,
        })
    }

    /// The program of what precedes the arrow, and what is to be done before the successor.
    fn condition(
        &mut self,
        cursor: &mut Cursor,
        scope: &mut Scope,
    ) -> Parsed<(Program, Vec<Instruction>)> {
        let is_own = self.is_own();
        let mut compiler = self.compiler(cursor, scope);
        compiler.block()?;
        let value = match compiler.cursor.peek_term() {
            (Term::Arrow | Term::OpenBlock, _) => Operand::Constant(1.0),
            (Term::Star, span) => {
                compiler.cursor.position = span.end;
                Operand::Constant(1.0)
            }
            _ => compiler.expression()?,
        };
        let before = std::mem::take(&mut compiler.code);
        compiler.temporaries = 0;
        compiler.block()?;
        let mut after = std::mem::take(&mut compiler.code);
        compiler.code = before;
        let always = value == Operand::Constant(1.0);
        if is_own && !after.is_empty() {
            // Here the probability may depend on what is computed after the condition.
            if let Operand::Register(test) = value {
                let skip = compiler.emit(Instruction::JumpIfFalse { test, distance: 0 })?;
                compiler.code.append(&mut after);
                let from = compiler.register(Operand::Constant(1.0))?;
                compiler.emit(Instruction::Return { from })?;
                compiler.land(skip);
            } else {
                compiler.code.append(&mut after);
            }
        }
        if always && compiler.code.is_empty() {
            return Ok((Program::default(), after));
        }
        let one = compiler.register(Operand::Constant(1.0))?;
        let program = compiler.returning(value)?;
        Ok((Program(with_early_ends(program.0.into_vec(), one).into()), after))
    }

    fn predecessor(&mut self, cursor: &mut Cursor, scope: &mut Scope) -> Parsed<Predecessor> {
        let start = cursor.peek_word().1;
        let (mut left, mut right) = (Vec::new(), Vec::new());
        let mut strict = self.formals(cursor)?;
        if let (Word::Less, span) = cursor.peek_word() {
            cursor.position = span.end;
            left = std::mem::replace(&mut strict, self.formals(cursor)?);
        }
        if let (Word::Greater, span) = cursor.peek_word() {
            cursor.position = span.end;
            right = self.formals(cursor)?;
        }
        if strict.is_empty() {
            return Err(SyntaxError::unexpected(cursor, start, "a module to be replaced"));
        }
        // The parameters of the strict predecessor come first: all its productions share them.
        let strict = bind(scope, strict)?;
        let left = bind(scope, left)?;
        let right = bind(scope, right)?;
        if left.iter().any(Pattern::is_bracket) {
            return Err(SyntaxError::new(start, "brackets are allowed in right contexts only"));
        }
        let needs_balance = self.draft().right_context != RightContext::Reference;
        if needs_balance && !is_balanced(right.iter().map(|pattern| pattern.kind)) {
            return Err(SyntaxError::new(start, "the brackets of this context do not match"));
        }
        Ok(Predecessor { left, strict, right })
    }

    /// Modules with names as parameters, up to something else.
    fn formals(&mut self, cursor: &mut Cursor) -> Parsed<Vec<Formal>> {
        let mut formals = Vec::new();
        if let (Word::Star, span) = cursor.peek_word() {
            cursor.position = span.end;
            return Ok(formals);
        }
        while let (Word::Symbol, span) = cursor.peek_word() {
            if self.is_after(cursor) {
                break;
            }
            cursor.position = span.end;
            let symbol = cursor.slice(span.clone()).to_string();
            let names = match cursor.peek_word().0 {
                Word::Open => formal_names(cursor)?,
                // A declared module may be named without its parameters.
                _ => {
                    let names = self.declared_names(&symbol).into_iter();
                    names.map(|name| (name, span.clone())).collect()
                }
            };
            let names = self.with_age(&symbol, names, &span);
            let kind = self.kind(&symbol, names.len(), span)?;
            formals.push(Formal { kind, names });
        }
        Ok(formals)
    }

    /// In a timed model the first parameter of a declared module is its age, which is not written;
    /// but what a `growth:` line lets it show has the numbers of that line alone.
    fn with_age(
        &self,
        symbol: &str,
        mut names: Vec<(String, Range<usize>)>,
        span: &Range<usize>,
    ) -> Vec<(String, Range<usize>)> {
        let is_declared = self.declared.iter().any(|(known, _)| known == symbol);
        let has_age = names.first().is_some_and(|(name, _)| name == "age");
        let shows_else = self.part == Part::Homomorphism
            && self
                .growth
                .iter()
                .any(|&(kind, ..)| *self.alphabet.kinds()[kind as usize].symbol == *symbol);
        if self.timed.is_some() && is_declared && !has_age && !shows_else {
            names.insert(0, ("age".into(), span.clone()));
        }
        names
    }

    fn declared_names(&self, symbol: &str) -> Vec<String> {
        let declared = self.declared.iter().find(|(known, _)| known == symbol);
        declared.map(|(_, names)| names.clone()).unwrap_or_default()
    }

    /// The axiom.
    pub(super) fn axiom_word(&mut self, cursor: &mut Cursor) -> Parsed<Successor> {
        let mut code = Vec::new();
        let kinds = self.successor(cursor, &mut Scope::new(), &mut code)?;
        let (token, span) = cursor.peek_word();
        if token != Word::End {
            return Err(SyntaxError::unexpected(cursor, span, "a module"));
        }
        Ok(Successor { kinds, program: Program(code.into()) })
    }

    /// Modules with expressions as parameters, up to something else; `*` for none. The code that
    /// computes the parameters is appended.
    fn successor(
        &mut self,
        cursor: &mut Cursor,
        scope: &mut Scope,
        code: &mut Vec<Instruction>,
    ) -> Parsed<Vec<u8>> {
        let mut kinds = Vec::new();
        let (token, start) = cursor.peek_word();
        if token == Word::Star {
            cursor.position = start.end;
            return Ok(kinds);
        }
        let mut word = start.start..start.start;
        while let (Word::Symbol, span) = cursor.peek_word() {
            cursor.position = span.end;
            let symbol = cursor.slice(span.clone()).to_string();
            self.spelled(cursor, &mut word, span.clone());
            let mut arity = 0;
            let is_timed =
                self.timed.is_some() && self.declared.iter().any(|(known, _)| *known == symbol);
            if cursor.peek_word().0 == Word::Open || is_timed {
                let mut compiler = self.compiler(cursor, scope);
                compiler.code = std::mem::take(code);
                if is_timed {
                    let from = compiler.register(Operand::Constant(0.0))?;
                    compiler.emit(Instruction::Emit { from })?;
                }
                let is_told = compiler.cursor.peek_word().0 == Word::Open;
                if is_told {
                    arity = arguments(&mut compiler)?;
                }
                *code = compiler.code;
                if is_told {
                    self.check_arity(&symbol, arity, span.clone());
                }
                arity += usize::from(is_timed);
            } else {
                arity += self.implied(&symbol, cursor, scope, code)?;
            }
            kinds.push(self.kind(&symbol, arity, span)?);
        }
        if kinds.is_empty() {
            let (_, span) = cursor.peek_word();
            return Err(SyntaxError::unexpected(cursor, span, "a module, or '*' for nothing"));
        }
        if !is_balanced(kinds.iter().copied()) {
            let message = "the brackets of this string do not match";
            self.warn(SyntaxError::new(start.start..cursor.position, message));
        }
        Ok(kinds)
    }

    /// A declared module without parameters keeps those of the same names, others are zero.
    fn implied(
        &mut self,
        symbol: &str,
        cursor: &mut Cursor,
        scope: &mut Scope,
        code: &mut Vec<Instruction>,
    ) -> Parsed<usize> {
        let names = self.declared_names(symbol);
        let mut compiler = self.compiler(cursor, scope);
        compiler.code = std::mem::take(code);
        for name in &names {
            let known = compiler.variable(name);
            let from = match known {
                Some(register) => register,
                None => compiler.register(Operand::Constant(0.0))?,
            };
            compiler.emit(Instruction::Emit { from })?;
        }
        *code = compiler.code;
        Ok(names.len())
    }

    pub(super) fn kind(&mut self, symbol: &str, arity: usize, span: Range<usize>) -> Parsed<u8> {
        if arity > ARITY_LIMIT {
            let message = format!("a module with {arity} parameters; at most {ARITY_LIMIT}");
            return Err(SyntaxError::new(span, message));
        }
        let code = self.alphabet.intern(symbol, arity as u8);
        code.ok_or_else(|| SyntaxError::new(span, "more than 256 different kinds of module"))
    }
}

/// A statement without an arrow; one that is nearly an arrow is pointed at.
fn without_arrow(cursor: &Cursor, span: Range<usize>) -> SyntaxError {
    let mut error = SyntaxError::unexpected(cursor, span.clone(), "'-->'");
    let (first, text) = cursor.statement();
    let nearly = ["->", "=>", "→"].into_iter().find_map(|arrow| Some((text.find(arrow)?, arrow)));
    if let Some((at, arrow)) = nearly.filter(|_| !text.contains("-->")) {
        let place = first + at..first + at + arrow.len();
        error = SyntaxError::new(place, format!("expected '-->', found '{arrow}'"));
        error.help = Some("a production is written 'predecessor --> successor'".into());
    }
    error
}

/// `(expression, …)`; how many.
fn arguments(compiler: &mut Compiler) -> Parsed<usize> {
    compiler.take();
    let mut arity = 0;
    loop {
        let first = compiler.code.len();
        let value = match compiler.cursor.peek_term().0 {
            Term::Text => Operand::Constant(f64::from(compiler.text()?)),
            _ => compiler.expression()?,
        };
        let from = compiler.register(value)?;
        compiler.room()?;
        end_with_emission(&mut compiler.code, first, from);
        compiler.temporaries = 0;
        arity += 1;
        match compiler.cursor.peek_term().0 {
            Term::Comma => compiler.take(),
            Term::Close => {
                compiler.take();
                return Ok(arity);
            }
            _ => return Err(compiler.unexpected("',' or ')' after a parameter")),
        }
    }
}

/// `(name, …)`
fn formal_names(cursor: &mut Cursor) -> Parsed<Vec<(String, Range<usize>)>> {
    let mut names = Vec::new();
    loop {
        cursor.position = cursor.peek_term().1.end;
        let (token, span) = cursor.peek_term();
        if token != Term::Name {
            return Err(SyntaxError::unexpected(cursor, span, "the name of a parameter"));
        }
        names.push((cursor.slice(span.clone()).to_string(), span.clone()));
        cursor.position = span.end;
        match cursor.peek_term() {
            (Term::Comma, _) => {}
            (Term::Close, span) => {
                cursor.position = span.end;
                return Ok(names);
            }
            (_, span) => return Err(SyntaxError::unexpected(cursor, span, "',' or ')'")),
        }
    }
}

/// Gives the parameters of these modules the next slots.
fn bind(scope: &mut Scope, formals: Vec<Formal>) -> Parsed<Vec<Pattern>> {
    let mut patterns = Vec::new();
    for Formal { kind, names } in formals {
        let (slot, arity) = (scope.len() as u8, names.len() as u8);
        for (mut name, span) in names {
            if name == "age" && scope.contains(&name) {
                // The age of a context cannot be named.
                name = format!("age {}", scope.len());
            }
            if scope.contains(&name) {
                let message = format!("parameter '{name}' has a namesake here");
                return Err(SyntaxError::new(span, message));
            }
            if scope.len() >= SLOT_LIMIT {
                let message =
                    format!("more than {SLOT_LIMIT} parameters and variables in a production");
                return Err(SyntaxError::new(span, message));
            }
            scope.push(name);
        }
        patterns.push(Pattern { kind, arity, slot });
    }
    Ok(patterns)
}

/// Passes over the number of a production, as in `p12: A --> B`.
fn skip_label(cursor: &mut Cursor, is_own: bool) {
    let rest = cursor.rest();
    let Some(colon) = rest.find(':') else { return };
    let label = rest[..colon].trim();
    let mut letters = label.chars();
    let first =
        letters.next().is_some_and(|first| first == 'p' || (is_own && first.is_alphabetic()));
    let numbered = first && letters.next().is_some_and(|c| c.is_ascii_digit());
    if numbered && letters.all(|letter| letter.is_ascii_alphanumeric()) {
        cursor.position += colon + 1;
    }
}

fn is_balanced(kinds: impl Iterator<Item = u8>) -> bool {
    let mut depth = 0_i64;
    for kind in kinds {
        depth += i64::from(kind == Alphabet::OPEN) - i64::from(kind == Alphabet::CLOSE);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_numbered_letters() {
        let rest = |text: &'static str, is_own| {
            let mut cursor = Cursor::new(text, 0..text.len());
            skip_label(&mut cursor, is_own);
            cursor.rest().trim()
        };
        assert_eq!(rest("p12a : A --> B", false), "A --> B");
        assert_eq!(rest("q1: A --> B", false), "q1: A --> B");
        assert_eq!(rest("q1: A --> B", true), "A --> B");
        assert_eq!(rest("A : x > 3 --> B", true), "A : x > 3 --> B");
    }
}
