//! Everything that is no production.

use super::{
    Listed, Parsed, Parser, Part, SECTIONS, SyntaxError,
    names::Scope,
    statements::{Block, Section, Statement},
};
use crate::{
    diagnostic::suggestion,
    lexer::{Cursor, Term, Word},
    machine::Program,
    model::{Order, RightContext},
};

impl Parser<'_> {
    pub(super) fn section(
        &mut self,
        section: Section,
        statement: &Statement,
        cursor: &mut Cursor,
    ) -> Parsed<()> {
        match section {
            Section::Label => {
                self.draft().label = cursor.words().to_string();
                Ok(())
            }
            Section::Heading => Ok(()),
            Section::Seed => self.seed(cursor),
            Section::Axiom => self.axiom(cursor),
            Section::DerivationLength => {
                let length = self.count(cursor, "a number of steps")?;
                if self.drafts.len() == 1 {
                    self.derivation_length = length;
                }
                Ok(())
            }
            Section::Angle => {
                let value = self.number(cursor)?;
                self.angle = Some(value as f32);
                Ok(())
            }
            Section::Ignore => {
                let listed = self.listed(cursor)?;
                self.draft().ignored = Some(listed);
                self.draft().considered = None;
                Ok(())
            }
            Section::Consider => {
                let listed = self.listed(cursor)?;
                self.draft().considered = Some(listed);
                self.draft().ignored = None;
                Ok(())
            }
            Section::Decomposition => self.begin(Part::Decomposition),
            Section::Homomorphism => self.begin(Part::Homomorphism),
            Section::MaximumDepth => self.maximum_depth(cursor),
            Section::End => self.begin(Part::Over),
            Section::Ring => {
                self.draft().is_ring = true;
                Ok(())
            }
            Section::Block(block) => self.control_block(block, cursor),
            Section::Array => self.array(cursor),
            Section::RightContext => self.right_context(cursor),
            Section::Environment => {
                self.environment = Some(cursor.words().to_string());
                Ok(())
            }
            Section::Table => {
                let name = cursor.words();
                self.draft().begin_table(name);
                Ok(())
            }
            Section::Select => self.select(cursor),
            Section::Modules => self.modules(cursor),
            Section::Order => self.order(cursor),
            Section::Timed => self.timed(cursor),
            Section::Growth => self.growth(cursor),
            Section::Unknown => Err(self.unknown_section(statement)),
        }
    }

    fn begin(&mut self, part: Part) -> Parsed<()> {
        self.part = part;
        Ok(())
    }

    fn unknown_section(&self, statement: &Statement) -> SyntaxError {
        let head = self.source.expanded[statement.head.clone()].trim();
        let message = format!("unknown section '{head}:'; a production needs '-->'");
        let mut error = SyntaxError::new(statement.head.clone(), message);
        let known = suggestion(head, SECTIONS.iter().map(|(name, _)| *name));
        error.help = known.map(|name| format!("did you mean '{name}:'?"));
        error
    }

    fn seed(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let value = self.number(cursor)?;
        if self.part == Part::Homomorphism {
            // A negative seed stands for none, as in the reference program.
            self.draft().homomorphism_seed = (value >= 0.0).then_some(value as i64);
        } else {
            self.draft().is_stochastic = true;
        }
        Ok(())
    }

    fn axiom(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let start = cursor.peek_word().1.start;
        let axiom = self.axiom_word(cursor)?;
        // Axioms of sub-L-systems are never used: their strings stand in that of the main one.
        if self.drafts.len() == 1 && self.axiom.replace((axiom, start)).is_some() {
            return Err(SyntaxError::new(start..start + 1, "a second axiom"));
        }
        Ok(())
    }

    /// A constant expression.
    pub(super) fn number(&mut self, cursor: &mut Cursor) -> Parsed<f64> {
        let mut scope = Scope::new();
        let value = self.compiler(cursor, &mut scope).constant()?;
        let (token, span) = cursor.peek_term();
        if token != Term::End {
            return Err(SyntaxError::unexpected(cursor, span, "the end of the line"));
        }
        Ok(value)
    }

    /// A whole number from 0 to a thousand million.
    fn count(&mut self, cursor: &mut Cursor, what: &str) -> Parsed<u32> {
        let span = cursor.peek_term().1;
        let value = self.number(cursor)?;
        if (0.0..=1e9).contains(&value) {
            return Ok(value as u32);
        }
        let message = format!("expected {what} from 0 to 1000000000, found {value}");
        Err(SyntaxError::new(span, message))
    }

    fn maximum_depth(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let depth = Some(self.count(cursor, "a depth")?);
        let part = self.part;
        match part {
            Part::Homomorphism => self.draft().homomorphism.depth = depth,
            _ => self.draft().decomposition.depth = depth,
        }
        Ok(())
    }

    fn listed(&mut self, cursor: &mut Cursor) -> Parsed<Listed> {
        if !self.is_own() && self.modules.is_empty() {
            let letters = cursor.rest().chars().filter(|letter| !letter.is_whitespace());
            return Ok(Listed::Letters(letters.collect()));
        }
        let mut symbols = std::collections::BTreeSet::new();
        loop {
            let (token, span) = cursor.peek_word();
            match token {
                Word::End => return Ok(Listed::Symbols(symbols)),
                Word::Symbol => symbols.insert(cursor.slice(span.clone()).to_string()),
                // The comparison signs and the star are symbols here.
                Word::Less | Word::Greater | Word::Star => true,
                _ => return Err(SyntaxError::unexpected(cursor, span, "a symbol")),
            };
            cursor.position = span.end;
        }
    }

    fn control_block(&mut self, block: Block, cursor: &mut Cursor) -> Parsed<()> {
        let mut scope = Scope::new();
        let mut compiler = self.compiler(cursor, &mut scope);
        compiler.in_control_block = true;
        if compiler.cursor.peek_term().0 != Term::OpenBlock {
            return Err(compiler.unexpected("'{'"));
        }
        compiler.block()?;
        let program = Program(compiler.code.into());
        let (token, span) = cursor.peek_term();
        if token != Term::End {
            return Err(SyntaxError::unexpected(cursor, span, "the end of the block"));
        }
        let blocks = &mut self.draft().blocks;
        match block {
            // Arrays are filled while the file is read.
            Block::Define => {}
            Block::Start => blocks.start = program,
            Block::StartEach => blocks.start_each = program,
            Block::EndEach => blocks.end_each = program,
            Block::End => blocks.end = program,
        }
        Ok(())
    }

    fn array(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let mut scope = Scope::new();
        let mut compiler = self.compiler(cursor, &mut scope);
        compiler.array()?;
        match cursor.peek_term() {
            (Term::End | Term::Semicolon, _) => Ok(()),
            (_, span) => Err(SyntaxError::unexpected(cursor, span, "the end of the line")),
        }
    }

    fn right_context(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let words = cursor.words();
        self.draft().right_context = match words {
            "tree" => RightContext::Tree,
            "axis" => RightContext::Axis,
            _ => {
                let span = cursor.peek_term().1;
                return Err(SyntaxError::unexpected(cursor, span, "'tree' or 'axis'"));
            }
        };
        Ok(())
    }

    /// `condition -> table`
    fn select(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let text = cursor.rest();
        let Some(arrow) = text.rfind("->") else {
            let span = cursor.peek_term().1;
            return Err(SyntaxError::unexpected(cursor, span, "a condition, '->' and a table"));
        };
        let table = text[arrow + 2..].trim().to_string();
        let mut scope = Scope::new();
        let start = cursor.position;
        let mut test = Cursor::new(&self.source.expanded, start..start + arrow);
        let mut compiler = self.compiler(&mut test, &mut scope);
        let value = compiler.expression()?;
        let program = compiler.returning(value)?;
        self.draft().selections.push((program, table));
        Ok(())
    }

    /// `Apex(age, vigor), Leaf, …`
    fn modules(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        loop {
            let (token, span) = cursor.peek_term();
            if token != Term::Name {
                return Err(SyntaxError::unexpected(cursor, span, "the name of a module"));
            }
            let name = cursor.slice(span.clone()).to_string();
            cursor.position = span.end;
            let mut parameters = self.declared_parameters(cursor)?;
            if self.timed.is_some() {
                parameters.insert(0, "age".into());
            }
            if self.declared.iter().any(|(known, _)| *known == name) {
                return Err(SyntaxError::new(span, format!("module '{name}' is declared twice")));
            }
            self.declared.push((name, parameters));
            match cursor.peek_term() {
                (Term::Comma | Term::Semicolon, span) => cursor.position = span.end,
                (Term::End, _) => break,
                (_, span) => return Err(SyntaxError::unexpected(cursor, span, "',' or the end")),
            }
        }
        let mut names: Vec<String> = self.declared.iter().map(|(name, _)| name.clone()).collect();
        names.sort_by_key(|name| std::cmp::Reverse(name.len()));
        self.modules = names.into();
        Ok(())
    }

    fn declared_parameters(&mut self, cursor: &mut Cursor) -> Parsed<Vec<String>> {
        let mut parameters = Vec::new();
        if cursor.peek_term().0 != Term::Open {
            return Ok(parameters);
        }
        loop {
            cursor.position = cursor.peek_term().1.end;
            let (token, span) = cursor.peek_term();
            if token != Term::Name {
                return Err(SyntaxError::unexpected(cursor, span, "the name of a parameter"));
            }
            parameters.push(cursor.slice(span.clone()).to_string());
            cursor.position = span.end;
            match cursor.peek_term() {
                (Term::Comma, _) => {}
                (Term::Close, span) => {
                    cursor.position = span.end;
                    return Ok(parameters);
                }
                (_, span) => return Err(SyntaxError::unexpected(cursor, span, "',' or ')'")),
            }
        }
    }

    fn order(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let words = cursor.words();
        self.draft().order = match words {
            "parallel" => Order::Parallel,
            "leftmost" => Order::Leftmost,
            "random" => Order::Random,
            _ => {
                let span = cursor.peek_term().1;
                let expected = "'parallel', 'leftmost' or 'random'";
                return Err(SyntaxError::unexpected(cursor, span, expected));
            }
        };
        Ok(())
    }
}
