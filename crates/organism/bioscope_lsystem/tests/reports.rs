//! Errors say where and what, and several are found at once.

use bioscope_lsystem::{Diagnostic, LSystem};

fn errors(text: &str) -> Vec<Diagnostic> {
    match LSystem::parse(text, "bad.l") {
        Ok(_) => panic!("accepted: {text}"),
        Err(reports) => reports.0,
    }
}

#[test]
fn each_error_has_its_line_and_column() {
    for (text, line, column, part) in [
        (
            "axiom: F(1\nF --> F",
            1,
            11,
            "expected ',' or ')' after a parameter, but the statement ends here",
        ),
        ("axiom: F\nF(x --> FF", 2, 5, "expected ',' or ')', found '-->'"),
        ("axiom: F\nF(x) : x > --> FF", 2, 12, "expected a number, a name or '(', found '-->'"),
        ("axiom: F\nF --> F F *", 2, 11, "found '*'"),
        ("axiom: F\nF FF", 2, 5, "expected '-->', but"),
        ("axiom: F\nF -->", 2, 6, "'*' for nothing"),
        ("axiom: F\nF(2) --> F", 2, 3, "expected the name of a parameter, found '2'"),
        ("axiom: F\nF(x,x) --> F", 2, 5, "namesake"),
        ("axiom: F\nF --> G(sinn(3))", 2, 9, "unknown function 'sinn'"),
        ("axiom: F\nF --> G(sin(3,4))", 2, 9, "sin() takes 1 argument, found 2"),
        ("axiom: F\nF --> Gä", 2, 8, "found 'ä'"),
        ("F --> F", 1, 8, "expected 'axiom:'"),
        ("axiom: F", 1, 9, "expected at least one production"),
        ("axiom: F\naxiom: G\nF --> F", 2, 8, "a second axiom"),
        ("axiom: F\nderivation length: -1\nF --> F", 2, 20, "a number of steps"),
        ("axiom: F\nstart: { external x; }\nF --> F", 2, 10, "not supported: external"),
        ("axiom: F\nstart: { x = 1\nF --> F", 3, 1, "expected ';', found 'F'"),
        ("axiom: F\nstart: { a[2] = 1; }\nF --> F", 2, 10, "unknown array 'a'"),
        ("axiom: F\ndefine: { array a[2][3]; }\nF --> G(a[1])", 3, 9, "has 2 dimensions, found 1"),
        ("axiom: F\ndefine: { array a[0]; }\nF --> F", 2, 17, "sizes of at least 1"),
        ("axiom: F\nF : { if x } --> F", 2, 10, "expected '(', found 'x'"),
        ("axiom: F\n#include \"x.h\"\nF --> F", 2, 2, "cannot include a file"),
        ("axiom: F\nA[B] < F --> F", 2, 1, "right contexts only"),
        ("axiom: F\nF --> F\nendlsystem\naxiom: G", 4, 1, "expected 'lsystem:' after"),
        ("axiom: F\n * < B > --> F /* ", 2, 16, "never ends"),
        ("axiom: F\n > B --> F", 2, 2, "expected a module to be replaced, found"),
    ] {
        let found = errors(text);
        let place = &found[0].place;
        assert_eq!((place.line, place.column), (line, column), "{}", found[0]);
        assert!(found[0].message.contains(part), "{}", found[0]);
    }
}

#[test]
fn all_errors_are_found_in_one_reading() {
    let text =
        "axoim: F\nderivation lenght: 3\nF(x --> F\nF(x) --> F(x\nF(x) --> F(x)\nG --> H(foo(1))";
    let lines: Vec<u32> = errors(text).iter().map(|error| error.place.line).collect();
    assert_eq!(lines, [1, 2, 3, 4, 6]);
}

#[test]
fn misspelled_names_bring_a_suggestion() {
    let help = |text: &str| errors(text)[0].help.clone().unwrap();
    assert_eq!(help("axoim: F\nF --> F"), "did you mean 'axiom:'?");
    assert_eq!(help("axiom: F\nF --> G(sqtr(3))"), "did you mean 'sqrt'?");
    let text = "axiom: F(1)\nF(length) --> F(lenght*2)";
    let system = LSystem::parse(text, "doubtful.l").unwrap();
    let warning = system.warnings()[0].to_string();
    let expected = "doubtful.l:2:17: unknown name 'lenght' counts as 0\n \
        2 | F(length) --> F(lenght*2)\n   |                 ^^^^^^\n   = did you mean 'length'?";
    assert_eq!(warning, expected);
}

#[test]
fn errors_in_macros_are_reported_where_the_macro_is_used() {
    let text = "#define half(x) ((x)/2\naxiom: F(1)\nF(x) --> F( half(x) )";
    let found = errors(text);
    assert_eq!((found[0].place.line, found[0].place.column), (3, 22), "{}", found[0]);
    let text = "#define half(x) ((x)//2)\naxiom: F(1)\nF(x) --> F( half(x) )";
    let found = errors(text);
    assert_eq!((found[0].place.line, found[0].place.column), (3, 13), "{}", found[0]);
    assert_eq!(found[0].help.as_deref(), Some("in the expansion of macro 'half'"));
    assert_eq!(found[0].width, 7);
}

#[test]
fn a_missing_file_is_named() {
    let error = LSystem::read("no/such/plant.l").unwrap_err().to_string();
    assert!(error.starts_with("no/such/plant.l: "), "{error}");
}

#[test]
fn unmatched_brackets_are_doubtful() {
    let system = LSystem::parse("axiom: F\nF --> F[+F", "brackets.l").unwrap();
    assert!(system.warnings()[0].message.contains("brackets"));
}
