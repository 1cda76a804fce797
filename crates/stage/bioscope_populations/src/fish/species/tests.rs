use proptest::prelude::*;

use super::*;

const ANCHOVY: &str = include_str!("../../../species/anchovy.toml");

/// The message for the anchovy with one text replaced.
fn fault(from: &str, to: &str) -> String {
    assert!(ANCHOVY.contains(from), "{from}");
    let text = ANCHOVY.replacen(from, to, 1);
    FishSpecies::parse(&text, "mine.toml").expect_err("a faulty species").to_string()
}

#[test]
fn all_ready_made_species_are_sound() {
    for name in FishSpecies::names() {
        let species = FishSpecies::named(name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(species.name, name);
        assert!(FishSpecies::parse(species.text(), name).is_ok());
    }
    let message = FishSpecies::named("unicorn").unwrap_err().to_string();
    assert!(message.contains("unknown species of fish 'unicorn'; known: anchovy"), "{message}");
}

#[test]
fn faults_name_file_field_and_value() {
    for (from, to, expected) in [
        (
            "length = 0.13",
            "length = -1",
            "mine.toml: length = -1: expected a number from 0.005 to 20",
        ),
        ("length = 0.13", "length = nan", "mine.toml: length = NaN"),
        ("length = 0.13", "length = inf", "mine.toml: length = inf"),
        ("cruise = 2.0", "cruise = 99.0", "mine.toml: swimming.cruise = 99"),
        (
            "burst = 10.0",
            "burst = 1.0",
            "mine.toml: swimming.burst = 1: expected a number from 2 to 40",
        ),
        ("back = [0.01, 0.02", "back = [0.01, 3.0", "mine.toml: outline.back[1] = 3"),
        (
            "at = [0.0, 0.008",
            "at = [0.0, 0.5",
            "mine.toml: outline.at[2] = 0.02: expected more than 0.5",
        ),
        ("at = [0.0, ", "at = [0.001, ", "mine.toml: outline.at[0] = 0.001: expected 0"),
        ("width = [0.007, ", "width = [", "mine.toml: outline.width = 12 numbers: expected 13"),
        ("radius = 0.0195", "radius = 0.9", "mine.toml: eye.radius = 0.9"),
        ("flare = 24", "flare = 400", "mine.toml: pairs[0].flare = 400"),
        ("name = \"dorsal\"", "name = \"The Fin\"", "mine.toml: fins[0].name = 'The Fin'"),
        ("levels = [0.3, 0.7]", "levels = [0.7, 0.3]", "mine.toml: skin.levels[1] = 0.3"),
    ] {
        let message = fault(from, to);
        assert!(message.contains(expected), "{message}\n{expected}");
    }
}

#[test]
fn text_that_is_no_species_is_told_with_line_and_column() {
    for (from, to, expected) in [
        ("style = \"mackerel\"", "style = \"frog\"", "unknown variant `frog`"),
        ("cruise = 2.0", "", "missing field `cruise`"),
        ("cruise = 2.0", "cruise = 2.0\nspeed = 3.0", "unknown field `speed`"),
        ("back = \"#2f5d63\"", "back = \"blue\"", "a color like"),
        ("length = 0.13", "length = \"long\"", "invalid type"),
        ("[outline]", "[outline", "mine.toml:"),
    ] {
        let message = fault(from, to);
        assert!(message.contains(expected), "{message}");
        let numbers: Vec<&str> = message.split(':').collect();
        assert_eq!(numbers[0], "mine.toml");
        assert!(numbers[1..3].iter().all(|part| part.parse::<usize>().is_ok()), "{message}");
    }
    let unknown = fault("cruise = 2.0", "cruise = 2.0\nspeed = 3.0");
    let line = 1 + ANCHOVY.lines().position(|line| line == "cruise = 2.0").unwrap_or(0);
    assert!(unknown.starts_with(&format!("mine.toml:{}:1", line + 1)), "{unknown}");
    let long = "#".repeat(70_000);
    assert!(
        FishSpecies::parse(&long, "mine.toml")
            .unwrap_err()
            .to_string()
            .contains("exceeds the limit")
    );
}

proptest! {
    /// Any number in the file replaced by any other: a species or a message, never a panic.
    #[test]
    fn no_number_does_harm(number in 0usize..400, value in prop::num::f32::ANY) {
        let value = if value.is_nan() { String::from("nan") } else { format!("{value:e}") };
        let words: Vec<&str> = ANCHOVY.split_inclusive([' ', ',', '[', ']', '\n']).collect();
        let bare = |word: &str| word.trim_end_matches([' ', ',', '[', ']', '\n']).to_owned();
        let numbers: Vec<usize> =
            (0..words.len()).filter(|&word| bare(words[word]).parse::<f32>().is_ok()).collect();
        let chosen = numbers[number % numbers.len()];
        let mut text = String::new();
        for (index, word) in words.iter().enumerate() {
            let replaced = word.replacen(&bare(word), &value, 1);
            text.push_str(if index == chosen { &replaced } else { word });
        }
        if let Err(error) = FishSpecies::parse(&text, "mine.toml") {
            prop_assert!(error.to_string().starts_with("mine.toml"), "{error}");
        }
    }

    #[test]
    fn no_text_does_harm(text in "\\PC{0,200}") {
        let message = FishSpecies::parse(&text, "mine.toml").unwrap_err().to_string();
        prop_assert!(message.starts_with("mine.toml"));
    }
}
