//! From text to [`LSystem`]: statements and sections.
//!
//! A statement is a line with the indented lines that follow it. An error ends only its own
//! statement, so that one reading reports all of them. The parser is a plain recursive descent:
//! it steers the two languages of the lexer, bounds every depth, and always knows what it expects.

mod block;
mod expression;
mod functions;
mod letters;
mod lint;
mod names;
mod production;
mod reading;
mod sections;
mod statements;
mod systems;
mod timed;

use std::{collections::BTreeSet, ops::Range, rc::Rc};

use crate::{
    Alphabet, Diagnostic, Diagnostics, LSystem,
    diagnostic::suggestion,
    lexer::{Cursor, Term},
    machine::Rules,
    model::Successor,
    source::Source,
};
use expression::Compiler;
use names::{Names, Scope};
use statements::{SECTIONS, Section, Statement, statements};
use systems::Draft;

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

/// The value of a constant expression that fills the cursor's text; unknown names count as zero.
pub(crate) fn constant_value(cursor: &mut Cursor) -> Option<f64> {
    let (mut names, mut scope, mut unknown) = (Names::default(), Scope::new(), Vec::new());
    let mut compiler = Compiler {
        cursor,
        names: &mut names,
        scope: &mut scope,
        in_control_block: false,
        unknown: &mut unknown,
        code: Vec::new(),
        temporaries: 0,
        nesting: 0,
    };
    let value = compiler.constant().ok()?;
    (cursor.peek_term().0 == Term::End).then_some(value)
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

struct Parser<'s> {
    source: &'s Source,
    errors: Vec<Diagnostic>,
    unknown: Vec<SyntaxError>,
    warnings: Vec<Diagnostic>,
    alphabet: Alphabet,
    part: Part,
    names: Names,
    /// Declared modules, longest names first, and what their parameters are called.
    modules: Rc<[String]>,
    declared: Vec<(String, Vec<String>)>,
    /// The L-systems so far; the last one is being read.
    drafts: Vec<Draft>,
    axiom: Option<(Successor, usize)>,
    derivation_length: u32,
    angle: Option<f32>,
    environment: Option<String>,
    constants: Vec<(String, f64)>,
    /// Seconds per step of a timed model.
    timed: Option<f64>,
    /// What timed modules show: kind, shown kind and program.
    growth: Vec<(u8, u8, crate::machine::Program)>,
    /// Whether every letter is a module, `@o` two of them.
    letters: bool,
}

impl<'s> Parser<'s> {
    fn new(source: &'s Source, rules: Rules, errors: Vec<Diagnostic>) -> Self {
        let mut names = Names::default();
        names.pool.rules = rules;
        Self {
            source,
            errors,
            unknown: Vec::new(),
            warnings: Vec::new(),
            alphabet: Alphabet::default(),
            part: Part::Rewriting,
            names,
            modules: Rc::new([]),
            declared: Vec::new(),
            drafts: vec![Draft::new(rules)],
            axiom: None,
            derivation_length: 0,
            angle: None,
            environment: None,
            constants: Vec::new(),
            timed: None,
            growth: Vec::new(),
            letters: false,
        }
    }

    fn is_own(&self) -> bool {
        self.names.pool.rules == Rules::Own
    }

    /// Keeps those `#define`s whose text is a number.
    fn constants(&mut self, texts: &[(String, String)]) {
        for (name, text) in texts {
            let mut cursor = Cursor::new(text, 0..text.len());
            let (mut scope, mut unknown) = (Scope::new(), Vec::new());
            let mut compiler = Compiler {
                cursor: &mut cursor,
                names: &mut self.names,
                scope: &mut scope,
                in_control_block: false,
                unknown: &mut unknown,
                code: Vec::new(),
                temporaries: 0,
                nesting: 0,
            };
            if let Ok(value) = compiler.constant()
                && unknown.is_empty()
                && cursor.peek_term().0 == Term::End
            {
                self.constants.push((name.clone(), value));
            }
        }
    }

    fn statement(&mut self, statement: &Statement) {
        let cursor = Cursor::new(&self.source.expanded, statement.content.clone());
        let mut cursor = cursor.with_modules(self.modules.clone()).by_letters(self.letters);
        if self.part == Part::Over && !self.begin_system(statement) {
            return;
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

    /// After `endlsystem`, only another L-system may follow.
    fn begin_system(&mut self, statement: &Statement) -> bool {
        if statement.section != Some(Section::Label) {
            let span = statement.head.start..statement.content.end;
            let message = "expected 'lsystem:' after 'endlsystem'";
            self.error(SyntaxError::new(span, message));
            // One report is enough for everything that follows.
            self.part = Part::Rewriting;
            return false;
        }
        self.drafts.push(Draft::new(self.names.pool.rules));
        self.names.system = self.drafts.len() - 1;
        self.part = Part::Rewriting;
        true
    }

    fn draft(&mut self) -> &mut Draft {
        let last = self.drafts.len() - 1;
        &mut self.drafts[last]
    }

    fn compiler<'p, 'a>(
        &'p mut self,
        cursor: &'p mut Cursor<'a>,
        scope: &'p mut Scope,
    ) -> Compiler<'p, 'a> {
        Compiler {
            cursor,
            names: &mut self.names,
            scope,
            in_control_block: false,
            unknown: &mut self.unknown,
            code: Vec::new(),
            temporaries: 0,
            nesting: 0,
        }
    }

    fn error(&mut self, error: SyntaxError) {
        if self.errors.len() < REPORT_LIMIT {
            self.errors.push(self.diagnostic(error));
        }
    }

    fn warn(&mut self, warning: SyntaxError) {
        if self.warnings.len() < REPORT_LIMIT {
            self.warnings.push(self.diagnostic(warning));
        }
    }

    fn report_unknown_names(&mut self) {
        for mut warning in std::mem::take(&mut self.unknown) {
            if warning.help.is_none() {
                let name = &self.source.expanded[warning.span.clone()];
                let known = self.constants.iter().map(|(known, _)| known.as_str());
                let known = suggestion(name, known);
                warning.help = known.map(|known| format!("did you mean '{known}'?"));
            }
            self.warn(warning);
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
        if self.errors.is_empty() && self.drafts[0].has_no_productions() {
            self.error(SyntaxError::new(end..end, "expected at least one production"));
        }
        self.lint();
        let (Some((axiom, start)), []) = (self.axiom.take(), &self.errors[..]) else {
            self.errors.sort_by_key(|error| (error.place.line, error.place.column));
            return Err(Diagnostics(self.errors));
        };
        let timing = self.timing();
        let alphabet = &self.alphabet;
        Ok(LSystem {
            timing,
            axiom,
            axiom_place: self.source.place(start),
            systems: self.drafts.into_iter().map(|draft| draft.finish(alphabet)).collect(),
            pool: self.names.pool.into(),
            derivation_length: self.derivation_length,
            angle: self.angle,
            environment: self.environment,
            constants: self.constants,
            warnings: self.warnings,
            alphabet: self.alphabet.into(),
        })
    }
}

/// What a list of symbols says, in either notation.
#[derive(Clone, Debug)]
enum Listed {
    /// Whole symbols.
    Symbols(BTreeSet<String>),
    /// Single letters, as the reference program sees them: `@o` is listed if `@` and `o` are.
    Letters(BTreeSet<char>),
}

impl Listed {
    fn contains(&self, symbol: &str) -> bool {
        match self {
            Self::Symbols(symbols) => symbols.contains(symbol),
            Self::Letters(letters) => symbol.chars().all(|letter| letters.contains(&letter)),
        }
    }

    fn contains_part_of(&self, symbol: &str) -> bool {
        match self {
            Self::Symbols(symbols) => symbols.contains(symbol),
            Self::Letters(letters) => symbol.chars().any(|letter| letters.contains(&letter)),
        }
    }
}
