use std::{fmt, sync::Arc};

/// Where something stands in a file; lines and columns count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Name of the file as it was given.
    pub file: Arc<str>,
    /// Line.
    pub line: u32,
    /// Column.
    pub column: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file, self.line, self.column)
    }
}

/// One thing wrong (or doubtful) in an L-system file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Where; inside the expansion of a macro, where the macro is used.
    pub place: Place,
    /// The line of the file that contains the place.
    pub source_line: String,
    /// How many characters of that line are meant, at least 1.
    pub width: u32,
    /// What was found and what was expected.
    pub message: String,
    /// What might help: a name that was perhaps meant, the macro that was being expanded.
    pub help: Option<String>,
}

/// How many characters of a very long line a report shows on either side of the place.
const SHOWN: usize = 60;

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let column = self.place.column as usize - 1;
        let first = column.saturating_sub(SHOWN);
        let shown: String = self.source_line.chars().skip(first).take(2 * SHOWN).collect();
        let shown = shown.replace('\t', " ").replace(char::is_control, "\u{fffd}");
        let underline = (self.width as usize).clamp(1, shown.chars().count().max(1));
        let number = self.place.line.to_string();
        let gutter = " ".repeat(number.len());
        writeln!(f, "{}: {}", self.place, self.message)?;
        writeln!(f, " {number} | {}", shown.trim_end())?;
        write!(f, " {gutter} | {}{}", " ".repeat(column - first), "^".repeat(underline))?;
        match &self.help {
            Some(help) => write!(f, "\n {gutter} = {help}"),
            None => Ok(()),
        }
    }
}

/// Everything that is wrong in an L-system file, in the order of the file; never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics(pub Vec<Diagnostic>);

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, diagnostic) in self.0.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{diagnostic}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

impl From<Diagnostics> for bioscope_core::Error {
    /// The first report's place is the error's place; the text holds all reports.
    fn from(diagnostics: Diagnostics) -> Self {
        let Some(first) = diagnostics.0.first() else {
            return Self::format("L-system", "not valid");
        };
        let text = diagnostics.to_string();
        let place = first.place.to_string();
        let message = text.strip_prefix(&format!("{place}: ")).unwrap_or(&text);
        Self::format(place.clone(), message)
    }
}

/// The known name most like `name`, if one is like enough to have been meant.
pub(crate) fn suggestion<'a>(
    name: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let allowed = match name.chars().count() {
        0..=2 => return None,
        3..=5 => 1,
        _ => 2,
    };
    known
        .into_iter()
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|&(distance, _)| distance <= allowed)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// Number of letters to insert, remove, replace or swap with their neighbor to turn `a` into `b`, case ignored.
fn distance(a: &str, b: &str) -> usize {
    const LONGEST: usize = 40;
    let fold = |text: &str| text.chars().take(LONGEST).flat_map(char::to_lowercase).collect();
    let (a, b): (Vec<char>, Vec<char>) = (fold(a), fold(b));
    let mut before = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1];
        for j in 0..b.len() {
            let replaced = last[j] + usize::from(a[i] != b[j]);
            let mut least = replaced.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggests_what_was_perhaps_meant() {
        let known = ["length", "axiom", "ignore"];
        assert_eq!(suggestion("lenght", known), Some("length"));
        assert_eq!(suggestion("Axoim", known), Some("axiom"));
        assert_eq!(suggestion("colour", known), None);
        assert_eq!(suggestion("x", ["y"]), None);
    }

    #[test]
    fn a_report_points_at_the_place() {
        let diagnostic = Diagnostic {
            place: Place { file: "fern.l".into(), line: 12, column: 3 },
            source_line: "F(x --> FF".into(),
            width: 1,
            message: "expected ')'".into(),
            help: None,
        };
        let expected = "fern.l:12:3: expected ')'\n 12 | F(x --> FF\n    |   ^";
        assert_eq!(diagnostic.to_string(), expected);
    }
}
