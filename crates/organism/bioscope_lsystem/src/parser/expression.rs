//! Expressions: operator precedence, names and functions, straight to the stack machine.
//!
//! Precedence from loose to tight, as in the reference program: `?:`, `||`, `&&`, equality,
//! order, sum, product, `^` (associates to the left), sign and `!`.

use std::ops::Range;

use super::SyntaxError;
use crate::{
    diagnostic::suggestion,
    expression::{Binary, Expression, Instruction, STACK_LIMIT, Unary, binary, unary},
    lexer::{Cursor, Term},
};

/// How deeply parentheses, signs and conditions may be nested.
const NESTING_LIMIT: usize = 100;

/// Names of parameters and local variables, in the order of their slots.
pub(super) type Scope = Vec<String>;

/// Reads one expression at the cursor.
pub(super) struct ExpressionParser<'p, 'a> {
    pub cursor: &'p mut Cursor<'a>,
    pub scope: &'p Scope,
    /// Unknown names, taken as zero.
    pub unknown: &'p mut Vec<SyntaxError>,
    program: Vec<Instruction>,
    depth: usize,
    nesting: usize,
}

type Parsed<T> = Result<T, SyntaxError>;

impl<'p, 'a> ExpressionParser<'p, 'a> {
    pub fn new(
        cursor: &'p mut Cursor<'a>,
        scope: &'p Scope,
        unknown: &'p mut Vec<SyntaxError>,
    ) -> Self {
        Self { cursor, scope, unknown, program: Vec::new(), depth: 0, nesting: 0 }
    }

    pub fn parse(mut self) -> Parsed<Expression> {
        self.conditional()?;
        Ok(Expression::from_program(self.program))
    }

    /// The expression's instructions, which leave its value on the stack.
    pub fn parse_program(mut self) -> Parsed<Vec<Instruction>> {
        self.conditional()?;
        Ok(self.program)
    }

    fn conditional(&mut self) -> Parsed<()> {
        self.enter()?;
        self.chain(1)?;
        if self.cursor.peek_term().0 == Term::Question {
            self.take();
            let test = self.emit_jump(Instruction::JumpIfFalse);
            self.depth -= 1;
            self.conditional()?;
            self.expect(Term::Colon, "':' of the conditional")?;
            let end = self.emit_jump(Instruction::Jump);
            self.land(test);
            self.depth -= 1;
            self.conditional()?;
            self.land(end);
        }
        self.nesting -= 1;
        Ok(())
    }

    /// Operators of at least this precedence between operands.
    fn chain(&mut self, least: u8) -> Parsed<()> {
        let left = self.program.len();
        self.operand()?;
        loop {
            let (token, _) = self.cursor.peek_term();
            let Some((precedence, operator)) = operator(token).filter(|&(p, _)| p >= least) else {
                return Ok(());
            };
            self.take();
            match operator {
                Operator::Binary(operation) => {
                    let right = self.program.len();
                    self.chain(precedence + 1)?;
                    self.emit_binary(operation, left, right);
                }
                Operator::And => self.short_circuit(Instruction::And, precedence)?,
                Operator::Or => self.short_circuit(Instruction::Or, precedence)?,
            }
        }
    }

    fn short_circuit(&mut self, jump: fn(u32) -> Instruction, precedence: u8) -> Parsed<()> {
        let end = self.emit_jump(jump);
        self.depth -= 1;
        self.chain(precedence + 1)?;
        self.program.push(Instruction::Unary(Unary::Truth));
        self.land(end);
        Ok(())
    }

    fn operand(&mut self) -> Parsed<()> {
        let (token, span) = self.cursor.peek_term();
        match token {
            Term::Number => {
                let value = self.take_text().parse().unwrap_or(f64::INFINITY);
                self.push(Instruction::Constant(value), span)
            }
            Term::Name => self.name(),
            Term::Open => {
                self.take();
                self.conditional()?;
                self.expect(Term::Close, "')'")
            }
            Term::Minus => self.prefix(Some(Unary::Negate)),
            Term::Not => self.prefix(Some(Unary::Not)),
            Term::Plus => self.prefix(None),
            Term::Text => Err(SyntaxError::new(span, "not supported: text as a parameter")),
            _ => Err(self.unexpected("a number, a name or '('")),
        }
    }

    fn prefix(&mut self, operation: Option<Unary>) -> Parsed<()> {
        self.enter()?;
        self.take();
        let start = self.program.len();
        self.operand()?;
        self.nesting -= 1;
        if let Some(operation) = operation {
            self.emit_unary(operation, start);
        }
        Ok(())
    }

    fn name(&mut self) -> Parsed<()> {
        let (_, span) = self.cursor.peek_term();
        let name = self.take_text();
        match self.cursor.peek_term().0 {
            Term::Open => return self.call(name, span),
            Term::OpenIndex => {
                return Err(SyntaxError::new(span, format!("not supported: array '{name}'")));
            }
            _ => {}
        }
        let instruction = match self.scope.iter().position(|known| known == name) {
            Some(slot) => Instruction::Load(slot as u8),
            None => match name {
                "Q" => Instruction::Step,
                "Z" => Instruction::Length,
                "pi" => Instruction::Constant(std::f64::consts::PI),
                _ => {
                    let message = format!("unknown name '{name}' counts as 0");
                    let mut warning = SyntaxError::new(span.clone(), message);
                    let known = suggestion(name, self.scope.iter().map(String::as_str));
                    warning.help = known.map(|known| format!("did you mean '{known}'?"));
                    self.unknown.push(warning);
                    Instruction::Constant(0.0)
                }
            },
        };
        self.push(instruction, span)
    }

    fn call(&mut self, name: &str, span: Range<usize>) -> Parsed<()> {
        self.take();
        let start = self.program.len();
        let mut last = start;
        let mut count = 0;
        while self.cursor.peek_term().0 != Term::Close {
            if count > 0 {
                self.expect(Term::Comma, "',' or ')'")?;
            }
            last = self.program.len();
            self.conditional()?;
            count += 1;
        }
        self.take();
        let Some(function) = function(name) else { return Err(unknown_function(name, span)) };
        let wanted = match function {
            Function::Unary(_) | Function::Uniform => 1,
            Function::Binary(_) | Function::Normal => 2,
        };
        if count != wanted {
            let plural = if wanted == 1 { "" } else { "s" };
            let message = format!("{name}() takes {wanted} argument{plural}, found {count}");
            return Err(SyntaxError::new(span, message));
        }
        match function {
            Function::Unary(operation) => self.emit_unary(operation, start),
            Function::Binary(operation) => self.emit_binary(operation, start, last),
            Function::Uniform => self.program.push(Instruction::Uniform),
            Function::Normal => {
                self.program.push(Instruction::Normal);
                self.depth -= 1;
            }
        }
        Ok(())
    }

    fn enter(&mut self) -> Parsed<()> {
        self.nesting += 1;
        if self.nesting > NESTING_LIMIT {
            let (_, span) = self.cursor.peek_term();
            let message = format!("an expression nested more than {NESTING_LIMIT} deep");
            return Err(SyntaxError::new(span, message));
        }
        Ok(())
    }

    fn push(&mut self, instruction: Instruction, span: Range<usize>) -> Parsed<()> {
        self.depth += 1;
        if self.depth > STACK_LIMIT {
            let message =
                format!("an expression that needs more than {STACK_LIMIT} numbers at once");
            return Err(SyntaxError::new(span, message));
        }
        self.program.push(instruction);
        Ok(())
    }

    fn emit_unary(&mut self, operation: Unary, start: usize) {
        if let [Instruction::Constant(value)] = self.program[start..] {
            self.program[start] = Instruction::Constant(unary(operation, value));
        } else {
            self.program.push(Instruction::Unary(operation));
        }
    }

    /// Combines the operands that begin at `left` and `right`; at once if both are constants.
    fn emit_binary(&mut self, operation: Binary, left: usize, right: usize) {
        self.depth -= 1;
        if let ([Instruction::Constant(a)], [Instruction::Constant(b)]) =
            (&self.program[left..right], &self.program[right..])
            && let Ok(value) = binary(operation, *a, *b)
        {
            self.program.truncate(left);
            self.program.push(Instruction::Constant(value));
            return;
        }
        self.program.push(Instruction::Binary(operation));
    }

    /// Emits a jump whose distance is not known yet.
    fn emit_jump(&mut self, jump: fn(u32) -> Instruction) -> usize {
        self.program.push(jump(0));
        self.program.len() - 1
    }

    /// Lets the jump at `index` lead to here.
    fn land(&mut self, index: usize) {
        let distance = (self.program.len() - index - 1) as u32;
        match &mut self.program[index] {
            Instruction::Jump(to)
            | Instruction::JumpIfFalse(to)
            | Instruction::And(to)
            | Instruction::Or(to) => *to = distance,
            other => unreachable!("{other:?} is no jump"),
        }
    }

    fn take(&mut self) {
        self.cursor.position = self.cursor.peek_term().1.end;
    }

    fn take_text(&mut self) -> &'a str {
        let (_, span) = self.cursor.peek_term();
        self.cursor.position = span.end;
        self.cursor.slice(span)
    }

    fn expect(&mut self, wanted: Term, name: &str) -> Parsed<()> {
        if self.cursor.peek_term().0 != wanted {
            return Err(self.unexpected(name));
        }
        self.take();
        Ok(())
    }

    fn unexpected(&self, expected: &str) -> SyntaxError {
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
        Term::Power => (7, Binary::Power),
        _ => return None,
    };
    Some((precedence, Operator::Binary(operation)))
}

#[derive(Clone, Copy)]
enum Function {
    Unary(Unary),
    Binary(Binary),
    Uniform,
    Normal,
}

const FUNCTIONS: [(&str, Function); 21] = [
    ("tan", Function::Unary(Unary::Tangent)),
    ("sin", Function::Unary(Unary::Sine)),
    ("cos", Function::Unary(Unary::Cosine)),
    ("atan", Function::Unary(Unary::ArcTangent)),
    ("asin", Function::Unary(Unary::ArcSine)),
    ("acos", Function::Unary(Unary::ArcCosine)),
    ("exp", Function::Unary(Unary::Exponential)),
    ("log", Function::Unary(Unary::Logarithm)),
    ("sqrt", Function::Unary(Unary::SquareRoot)),
    ("floor", Function::Unary(Unary::Floor)),
    ("ceil", Function::Unary(Unary::Ceiling)),
    ("trunc", Function::Unary(Unary::Truncate)),
    ("fabs", Function::Unary(Unary::Absolute)),
    ("abs", Function::Unary(Unary::Absolute)),
    ("sign", Function::Unary(Unary::Sign)),
    ("min", Function::Binary(Binary::Minimum)),
    ("max", Function::Binary(Binary::Maximum)),
    ("pow", Function::Binary(Binary::Power)),
    ("atan2", Function::Binary(Binary::Angle)),
    ("ran", Function::Uniform),
    ("nran", Function::Normal),
];

/// Functions of the reference program that have no meaning here yet.
const UNSUPPORTED: [&str; 23] = [
    "bran",
    "biran",
    "srand",
    "inblob",
    "stop",
    "printf",
    "fprintf",
    "fopen",
    "fclose",
    "fflush",
    "fscanf",
    "func",
    "play",
    "curveX",
    "curveY",
    "curveZ",
    "curveGAL",
    "SetDerivationLength",
    "GetDerivationLength",
    "vvXmin",
    "vvXmax",
    "vvScale",
    "Display",
];

fn function(name: &str) -> Option<Function> {
    FUNCTIONS.iter().find(|(known, _)| *known == name).map(|&(_, function)| function)
}

fn unknown_function(name: &str, span: Range<usize>) -> SyntaxError {
    if UNSUPPORTED.contains(&name) {
        return SyntaxError::new(span, format!("not supported: function {name}()"));
    }
    let mut error = SyntaxError::new(span, format!("unknown function '{name}'"));
    let known = suggestion(name, FUNCTIONS.iter().map(|(known, _)| *known));
    error.help = known.map(|known| format!("did you mean '{known}'?"));
    error
}
