use std::{ops::Range, sync::Arc};

use crate::{Diagnostic, Place};

/// The text of an L-system file after its macros are expanded, with the way back to the file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Source {
    pub file: Arc<str>,
    pub original: String,
    /// Where the lines of `original` begin.
    pub lines: Vec<usize>,
    pub expanded: String,
    /// One entry per stretch of `expanded`, in order.
    pub stretches: Vec<Stretch>,
}

/// A stretch of the expanded text.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// Where it begins in the expanded text.
    pub expanded: usize,
    /// Where it came from in the file.
    pub origin: Range<usize>,
    /// The macro it comes from; none if it is copied from the file letter by letter.
    pub made_by: Option<Arc<str>>,
}

impl Source {
    /// A text whose macros are not expanded yet.
    pub fn new(file: &str, original: String) -> Self {
        let newlines = original.match_indices('\n').map(|(index, _)| index + 1);
        let lines = std::iter::once(0).chain(newlines).collect();
        Self { file: file.into(), original, lines, ..Self::default() }
    }

    /// A report about these bytes of the expanded text.
    pub fn diagnostic(&self, span: Range<usize>, message: impl Into<String>) -> Diagnostic {
        let (origin, made_by) = self.origin(span);
        let help = made_by.map(|name| format!("in the expansion of macro '{name}'"));
        Diagnostic { help, ..self.diagnostic_in_file(origin, message) }
    }

    /// A report about these bytes of the file itself.
    pub fn diagnostic_in_file(&self, span: Range<usize>, message: impl Into<String>) -> Diagnostic {
        let line = self.line_around(span.start);
        let end = span.end.clamp(span.start, line.end.max(span.start));
        Diagnostic {
            place: self.place_in_file(span.start),
            source_line: self.original[line].to_string(),
            width: self.original[span.start..end].chars().count().max(1) as u32,
            message: message.into(),
            help: None,
        }
    }

    /// Line and column of a byte of the expanded text.
    pub fn place(&self, position: usize) -> Place {
        self.place_in_file(self.origin(position..position).0.start)
    }

    fn place_in_file(&self, position: usize) -> Place {
        let line = self.lines.partition_point(|&start| start <= position);
        let column = self.original[self.line_around(position).start..position].chars().count() + 1;
        Place { file: self.file.clone(), line: line as u32, column: column as u32 }
    }

    fn line_around(&self, position: usize) -> Range<usize> {
        let line = self.lines.partition_point(|&start| start <= position);
        let end = self.lines.get(line).map_or(self.original.len(), |next| next - 1);
        self.lines[line - 1]..end
    }

    fn origin(&self, span: Range<usize>) -> (Range<usize>, Option<&Arc<str>>) {
        let index = self.stretches.partition_point(|stretch| stretch.expanded <= span.start);
        let Some(stretch) = index.checked_sub(1).map(|index| &self.stretches[index]) else {
            return (0..0, None);
        };
        if stretch.made_by.is_some() {
            return (stretch.origin.clone(), stretch.made_by.as_ref());
        }
        let start = (stretch.origin.start + span.start - stretch.expanded).min(stretch.origin.end);
        let mut end = (start + span.len()).min(self.original.len());
        while !self.original.is_char_boundary(end) {
            end += 1;
        }
        (start..end, None)
    }
}
