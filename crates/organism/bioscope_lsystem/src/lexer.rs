//! Tokens. The same letters mean different things in a string of modules (`F-F` are three
//! modules) and in an expression (a difference), so the parser says which it expects next.

use std::{ops::Range, rc::Rc};

use logos::Logos;

/// What strings of modules consist of.
#[derive(Logos, Clone, Copy, Debug, PartialEq)]
#[logos(skip r"[ \t\r\n\f]+")]
pub(crate) enum Word {
    #[regex(r"[A-Za-z0-9+\-&^\\/|!'#;,.\[\]{}%$_?=]")]
    #[regex(r"@([A-Za-z!#;,]|PS|PC|PD|G[secrt]|Tx|T[sdpf]|D[id]|b[oc])")]
    #[regex(r"[~?][A-Za-z]")]
    Symbol,
    #[token("-->")]
    Arrow,
    #[token("-o>")]
    ObjectArrow,
    #[token("<")]
    Less,
    #[token(">")]
    Greater,
    #[token(":")]
    Colon,
    #[token("*")]
    Star,
    #[token("(")]
    Open,
    End,
    Unknown,
}

/// What expressions consist of.
#[derive(Logos, Clone, Copy, Debug, PartialEq)]
#[logos(skip r"[ \t\r\n\f]+")]
pub(crate) enum Term {
    #[regex(r"[0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)?")]
    #[regex(r"\.[0-9]+([eE][+-]?[0-9]+)?")]
    Number,
    #[regex(r"[A-Za-z_][A-Za-z0-9_]*")]
    Name,
    #[regex(r#""([^"\\\n]|\\[^\n])*""#)]
    Text,
    #[token("+")]
    Plus,
    #[token("-")]
    Minus,
    #[token("*")]
    Star,
    #[token("/")]
    Slash,
    #[token("%")]
    Percent,
    #[token("^")]
    Power,
    #[token("!")]
    Not,
    #[token("<")]
    Less,
    #[token("<=")]
    LessEqual,
    #[token(">")]
    Greater,
    #[token(">=")]
    GreaterEqual,
    #[token("==")]
    Equal,
    #[token("!=")]
    #[token("<>")]
    Unequal,
    #[token("&&")]
    And,
    #[token("||")]
    Or,
    #[token("?")]
    Question,
    #[token(":")]
    Colon,
    #[token("(")]
    Open,
    #[token(")")]
    Close,
    #[token("[")]
    OpenIndex,
    #[token("]")]
    CloseIndex,
    #[token("&")]
    Address,
    #[token("{")]
    OpenBlock,
    #[token("}")]
    CloseBlock,
    #[token(",")]
    Comma,
    #[token(";")]
    Semicolon,
    #[token("=")]
    Assign,
    #[token("-->")]
    #[token("-o>")]
    Arrow,
    End,
    Unknown,
}

/// A place in the text of one statement, from which tokens of either kind are read.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    text: &'a str,
    /// Next byte to be read.
    pub position: usize,
    end: usize,
    /// Declared names of modules, longest first.
    modules: Rc<[String]>,
    /// Whether every letter is a module, `@o` two of them.
    letters: bool,
}

impl<'a> Cursor<'a> {
    pub fn new(text: &'a str, span: Range<usize>) -> Self {
        Self { text, position: span.start, end: span.end, modules: Rc::new([]), letters: false }
    }

    /// One that knows modules of several letters.
    pub fn with_modules(self, modules: Rc<[String]>) -> Self {
        Self { modules, ..self }
    }

    /// One to which every letter is a module, if `letters`.
    pub fn by_letters(self, letters: bool) -> Self {
        Self { letters, ..self }
    }

    /// The text of these bytes.
    pub fn slice(&self, span: Range<usize>) -> &'a str {
        &self.text[span]
    }

    /// Where the statement begins that is read, and its text.
    pub fn statement(&self) -> (usize, &'a str) {
        let first = self.text[..self.position].rfind('\n').map_or(0, |end| end + 1);
        (first, &self.text[first..self.end])
    }

    /// What has not been read.
    pub fn rest(&self) -> &'a str {
        &self.text[self.position..self.end]
    }

    /// The next token as part of a string of modules, without reading past it.
    pub fn peek_word(&self) -> (Word, Range<usize>) {
        if let Some(span) = self.declared_module() {
            return (Word::Symbol, span);
        }
        let (token, span) = self.peek(Word::End);
        if self.letters && self.slice(span.clone()).starts_with(['@', '~']) {
            return (Word::Symbol, span.start..span.start + 1);
        }
        (token.unwrap_or(Word::Unknown), span)
    }

    fn declared_module(&self) -> Option<Range<usize>> {
        let rest = self.rest();
        let text = rest.trim_start();
        let name = self.modules.iter().find(|name| text.starts_with(name.as_str()))?;
        let start = self.position + rest.len() - text.len();
        Some(start..start + name.len())
    }

    /// The next token as part of an expression, without reading past it.
    pub fn peek_term(&self) -> (Term, Range<usize>) {
        let (token, span) = self.peek(Term::End);
        (token.unwrap_or(Term::Unknown), span)
    }

    fn peek<T>(&self, end: T) -> (Result<T, ()>, Range<usize>)
    where
        T: Logos<'a, Source = str, Error = (), Extras = ()>,
    {
        let mut lexer = T::lexer(self.rest());
        match lexer.next() {
            Some(token) => {
                let span = lexer.span();
                (token, self.position + span.start..self.position + span.end)
            }
            None => {
                let last = self.position + self.rest().trim_end().len();
                (Ok(end), last..last)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<(Word, &str)> {
        let mut cursor = Cursor::new(text, 0..text.len());
        let mut tokens = Vec::new();
        loop {
            let (token, span) = cursor.peek_word();
            if token == Word::End {
                return tokens;
            }
            cursor.position = span.end;
            tokens.push((token, &text[span]));
        }
    }

    #[test]
    fn modules_are_single_letters_and_named_turtle_symbols() {
        let texts: Vec<&str> = words("F--F-->@GsA@T~l?P@Tx@;%").iter().map(|word| word.1).collect();
        assert_eq!(
            texts,
            ["F", "-", "-", "F", "-->", "@Gs", "A", "@T", "~l", "?P", "@Tx", "@;", "%"]
        );
    }

    #[test]
    fn modules_may_be_single_letters_alone() {
        let text = "@Gs~l@";
        let mut cursor = Cursor::new(text, 0..text.len()).by_letters(true);
        let mut found = Vec::new();
        while let (Word::Symbol, span) = cursor.peek_word() {
            cursor.position = span.end;
            found.push(&text[span]);
        }
        assert_eq!(found, ["@", "G", "s", "~", "l", "@"]);
    }

    #[test]
    fn what_is_no_module_is_unknown_and_keeps_its_whole_character() {
        let unknown = words("Fä F");
        assert_eq!(unknown[1], (Word::Unknown, "ä"));
        assert_eq!(words("~ F")[0], (Word::Unknown, "~"));
    }

    #[test]
    fn expressions_have_numbers_and_operators() {
        for (text, token) in [
            (".5", Term::Number),
            ("1.", Term::Number),
            ("2.5e-3", Term::Number),
            ("<>", Term::Unequal),
            ("<=", Term::LessEqual),
            ("x_1", Term::Name),
            ("-->", Term::Arrow),
            ("", Term::End),
        ] {
            let cursor = Cursor::new(text, 0..text.len());
            assert_eq!(cursor.peek_term(), (token, 0..text.len()), "{text}");
        }
    }
}
