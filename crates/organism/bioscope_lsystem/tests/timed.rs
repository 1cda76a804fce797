//! Timed modules: ages, growth functions, identities, and the one engine behind both views of time.

use bioscope_lsystem::{Derivation, DerivationOptions, LSystem, Limits};

fn model(text: &str) -> LSystem {
    LSystem::parse(text, "timed.lsys").unwrap_or_else(|reports| panic!("{reports}"))
}

fn options(seed: u64) -> DerivationOptions {
    DerivationOptions { seed: Some(seed), ..Default::default() }
}

/// The string after so many seconds in steps of so many, and what it looks like.
fn at(system: &LSystem, seconds: f64, step: f64) -> (String, String) {
    let mut derivation = Derivation::with_options(system, options(7)).unwrap();
    let steps = (seconds / step).round() as usize;
    for _ in 0..steps {
        derivation.pass(step).unwrap();
    }
    (derivation.string().to_string(), derivation.appearance().unwrap().to_string())
}

const TREE: &str = "timed: 0.1\nmodules: p(x), q(x)\n\
    growth: p = 6*x*age\ngrowth: q = 6*x+age\n\
    axiom: p(1)\n\
    p1: p(x) after 1 --> q(x)[+(90)p(x/2)][-(90)p(x/2)]";

/// The growing tree: continuous, since the limit of p's length is q's first.
#[test]
fn a_tree_grows_continuously() {
    let system = model(TREE);
    assert_eq!(at(&system, 0.5, 0.5).1, "p(3)");
    assert_eq!(at(&system, 0.9, 0.9).1, "p(5.39999962)");
    let (string, shown) = at(&system, 1.5, 1.5);
    assert_eq!(string, "q(0.5,1)[+(90)p(0.5,0.5)][-(90)p(0.5,0.5)]");
    assert_eq!(shown, "q(6.5)[+(90)p(1.5)][-(90)p(1.5)]");
}

/// One long step (the recursive view) gives what many short ones give (the iterative view).
#[test]
fn long_and_short_steps_agree() {
    let system = model(TREE);
    let counts = |text: &str| (text.matches('p').count(), text.matches('q').count());
    for whole in 0..6_u32 {
        let seconds = f64::from(whole) + 0.5;
        let (once, _) = at(&system, seconds, seconds);
        let (often, _) = at(&system, seconds, 1.0 / 64.0);
        assert_eq!(once, often);
        assert_eq!(counts(&once), (1 << whole, (1 << whole) - 1));
    }
}

/// Parameters are frozen when a module is made; growth functions follow its age.
#[test]
fn growth_is_evaluated_all_the_time() {
    let text = "timed: 0.5\nmodules: a(x,y,z), b(x,y,z)\ngrowth: a = y, z, age\n\
        growth: b = x, 2*y, x+z\naxiom: a(2,1,3)\np1: a(x,y,z) after 1 --> b(x*2,x+3,x*y*z)";
    let system = model(text);
    assert_eq!(at(&system, 0.5, 0.5).1, "a(1,3,0.5)");
    let (string, shown) = at(&system, 1.5, 0.5);
    assert_eq!((string.as_str(), shown.as_str()), ("b(0.5,4,5,6)", "b(4,10,10)"));
}

#[test]
fn modules_keep_their_identities_for_life() {
    let system = model(TREE);
    let mut derivation = Derivation::with_options(&system, options(1)).unwrap();
    let mut seen = std::collections::BTreeSet::new();
    let mut last = std::collections::BTreeMap::new();
    for _ in 0..30 {
        derivation.advance().unwrap();
        let now: std::collections::BTreeMap<u64, u8> = derivation
            .ids()
            .iter()
            .copied()
            .zip(derivation.string().kinds().iter().copied())
            .collect();
        assert_eq!(now.len(), derivation.string().len(), "identities are unique");
        for (id, kind) in &now {
            match last.get(id) {
                Some(before) => assert_eq!(before, kind),
                None => assert!(seen.insert(*id), "an identity was used again"),
            }
        }
        last = now;
    }
    assert!((derivation.time() - 3.0).abs() < 1e-9);
}

/// The choices of the first second are the same at all later times, and for any length of steps.
#[test]
fn choices_do_not_change_with_time() {
    let text = "timed: 1\nmodules: a, c, r\naxiom: aaaaaaaaaaaa\n\
        p1: a after 1 --> ca : 0.7\np2: a after 1 --> ra : 0.3";
    let system = model(text);
    let letters = |seconds, step| -> String {
        at(&system, seconds, step).0.chars().filter(char::is_ascii_alphabetic).collect()
    };
    let first = |text: String| -> String {
        text.split_inclusive('a').map(|part| part.chars().next().unwrap()).collect()
    };
    let early = first(letters(1.5, 0.5));
    assert!(early.len() == 12 && early.contains('c') && early.contains('r'), "{early}");
    assert_eq!(early, first(letters(4.5, 0.25)));
    assert_eq!(letters(4.5, 4.5), letters(4.5, 0.25));
}

/// The chosen shares over many modules.
#[test]
fn choices_have_their_chances() {
    let letters = "a".repeat(20_000);
    let text = format!(
        "timed: 1\nmodules: a, c, r\naxiom: {letters}\np1: a after 1 --> c : 0.7\np2: a after 1 --> r : 0.3"
    );
    let (string, _) = at(&model(&text), 1.0, 1.0);
    let share = string.matches('c').count() as f64 / 20_000.0;
    assert!((share - 0.7).abs() < 3.0 * (0.21_f64 / 20_000.0).sqrt(), "{share}");
}

/// A module outlives its age while its condition is false, and context is that of the old string.
#[test]
fn conditions_and_contexts_delay() {
    let text = "timed: 1\nmodules: a(x), b, s\nignore: + -\naxiom: s+a(3)-b\n\
        p1: a(x) after 1 : T >= x --> b\np2: s < a(x) after 100 --> *\np3: s > b after 1 --> *\n\
        p4: a(x) < b after 2 --> a(0)";
    let system = model(text);
    let strings: Vec<String> = (1..=3).map(|steps| at(&system, f64::from(steps), 1.0).0).collect();
    assert_eq!(strings[0], "s(1)+a(1,3)-b(1)");
    assert_eq!(strings[1], "s(2)+a(2,3)-a(0,0)");
    assert_eq!(strings[2], "s(3)+b(2)-b(0)");
}

#[test]
fn modules_that_are_reborn_at_once_do_not_hang() {
    let system = model("timed: 1\nmodules: a\naxiom: a\np1: a after 0 --> a");
    assert_eq!(at(&system, 1.0, 1.0).0.matches('a').count(), 1);
    let system = model("timed: 1\nmodules: a\naxiom: a\np1: a after 0 --> aa");
    let limits = Limits { modules: 10_000, ..Limits::default() };
    let options = DerivationOptions { limits, ..options(1) };
    let mut derivation = Derivation::with_options(&system, options).unwrap();
    derivation.pass(1.0).unwrap_err();
}

#[test]
fn homomorphism_sees_what_growth_lets_a_module_show() {
    let text = "timed: 1\nmodules: p(x), q\ngrowth: p = 6*x*age, x\naxiom: p(2)q\n\
        p1: p(x) after 9 --> q\nhomomorphism\np(length, width) --> !(width)F(length)\nq --> @O(age)";
    let system = LSystem::parse(text, "shown.lsys").unwrap();
    assert!(system.warnings().is_empty(), "{:?}", system.warnings());
    let string = system.derive(3, 0).unwrap();
    assert_eq!(system.appearance(&string, 0).unwrap().to_string(), "!(2)F(36)@O(3)");
}
