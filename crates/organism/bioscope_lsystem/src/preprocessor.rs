//! Comments, continued lines and `#define`, as in the C preprocessor.

use std::{collections::BTreeMap, ops::Range, sync::Arc};

use logos::Logos;

use crate::{Diagnostic, source::Source, source::Stretch};

/// How deeply macros may be nested in one another.
const DEPTH_LIMIT: usize = 64;
/// How many tokens all expansions together may produce.
const TOKEN_LIMIT: usize = 2_000_000;
/// How many tokens the arguments of one call may have.
const CALL_LIMIT: usize = 1_000;
/// How many errors are kept.
const ERROR_LIMIT: usize = 50;
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

#[derive(Clone, Copy, Debug)]
struct Token<'a> {
    kind: Kind,
    text: &'a str,
    start: usize,
}

impl Token<'_> {
    fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }
}

#[derive(Debug)]
struct Macro<'a> {
    /// None for a constant: no parentheses follow its name.
    formals: Option<Vec<&'a str>>,
    body: Vec<Token<'a>>,
}

/// The text after preprocessing, with the names of the constants that it defined and their
/// texts (themselves expanded), and what was wrong.
pub(crate) fn preprocess(
    original: String,
    file: &str,
) -> (Source, Vec<(String, String)>, Vec<Diagnostic>) {
    let mut source = Source::new(file, original);
    let original = std::mem::take(&mut source.original);
    let mut preprocessor = Preprocessor {
        source: &mut source,
        macros: BTreeMap::new(),
        errors: Vec::new(),
        produced: 0,
    };
    preprocessor.run(&original);
    let constants = preprocessor.constants();
    let errors = preprocessor.errors;
    source.original = original;
    let reports = errors
        .into_iter()
        .map(|(span, message)| source.diagnostic_in_file(span, message))
        .collect();
    (source, constants, reports)
}

struct Preprocessor<'a, 's> {
    source: &'s mut Source,
    macros: BTreeMap<&'a str, Macro<'a>>,
    errors: Vec<(Range<usize>, String)>,
    produced: usize,
}

impl<'a> Preprocessor<'a, '_> {
    fn run(&mut self, original: &'a str) {
        let tokens = tokenize(original);
        let mut next = 0;
        let mut at_line_start = true;
        while next < tokens.len() && self.source.expanded.len() < SIZE_LIMIT {
            let token = tokens[next];
            match token.kind {
                Kind::Hash if at_line_start => {
                    let line = &tokens[next..line_end(&tokens, next)];
                    if self.directive(line) {
                        next += line.len();
                    } else {
                        self.copy(token);
                        next += 1;
                    }
                }
                Kind::Name => next += self.name(&tokens[next..]),
                Kind::OpenComment => {
                    self.error(token.span(), "this comment never ends: expected '*/'");
                    return;
                }
                _ => {
                    at_line_start = token.kind == Kind::Newline
                        || (at_line_start && matches!(token.kind, Kind::Blank | Kind::Comment));
                    self.copy(token);
                    next += 1;
                    continue;
                }
            }
            at_line_start = false;
        }
        if self.source.expanded.len() >= SIZE_LIMIT {
            self.error(0..0, format!("more than {} MiB of text", SIZE_LIMIT >> 20));
        }
    }

    fn error(&mut self, span: Range<usize>, message: impl Into<String>) {
        if self.errors.len() < ERROR_LIMIT {
            self.errors.push((span, message.into()));
        }
    }

    fn copy(&mut self, token: Token) {
        let text = match token.kind {
            Kind::Comment | Kind::Continuation => " ",
            _ => token.text,
        };
        self.emit(text, token.span(), None);
    }

    fn emit(&mut self, text: &str, origin: Range<usize>, made_by: Option<Arc<str>>) {
        let expanded = self.source.expanded.len();
        self.source.stretches.push(Stretch { expanded, origin, made_by });
        self.source.expanded.push_str(text);
    }

    /// Carries out the directive in these tokens of one line; false if it is no directive (the
    /// turtle has a symbol `#` too).
    fn directive(&mut self, line: &[Token<'a>]) -> bool {
        let words = &line[1..];
        let Some(name) = words.iter().find(|token| token.kind != Kind::Blank) else { return false };
        match name.text {
            "define" => self.define(line, after(words, name)),
            "undef" => {
                let rest = after(words, name).iter().find(|token| token.kind == Kind::Name);
                rest.map(|name| self.macros.remove(name.text));
            }
            "include" | "if" | "ifdef" | "ifndef" | "else" | "elif" | "endif" | "line"
            | "pragma" | "error" => {
                self.error(name.span(), format!("not supported: #{}", name.text));
            }
            _ => return false,
        }
        true
    }

    /// A definition: the whole line for reports, and its part after `define`.
    fn define(&mut self, line: &[Token<'a>], rest: &[Token<'a>]) {
        let name = rest.iter().find(|token| token.kind != Kind::Blank);
        let Some(name) = name.filter(|token| token.kind == Kind::Name) else {
            let end = line[line.len() - 1].span();
            return self.error(end, "expected a name after #define");
        };
        let mut rest = after(rest, name);
        let mut formals = None;
        if let Some(open) = rest.first().filter(|token| token.kind == Kind::Open) {
            let Some(close) = rest.iter().position(|token| token.kind == Kind::Close) else {
                return self.error(open.span(), "expected ')' after the macro's parameters");
            };
            let names = rest[1..close].iter().filter(|token| token.kind == Kind::Name);
            formals = Some(names.map(|token| token.text).collect());
            rest = &rest[close + 1..];
        }
        let body = rest.iter().map(|&token| match token.kind {
            Kind::Comment | Kind::Continuation => Token { kind: Kind::Blank, text: " ", ..token },
            _ => token,
        });
        let body = body.skip_while(|token| token.kind == Kind::Blank).collect();
        self.macros.insert(name.text, Macro { formals, body });
    }

    /// Copies a name or expands the macro of this name; how many tokens it took from the file.
    fn name(&mut self, tokens: &[Token<'a>]) -> usize {
        let name = tokens[0];
        let used = match self.macros.get(name.text) {
            None => None,
            Some(Macro { formals: None, .. }) => Some(1),
            Some(_) => call_length(&tokens[1..]).map(|length| length + 1),
        };
        let Some(used) = used else {
            self.copy(name);
            return 1;
        };
        let mut expanded = Vec::new();
        match self.expand(&tokens[..used], &mut Vec::new(), &mut expanded) {
            Ok(()) => {
                let text: String = expanded.iter().map(|token| token.text).collect();
                let origin = name.start..tokens[used - 1].span().end;
                self.emit(&text, origin, Some(name.text.into()));
            }
            Err(message) => self.error(name.span(), message),
        }
        used
    }

    /// Appends `tokens` with all macros expanded, except those `active` already.
    fn expand(
        &mut self,
        tokens: &[Token<'a>],
        active: &mut Vec<&'a str>,
        out: &mut Vec<Token<'a>>,
    ) -> Result<(), String> {
        if active.len() >= DEPTH_LIMIT {
            return Err(format!("macros nested more than {DEPTH_LIMIT} deep"));
        }
        let mut next = 0;
        while next < tokens.len() {
            let token = tokens[next];
            self.produced += 1;
            if self.produced > TOKEN_LIMIT {
                return Err(format!("macros expand to more than {TOKEN_LIMIT} tokens"));
            }
            next += 1;
            let known = token.kind == Kind::Name && !active.contains(&token.text);
            let Some(definition) = self.macros.get(token.text).filter(|_| known) else {
                out.push(token);
                continue;
            };
            let mut body = definition.body.clone();
            if let Some(formals) = definition.formals.clone() {
                let Some(length) = call_length(&tokens[next..]) else {
                    out.push(token);
                    continue;
                };
                let actuals = arguments(&tokens[next..next + length]);
                next += length;
                if actuals.len() != formals.len() {
                    return Err(format!(
                        "macro '{}' has {} parameters, found {}",
                        token.text,
                        formals.len(),
                        actuals.len()
                    ));
                }
                body = self.substitute(&body, &formals, &actuals, active)?;
            }
            active.push(token.text);
            self.expand(&body, active, out)?;
            active.pop();
        }
        Ok(())
    }

    /// The macro's body with its parameters replaced by the expanded arguments.
    fn substitute(
        &mut self,
        body: &[Token<'a>],
        formals: &[&'a str],
        actuals: &[&[Token<'a>]],
        active: &mut Vec<&'a str>,
    ) -> Result<Vec<Token<'a>>, String> {
        let mut expanded = Vec::new();
        for actual in actuals {
            let mut tokens = Vec::new();
            // One more than the macros that are active, so that nested calls count as depth.
            active.push("");
            self.expand(actual, active, &mut tokens)?;
            active.pop();
            expanded.push(tokens);
        }
        let mut out = Vec::new();
        for token in body {
            match formals.iter().position(|&formal| formal == token.text) {
                Some(index) => out.extend_from_slice(&expanded[index]),
                None => out.push(*token),
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
        let bodies: Vec<(&str, Vec<Token>)> =
            constants.map(|(&name, definition)| (name, definition.body.clone())).collect();
        let mut texts = Vec::new();
        for (name, body) in bodies {
            let mut out = Vec::new();
            if self.expand(&body, &mut vec![name], &mut out).is_ok() {
                texts.push((name.to_string(), out.iter().map(|token| token.text).collect()));
            }
        }
        texts
    }
}

fn tokenize(text: &str) -> Vec<Token<'_>> {
    let token = |(kind, span): (Result<Kind, ()>, Range<usize>)| Token {
        kind: kind.unwrap_or(Kind::Other),
        text: &text[span.clone()],
        start: span.start,
    };
    Kind::lexer(text).spanned().map(token).collect()
}

/// Index of the next newline, or the number of tokens.
fn line_end(tokens: &[Token], from: usize) -> usize {
    let newline = tokens[from..].iter().position(|token| token.kind == Kind::Newline);
    newline.map_or(tokens.len(), |index| from + index)
}

/// What follows one of these tokens.
fn after<'t, 'a>(tokens: &'t [Token<'a>], token: &Token) -> &'t [Token<'a>] {
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
fn arguments<'t, 'a>(call: &'t [Token<'a>]) -> Vec<&'t [Token<'a>]> {
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

    fn expanded(text: &str) -> String {
        let (source, _, reports) = preprocess(text.to_string(), "test.l");
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
        let (_, _, reports) = preprocess(text + "a8", "test.l");
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
            ("#include <a.h>", 1, 2, "not supported: #include"),
        ] {
            let (_, _, reports) = preprocess(text.to_string(), "test.l");
            assert_eq!(reports.len(), 1, "{text}");
            assert_eq!((reports[0].place.line, reports[0].place.column), (line, column), "{text}");
            assert!(reports[0].message.contains(part), "{}", reports[0]);
        }
    }
}
