use super::EnvironmentError;
use crate::Diagnostics;
use crate::files::{Text, numbers};

/// What an environment is told about itself: `name: value` lines of a specification file, or
/// `name=value` pairs of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    entries: Vec<(String, String)>,
}

impl Settings {
    /// Reads the specification file of a field program.
    pub fn parse(bytes: &[u8], file: &str) -> Result<Self, Diagnostics> {
        let text = Text::new(bytes, file)?;
        let mut settings = Self::default();
        for line in text.lines() {
            match line.command() {
                Some((name, value)) => settings.set(name, value),
                // Numbers that continue the line before, as those of arrays do.
                None => match settings.entries.last_mut() {
                    Some((_, value)) => {
                        value.push(' ');
                        value.push_str(line.text.trim());
                    }
                    None => return Err(text.error(&line, "expected 'name: value'")),
                },
            }
        }
        Ok(settings)
    }

    /// Sets one, in any spelling of blanks, underscores and capitals.
    pub fn set(&mut self, name: &str, value: impl Into<String>) {
        self.entries.push((spelled(name), value.into()));
    }

    /// The last value with one of these names.
    pub fn get(&self, names: &[&str]) -> Option<&str> {
        let known = |entry: &&(String, String)| names.iter().any(|name| spelled(name) == entry.0);
        self.entries.iter().rev().find(known).map(|(_, value)| value.as_str())
    }

    /// All values of this name, in order.
    pub fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a str> {
        self.entries.iter().filter(move |entry| spelled(name) == entry.0).map(|entry| &*entry.1)
    }

    /// The numbers of a value.
    pub fn numbers(&self, names: &[&str]) -> Vec<f32> {
        self.get(names).map_or_else(Vec::new, |value| numbers(&value.replace(['x', 'X'], " ")))
    }

    /// The first number of a value; `usual` if it is not given.
    pub fn number(&self, names: &[&str], usual: f32) -> f32 {
        self.numbers(names).first().copied().unwrap_or(usual)
    }

    /// Whether a switch is on.
    pub fn switch(&self, names: &[&str], usual: bool) -> bool {
        self.get(names).map_or(usual, |value| {
            let word = value.split_whitespace().next().unwrap_or("");
            ["on", "yes", "1", "true", "True"].contains(&word)
        })
    }

    /// Fails for names that are not among the known ones, so that no spelling error is silent.
    pub fn check(&self, environment: &str, known: &[&str]) -> Result<(), EnvironmentError> {
        let known: Vec<String> = known.iter().map(|name| spelled(name)).collect();
        let strange =
            self.entries.iter().find(|(name, _)| !known.contains(name) && name != "verbose");
        match strange {
            None => Ok(()),
            Some((name, _)) => Err(EnvironmentError::Refused {
                name: environment.into(),
                reason: format!("it has no setting '{name}'; it has {}", known.join(", ")),
            }),
        }
    }
}

fn spelled(name: &str) -> String {
    let words: Vec<String> = name
        .split(|letter: char| letter.is_whitespace() || letter == '_' || letter == '-')
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect();
    words.join("_")
}

/// A number within limits, or an error that names it.
pub(super) fn bounded(
    environment: &str,
    name: &str,
    number: f32,
    (low, high): (f32, f32),
) -> Result<f32, EnvironmentError> {
    if (low..=high).contains(&number) {
        return Ok(number);
    }
    Err(EnvironmentError::Refused {
        name: environment.into(),
        reason: format!("{name} = {number}: expected {low} to {high}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_and_pairs_give_the_same_settings() {
        let text = b"grid size: 32x16 x 8\nverbose: off\nEstimate intersection area: on\n\
            array: 2 2 1\n 0.5 0.25\n";
        let settings = Settings::parse(text, "light.spec").unwrap();
        assert_eq!(settings.numbers(&["grid_size"]), [32.0, 16.0, 8.0]);
        assert!(settings.switch(&["estimate intersection area"], false));
        assert_eq!(settings.numbers(&["array"]).len(), 5);
        assert_eq!(settings.number(&["radius"], 25.0), 25.0);
        let known = ["grid size", "estimate_intersection_area"];
        let error = settings.check("chiba", &known).unwrap_err().to_string();
        assert!(error.contains("no setting 'array'"), "{error}");
    }
}
