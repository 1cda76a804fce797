use std::sync::Arc;

use crate::{Diagnostic, Diagnostics, Place};

/// Largest text file, bytes.
const LARGEST: usize = 16 << 20;
/// Most macros of one file.
const MACROS: usize = 1000;

/// A text file of commands, its comments blanked out and its simple macros replaced.
pub(crate) struct Text {
    pub file: Arc<str>,
    lines: Vec<String>,
}

/// A line with something in it.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    /// Counted from 1.
    pub number: u32,
    pub text: String,
}

impl Text {
    /// Takes over a file; bytes that are no UTF-8 become question marks.
    pub fn new(bytes: &[u8], file: &str) -> Result<Self, Diagnostics> {
        let file: Arc<str> = file.into();
        if bytes.len() > LARGEST {
            let line = Line { number: 1, text: String::new() };
            let text = Self { file, lines: Vec::new() };
            return Err(text.error(&line, "the file is larger than 16 MiB"));
        }
        let mut text = Self { file, lines: Vec::new() };
        let clean = without_comments(&String::from_utf8_lossy(bytes));
        let mut macros: Vec<(String, String)> = Vec::new();
        for line in clean.lines() {
            if let Some(rest) = line.trim_start().strip_prefix('#') {
                if let Some(definition) = rest.trim_start().strip_prefix("define") {
                    let (name, value) = halves(definition.trim());
                    if macros.len() < MACROS && !name.is_empty() && !name.contains('(') {
                        macros.push((name.into(), value.trim().into()));
                    }
                }
                text.lines.push(String::new());
            } else {
                text.lines.push(replaced(line, &macros));
            }
        }
        Ok(text)
    }

    /// The lines that hold something.
    pub fn lines(&self) -> impl Iterator<Item = Line> {
        let numbered = self.lines.iter().enumerate();
        numbered.filter(|(_, text)| !text.trim().is_empty()).map(|(index, text)| Line {
            number: index as u32 + 1,
            text: text.trim_end().to_string(),
        })
    }

    /// A report about a line.
    pub fn diagnostic(&self, line: &Line, message: impl Into<String>) -> Diagnostic {
        let indent = line.text.len() - line.text.trim_start().len();
        Diagnostic {
            place: Place { file: self.file.clone(), line: line.number, column: indent as u32 + 1 },
            source_line: line.text.clone(),
            width: line.text.trim().chars().count().max(1) as u32,
            message: message.into(),
            help: None,
        }
    }

    /// The same as what ends the reading.
    pub fn error(&self, line: &Line, message: impl Into<String>) -> Diagnostics {
        Diagnostics(vec![self.diagnostic(line, message)])
    }

    /// What ends the reading after the last line.
    pub fn ends(&self, expected: &str) -> Diagnostics {
        let line = Line { number: self.lines.len().max(1) as u32, text: String::new() };
        self.error(&line, format!("the file ends where {expected} was expected"))
    }
}

impl Line {
    /// What stands before and after the first colon.
    pub fn command(&self) -> Option<(&str, &str)> {
        let (name, rest) = self.text.split_once(':')?;
        Some((name.trim(), rest.trim()))
    }
}

/// The numbers in a text, which may be separated by blanks, commas, colons and letters x.
pub(crate) fn numbers(text: &str) -> Vec<f32> {
    let separators = |letter: char| letter.is_whitespace() || ",;:()".contains(letter);
    let words = text.split(separators).filter(|word| !word.is_empty());
    words.map_while(number).collect()
}

/// A finite number at the beginning of a word.
pub(crate) fn number(word: &str) -> Option<f32> {
    word.parse::<f32>().ok().filter(|number| number.is_finite())
}

fn halves(text: &str) -> (&str, &str) {
    text.split_once(char::is_whitespace).unwrap_or((text, ""))
}

/// Replaces comments by as much blank, so that places stay true.
fn without_comments(text: &str) -> String {
    let mut clean = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find("/*") {
        clean.push_str(&rest[..start]);
        let end = rest[start + 2..].find("*/").map_or(rest.len(), |end| start + 2 + end + 2);
        clean.extend(rest[start..end].chars().map(|one| if one == '\n' { '\n' } else { ' ' }));
        rest = &rest[end..];
    }
    clean.push_str(rest);
    clean
}

/// Replaces words that are names of macros, once.
fn replaced(line: &str, macros: &[(String, String)]) -> String {
    if macros.is_empty() {
        return line.to_string();
    }
    let mut result = String::with_capacity(line.len());
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut rest = line;
    while !rest.is_empty() {
        let word = rest.find(|letter| !is_word(letter)).unwrap_or(rest.len());
        if word > 0 {
            let name = &rest[..word];
            let value = macros.iter().rev().find(|(known, _)| known == name);
            result.push_str(value.map_or(name, |(_, value)| value));
            rest = &rest[word..];
        } else {
            let other = rest.find(is_word).unwrap_or(rest.len());
            result.push_str(&rest[..other]);
            rest = &rest[other..];
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_macros_leave_the_lines_in_place() {
        let source = "#define SIZE 3\n/* one\n two */ a: SIZE\n\nb: 1,2 3x\n";
        let text = Text::new(source.as_bytes(), "x.v").unwrap();
        let lines: Vec<Line> = text.lines().collect();
        assert_eq!(lines[0].number, 3);
        assert_eq!(lines[0].command(), Some(("a", "3")));
        assert_eq!(lines[1].number, 5);
        assert_eq!(numbers(lines[1].command().unwrap().1), [1.0, 2.0]);
        let report = text.diagnostic(&lines[1], "no").to_string();
        assert!(report.starts_with("x.v:5:1: no"), "{report}");
    }
}
