use std::{ops::Range, sync::Arc};

use crate::{Diagnostic, Place};

/// The text of an L-system after its macros are expanded, with the way back to the files.
#[derive(Clone, Debug, Default)]
pub(crate) struct Source {
    /// The file itself, then those that it includes.
    pub files: Vec<FileText>,
    pub expanded: String,
    /// One entry per stretch of `expanded`, in order.
    pub stretches: Vec<Stretch>,
}

/// One file.
#[derive(Clone, Debug)]
pub(crate) struct FileText {
    pub name: Arc<str>,
    pub text: Arc<str>,
    /// Where its lines begin.
    lines: Vec<usize>,
    /// Lines whose numbers are said to be others, with those and the file's other name (`#line`).
    renumbered: Vec<(usize, u32, Arc<str>)>,
}

/// Bytes of one of the files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Origin {
    pub file: u16,
    pub span: Range<usize>,
}

/// A stretch of the expanded text.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// Where it begins in the expanded text.
    pub expanded: usize,
    /// Where it came from.
    pub origin: Origin,
    /// The macro it comes from; none if it is copied from the file letter by letter.
    pub made_by: Option<Arc<str>>,
}

impl FileText {
    fn new(name: &str, text: String) -> Self {
        let newlines = text.match_indices('\n').map(|(index, _)| index + 1);
        let lines = std::iter::once(0).chain(newlines).collect();
        Self { name: name.into(), lines, text: text.into(), renumbered: Vec::new() }
    }

    fn place(&self, position: usize) -> Place {
        let line = self.lines.partition_point(|&start| start <= position);
        let column = self.text[self.line_around(position).start..position].chars().count() + 1;
        let said = self.renumbered.iter().rev().find(|(from, ..)| line >= *from);
        let (number, file) = match said {
            Some((from, number, name)) => ((line - from) as u32 + number, name.clone()),
            None => (line as u32, self.name.clone()),
        };
        Place { file, line: number, column: column as u32 }
    }

    fn line_around(&self, position: usize) -> Range<usize> {
        let line = self.lines.partition_point(|&start| start <= position);
        let end = self.lines.get(line).map_or(self.text.len(), |next| next - 1);
        self.lines[line - 1]..end
    }
}

impl Source {
    /// A text whose macros are not expanded yet.
    pub fn new(file: &str, text: String) -> Self {
        Self { files: vec![FileText::new(file, text)], ..Self::default() }
    }

    /// Adds an included file; its number.
    pub fn add_file(&mut self, name: &str, text: String) -> u16 {
        self.files.push(FileText::new(name, text));
        (self.files.len() - 1) as u16
    }

    /// Lets the lines after the one at `position` count from `number` on, as in a file `name`.
    pub fn renumber(&mut self, file: u16, position: usize, number: u32, name: Option<&str>) {
        let text = &mut self.files[file as usize];
        let line = text.lines.partition_point(|&start| start <= position);
        let name = name.map_or_else(|| text.name.clone(), Arc::from);
        text.renumbered.push((line + 1, number, name));
    }

    /// A report about these bytes of the expanded text.
    pub fn diagnostic(&self, span: Range<usize>, message: impl Into<String>) -> Diagnostic {
        let (origin, made_by) = self.origin(span);
        let help = made_by.map(|name| format!("in the expansion of macro '{name}'"));
        Diagnostic { help, ..self.diagnostic_in_file(origin, message) }
    }

    /// A report about these bytes of a file itself.
    pub fn diagnostic_in_file(&self, origin: Origin, message: impl Into<String>) -> Diagnostic {
        let file = &self.files[origin.file as usize];
        let span = origin.span;
        let line = file.line_around(span.start);
        let end = span.end.clamp(span.start, line.end.max(span.start));
        Diagnostic {
            place: file.place(span.start),
            source_line: file.text[line].to_string(),
            width: file.text[span.start..end].chars().count().max(1) as u32,
            message: message.into(),
            help: None,
        }
    }

    /// Line and column of a byte of the expanded text.
    pub fn place(&self, position: usize) -> Place {
        let origin = self.origin(position..position).0;
        self.files[origin.file as usize].place(origin.span.start)
    }

    fn origin(&self, span: Range<usize>) -> (Origin, Option<&Arc<str>>) {
        let index = self.stretches.partition_point(|stretch| stretch.expanded <= span.start);
        let Some(stretch) = index.checked_sub(1).map(|index| &self.stretches[index]) else {
            return (Origin::default(), None);
        };
        if stretch.made_by.is_some() {
            return (stretch.origin.clone(), stretch.made_by.as_ref());
        }
        let Origin { file, span: ref from } = stretch.origin;
        let text = &self.files[file as usize].text;
        let start = (from.start + span.start - stretch.expanded).min(from.end);
        let mut end = (start + span.len()).min(text.len());
        while !text.is_char_boundary(end) {
            end += 1;
        }
        (Origin { file, span: start..end }, None)
    }
}
