//! No text makes the parser or the derivation panic, hang or grow without bound.

use std::time::{Duration, Instant};

use bioscope_lsystem::{LSystem, Limits};
use proptest::prelude::*;

const LIMITS: Limits = Limits { modules: 20_000, bytes: 1 << 20, operations: 200_000 };

fn try_all(text: &str) {
    try_as(text, "any.l");
    try_as(text, "any.lsys");
}

fn try_as(text: &str, name: &str) {
    match LSystem::parse(text, name) {
        Ok(system) => {
            for seed in [None, Some(1)] {
                if let Ok(string) = system.derive_within(6, seed, &LIMITS) {
                    assert!(string.to_string().len() >= string.len());
                    let _ = system.appearance(&string, seed);
                }
            }
        }
        Err(reports) => {
            assert!(!reports.0.is_empty());
            for report in &reports.0 {
                assert!(report.place.line >= 1 && report.place.column >= 1);
                assert!(report.to_string().starts_with("any."));
            }
        }
    }
}

/// Pieces of the language in any order reach much deeper than random letters.
fn pieces() -> impl Strategy<Value = String> {
    let piece = prop::sample::select(vec![
        "axiom: ",
        "F",
        "A(x)",
        "A",
        "(",
        ")",
        "[",
        "]",
        " --> ",
        "\n",
        "\n\t",
        " : ",
        " < ",
        " > ",
        "x",
        "y",
        "+",
        "-",
        "*",
        "/",
        "%",
        "^",
        "!",
        "&&",
        "||",
        "?",
        ",",
        "1",
        "0.5",
        "1e9",
        "-7",
        "{",
        "}",
        "x=1;",
        "ran(",
        "nran(1,2)",
        "#define A B\n",
        "#define f(x) x*x\n",
        "f(",
        "#",
        "/*",
        "*/",
        "\\\n",
        "\"",
        "derivation length: 3\n",
        "ignore: +\n",
        "decomposition\n",
        "homomorphism\n",
        "maximum depth: 5\n",
        "endlsystem",
        "lsystem: 1\n",
        "ä",
        "\u{0}",
        "~l",
        "@Gs",
        "?P",
        "B(x+1)",
        "start: { ",
        "endEach: { x = x + 1; }\n",
        "define: { array a[3] = {1, 2}; }\n",
        "a[",
        "]",
        "while (x) { ",
        "do { ",
        "if (x > 1) { ",
        "else { ",
        "printf(\"%g\", x);",
        "fopen(\"a\",\"w\")",
        "ring lsystem\n",
        "?(2,1)",
        "$",
        "?P(0,0)",
        "?E(x)",
        "=",
        "context: tree\n",
        "table: t\n",
        "select: Q -> t\n",
        "modules: A(x), Bud\n",
        "Bud",
        "order: random\n",
        "timed: 1\n",
        "growth: A = x\n",
        " after 1",
        "array b[2][2] = {1}\n",
        "#if ",
        "#else\n",
        "#endif\n",
        "#include \"x\"\n",
        "seed: 1\n",
        "biran(",
        "srand(1)",
        "func(1,x)",
        "SetDerivationLength(3)",
        "A(x) : x > 3 --> B(x*x)A(x/2)\n",
        "axiom: A(3)B\n",
        "A(x) --> A(x)A(x)\n",
    ]);
    prop::collection::vec(piece, 0..40).prop_map(|pieces| pieces.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        try_all(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn any_text(text in "\\PC{0,200}") {
        try_all(&text);
    }

    #[test]
    fn any_pieces(text in pieces()) {
        try_all(&text);
        try_all(&format!("axiom: A(3)\nA(x) --> A(x)B\n{text}"));
    }
}

#[test]
fn deep_and_long_texts_are_refused_or_read_quickly() {
    let deep = |open: &str, close: &str| {
        let (open, close) = (open.repeat(100_000), close.repeat(100_000));
        format!("axiom: A({open}1{close})\nA --> A")
    };
    for text in [
        deep("(", ")"),
        deep("-", ""),
        deep("!", ""),
        deep("1+(", ")"),
        deep("1?", ":1"),
        deep("sin(", ")"),
        deep("", "+1"),
        deep("", "^1"),
        deep("1||", ""),
        format!("axiom: {}\nA --> A", "[".repeat(300_000)),
        format!("axiom: A\nA --> B{}", "\n A".repeat(100_000)),
        "A --> B\n".repeat(50_000),
        "\n -->".repeat(50_000),
        format!("#define f(x) x\naxiom: A\nA --> A({}", "f(".repeat(50_000)),
        format!("#define f(x) x x\naxiom: A({}1{})", "f(".repeat(60), ")".repeat(60)),
    ] {
        let begin = Instant::now();
        try_all(&text);
        assert!(begin.elapsed() < Duration::from_secs(10), "{}", &text[..30]);
    }
}
