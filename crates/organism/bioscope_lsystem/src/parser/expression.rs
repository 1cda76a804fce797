//! Expressions: operator precedence, names and functions, straight to the register machine.
//!
//! Precedence from loose to tight, as in the reference program: `?:`, `||`, `&&`, equality,
//! order, sum, product, `^`, sign and `!`. In the notation of our own `^` is tighter than the
//! sign, and associates to the right.

use std::ops::Range;

use super::{
    Parsed, SyntaxError,
    functions::{FUNCTIONS, Function, function},
    names::{Names, Scope},
};
use crate::{
    diagnostic::suggestion,
    lexer::{Cursor, Term},
    machine::{
        Binary, Call, Instruction, Program, Register, Rules, TEMPORARIES, TEMPORARY_LIMIT, Unary,
        binary, unary,
    },
};

/// How deeply parentheses, signs, conditions and blocks may be nested.
const NESTING_LIMIT: usize = 100;
/// How many instructions one program may have.
const PROGRAM_LIMIT: usize = 30_000;
const POWER: u8 = 7;

/// Where a value is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Operand {
    Constant(f64),
    Register(Register),
}

/// Compiles expressions and statements at the cursor.
pub(super) struct Compiler<'p, 'a> {
    pub cursor: &'p mut Cursor<'a>,
    pub names: &'p mut Names,
    pub scope: &'p mut Scope,
    /// Whether new variables belong to the model rather than to a production.
    pub in_control_block: bool,
    /// Unknown names, taken as zero.
    pub unknown: &'p mut Vec<SyntaxError>,
    pub code: Vec<Instruction>,
    /// How many temporary registers are in use.
    pub temporaries: usize,
    pub nesting: usize,
}

impl Compiler<'_, '_> {
    /// An expression; it may end at any token that cannot continue it.
    pub fn expression(&mut self) -> Parsed<Operand> {
        self.enter()?;
        let mark = self.temporaries;
        let test = self.chain(1)?;
        self.nesting -= 1;
        if self.cursor.peek_term().0 != Term::Question {
            return Ok(test);
        }
        self.take();
        let test = self.register(test)?;
        let skip = self.emit(Instruction::JumpIfFalse { test, distance: 0 })?;
        self.temporaries = mark;
        let to = self.temporary()?;
        self.branch(to)?;
        self.expect(Term::Colon, "':' of the conditional")?;
        let end = self.emit(Instruction::Jump { distance: 0 })?;
        self.land(skip);
        self.branch(to)?;
        self.land(end);
        Ok(Operand::Register(to))
    }

    fn branch(&mut self, to: Register) -> Parsed<()> {
        self.enter()?;
        let mark = self.temporaries;
        let value = self.expression()?;
        self.assign(to, value)?;
        self.temporaries = mark;
        self.nesting -= 1;
        Ok(())
    }

    /// The program of everything compiled so far, which returns this value.
    pub fn returning(mut self, value: Operand) -> Parsed<Program> {
        let from = self.register(value)?;
        self.emit(Instruction::Return { from })?;
        Ok(Program(self.code.into()))
    }

    /// Operators of at least this precedence between operands.
    fn chain(&mut self, least: u8) -> Parsed<Operand> {
        let mark = self.temporaries;
        let mut left = self.operand()?;
        loop {
            let (token, _) = self.cursor.peek_term();
            let Some((precedence, operator)) = operator(token).filter(|&(p, _)| p >= least) else {
                return Ok(left);
            };
            self.take();
            left = match operator {
                Operator::Binary(operation) => {
                    let to_right = precedence == POWER && self.is_own();
                    let right = if to_right {
                        self.enter()?;
                        let right = self.chain(precedence)?;
                        self.nesting -= 1;
                        right
                    } else {
                        self.chain(precedence + 1)?
                    };
                    self.binary(operation, left, right, mark)?
                }
                Operator::And | Operator::Or => {
                    self.short_circuit(matches!(operator, Operator::Or), left, precedence, mark)?
                }
            };
        }
    }

    /// In the reference program, what decides an `||` is also its value.
    fn short_circuit(
        &mut self,
        is_or: bool,
        left: Operand,
        precedence: u8,
        mark: usize,
    ) -> Parsed<Operand> {
        let left = self.register(left)?;
        self.temporaries = mark;
        let to = self.temporary()?;
        let is_truth = self.code.last().is_some_and(|last| last.is_truth_in(left));
        if self.is_own() && !(is_truth && left == to) {
            self.emit(Instruction::Unary { operation: Unary::Truth, to, a: left })?;
        } else if left != to {
            self.emit(Instruction::Move { to, from: left })?;
        }
        let jump = self.emit(if is_or {
            Instruction::JumpIfTrue { test: to, distance: 0 }
        } else {
            Instruction::JumpIfFalse { test: to, distance: 0 }
        })?;
        let right = self.chain(precedence + 1)?;
        let right = self.register(right)?;
        self.emit(Instruction::Unary { operation: Unary::Truth, to, a: right })?;
        self.land(jump);
        self.temporaries = mark + 1;
        Ok(Operand::Register(to))
    }

    fn operand(&mut self) -> Parsed<Operand> {
        let (token, _) = self.cursor.peek_term();
        match token {
            Term::Number => {
                Ok(Operand::Constant(self.take_text().parse().unwrap_or(f64::INFINITY)))
            }
            Term::Name => self.name(),
            Term::Open => {
                self.take();
                let value = self.expression()?;
                self.expect(Term::Close, "')'")?;
                Ok(value)
            }
            Term::Minus => self.prefix(Some(Unary::Negate)),
            Term::Not => self.prefix(Some(Unary::Not)),
            Term::Plus => self.prefix(None),
            _ => Err(self.unexpected("a number, a name or '('")),
        }
    }

    fn prefix(&mut self, operation: Option<Unary>) -> Parsed<Operand> {
        self.enter()?;
        self.take();
        let mark = self.temporaries;
        let value = if self.is_own() { self.chain(POWER)? } else { self.operand()? };
        self.nesting -= 1;
        match operation {
            Some(operation) => self.unary(operation, value, mark),
            None => Ok(value),
        }
    }

    fn name(&mut self) -> Parsed<Operand> {
        let (_, span) = self.cursor.peek_term();
        let name = self.take_text().to_string();
        match self.cursor.peek_term().0 {
            Term::Open => return self.call(&name, span),
            Term::OpenIndex => {
                let mark = self.temporaries;
                let (array, at) = self.element(&name, span)?;
                self.temporaries = mark;
                let to = self.temporary()?;
                self.emit(Instruction::Load { to, array, at })?;
                return Ok(Operand::Register(to));
            }
            _ => {}
        }
        if let Some(register) = self.variable(&name) {
            return Ok(Operand::Register(register));
        }
        if name == "pi" {
            return Ok(Operand::Constant(std::f64::consts::PI));
        }
        if self.names.array(&name).is_some() {
            let message = format!("'{name}' is an array: expected '[' and an index");
            return Err(SyntaxError::new(span, message));
        }
        let mut warning = SyntaxError::new(span, format!("unknown name '{name}' counts as 0"));
        let known = self.scope.iter().map(String::as_str).chain(self.names.known());
        warning.help = suggestion(&name, known).map(|known| format!("did you mean '{known}'?"));
        self.unknown.push(warning);
        Ok(Operand::Constant(0.0))
    }

    /// Register of a variable that is known.
    pub fn variable(&self, name: &str) -> Option<Register> {
        let slot = self.scope.iter().position(|known| known == name);
        slot.map(|slot| slot as Register).or_else(|| self.names.global(name))
    }

    /// Array and register of the place of `name[i][j]…`.
    pub fn element(&mut self, name: &str, span: Range<usize>) -> Parsed<(u16, Register)> {
        let Some(array) = self.names.array(name) else {
            let mut error = SyntaxError::new(span, format!("unknown array '{name}'"));
            error.help = suggestion(name, self.names.known())
                .map(|known| format!("did you mean '{known}'?"));
            return Err(error);
        };
        let at = self.temporary()?;
        self.assign(at, Operand::Constant(0.0))?;
        let mut count = 0;
        while self.cursor.peek_term().0 == Term::OpenIndex {
            self.take();
            let mark = self.temporaries;
            let index = self.expression()?;
            let from = self.register(index)?;
            self.temporaries = mark;
            self.expect(Term::CloseIndex, "']'")?;
            let dimensions = self.names.pool.arrays[array as usize].sizes.len() as u16;
            if count < dimensions {
                let dimension = self.names.dimension(array, count);
                self.emit(Instruction::Index { to: at, from, dimension })?;
            }
            count += 1;
        }
        let dimensions = self.names.pool.arrays[array as usize].sizes.len();
        if count as usize != dimensions {
            let message = format!("array '{name}' has {dimensions} dimensions, found {count}");
            return Err(SyntaxError::new(span, message));
        }
        Ok((array, at))
    }

    fn call(&mut self, name: &str, span: Range<usize>) -> Parsed<Operand> {
        let Some(function) = function(name) else { return Err(unknown_function(name, span)) };
        let mark = self.temporaries;
        self.take();
        match function {
            Function::Unary(operation) => {
                let [a] = self.arguments(name, span)?;
                self.unary(operation, a, mark)
            }
            Function::Binary(operation) => {
                let [a, b] = self.arguments(name, span)?;
                self.binary(operation, a, b, mark)
            }
            Function::Call(call, count) => self.call_with(call, count, name, span),
            Function::Print => self.print(false),
            Function::FilePrint => self.print(true),
            Function::FileOpen => self.open(),
            Function::FileScan => self.scan(),
            Function::Play => {
                self.text()?;
                self.expect(Term::Close, "')'")?;
                Ok(Operand::Constant(0.0))
            }
        }
    }

    /// Exactly so many arguments, up to the closing parenthesis.
    fn arguments<const COUNT: usize>(
        &mut self,
        name: &str,
        span: Range<usize>,
    ) -> Parsed<[Operand; COUNT]> {
        let mut arguments = [Operand::Constant(0.0); COUNT];
        let mut count = 0;
        while self.cursor.peek_term().0 != Term::Close {
            if count > 0 {
                self.expect(Term::Comma, "',' or ')'")?;
            }
            let mark = self.temporaries;
            let argument = self.expression()?;
            match arguments.get_mut(count) {
                Some(place) => *place = argument,
                None => self.temporaries = mark,
            }
            count += 1;
        }
        self.take();
        if count == COUNT { Ok(arguments) } else { Err(wrong_count(name, span, COUNT, count)) }
    }

    fn call_with(
        &mut self,
        call: Call,
        wanted: u8,
        name: &str,
        span: Range<usize>,
    ) -> Parsed<Operand> {
        let mark = self.temporaries;
        // A call may look at two registers even if it has only one argument.
        let first = self.temporary()?;
        self.temporaries -= 1;
        let mut count = 0;
        while self.cursor.peek_term().0 != Term::Close {
            if count > 0 {
                self.expect(Term::Comma, "',' or ')'")?;
            }
            self.argument_in_order()?;
            count += 1;
        }
        self.take();
        if count != wanted as usize {
            return Err(wrong_count(name, span, wanted as usize, count));
        }
        self.temporaries = mark;
        let to = self.temporary()?;
        self.emit(Instruction::Call { call, to, first })?;
        Ok(Operand::Register(to))
    }

    /// An expression whose value comes to the next temporary register.
    pub fn argument_in_order(&mut self) -> Parsed<Register> {
        let mark = self.temporaries;
        let value = self.expression()?;
        self.temporaries = mark;
        let to = self.temporary()?;
        self.assign(to, value)?;
        Ok(to)
    }

    pub fn enter(&mut self) -> Parsed<()> {
        self.nesting += 1;
        if self.nesting > NESTING_LIMIT {
            let (_, span) = self.cursor.peek_term();
            let message = format!("an expression nested more than {NESTING_LIMIT} deep");
            return Err(SyntaxError::new(span, message));
        }
        Ok(())
    }

    fn is_own(&self) -> bool {
        self.names.pool.rules == Rules::Own
    }

    pub fn temporary(&mut self) -> Parsed<Register> {
        self.temporaries += 1;
        // One is left for calls, which look at two registers.
        if self.temporaries >= TEMPORARY_LIMIT {
            let (_, span) = self.cursor.peek_term();
            let message =
                format!("an expression that needs {TEMPORARY_LIMIT} or more numbers at once");
            return Err(SyntaxError::new(span, message));
        }
        Ok((TEMPORARIES + self.temporaries - 1) as Register)
    }

    /// The register that holds a value.
    pub fn register(&mut self, value: Operand) -> Parsed<Register> {
        match value {
            Operand::Register(register) => Ok(register),
            Operand::Constant(value) => {
                let to = (TEMPORARIES + self.temporaries) as Register;
                match self.names.constant(value, to) {
                    Ok(register) => Ok(register),
                    Err(instruction) => {
                        let to = self.temporary()?;
                        self.emit(instruction)?;
                        Ok(to)
                    }
                }
            }
        }
    }

    pub fn assign(&mut self, to: Register, value: Operand) -> Parsed<()> {
        let from = self.register(value)?;
        if from != to {
            self.emit(Instruction::Move { to, from })?;
        }
        Ok(())
    }

    fn unary(&mut self, operation: Unary, value: Operand, mark: usize) -> Parsed<Operand> {
        if let Operand::Constant(value) = value {
            return Ok(Operand::Constant(unary(operation, value, self.names.pool.rules)));
        }
        let a = self.register(value)?;
        self.temporaries = mark;
        let to = self.temporary()?;
        self.emit(Instruction::Unary { operation, to, a })?;
        Ok(Operand::Register(to))
    }

    /// Combines two values; at once if both are constants.
    fn binary(
        &mut self,
        operation: Binary,
        left: Operand,
        right: Operand,
        mark: usize,
    ) -> Parsed<Operand> {
        if let (Operand::Constant(a), Operand::Constant(b)) = (left, right)
            && !(operation == Binary::Divide && b == 0.0)
            && let Ok(value) = binary(operation, a, b, self.names.pool.rules)
        {
            return Ok(Operand::Constant(value));
        }
        let (a, b) = (self.register(left)?, self.register(right)?);
        self.temporaries = mark;
        let to = self.temporary()?;
        self.emit(match operation {
            Binary::Add => Instruction::Add { to, a, b },
            Binary::Subtract => Instruction::Subtract { to, a, b },
            Binary::Multiply => Instruction::Multiply { to, a, b },
            Binary::Less => Instruction::Less { to, a, b },
            Binary::Greater => Instruction::Greater { to, a, b },
            Binary::Equal => Instruction::Equal { to, a, b },
            _ => Instruction::Binary { operation, to, a, b },
        })?;
        Ok(Operand::Register(to))
    }

    /// An error if there is no room for another instruction.
    pub fn room(&self) -> Parsed<()> {
        if self.code.len() < PROGRAM_LIMIT {
            return Ok(());
        }
        let (_, span) = self.cursor.peek_term();
        let message = format!("a program of more than {PROGRAM_LIMIT} steps");
        Err(SyntaxError::new(span, message))
    }

    pub fn emit(&mut self, instruction: Instruction) -> Parsed<usize> {
        self.room()?;
        self.code.push(instruction);
        Ok(self.code.len() - 1)
    }

    /// Lets the jump at `index` lead to here.
    pub fn land(&mut self, index: usize) {
        let to = (self.code.len() - index - 1) as u16;
        match &mut self.code[index] {
            Instruction::Jump { distance }
            | Instruction::JumpIfFalse { distance, .. }
            | Instruction::JumpIfTrue { distance, .. } => *distance = to,
            other => unreachable!("{other:?} is no jump"),
        }
    }

    pub fn take(&mut self) {
        self.cursor.position = self.cursor.peek_term().1.end;
    }

    pub fn take_text(&mut self) -> &str {
        let (_, span) = self.cursor.peek_term();
        self.cursor.position = span.end;
        self.cursor.slice(span)
    }

    pub fn expect(&mut self, wanted: Term, name: &str) -> Parsed<()> {
        if self.cursor.peek_term().0 != wanted {
            return Err(self.unexpected(name));
        }
        self.take();
        Ok(())
    }

    pub fn unexpected(&self, expected: &str) -> SyntaxError {
        let (_, span) = self.cursor.peek_term();
        SyntaxError::unexpected(self.cursor, span, expected)
    }
}

enum Operator {
    Binary(Binary),
    And,
    Or,
}

fn operator(token: Term) -> Option<(u8, Operator)> {
    let (precedence, operation) = match token {
        Term::Or => return Some((1, Operator::Or)),
        Term::And => return Some((2, Operator::And)),
        Term::Equal => (3, Binary::Equal),
        Term::Unequal => (3, Binary::Unequal),
        Term::Less => (4, Binary::Less),
        Term::LessEqual => (4, Binary::LessEqual),
        Term::Greater => (4, Binary::Greater),
        Term::GreaterEqual => (4, Binary::GreaterEqual),
        Term::Plus => (5, Binary::Add),
        Term::Minus => (5, Binary::Subtract),
        Term::Star => (6, Binary::Multiply),
        Term::Slash => (6, Binary::Divide),
        Term::Percent => (6, Binary::Remainder),
        Term::Power => (POWER, Binary::Power),
        _ => return None,
    };
    Some((precedence, Operator::Binary(operation)))
}

fn wrong_count(name: &str, span: Range<usize>, wanted: usize, found: usize) -> SyntaxError {
    let plural = if wanted == 1 { "" } else { "s" };
    SyntaxError::new(span, format!("{name}() takes {wanted} argument{plural}, found {found}"))
}

fn unknown_function(name: &str, span: Range<usize>) -> SyntaxError {
    let mut error = SyntaxError::new(span, format!("unknown function '{name}'"));
    let known = suggestion(name, FUNCTIONS.iter().map(|(known, _)| *known));
    error.help = known.map(|known| format!("did you mean '{known}'?"));
    error
}
