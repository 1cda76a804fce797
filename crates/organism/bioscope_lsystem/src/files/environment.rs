use super::text::Text;
use crate::{Diagnostic, Diagnostics};

/// An environment file (.e): which program surrounds a model, and what is sent to it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EnvironmentFile {
    /// Name of the program: the first word of `executable:`, without its folder.
    pub program: String,
    /// The specification file that is given to it.
    pub specification: Option<String>,
    /// How the original talked to it: `memory`, `pipes`, `files` or `sockets`.
    pub communication: String,
    /// Whether the module that follows is sent too.
    pub sends_following: bool,
    /// What was not understood.
    pub warnings: Vec<Diagnostic>,
}

const FORMATS: [&str; 6] = [
    "turtle position",
    "turtle heading",
    "turtle left",
    "turtle up",
    "turtle line width",
    "turtle scale factor",
];
const IGNORED: [&str; 6] = [
    "verbose",
    "remote host",
    "strings only",
    "binary data",
    "when interpret",
    "interpreted modules",
];

impl EnvironmentFile {
    /// Reads an environment file; commands that are not known are warnings.
    pub fn parse(bytes: &[u8], file: &str) -> Result<Self, Diagnostics> {
        let text = Text::new(bytes, file)?;
        let mut found = Self { sends_following: true, ..Self::default() };
        for line in text.lines() {
            match line.command() {
                Some(("executable", command)) => {
                    let words: Vec<&str> = command.split_whitespace().collect();
                    let Some((program, arguments)) = words.split_first() else {
                        return Err(text.error(&line, "expected the name of a program"));
                    };
                    let name = program.rsplit(['/', '\\']).next().unwrap_or(program);
                    found.program = name.to_string();
                    let is_option = |index: usize| {
                        let own = arguments[index].starts_with('-');
                        own || (index > 0 && arguments[index - 1].starts_with('-'))
                    };
                    let free = (0..arguments.len()).rfind(|&index| !is_option(index));
                    found.specification = free.map(|index| arguments[index].to_string());
                }
                Some(("communication type", kind)) => found.communication = kind.to_string(),
                Some(("following module", value)) => found.sends_following = value != "off",
                Some((name, _)) if FORMATS.contains(&name) || IGNORED.contains(&name) => {}
                _ => {
                    let message = format!("unknown environment command '{}'", line.text.trim());
                    found.warnings.push(text.diagnostic(&line, message));
                }
            }
        }
        if found.program.is_empty() {
            return Err(text.ends("'executable: program'"));
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_and_their_specifications_are_found() {
        let text = b"executable: honda81 -e plant.e density.spec\ncommunication type: memory\n\
            turtle position:P:%.4f %.0f %.4f\nturtle hat: on\n";
        let file = EnvironmentFile::parse(text, "plant.e").unwrap();
        assert_eq!(file.program, "honda81");
        assert_eq!(file.specification.as_deref(), Some("density.spec"));
        assert!(file.warnings[0].to_string().starts_with("plant.e:4:1: unknown environment"));
        assert!(EnvironmentFile::parse(b"verbose: on", "x.e").is_err());
    }
}
