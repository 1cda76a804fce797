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
    Ring,
    Block(Block),
    RightContext,
    Environment,
    Table,
    Select,
    Modules,
    Order,
    Timed,
    Growth,
    /// `array name[size] = { … }` on a line of its own.
    Array,
    End,
    /// A heading that says nothing.
    Heading,
    Unknown,
}

/// A block of statements in braces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Block {
    Define,
    Start,
    StartEach,
    EndEach,
    End,
}

/// The words before the colon, lower case, and what they begin.
pub(super) const SECTIONS: [(&str, Section); 30] = [
    ("lsystem", Section::Label),
    ("seed", Section::Seed),
    ("axiom", Section::Axiom),
    ("derivation length", Section::DerivationLength),
    ("derivationlength", Section::DerivationLength),
    ("angle", Section::Angle),
    ("ignore", Section::Ignore),
    ("consider", Section::Consider),
    ("decomposition", Section::Decomposition),
    ("homomorphism", Section::Homomorphism),
    ("maximum depth", Section::MaximumDepth),
    ("production", Section::Heading),
    ("productions", Section::Heading),
    ("ring lsystem", Section::Ring),
    ("ring l-system", Section::Ring),
    ("define", Section::Block(Block::Define)),
    ("start", Section::Block(Block::Start)),
    ("starteach", Section::Block(Block::StartEach)),
    ("start each", Section::Block(Block::StartEach)),
    ("end", Section::Block(Block::End)),
    ("endeach", Section::Block(Block::EndEach)),
    ("end each", Section::Block(Block::EndEach)),
    ("context", Section::RightContext),
    ("environment", Section::Environment),
    ("table", Section::Table),
    ("select", Section::Select),
    ("modules", Section::Modules),
    ("order", Section::Order),
    ("timed", Section::Timed),
    ("growth", Section::Growth),
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
    let mut braces = Braces::default();
    for line in text.split_inclusive('\n') {
        let start = position;
        position += line.len();
        let end = start + line.trim_end().len();
        if start == end {
            continue;
        }
        let content = &text[start..end];
        if braces.are_open() {
            braces.count(content);
            if let Some(last) = statements.last_mut() {
                last.content.end = end;
            }
            continue;
        }
        let statement = classify(text, start..end);
        match statements.last_mut() {
            Some(last) if continues(text, last, &statement, start..end) => {
                last.content.end = end;
                if last.section.is_none() || matches!(last.section, Some(Section::Block(_))) {
                    braces.count(content);
                }
            }
            _ => {
                braces = match statement.section {
                    None => Braces::of_production(),
                    Some(Section::Block(_) | Section::Array) => Braces::of_block(),
                    Some(_) => Braces::default(),
                };
                braces.count(content);
                statements.push(statement);
            }
        }
    }
    statements
}

/// Braces that keep a statement open over several lines.
///
/// In a production only those between the colon and the arrow count: others are modules.
#[derive(Default)]
struct Braces {
    open: i32,
    counting: bool,
    /// Whether the colon of a production is still to come.
    before_colon: bool,
    is_production: bool,
}

impl Braces {
    fn of_block() -> Self {
        Self { counting: true, ..Self::default() }
    }

    fn of_production() -> Self {
        Self { before_colon: true, is_production: true, ..Self::default() }
    }

    fn are_open(&self) -> bool {
        self.open > 0
    }

    fn count(&mut self, line: &str) {
        let mut in_text = false;
        for (index, letter) in line.char_indices() {
            match letter {
                '"' => in_text = !in_text,
                _ if in_text => {}
                ':' if self.before_colon => (self.before_colon, self.counting) = (false, true),
                '-' if self.is_production
                    && self.open == 0
                    && (line[index..].starts_with("-->") || line[index..].starts_with("-o>")) =>
                {
                    (self.before_colon, self.counting) = (false, false);
                }
                '{' if self.counting => self.open += 1,
                '}' if self.counting => self.open = (self.open - 1).max(0),
                _ => {}
            }
        }
    }
}

/// Whether an indented line belongs to the statement before it.
fn continues(text: &str, last: &Statement, next: &Statement, line: Range<usize>) -> bool {
    let content = &text[line.clone()];
    if let Some(Section::Block(_)) = last.section {
        // The brace of a block may stand on the next line.
        let is_empty = text[last.content.clone()].trim().is_empty();
        return is_empty && content.trim_start().starts_with('{');
    }
    let indented = content.starts_with([' ', '\t']);
    let is_section = next.section.is_some_and(|section| section != Section::Unknown);
    let has_arrow = |text: &str| text.contains("-->") || text.contains("-o>");
    let is_production =
        has_arrow(content) && (last.section.is_some() || has_arrow(&text[last.content.clone()]));
    indented && !is_section && !is_production
}

fn classify(text: &str, line: Range<usize>) -> Statement {
    let content = &text[line.clone()];
    let indent = content.len() - content.trim_start().len();
    let first = line.start + indent;
    let words = content.trim();
    let production = Statement { section: None, head: first..first, content: first..line.end };
    let lower = words.to_ascii_lowercase();
    let alone = match lower.as_str() {
        "endlsystem" => Some(Section::End),
        "decomposition" => Some(Section::Decomposition),
        "homomorphism" => Some(Section::Homomorphism),
        "ring lsystem" | "ring l-system" => Some(Section::Ring),
        _ => None,
    };
    if alone.is_some() {
        return Statement { section: alone, head: first..line.end, content: line.end..line.end };
    }
    if lower.starts_with("array ") && words.contains('[') && !words.contains("-->") {
        let content = first + "array ".len()..line.end;
        return Statement { section: Some(Section::Array), head: first..content.start, content };
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
    fn blocks_are_one_statement() {
        let text = "define: {\narray a[2] = {1,\n2};\n}\nstart:\n{ x = 1;\n if (x) {\ny = \"}\"; }\n}\nA --> {\nB --> }";
        let parts = split(text);
        assert_eq!(parts.len(), 4, "{parts:?}");
        assert_eq!(parts[1].0, Some(Section::Block(Block::Start)));
        assert_eq!(parts[3], (None, "B --> }"));
    }

    #[test]
    fn blocks_in_productions_may_span_lines() {
        let text = "A(x) : {y = x;\nz = y;}\n\tz > 1 {\nw = 2;\n} --> B(z)\nB --> C";
        let parts = split(text);
        assert_eq!(parts.len(), 2, "{parts:?}");
        assert_eq!(parts[1], (None, "B --> C"));
    }

    #[test]
    fn sections_may_be_indented_and_capitalized() {
        let parts = split("  Derivation  Length : 3\n  Axiom: F\nAxoim: F");
        assert_eq!(parts[0].0, Some(Section::DerivationLength));
        assert_eq!(parts[1], (Some(Section::Axiom), "F"));
        assert_eq!(parts[2].0, Some(Section::Unknown));
    }
}
