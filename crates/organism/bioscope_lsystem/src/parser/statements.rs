use std::ops::Range;

/// What a statement that is no production says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Section {
    Label,
    Seed,
    Axiom,
    DerivationLength,
    Angle,
    Ignore,
    Consider,
    Decomposition,
    Homomorphism,
    MaximumDepth,
    End,
    /// Known to the reference program only.
    Unsupported(&'static str),
    Unknown,
}

/// The words before the colon, lower case, and what they begin.
pub(super) const SECTIONS: [(&str, Section); 24] = [
    ("lsystem", Section::Label),
    ("seed", Section::Seed),
    ("axiom", Section::Axiom),
    ("derivation length", Section::DerivationLength),
    ("angle", Section::Angle),
    ("ignore", Section::Ignore),
    ("consider", Section::Consider),
    ("decomposition", Section::Decomposition),
    ("homomorphism", Section::Homomorphism),
    ("maximum depth", Section::MaximumDepth),
    ("production", Section::Label),
    ("ring lsystem", Section::Unsupported("ring L-systems")),
    ("ring l-system", Section::Unsupported("ring L-systems")),
    ("define", Section::Unsupported("define blocks")),
    ("start", Section::Unsupported("start blocks")),
    ("starteach", Section::Unsupported("startEach blocks")),
    ("start each", Section::Unsupported("startEach blocks")),
    ("end", Section::Unsupported("end blocks")),
    ("endeach", Section::Unsupported("endEach blocks")),
    ("end each", Section::Unsupported("endEach blocks")),
    ("context", Section::Unsupported("right-context modes")),
    ("environment", Section::Unsupported("environments")),
    ("table", Section::Unsupported("tables")),
    ("select", Section::Unsupported("tables")),
];

/// One statement: bytes of the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Statement {
    /// None for a production.
    pub section: Option<Section>,
    /// The words before the colon.
    pub head: Range<usize>,
    /// What follows the colon; the whole production.
    pub content: Range<usize>,
}

/// Splits a text into statements.
pub(super) fn statements(text: &str) -> Vec<Statement> {
    let mut statements: Vec<Statement> = Vec::new();
    let mut position = 0;
    let mut open_braces = 0;
    for line in text.split_inclusive('\n') {
        let start = position;
        position += line.len();
        let end = start + line.trim_end().len();
        if start == end {
            continue;
        }
        let statement = classify(text, start..end);
        match statements.last_mut() {
            // A block that is not supported is passed over as a whole.
            Some(Statement { section: Some(Section::Unsupported(_)), .. }) if open_braces > 0 => {}
            Some(last) if continues(text, last, &statement, start..end) => last.content.end = end,
            _ => {
                open_braces = 0;
                statements.push(statement);
            }
        }
        if let Some(Statement { section: Some(Section::Unsupported(_)), .. }) = statements.last() {
            open_braces += braces(&text[start..end]);
        }
    }
    statements
}

/// Whether an indented line belongs to the statement before it.
fn continues(text: &str, last: &Statement, next: &Statement, line: Range<usize>) -> bool {
    let indented = text[line.clone()].starts_with([' ', '\t']);
    let is_section = next.section.is_some_and(|section| section != Section::Unknown);
    let is_production = text[line].contains("-->")
        && (last.section.is_some() || text[last.content.clone()].contains("-->"));
    indented && !is_section && !is_production
}

fn braces(line: &str) -> i32 {
    line.chars().map(|letter| i32::from(letter == '{') - i32::from(letter == '}')).sum()
}

fn classify(text: &str, line: Range<usize>) -> Statement {
    let content = &text[line.clone()];
    let indent = content.len() - content.trim_start().len();
    let first = line.start + indent;
    let words = content.trim();
    let production = Statement { section: None, head: first..first, content: first..line.end };
    let alone = match words.to_ascii_lowercase().as_str() {
        "endlsystem" => Some(Section::End),
        "decomposition" => Some(Section::Decomposition),
        "homomorphism" => Some(Section::Homomorphism),
        _ => None,
    };
    if alone.is_some() {
        return Statement { section: alone, head: first..line.end, content: line.end..line.end };
    }
    let Some(colon) = words.find(':') else { return production };
    let head = words[..colon].trim_end();
    let normal = head.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
    let known = SECTIONS.iter().find(|(name, _)| *name == normal).map(|&(_, section)| section);
    let section = match known {
        Some(section) => section,
        None if content.contains("-->") || !is_like_a_section(head) => return production,
        None => Section::Unknown,
    };
    let head_end = first + head.len();
    Statement {
        section: Some(section),
        head: first..head_end,
        content: first + colon + 1..line.end,
    }
}

/// Whether these are several letters and blanks, as section names are.
fn is_like_a_section(head: &str) -> bool {
    head.len() > 2 && head.chars().all(|letter| letter.is_ascii_alphabetic() || letter == ' ')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(text: &str) -> Vec<(Option<Section>, &str)> {
        let parts = statements(text).into_iter();
        parts.map(|part| (part.section, text[part.content].trim())).collect()
    }

    #[test]
    fn indented_lines_continue_a_statement() {
        let text = "axiom: A\n B\nA : x >\n\t3 --> F\n  F\n  F --> G\n\nG -->\n H";
        assert_eq!(
            split(text),
            [
                (Some(Section::Axiom), "A\n B"),
                (None, "A : x >\n\t3 --> F\n  F"),
                (None, "F --> G"),
                (None, "G -->\n H"),
            ]
        );
    }

    #[test]
    fn unsupported_blocks_are_one_statement() {
        let text = "define: {\narray a[2] = {1,\n2};\n}\nA --> B";
        let parts = split(text);
        assert_eq!(parts.len(), 2, "{parts:?}");
        assert_eq!(parts[1], (None, "A --> B"));
    }

    #[test]
    fn sections_may_be_indented_and_capitalized() {
        let parts = split("  Derivation  Length : 3\n  Axiom: F\nAxoim: F");
        assert_eq!(parts[0].0, Some(Section::DerivationLength));
        assert_eq!(parts[1], (Some(Section::Axiom), "F"));
        assert_eq!(parts[2].0, Some(Section::Unknown));
    }
}
