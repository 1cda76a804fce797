//! Files and texts.

use std::path::{Component, Path};

use super::{Parser, statements};
use crate::{Diagnostics, LSystem, lexer::Cursor, machine::Rules, preprocessor::preprocess};

/// How large an included file may be, bytes.
const INCLUDE_LIMIT: u64 = 16 << 20;

impl LSystem {
    /// Reads an L-system from a file; what it includes must be in the same folder or below.
    ///
    /// The name says which notation it is in: `.lsys` is our own, everything else the cpfg
    /// dialect.
    pub fn read(path: impl AsRef<Path>) -> bioscope_core::Result<Self> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let bytes = std::fs::read(path)
            .map_err(|error| bioscope_core::Error::format(&name, error.to_string()))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let line = error.as_bytes()[..error.utf8_error().valid_up_to()]
                .iter()
                .filter(|&&byte| byte == b'\n')
                .count();
            bioscope_core::Error::format(format!("{name}:{}", line + 1), "not UTF-8 text")
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Ok(Self::parse_in(&text, &name, folder)?)
    }

    /// Reads an L-system from text; `file_name` is what reports call it, and says which notation
    /// it is in. It can include no files.
    ///
    /// ```
    /// use bioscope_lsystem::LSystem;
    /// let text = "lsystem: 1\nderivation length: 2\naxiom: A(1)\nA(x) --> A(x+1)A(x/2)\nendlsystem\n";
    /// let string = LSystem::parse(text, "pairs.l")?.derive(2, 0)?;
    /// assert_eq!(string.to_string(), "A(3)A(1)A(1.5)A(0.25)");
    /// # Ok::<(), bioscope_core::Error>(())
    /// ```
    pub fn parse(source: &str, file_name: &str) -> Result<Self, Diagnostics> {
        let include = |name: &str| Err(format!("a text alone cannot include a file: '{name}'"));
        Self::parse_with(source, file_name, &include)
    }

    /// Reads an L-system from text that may include files of a folder.
    pub fn parse_in(source: &str, file_name: &str, folder: &Path) -> Result<Self, Diagnostics> {
        Self::parse_with(source, file_name, &|name| included(folder, name))
    }

    fn parse_with(
        source: &str,
        file_name: &str,
        include: &dyn Fn(&str) -> Result<String, String>,
    ) -> Result<Self, Diagnostics> {
        let is_own = Path::new(file_name).extension().is_some_and(|ending| ending == "lsys");
        let rules = if is_own { Rules::Own } else { Rules::Reference };
        let (source, constants, reports) = preprocess(source.to_string(), file_name, include);
        let read = |letters: bool| {
            let mut parser = Parser::new(&source, rules, reports.clone());
            parser.letters = letters;
            parser.constants(&constants);
            for statement in statements(&source.expanded) {
                parser.statement(&statement);
            }
            parser
        };
        let parser = read(false);
        if parser.splits_symbols() {
            let by_letters = read(true);
            // What is wrong either way is told of the usual reading.
            if by_letters.errors.is_empty() {
                return by_letters.finish();
            }
        }
        parser.finish()
    }
}

fn included(folder: &Path, name: &str) -> Result<String, String> {
    let inside = |part: Component| matches!(part, Component::Normal(_) | Component::CurDir);
    if !Path::new(name).components().all(inside) {
        return Err(format!("'{name}' is outside the folder of this file"));
    }
    let path = folder.join(name);
    let describe = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            let place = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
            format!("cannot include '{name}': there is no such file in '{}'", place.display())
        }
        _ => format!("cannot include '{name}': {error}"),
    };
    if std::fs::metadata(&path).map_err(describe)?.len() > INCLUDE_LIMIT {
        return Err(format!("cannot include '{name}': larger than {} MiB", INCLUDE_LIMIT >> 20));
    }
    let bytes = std::fs::read(&path).map_err(describe)?;
    String::from_utf8(bytes).map_err(|_| format!("cannot include '{name}': not UTF-8 text"))
}

impl<'a> Cursor<'a> {
    /// What has not been read, without blanks around it.
    pub(super) fn words(&self) -> &'a str {
        self.rest().trim()
    }
}
