//! From text to [`LSystem`]: statements and sections.
//!
//! A statement is a line with the indented lines that follow it. An error ends only its own
//! statement, so that one reading reports all of them. The parser is a plain recursive descent:
//! it steers the two languages of the lexer, bounds every depth, and always knows what it expects.

mod expression;
mod production;
mod statements;

use std::{collections::BTreeSet, ops::Range, path::Path};

use crate::{
    Alphabet, Diagnostic, Diagnostics, LSystem,
    diagnostic::suggestion,
    expression::{Bindings, Expression},
    lexer::{Cursor, Term, Word},
    model::{Production, ProductionSet, Successor},
    preprocessor::preprocess,
    source::Source,
};
use expression::ExpressionParser;
use statements::{SECTIONS, Section, Statement, statements};

/// How many errors and how many warnings are kept.
const REPORT_LIMIT: usize = 50;

/// Something wrong at these bytes of the expanded text.
#[derive(Clone, Debug)]
struct SyntaxError {
    span: Range<usize>,
    message: String,
    help: Option<String>,
}

impl SyntaxError {
    fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { span, message: message.into(), help: None }
    }

    fn unexpected(cursor: &Cursor, span: Range<usize>, expected: &str) -> Self {
        let found = cursor.slice(span.clone());
        let message = if found.is_empty() {
            format!("expected {expected}, but the statement ends here")
        } else {
            format!("expected {expected}, found '{found}'")
        };
        Self::new(span, message)
    }
}

type Parsed<T> = Result<T, SyntaxError>;

impl LSystem {
    /// Reads an L-system from a file.
    pub fn read(path: impl AsRef<Path>) -> bioscope_core::Result<Self> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let bytes = std::fs::read(path)
            .map_err(|error| bioscope_core::Error::format(&name, error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let line = error.as_bytes()[..error.utf8_error().valid_up_to()]
                .iter()
                .filter(|&&byte| byte == b'\n')
                .count();
            bioscope_core::Error::format(format!("{name}:{}", line + 1), "not UTF-8 text")
        })?;
        Ok(Self::parse(&text, &name)?)
    }

    /// Reads an L-system from text; `file_name` is what reports call it.
    ///
    /// ```
    /// use bioscope_lsystem::LSystem;
    /// let text = "lsystem: 1\nderivation length: 2\naxiom: A(1)\nA(x) --> A(x+1)A(x/2)\nendlsystem\n";
    /// let string = LSystem::parse(text, "pairs.l")?.derive(2, 0)?;
    /// assert_eq!(string.to_string(), "A(3)A(1)A(1.5)A(0.25)");
    /// # Ok::<(), bioscope_core::Error>(())
    /// ```
    pub fn parse(source: &str, file_name: &str) -> Result<Self, Diagnostics> {
        let (source, constants, reports) = preprocess(source.to_string(), file_name);
        let mut parser = Parser::new(&source, reports);
        parser.constants(&constants);
        for statement in statements(&source.expanded) {
            parser.statement(&statement);
        }
        parser.finish()
    }
}

/// Which set of productions a statement adds to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Rewriting,
    Decomposition,
    Homomorphism,
    /// After `endlsystem`.
    Over,
}

#[derive(Default)]
struct Productions {
    list: Vec<Production>,
    depth: Option<u32>,
}

struct Parser<'s> {
    source: &'s Source,
    errors: Vec<Diagnostic>,
    unknown: Vec<SyntaxError>,
    warnings: Vec<Diagnostic>,
    alphabet: Alphabet,
    part: Part,
    sets: [Productions; 3],
    axiom: Option<(Successor, usize)>,
    derivation_length: u32,
    angle: Option<f32>,
    constants: Vec<(String, f64)>,
    ignored: Option<BTreeSet<String>>,
    considered: Option<BTreeSet<String>>,
}

impl<'s> Parser<'s> {
    fn new(source: &'s Source, errors: Vec<Diagnostic>) -> Self {
        Self {
            source,
            errors,
            unknown: Vec::new(),
            warnings: Vec::new(),
            alphabet: Alphabet::default(),
            part: Part::Rewriting,
            sets: Default::default(),
            axiom: None,
            derivation_length: 0,
            angle: None,
            constants: Vec::new(),
            ignored: None,
            considered: None,
        }
    }

    /// Keeps those `#define`s whose text is a number.
    fn constants(&mut self, texts: &[(String, String)]) {
        for (name, text) in texts {
            let mut cursor = Cursor::new(text, 0..text.len());
            let (scope, mut unknown) = (Vec::new(), Vec::new());
            let parsed = ExpressionParser::new(&mut cursor, &scope, &mut unknown).parse();
            if let Ok(Expression::Constant(value)) = parsed
                && unknown.is_empty()
                && cursor.peek_term().0 == Term::End
            {
                self.constants.push((name.clone(), value));
            }
        }
    }

    fn statement(&mut self, statement: &Statement) {
        let mut cursor = Cursor::new(&self.source.expanded, statement.content.clone());
        if self.part == Part::Over {
            let span = statement.head.start..statement.content.end;
            return self.error(SyntaxError::new(span, "not supported: a second L-system"));
        }
        let parsed = match &statement.section {
            Some(section) => self.section(*section, statement, &mut cursor),
            None => self.production_statement(&mut cursor),
        };
        if let Err(error) = parsed {
            self.error(error);
        }
        self.report_unknown_names();
    }

    fn section(
        &mut self,
        section: Section,
        statement: &Statement,
        cursor: &mut Cursor,
    ) -> Parsed<()> {
        match section {
            Section::Label | Section::Seed => Ok(()),
            Section::Axiom => self.axiom(cursor),
            Section::DerivationLength => {
                self.derivation_length = self.count(cursor, "a number of steps")?;
                Ok(())
            }
            Section::Angle => {
                let value = self.number(cursor)?;
                self.angle = Some(value as f32);
                Ok(())
            }
            Section::Ignore => {
                self.ignored = Some(self.symbols(cursor)?);
                Ok(())
            }
            Section::Consider => {
                self.considered = Some(self.symbols(cursor)?);
                Ok(())
            }
            Section::Decomposition => self.begin(Part::Decomposition),
            Section::Homomorphism => self.begin(Part::Homomorphism),
            Section::MaximumDepth => {
                let depth = self.count(cursor, "a depth")?;
                self.sets[self.part as usize].depth = Some(depth);
                Ok(())
            }
            Section::End => self.begin(Part::Over),
            Section::Unsupported(name) => {
                Err(SyntaxError::new(statement.head.clone(), format!("not supported: {name}")))
            }
            Section::Unknown => {
                let head = self.source.expanded[statement.head.clone()].trim();
                let message = format!("unknown section '{head}:'; a production needs '-->'");
                let mut error = SyntaxError::new(statement.head.clone(), message);
                let known = suggestion(head, SECTIONS.iter().map(|(name, _)| *name));
                error.help = known.map(|name| format!("did you mean '{name}:'?"));
                Err(error)
            }
        }
    }

    fn begin(&mut self, part: Part) -> Parsed<()> {
        self.part = part;
        Ok(())
    }

    fn axiom(&mut self, cursor: &mut Cursor) -> Parsed<()> {
        let start = cursor.peek_word().1.start;
        let axiom = self.successor(cursor, &Vec::new())?;
        let (token, span) = cursor.peek_word();
        if token != Word::End {
            return Err(SyntaxError::unexpected(cursor, span, "a module"));
        }
        if self.axiom.replace((axiom, start)).is_some() {
            return Err(SyntaxError::new(start..start + 1, "a second axiom"));
        }
        Ok(())
    }

    /// A constant expression.
    fn number(&mut self, cursor: &mut Cursor) -> Parsed<f64> {
        let scope = Vec::new();
        let expression = ExpressionParser::new(cursor, &scope, &mut self.unknown).parse()?;
        let (token, span) = cursor.peek_term();
        if token != Term::End {
            return Err(SyntaxError::unexpected(cursor, span, "the end of the line"));
        }
        Ok(expression.evaluate(&mut Bindings::new(0, 0.0)))
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

    fn symbols(&mut self, cursor: &mut Cursor) -> Parsed<BTreeSet<String>> {
        let mut symbols = BTreeSet::new();
        loop {
            let (token, span) = cursor.peek_word();
            match token {
                Word::End => return Ok(symbols),
                Word::Symbol => symbols.insert(cursor.slice(span.clone()).to_string()),
                // The comparison signs and the star are symbols here.
                Word::Less | Word::Greater | Word::Star => true,
                _ => return Err(SyntaxError::unexpected(cursor, span, "a symbol")),
            };
            cursor.position = span.end;
        }
    }

    fn error(&mut self, error: SyntaxError) {
        if self.errors.len() < REPORT_LIMIT {
            self.errors.push(self.diagnostic(error));
        }
    }

    fn report_unknown_names(&mut self) {
        for mut warning in std::mem::take(&mut self.unknown) {
            if self.warnings.len() >= REPORT_LIMIT {
                return;
            }
            if warning.help.is_none() {
                let name = &self.source.expanded[warning.span.clone()];
                let known = self.constants.iter().map(|(known, _)| known.as_str());
                let known = suggestion(name, known);
                warning.help = known.map(|known| format!("did you mean '{known}'?"));
            }
            self.warnings.push(self.diagnostic(warning));
        }
    }

    fn diagnostic(&self, error: SyntaxError) -> Diagnostic {
        let mut diagnostic = self.source.diagnostic(error.span, error.message);
        if error.help.is_some() {
            diagnostic.help = error.help;
        }
        diagnostic
    }

    fn finish(mut self) -> Result<LSystem, Diagnostics> {
        let end = self.source.expanded.trim_end().len();
        if self.errors.is_empty() && self.axiom.is_none() {
            self.error(SyntaxError::new(end..end, "expected 'axiom:' before the end of the file"));
        }
        let [rewriting, decomposition, homomorphism] = std::mem::take(&mut self.sets);
        if self.errors.is_empty() && rewriting.list.is_empty() {
            self.error(SyntaxError::new(end..end, "expected at least one production"));
        }
        let (Some((axiom, start)), []) = (self.axiom.take(), &self.errors[..]) else {
            self.errors.sort_by_key(|error| (error.place.line, error.place.column));
            return Err(Diagnostics(self.errors));
        };
        let optional = |set: Productions| {
            let depth = set.depth.unwrap_or(1);
            (!set.list.is_empty()).then(|| ProductionSet::new(set.list, depth))
        };
        let skipped = self.skipped();
        Ok(LSystem {
            axiom,
            axiom_place: self.source.place(start),
            rewriting: ProductionSet::new(rewriting.list, 1),
            decomposition: optional(decomposition),
            homomorphism: optional(homomorphism),
            skipped,
            derivation_length: self.derivation_length,
            angle: self.angle,
            constants: self.constants,
            warnings: self.warnings,
            alphabet: self.alphabet.into(),
        })
    }

    fn skipped(&self) -> Vec<bool> {
        let is_skipped = |symbol: &str| {
            let bracket = symbol == "[" || symbol == "]";
            let listed =
                |set: &Option<BTreeSet<String>>| set.as_ref().map(|set| set.contains(symbol));
            let outside = listed(&self.considered).is_some_and(|listed| !listed);
            !bracket && (outside || listed(&self.ignored).unwrap_or(false))
        };
        let mut skipped = vec![false; 256];
        for (code, kind) in self.alphabet.kinds().iter().enumerate() {
            skipped[code] = is_skipped(&kind.symbol);
        }
        skipped
    }
}
