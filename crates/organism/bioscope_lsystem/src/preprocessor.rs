//! Comments, continued lines and directives (`#define`, `#include`, `#if` …), as in the C
//! preprocessor.

mod conditions;

use std::{collections::BTreeMap, ops::Range, sync::Arc};

use logos::Logos;

use crate::{
    Diagnostic,
    diagnostic::suggestion,
    source::{Origin, Source, Stretch},
};
use conditions::{Conditions, value};

/// How deeply macros may be nested in one another.
const DEPTH_LIMIT: usize = 64;
/// How many tokens all expansions together may produce.
const TOKEN_LIMIT: usize = 2_000_000;
/// How many tokens the arguments of one call may have.
const CALL_LIMIT: usize = 1_000;
/// How many errors are kept.
const ERROR_LIMIT: usize = 50;
/// How many files may be included, and how deeply.
const INCLUDE_LIMIT: usize = 100;
const INCLUDE_DEPTH: usize = 20;
/// What may follow `#`.
const DIRECTIVES: [&str; 13] = [
    "define", "undef", "include", "line", "pragma", "error", "warning", "ifdef", "ifndef", "elif",
    "else", "endif", "if",
];
/// How many bytes the expanded text may have.
const SIZE_LIMIT: usize = 16 << 20;

#[derive(Logos, Clone, Copy, Debug, PartialEq)]
enum Kind {
    #[regex(r"/\*([^*]|\*+[^*/])*\*+/")]
    Comment,
    #[token("/*")]
    OpenComment,
    #[regex(r"\r?\n")]
    Newline,
    #[regex(r"\\[ \t]*\r?\n")]
    Continuation,
    #[regex(r"[ \t\f]+")]
    Blank,
    #[regex(r"[A-Za-z_][A-Za-z0-9_]*")]
    Name,
    #[regex(r"[0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)?")]
    #[regex(r"\.[0-9]+([eE][+-]?[0-9]+)?")]
    Number,
    #[regex(r#""[^"\n]*""#)]
    Text,
    #[token("#")]
    Hash,
    #[token("(")]
    Open,
    #[token(")")]
    Close,
    #[token(",")]
    Comma,
    #[regex(r"[^\n]", priority = 0)]
    Other,
}

/// A token of one of the files.
#[derive(Clone, Debug)]
struct Token {
    kind: Kind,
    file: u16,
    text: Fragment,
    start: usize,
}

/// A piece of a file's text.
#[derive(Clone, Debug)]
struct Fragment {
    file: Arc<str>,
    span: Range<usize>,
}

impl std::ops::Deref for Fragment {
    type Target = str;

    fn deref(&self) -> &str {
        &self.file[self.span.clone()]
    }
}

impl Token {
    fn origin(&self) -> Origin {
        Origin { file: self.file, span: self.start..self.end() }
    }

    fn end(&self) -> usize {
        self.start + self.text.len()
    }

    fn is_blank(&self) -> bool {
        matches!(self.kind, Kind::Blank | Kind::Comment | Kind::Continuation)
    }
}

#[derive(Clone, Debug)]
struct Macro {
    /// None for a constant: no parentheses follow its name.
    formals: Option<Vec<String>>,
    body: Arc<[Token]>,
}

/// Reads the files that a text includes, by the name in the directive; says why if it cannot.
pub(crate) type Include<'a> = dyn Fn(&str) -> Result<String, String> + 'a;

/// The text after preprocessing, with the names of the constants that it defined and their
/// texts (themselves expanded), and what was wrong.
pub(crate) fn preprocess(
    original: String,
    file: &str,
    include: &Include,
) -> (Source, Vec<(String, String)>, Vec<Diagnostic>) {
    let mut preprocessor = Preprocessor {
        source: Source::new(file, original),
        include,
        macros: BTreeMap::new(),
        errors: Vec::new(),
        produced: 0,
        including: vec![file.to_string()],
    };
    preprocessor.run(0);
    let constants = preprocessor.constants();
    let Preprocessor { source, errors, .. } = preprocessor;
    let report = |(origin, message)| source.diagnostic_in_file(origin, message);
    let reports = errors.into_iter().map(report).collect();
    (source, constants, reports)
}

struct Preprocessor<'a> {
    source: Source,
    include: &'a Include<'a>,
    macros: BTreeMap<String, Macro>,
    errors: Vec<(Origin, String)>,
    produced: usize,
    /// Names of the files that are being read.
    including: Vec<String>,
}

impl Preprocessor<'_> {
    fn run(&mut self, file: u16) {
        let tokens = tokenize(&self.source.files[file as usize].text, file);
        let mut conditions = Conditions::default();
        let mut next = 0;
        let mut at_line_start = true;
        while next < tokens.len() && self.source.expanded.len() < SIZE_LIMIT {
            let token = &tokens[next];
            match token.kind {
                Kind::Hash if at_line_start => {
                    let line = &tokens[next..line_end(&tokens, next)];
                    if self.directive(line, &mut conditions) {
                        next += line.len();
                    } else {
                        self.copy(token, &conditions);
                        next += 1;
                    }
                }
                Kind::Name if conditions.hold() => next += self.name(&tokens[next..]),
                Kind::OpenComment => {
                    self.error(token.origin(), "this comment never ends: expected '*/'");
                    return;
                }
                _ => {
                    at_line_start =
                        token.kind == Kind::Newline || (at_line_start && token.is_blank());
                    self.copy(token, &conditions);
                    next += 1;
                    continue;
                }
            }
            at_line_start = false;
        }
        if let Some(origin) = conditions.unfinished() {
            self.error(origin, "expected '#endif' before the end of the file");
        }
        if self.source.expanded.len() >= SIZE_LIMIT {
            self.error(Origin::default(), format!("more than {} MiB of text", SIZE_LIMIT >> 20));
        }
    }

    fn error(&mut self, origin: Origin, message: impl Into<String>) {
        if self.errors.len() < ERROR_LIMIT {
            self.errors.push((origin, message.into()));
        }
    }

    /// Copies a token; only line ends of parts that are left out.
    fn copy(&mut self, token: &Token, conditions: &Conditions) {
        let text = match token.kind {
            Kind::Comment | Kind::Continuation => " ",
            _ if !conditions.hold() && token.kind != Kind::Newline => "",
            _ => &token.text,
        };
        emit(&mut self.source, text, token.origin(), None);
    }

    /// Carries out the directive in these tokens of one line; false if it is no directive (the
    /// turtle has a symbol `#` too).
    fn directive(&mut self, line: &[Token], conditions: &mut Conditions) -> bool {
        let words = &line[1..];
        let Some(name) = words.iter().find(|token| !token.is_blank()) else { return false };
        let rest = after(words, name);
        match &*name.text {
            "if" | "ifdef" | "ifndef" | "elif" | "else" | "endif" => {
                if let Err(message) = self.condition(name, rest, conditions) {
                    self.error(name.origin(), message);
                }
            }
            "define" | "undef" | "include" | "line" | "pragma" | "error" | "warning"
                if !conditions.hold() => {}
            "define" => self.define(line, rest),
            "undef" => {
                if let Some(name) = rest.iter().find(|token| token.kind == Kind::Name) {
                    self.macros.remove(&*name.text);
                }
            }
            "include" => {
                if let Err(message) = self.include(rest) {
                    self.error(name.origin(), message);
                }
            }
            "line" => self.line(rest),
            "pragma" | "warning" => {}
            "error" => self.error(name.origin(), joined(rest).trim().to_string()),
            other => {
                let Some(meant) = suggestion(other, DIRECTIVES) else { return false };
                let message = format!("unknown directive '#{other}': did you mean '#{meant}'?");
                self.error(name.origin(), message);
            }
        }
        true
    }

    fn condition(
        &mut self,
        name: &Token,
        rest: &[Token],
        conditions: &mut Conditions,
    ) -> Result<(), String> {
        let first = rest.iter().find(|token| token.kind == Kind::Name);
        let is_defined = first.is_some_and(|name| self.macros.contains_key(&*name.text));
        match &*name.text {
            "ifdef" => conditions.begin(name.origin(), is_defined),
            "ifndef" => conditions.begin(name.origin(), !is_defined),
            "if" => {
                let holds = conditions.hold() && self.holds(rest)?;
                conditions.begin(name.origin(), holds);
            }
            "elif" => {
                let holds = conditions.may_hold() && self.holds(rest)?;
                conditions.otherwise(holds, false)?;
            }
            "else" => conditions.otherwise(true, true)?,
            _ => conditions.end()?,
        }
        Ok(())
    }

    /// Whether the expression of an `#if` is not zero.
    fn holds(&mut self, tokens: &[Token]) -> Result<bool, String> {
        let mut prepared = Vec::new();
        let mut next = 0;
        while let Some(token) = tokens.get(next) {
            next += 1;
            if &*token.text != "defined" {
                prepared.push(token.clone());
                continue;
            }
            let Some(length) = tokens[next..].iter().position(|token| token.kind == Kind::Name)
            else {
                return Err("expected a name after 'defined'".into());
            };
            let known = self.macros.contains_key(&*tokens[next + length].text);
            next += length + 1;
            let closes = tokens[next..].first().is_some_and(|token| token.kind == Kind::Close);
            next += usize::from(closes);
            let text: Arc<str> = if known { "1" } else { "0" }.into();
            let text = Fragment { file: text, span: 0..1 };
            prepared.push(Token { kind: Kind::Number, text, ..token.clone() });
        }
        let mut expanded = Vec::new();
        self.expand(&prepared, &mut Vec::new(), &mut expanded)?;
        Ok(value(&joined(&expanded))? != 0.0)
    }

    fn include(&mut self, rest: &[Token]) -> Result<(), String> {
        let text = joined(rest);
        let text = text.trim();
        let quoted = [('"', '"'), ('<', '>')].into_iter().find_map(|(open, close)| {
            let inner = text.strip_prefix(open)?;
            Some(inner[..inner.find(close)?].to_string())
        });
        let name = quoted.ok_or("expected a file name in quotes after #include")?;
        if self.including.contains(&name) {
            return Err(format!("'{name}' includes itself"));
        }
        if self.including.len() > INCLUDE_DEPTH || self.source.files.len() > INCLUDE_LIMIT {
            return Err(format!("files included more than {INCLUDE_DEPTH} deep"));
        }
        let content = (self.include)(&name)?;
        let file = self.source.add_file(&name, content);
        self.including.push(name);
        self.run(file);
        self.including.pop();
        emit(&mut self.source, "\n", Origin { file, span: 0..0 }, None);
        Ok(())
    }

    fn line(&mut self, rest: &[Token]) {
        let Some(number) = rest.iter().find(|token| token.kind == Kind::Number) else { return };
        let name = rest.iter().find(|token| token.kind == Kind::Text);
        let name = name.map(|token| token.text.trim_matches('"').to_string());
        if let Ok(line) = number.text.parse() {
            self.source.renumber(number.file, number.start, line, name.as_deref());
        }
    }

    /// A definition: the whole line for reports, and its part after `define`.
    fn define(&mut self, line: &[Token], rest: &[Token]) {
        let name = rest.iter().find(|token| !token.is_blank());
        let Some(name) = name.filter(|token| token.kind == Kind::Name) else {
            let end = line[line.len() - 1].origin();
            return self.error(end, "expected a name after #define");
        };
        let mut rest = after(rest, name);
        let mut formals = None;
        if let Some(open) = rest.first().filter(|token| token.kind == Kind::Open) {
            let Some(close) = rest.iter().position(|token| token.kind == Kind::Close) else {
                return self.error(open.origin(), "expected ')' after the macro's parameters");
            };
            let names = rest[1..close].iter().filter(|token| token.kind == Kind::Name);
            formals = Some(names.map(|token| token.text.to_string()).collect());
            rest = &rest[close + 1..];
        }
        let body = rest.iter().map(|token| {
            let mut token = token.clone();
            if token.is_blank() {
                token.kind = Kind::Blank;
                token.text = Fragment { file: " ".into(), span: 0..1 };
            }
            token
        });
        let body = body.skip_while(|token| token.kind == Kind::Blank).collect();
        self.macros.insert(name.text.to_string(), Macro { formals, body });
    }

    /// Copies a name or expands the macro of this name; how many tokens it took from the file.
    fn name(&mut self, tokens: &[Token]) -> usize {
        let name = &tokens[0];
        let used = match self.macros.get(&*name.text) {
            None => None,
            Some(Macro { formals: None, .. }) => Some(1),
            Some(_) => call_length(&tokens[1..]).map(|length| length + 1),
        };
        let Some(used) = used else {
            self.copy(name, &Conditions::default());
            return 1;
        };
        let mut expanded = Vec::new();
        match self.expand(&tokens[..used], &mut Vec::new(), &mut expanded) {
            Ok(()) => {
                let span = name.start..tokens[used - 1].end();
                let origin = Origin { file: name.file, span };
                emit(&mut self.source, &joined(&expanded), origin, Some((&*name.text).into()));
            }
            Err(message) => self.error(name.origin(), message),
        }
        used
    }

    /// Appends `tokens` with all macros expanded, except those `active` already.
    fn expand(
        &mut self,
        tokens: &[Token],
        active: &mut Vec<String>,
        out: &mut Vec<Token>,
    ) -> Result<(), String> {
        if active.len() >= DEPTH_LIMIT {
            return Err(format!("macros nested more than {DEPTH_LIMIT} deep"));
        }
        let mut next = 0;
        while next < tokens.len() {
            let token = &tokens[next];
            self.produced += 1;
            if self.produced > TOKEN_LIMIT {
                return Err(format!("macros expand to more than {TOKEN_LIMIT} tokens"));
            }
            next += 1;
            let known =
                token.kind == Kind::Name && !active.iter().any(|name| **name == *token.text);
            let Some(definition) = self.macros.get(&*token.text).filter(|_| known) else {
                out.push(token.clone());
                continue;
            };
            let Macro { formals, body } = definition.clone();
            active.push(token.text.to_string());
            match formals {
                None => self.expand(&body, active, out)?,
                Some(formals) => {
                    let Some(length) = call_length(&tokens[next..]) else {
                        active.pop();
                        out.push(token.clone());
                        continue;
                    };
                    let actuals = arguments(&tokens[next..next + length]);
                    next += length;
                    if actuals.len() != formals.len() {
                        return Err(format!(
                            "macro '{}' has {} parameters, found {}",
                            &*token.text,
                            formals.len(),
                            actuals.len()
                        ));
                    }
                    active.pop();
                    let body = self.substitute(&body, &formals, &actuals, active)?;
                    active.push(token.text.to_string());
                    self.expand(&body, active, out)?;
                }
            }
            active.pop();
        }
        Ok(())
    }

    /// The macro's body with its parameters replaced by the expanded arguments.
    fn substitute(
        &mut self,
        body: &[Token],
        formals: &[String],
        actuals: &[&[Token]],
        active: &mut Vec<String>,
    ) -> Result<Vec<Token>, String> {
        let mut expanded = Vec::new();
        for actual in actuals {
            let mut tokens = Vec::new();
            // One more than the macros that are active, so that nested calls count as depth.
            active.push(String::new());
            self.expand(actual, active, &mut tokens)?;
            active.pop();
            expanded.push(tokens);
        }
        let mut out = Vec::new();
        for token in body {
            match formals.iter().position(|formal| **formal == *token.text) {
                Some(index) => out.extend_from_slice(&expanded[index]),
                None => out.push(token.clone()),
            }
            if self.produced + out.len() > TOKEN_LIMIT {
                return Err(format!("macros expand to more than {TOKEN_LIMIT} tokens"));
            }
        }
        self.produced += out.len();
        Ok(out)
    }

    fn constants(&mut self) -> Vec<(String, String)> {
        let constants = self.macros.iter().filter(|(_, definition)| definition.formals.is_none());
        let bodies: Vec<(String, Arc<[Token]>)> =
            constants.map(|(name, definition)| (name.clone(), definition.body.clone())).collect();
        let mut texts = Vec::new();
        for (name, body) in bodies {
            let mut out = Vec::new();
            if self.expand(&body, &mut vec![name.clone()], &mut out).is_ok() {
                texts.push((name, joined(&out)));
            }
        }
        texts
    }
}

fn emit(source: &mut Source, text: &str, origin: Origin, made_by: Option<Arc<str>>) {
    if text.is_empty() {
        return;
    }
    source.stretches.push(Stretch { expanded: source.expanded.len(), origin, made_by });
    source.expanded.push_str(text);
}

fn joined(tokens: &[Token]) -> String {
    tokens.iter().map(|token| &*token.text).collect()
}

fn tokenize(text: &Arc<str>, file: u16) -> Vec<Token> {
    let token = |(kind, span): (Result<Kind, ()>, Range<usize>)| Token {
        kind: kind.unwrap_or(Kind::Other),
        file,
        start: span.start,
        text: Fragment { file: text.clone(), span },
    };
    Kind::lexer(text).spanned().map(token).collect()
}

/// Index of the next newline, or the number of tokens.
fn line_end(tokens: &[Token], from: usize) -> usize {
    let newline = tokens[from..].iter().position(|token| token.kind == Kind::Newline);
    newline.map_or(tokens.len(), |index| from + index)
}

/// What follows one of these tokens.
fn after<'t>(tokens: &'t [Token], token: &Token) -> &'t [Token] {
    let index = tokens.iter().position(|other| other.start == token.start);
    &tokens[index.map_or(tokens.len(), |index| index + 1)..]
}

/// How many tokens the parenthesized arguments take that should stand first here, blanks
/// included; all on one line.
fn call_length(tokens: &[Token]) -> Option<usize> {
    let open = tokens.iter().position(|token| token.kind != Kind::Blank)?;
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate().take(CALL_LIMIT).skip(open) {
        match token.kind {
            Kind::Open => depth += 1,
            Kind::Close => depth = depth.saturating_sub(1),
            Kind::Newline => return None,
            _ => {}
        }
        if depth == 0 {
            return (index > open).then_some(index + 1);
        }
    }
    None
}

/// The arguments between the parentheses of a call, separated by its commas.
fn arguments(call: &[Token]) -> Vec<&[Token]> {
    let open = call.iter().position(|token| token.kind == Kind::Open).unwrap_or(0);
    let inside = &call[open + 1..call.len() - 1];
    if inside.iter().all(|token| token.kind == Kind::Blank) {
        return Vec::new();
    }
    let mut depth = 0_usize;
    inside
        .split(|token| {
            match token.kind {
                Kind::Open => depth += 1,
                Kind::Close => depth = depth.saturating_sub(1),
                _ => {}
            }
            depth == 0 && token.kind == Kind::Comma
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn no_files(name: &str) -> Result<String, String> {
        Err(format!("no file '{name}'"))
    }

    fn expanded(text: &str) -> String {
        let (source, _, reports) = preprocess(text.to_string(), "test.l", &no_files);
        assert_eq!(reports, []);
        source.expanded.trim().to_string()
    }

    #[test]
    fn constants_and_functions_expand() {
        assert_eq!(
            expanded("#define N 3\n#define twice(x) ((x)*N)\nA(N,twice(N+1)) NA"),
            "A(3,((3+1)*3)) NA"
        );
        assert_eq!(expanded("#define A B\n#define B A\nA"), "A");
        assert_eq!(expanded("#define f(x) (x)\nf(f(f(1))) f"), "(((1))) f");
        assert_eq!(expanded("#define N 3 \\\n + 4 /* seven */\nN"), "3   + 4");
        assert_eq!(expanded("a /* b\n c */ d"), "a   d");
    }

    #[test]
    fn a_hash_that_starts_no_directive_is_the_turtle_symbol() {
        assert_eq!(expanded("#(3) --> #(2)"), "#(3) --> #(2)");
    }

    #[test]
    fn what_explodes_is_refused() {
        let mut text = String::from("#define a0 x x x x x x x x x x\n");
        for level in 1..9 {
            let last = level - 1;
            text += &format!("#define a{level} {}\n", format!("a{last} ").repeat(10));
        }
        let (_, _, reports) = preprocess(text + "a8", "test.l", &no_files);
        assert!(reports[0].message.contains("tokens"), "{}", reports[0]);
        assert_eq!(reports[0].place.line, 10);
    }

    #[test]
    fn unfinished_things_are_reported_where_they_begin() {
        for (text, line, column, part) in [
            ("a\n b /* c", 2, 4, "never ends"),
            ("#define f(x 3\n", 1, 10, "expected ')'"),
            ("#define\n", 1, 2, "expected a name"),
            ("#define f(x) x\nf(1,2)", 2, 1, "has 1 parameters, found 2"),
            ("#include <a.h>", 1, 2, "no file 'a.h'"),
            ("#if 1\nx", 1, 2, "expected '#endif'"),
            ("x\n#endif", 2, 2, "without '#if'"),
            ("#error too small", 1, 2, "too small"),
        ] {
            let (_, _, reports) = preprocess(text.to_string(), "test.l", &no_files);
            assert_eq!(reports.len(), 1, "{text}");
            assert_eq!((reports[0].place.line, reports[0].place.column), (line, column), "{text}");
            assert!(reports[0].message.contains(part), "{}", reports[0]);
        }
    }

    #[test]
    fn conditions_leave_parts_out() {
        let text = "#define N 2\n#if N > 1 && defined(N)\na\n#if 0\nb\n#else\nc\n#endif\n#elif 1\nd\n#else\ne\n#endif\n\
            #ifdef M\nf\n#endif\n#ifndef M\ng\n#endif\n#undef N\n#ifdef N\nh\n#endif";
        assert_eq!(expanded(text).split_whitespace().collect::<String>(), "acg");
    }

    #[test]
    fn files_are_included_and_reports_name_them() {
        let read = |name: &str| match name {
            "a.h" => Ok("#define N 3\nfoo bar(N)\n".to_string()),
            "b.h" => Ok("#include \"b.h\"\n".to_string()),
            _ => Err("no such file".to_string()),
        };
        let text = "#include \"a.h\"\nx N\n#include <b.h>\n#include nothing";
        let (source, _, reports) = preprocess(text.to_string(), "main.l", &read);
        assert_eq!(
            source.expanded.split_whitespace().collect::<Vec<_>>(),
            ["foo", "bar(3)", "x", "3"]
        );
        let bar = source.expanded.find("bar").unwrap();
        assert_eq!(source.place(bar).to_string(), "a.h:2:5");
        let texts: Vec<String> = reports.iter().map(|report| report.to_string()).collect();
        assert!(texts[0].starts_with("b.h:1:2: 'b.h' includes itself"), "{texts:?}");
        assert!(texts[1].starts_with("main.l:4:2: expected a file name"), "{texts:?}");
    }

    #[test]
    fn lines_can_be_renumbered() {
        let (source, _, _) = preprocess("#line 40 \"other.l\"\nx".into(), "main.l", &no_files);
        assert_eq!(source.place(source.expanded.find('x').unwrap()).to_string(), "other.l:40:1");
    }
}
