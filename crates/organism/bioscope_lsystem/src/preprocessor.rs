//! Comments, continued lines and directives (`#define`, `#include`, `#if` …), as in the C
//! preprocessor.

mod conditions;
mod macros;
mod token;

use std::{collections::BTreeMap, sync::Arc};

use crate::{
    Diagnostic,
    diagnostic::suggestion,
    source::{Origin, Source, Stretch},
};
use conditions::{Conditions, value};
use macros::Macro;
use token::{Fragment, Kind, Token, after, joined, line_end, tokenize};

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
}

fn emit(source: &mut Source, text: &str, origin: Origin, made_by: Option<Arc<str>>) {
    if text.is_empty() {
        return;
    }
    source.stretches.push(Stretch { expanded: source.expanded.len(), origin, made_by });
    source.expanded.push_str(text);
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
