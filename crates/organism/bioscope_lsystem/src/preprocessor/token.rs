//! The tokens that the preprocessor sees.

use std::{ops::Range, sync::Arc};

use logos::Logos;

use crate::source::Origin;

/// How many tokens the arguments of one call may have.
const CALL_LIMIT: usize = 1_000;

/// What a token is.
#[derive(Logos, Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
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
pub(super) struct Token {
    pub kind: Kind,
    pub file: u16,
    pub text: Fragment,
    pub start: usize,
}

/// A piece of a file's text.
#[derive(Clone, Debug)]
pub(super) struct Fragment {
    pub file: Arc<str>,
    pub span: Range<usize>,
}

impl std::ops::Deref for Fragment {
    type Target = str;

    fn deref(&self) -> &str {
        &self.file[self.span.clone()]
    }
}

impl Token {
    pub fn origin(&self) -> Origin {
        Origin { file: self.file, span: self.start..self.end() }
    }

    pub fn end(&self) -> usize {
        self.start + self.text.len()
    }

    pub fn is_blank(&self) -> bool {
        matches!(self.kind, Kind::Blank | Kind::Comment | Kind::Continuation)
    }
}

pub(super) fn joined(tokens: &[Token]) -> String {
    tokens.iter().map(|token| &*token.text).collect()
}

pub(super) fn tokenize(text: &Arc<str>, file: u16) -> Vec<Token> {
    let token = |(kind, span): (Result<Kind, ()>, Range<usize>)| Token {
        kind: kind.unwrap_or(Kind::Other),
        file,
        start: span.start,
        text: Fragment { file: text.clone(), span },
    };
    Kind::lexer(text).spanned().map(token).collect()
}

/// Index of the next newline, or the number of tokens.
pub(super) fn line_end(tokens: &[Token], from: usize) -> usize {
    let newline = tokens[from..].iter().position(|token| token.kind == Kind::Newline);
    newline.map_or(tokens.len(), |index| from + index)
}

/// What follows one of these tokens.
pub(super) fn after<'t>(tokens: &'t [Token], token: &Token) -> &'t [Token] {
    let index = tokens.iter().position(|other| other.start == token.start);
    &tokens[index.map_or(tokens.len(), |index| index + 1)..]
}

/// How many tokens the parenthesized arguments take that should stand first here, blanks
/// included; all on one line.
pub(super) fn call_length(tokens: &[Token]) -> Option<usize> {
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
pub(super) fn arguments(call: &[Token]) -> Vec<&[Token]> {
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
