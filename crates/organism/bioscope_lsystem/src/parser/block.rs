//! Statements: assignments, conditions, loops, printing and files.

use super::{
    Parsed, SyntaxError,
    expression::{Compiler, Operand},
};
use crate::{
    lexer::Term,
    machine::{Array, Instruction, Machine, Program, Randomness, Register, SLOT_LIMIT},
};

/// How many elements one array may have.
const ARRAY_LIMIT: usize = 1 << 22;

impl Compiler<'_, '_> {
    /// `{ statement … }`, if there is one.
    pub fn block(&mut self) -> Parsed<()> {
        if self.cursor.peek_term().0 != Term::OpenBlock {
            return Ok(());
        }
        self.enter()?;
        self.take();
        while self.cursor.peek_term().0 != Term::CloseBlock {
            self.statement()?;
            self.temporaries = 0;
        }
        self.take();
        self.nesting -= 1;
        Ok(())
    }

    /// A block that must be there.
    fn inner_block(&mut self) -> Parsed<()> {
        if self.cursor.peek_term().0 != Term::OpenBlock {
            return Err(self.unexpected("'{'"));
        }
        self.block()
    }

    fn statement(&mut self) -> Parsed<()> {
        let (token, span) = self.cursor.peek_term();
        if token == Term::Semicolon {
            self.take();
            return Ok(());
        }
        if token != Term::Name {
            return Err(self.unexpected("a statement or '}'"));
        }
        match self.cursor.slice(span.clone()) {
            "if" => return self.condition(),
            "while" => return self.repetition(),
            "do" => return self.repetition_with_test_at_end(),
            "array" if self.in_control_block => return self.arrays(),
            "external" => {
                return Err(SyntaxError::new(span, "not supported: external variables"));
            }
            _ => {}
        }
        let start = self.cursor.position;
        let name = self.take_text().to_string();
        match self.cursor.peek_term().0 {
            Term::Assign => {
                self.take();
                let value = self.expression()?;
                let to = self.target(&name)?;
                self.assign(to, value)?;
            }
            Term::OpenIndex => {
                let (array, at) = self.element(&name, span)?;
                self.expect(Term::Assign, "'='")?;
                let value = self.expression()?;
                let from = self.register(value)?;
                self.emit(Instruction::Store { array, at, from })?;
            }
            Term::Open => {
                self.cursor.position = start;
                self.expression()?;
            }
            _ => return Err(self.unexpected("'=', '[' or '('")),
        }
        self.end_of_statement()
    }

    fn end_of_statement(&mut self) -> Parsed<()> {
        match self.cursor.peek_term().0 {
            Term::CloseBlock => Ok(()),
            _ => self.expect(Term::Semicolon, "';'"),
        }
    }

    /// The variable to be assigned to, which is new if it is unknown.
    fn target(&mut self, name: &str) -> Parsed<Register> {
        if let Some(register) = self.variable(name) {
            return Ok(register);
        }
        let (_, span) = self.cursor.peek_term();
        if self.in_control_block {
            let message = "more variables than a model may have";
            return self.names.declare_global(name).ok_or_else(|| SyntaxError::new(span, message));
        }
        if self.scope.len() >= SLOT_LIMIT {
            let message =
                format!("more than {SLOT_LIMIT} parameters and variables in a production");
            return Err(SyntaxError::new(span, message));
        }
        self.scope.push(name.to_string());
        Ok(self.scope.len() as Register - 1)
    }

    /// `(test)`, as a jump that is taken when it is false.
    fn test(&mut self) -> Parsed<usize> {
        let test = self.parenthesized()?;
        self.emit(Instruction::JumpIfFalse { test, distance: 0 })
    }

    fn parenthesized(&mut self) -> Parsed<Register> {
        self.expect(Term::Open, "'('")?;
        let value = self.expression()?;
        self.expect(Term::Close, "')'")?;
        self.register(value)
    }

    fn condition(&mut self) -> Parsed<()> {
        self.take();
        let otherwise = self.test()?;
        self.temporaries = 0;
        self.inner_block()?;
        let (token, span) = self.cursor.peek_term();
        if token != Term::Name || self.cursor.slice(span) != "else" {
            self.land(otherwise);
            return Ok(());
        }
        self.take();
        let end = self.emit(Instruction::Jump { distance: 0 })?;
        self.land(otherwise);
        let (token, span) = self.cursor.peek_term();
        if token == Term::Name && self.cursor.slice(span) == "if" {
            self.enter()?;
            self.condition()?;
            self.nesting -= 1;
        } else {
            self.inner_block()?;
        }
        self.land(end);
        Ok(())
    }

    fn repetition(&mut self) -> Parsed<()> {
        self.take();
        let start = self.code.len();
        let end = self.test()?;
        self.temporaries = 0;
        self.inner_block()?;
        let always = self.register(Operand::Constant(1.0))?;
        self.jump_back(always, start)?;
        self.land(end);
        Ok(())
    }

    fn repetition_with_test_at_end(&mut self) -> Parsed<()> {
        self.take();
        let start = self.code.len();
        self.inner_block()?;
        let (token, span) = self.cursor.peek_term();
        if token != Term::Name || self.cursor.slice(span) != "while" {
            return Err(self.unexpected("'while'"));
        }
        self.take();
        let test = self.parenthesized()?;
        self.jump_back(test, start)?;
        self.end_of_statement()
    }

    fn jump_back(&mut self, test: Register, start: usize) -> Parsed<()> {
        let distance = (self.code.len() + 1 - start) as u16;
        self.emit(Instruction::BackIfTrue { test, distance })?;
        Ok(())
    }

    /// `array name[size]… = { … }, …;`
    fn arrays(&mut self) -> Parsed<()> {
        self.take();
        loop {
            self.array()?;
            match self.cursor.peek_term().0 {
                Term::Comma => self.take(),
                Term::Semicolon => {
                    self.take();
                    return Ok(());
                }
                // The last semicolon of a block may be missing, and a line may end a definition.
                Term::CloseBlock | Term::End => return Ok(()),
                _ => return Err(self.unexpected("',' or ';'")),
            }
        }
    }

    /// `name[size]… = { … }`
    pub fn array(&mut self) -> Parsed<()> {
        let (token, span) = self.cursor.peek_term();
        if token != Term::Name {
            return Err(self.unexpected("the name of an array"));
        }
        let name = self.take_text().to_string();
        let mut sizes = Vec::new();
        while self.cursor.peek_term().0 == Term::OpenIndex {
            self.take();
            sizes.push(self.constant()?);
            self.expect(Term::CloseIndex, "']'")?;
        }
        let total = sizes.iter().try_fold(1.0, |total: f64, &size| {
            (size >= 1.0 && total * size <= ARRAY_LIMIT as f64).then_some(total * size.trunc())
        });
        let Some(total) = total.filter(|_| !sizes.is_empty()) else {
            let message =
                format!("an array needs sizes of at least 1, together at most {ARRAY_LIMIT}");
            return Err(SyntaxError::new(span, message));
        };
        let mut values = Vec::new();
        if self.cursor.peek_term().0 == Term::Assign {
            self.take();
            self.initial_values(&mut values)?;
        }
        if values.len() > total as usize {
            let message = format!("array '{name}' has {total} elements, found {}", values.len());
            self.unknown.push(SyntaxError::new(span, message));
        }
        values.resize(total as usize, 0.0);
        let sizes = sizes.into_iter().map(|size| size as usize).collect();
        self.names.add_array(Array { name, sizes, values });
        Ok(())
    }

    fn initial_values(&mut self, values: &mut Vec<f64>) -> Parsed<()> {
        self.expect(Term::OpenBlock, "'{'")?;
        loop {
            match self.cursor.peek_term().0 {
                Term::CloseBlock => {
                    self.take();
                    return Ok(());
                }
                Term::Comma => self.take(),
                Term::OpenBlock => {
                    self.enter()?;
                    self.initial_values(values)?;
                    self.nesting -= 1;
                }
                _ => values.push(self.constant()?),
            }
        }
    }

    /// An expression that can be computed at once.
    pub fn constant(&mut self) -> Parsed<f64> {
        let start = self.code.len();
        let value = self.expression()?;
        let from = match value {
            Operand::Constant(value) => return Ok(value),
            Operand::Register(from) => from,
        };
        self.emit(Instruction::Return { from })?;
        let program = Program(self.code.split_off(start).into());
        let pool = std::sync::Arc::new(self.names.pool.clone());
        let mut machine = Machine::new(pool, 0.0, Randomness::reference(None), 1_000_000);
        Ok(machine.run(&program, &mut Vec::new()))
    }

    /// A text in quotes, its escapes resolved.
    pub fn text(&mut self) -> Parsed<u16> {
        if self.cursor.peek_term().0 != Term::Text {
            return Err(self.unexpected("a text in quotes"));
        }
        let quoted = self.take_text();
        let mut text = String::new();
        let mut letters = quoted[1..quoted.len() - 1].chars();
        while let Some(letter) = letters.next() {
            text.push(match letter {
                '\\' => match letters.next() {
                    Some('n') => '\n',
                    Some('t') => '\t',
                    Some('r') => '\r',
                    Some(other) => other,
                    None => '\\',
                },
                other => other,
            });
        }
        Ok(self.names.text(text))
    }

    /// `"text", x, …)`, preceded by a file.
    pub fn print(&mut self, to_file: bool) -> Parsed<Operand> {
        let mark = self.temporaries;
        let first = self.temporary()?;
        self.temporaries -= 1;
        let mut count = 0;
        if to_file {
            self.argument_in_order()?;
            count += 1;
            self.expect(Term::Comma, "',' and a text")?;
        }
        let text = self.text()?;
        while self.cursor.peek_term().0 == Term::Comma {
            self.take();
            self.argument_in_order()?;
            count += 1;
        }
        self.expect(Term::Close, "',' or ')'")?;
        self.emit(Instruction::Print { text, first, count, to_file })?;
        self.temporaries = mark;
        Ok(Operand::Constant(0.0))
    }

    /// `"name", "mode")`
    pub fn open(&mut self) -> Parsed<Operand> {
        let name = self.text()?;
        self.expect(Term::Comma, "',' and a mode")?;
        let mode = self.text()?;
        self.expect(Term::Close, "')'")?;
        let to = self.temporary()?;
        self.emit(Instruction::Open { to, name, mode })?;
        Ok(Operand::Register(to))
    }

    /// `file, "text", &x, …)`
    pub fn scan(&mut self) -> Parsed<Operand> {
        let first = self.argument_in_order()?;
        self.expect(Term::Comma, "',' and a text")?;
        let text = self.text()?;
        let at = self.emit(Instruction::Scan { text, first, count: 0 })?;
        let mut count: u8 = 0;
        let results: Vec<Register> = (0..10).map(|_| self.temporary()).collect::<Parsed<_>>()?;
        while self.cursor.peek_term().0 == Term::Comma {
            self.take();
            let (_, span) = self.cursor.peek_term();
            if count as usize >= results.len() {
                return Err(SyntaxError::new(span, "fscanf() reads at most 10 numbers"));
            }
            self.expect(Term::Address, "'&' and a variable")?;
            let (token, span) = self.cursor.peek_term();
            if token != Term::Name {
                return Err(self.unexpected("a variable"));
            }
            let name = self.take_text().to_string();
            let from = results[count as usize];
            if self.cursor.peek_term().0 == Term::OpenIndex {
                let (array, at) = self.element(&name, span)?;
                self.emit(Instruction::Store { array, at, from })?;
            } else {
                let to = self.target(&name)?;
                self.emit(Instruction::Move { to, from })?;
            }
            count += 1;
        }
        self.expect(Term::Close, "',' or ')'")?;
        self.code[at] = Instruction::Scan { text, first, count };
        Ok(Operand::Register(first))
    }
}
