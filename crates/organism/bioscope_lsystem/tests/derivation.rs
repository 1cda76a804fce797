//! Strings that are known from the literature, and what each construct does.

use bioscope_lsystem::{Derivation, DerivationError, LSystem, Limits};

fn parse(text: &str) -> LSystem {
    LSystem::parse(text, "test.l").unwrap_or_else(|reports| panic!("{reports}"))
}

fn derive(text: &str, steps: u64) -> String {
    parse(text).derive(steps, 1).unwrap().to_string()
}

/// All strings from the axiom on.
fn sequence(text: &str, steps: u64) -> Vec<String> {
    (0..=steps).map(|step| derive(text, step)).collect()
}

#[test]
fn koch_curve() {
    let snowflake = "axiom: F--F--F\nF --> F+F--F+F";
    assert_eq!(derive(snowflake, 1), "F+F--F+F--F+F--F+F--F+F--F+F");
    let edges = |steps| derive(snowflake, steps).matches('F').count();
    assert_eq!((0..5).map(edges).collect::<Vec<_>>(), [3, 12, 48, 192, 768]);
}

#[test]
fn fibonacci_lengths() {
    let lengths = sequence("axiom: B\nA --> AB\nB --> A", 9);
    let lengths: Vec<usize> = lengths.iter().map(String::len).collect();
    assert_eq!(lengths, [1, 1, 2, 3, 5, 8, 13, 21, 34, 55]);
}

/// Lindenmayer's filament of *Anabaena catenula*: a, b the cells' sizes, r, l their polarity;
/// here R = a_r, L = a_l, r = b_r, l = b_l.
#[test]
fn anabaena_filament() {
    let filament = "axiom: R\nR --> Lr\nL --> lR\nr --> R\nl --> L";
    assert_eq!(sequence(filament, 4), ["R", "Lr", "lRR", "LLrLr", "lRlRRlRR"]);
}

/// Equation (2) of the course notes "The artificial life of plants".
#[test]
fn parameters_and_conditions() {
    let text = "axiom: B(2)A(4,4)\n\
        p1: A(x,y) : y <= 3 --> A(x*2,x+y)\n\
        p2: A(x,y) : y > 3 --> B(x)A(x/y,0)\n\
        p3: B(x) : x < 1 --> C\n\
        p4: B(x) : x >= 1 --> B(x-1)\n";
    let expected = [
        "B(2)A(4,4)",
        "B(1)B(4)A(1,0)",
        "B(0)B(3)A(2,1)",
        "CB(2)A(4,3)",
        "CB(1)A(8,7)",
        "CB(0)B(8)A(1.14285719,0)",
    ];
    assert_eq!(sequence(text, 5), expected);
}

#[test]
fn the_first_production_that_applies_wins_and_arity_counts() {
    assert_eq!(derive("axiom: A(1)A(1,2)A\nA(x) --> B(x)\nA(x) --> C\nA --> D", 1), "B(1)A(1,2)D");
    assert_eq!(derive("axiom: AB\nA --> X\nA > B --> Y", 1), "XB");
    assert_eq!(derive("axiom: ABAAB\nAB --> X", 1), "XAX");
    assert_eq!(derive("axiom: ABC\nB --> *", 1), "AC");
}

#[test]
fn numbers_are_those_of_the_reference_program() {
    for (expression, value) in [
        ("2^3^2", "64"),
        ("-2^2", "4"),
        ("5.5%2", "1"),
        ("-7%3", "-1"),
        ("7/0", "7"),
        ("sin(30)", "0.5"),
        ("atan2(1,1)", "45"),
        ("log(0)", "-inf"),
        ("16777217", "16777216"),
        ("1 <> 2", "1"),
        ("!3", "0"),
        ("2 > 1 ? 5 : 6", "5"),
        ("0 ? 1 : 0 ? 2 : 3", "3"),
        ("1 || 1 % 0", "1"),
        ("0 && 1 % 0", "0"),
        ("2 && 3", "1"),
        (".5 + 1.", "1.5"),
        ("1 - 2 - 3", "-4"),
        ("min(2,3) + max(2,3)*10", "32"),
        ("trunc(-1.5) + floor(-1.5) + sign(-3)", "-4"),
        ("Q + Z*10", "51"),
    ] {
        let by_constant = format!("derivation length: 5\naxiom: A(1)\nA(x) --> A({expression})");
        assert_eq!(derive(&by_constant, 1), format!("A({value})"), "{expression}");
        let by_program = format!("derivation length: 5\naxiom: A(0)\nA(o) --> A(o+({expression}))");
        assert_eq!(derive(&by_program, 1), format!("A({value})"), "{expression}");
    }
    assert_eq!(derive("axiom: A(0.1)\nA(x) : x == 0.1 --> B", 1), "A(0.100000001)");
    // What is no number is not zero, hence true in C.
    assert_eq!(derive("axiom: A(0)\nA(x) : sqrt(x-1) --> B", 1), "B");
}

/// The condition's random number is drawn anew for each production: with probability 1/2, 1/4
/// and 1/4 the first, the second and none applies.
#[test]
fn conditions_draw_independently() {
    let letters = "A".repeat(4000);
    let text = format!("axiom: {letters}\nA : ran(1) < 0.5 --> B\nA : ran(1) < 0.5 --> C");
    let string = derive(&text, 1);
    let share = |letter| string.matches(letter).count() as f64 / 4000.0;
    assert!((share('B') - 0.5).abs() < 0.04 && (share('C') - 0.25).abs() < 0.04);
}

#[test]
fn random_choice_follows_the_probabilities() {
    let count = 30_000;
    let letters = "A(1)".repeat(count);
    let text = format!(
        "axiom: {letters}\nA(x) --> B : 2\nA(x) --> C : x+2\nA(x) : x > 3 --> D : 100\nA(x) --> E : -1"
    );
    let string = parse(&text).derive(1, 7).unwrap().to_string();
    let share = string.matches('B').count() as f64 / count as f64;
    // Four standard deviations of a binomial share.
    assert!((share - 0.4).abs() < 4.0 * (0.4 * 0.6 / count as f64).sqrt(), "{share}");
    assert_eq!(string.matches('B').count() + string.matches('C').count(), count);
    assert_eq!(string, parse(&text).derive(1, 7).unwrap().to_string());
    assert_ne!(string, parse(&text).derive(1, 8).unwrap().to_string());
}

#[test]
fn random_parameters_have_their_moments() {
    let text = format!("axiom: {}\nA --> B(nran(3,2))C(ran(4))", "A".repeat(20_000));
    let string = parse(&text).derive(1, 1).unwrap();
    let normal: Vec<f32> = string.parameters().iter().step_by(2).copied().collect();
    let uniform: Vec<f32> = string.parameters().iter().skip(1).step_by(2).copied().collect();
    let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
    let square = |values: &[f32], center| {
        mean(&values.iter().map(|x| (x - center) * (x - center)).collect::<Vec<_>>())
    };
    assert!((mean(&normal) - 3.0).abs() < 0.06 && (square(&normal, 3.0) - 4.0).abs() < 0.2);
    assert!((mean(&uniform) - 2.0).abs() < 0.04 && uniform.iter().all(|x| (0.0..4.0).contains(x)));
}

#[test]
fn context_looks_through_branches() {
    // Equation (3) of the course notes.
    let text = "axiom: A(4)B(5)C(6)\nA(x) < B(y) > C(z) : x+y+z > 10 --> E((x+y)/2)F((y+z)/2)";
    assert_eq!(derive(text, 1), "A(4)E(4.5)F(5.5)C(6)");
    assert_eq!(derive("axiom: A[B]C\nA < C --> X", 1), "A[B]X");
    assert_eq!(derive("axiom: A[[B]C]\nA < C --> X", 1), "A[[B]X]");
    assert_eq!(derive("axiom: A[B]C\nA > C --> X", 1), "X[B]C");
    assert_eq!(derive("axiom: A[B][C]D\nA > [B][C]D --> X", 1), "X[B][C]D");
    assert_eq!(derive("axiom: A[B][C]D\nA > [C]D --> X", 1), "A[B][C]D");
    assert_eq!(derive("axiom: A[BE]D\nA > [B]D --> X", 1), "A[BE]D");
    assert_eq!(derive("axiom: A[BE]D\nA > [B=]D --> X", 1), "X[BE]D");
    assert_eq!(derive("axiom: A[B[C]]D\nA > [B]D --> X", 1), "X[B[C]]D");
    assert_eq!(derive("axiom: [A]B\nA > B --> X", 1), "[A]B");
    assert_eq!(derive("ignore: +-\naxiom: A+-B\nA < B --> X", 1), "A+-X");
    assert_eq!(derive("consider: A B\naxiom: ACDB\nA < B --> X", 1), "ACDX");
}

/// A signal that runs through a filament, as in the acropetal signal of the course notes.
#[test]
fn signals_travel() {
    let text = "ignore: +\naxiom: S+F[F+F]F\nS < F --> S\nS --> F";
    assert_eq!(derive(text, 1), "F+S[F+F]F");
    assert_eq!(derive(text, 2), "F+F[S+F]S");
    assert_eq!(derive(text, 3), "F+F[F+S]F");
}

#[test]
fn cut_removes_the_rest_of_its_branch() {
    let text = "axiom: a[b%[cd]e[%f]]g[h[%i]j]k\nz --> z";
    assert_eq!(derive(text, 1), "a[b]g[h[]j]k");
}

/// Branch shedding, equation (5) of the course notes: after 5 steps each side always carries
/// 0 to 4 segments per whorl.
#[test]
fn shedding_keeps_the_crown_constant() {
    let text = "axiom: A\nA --> F(1)[-X(3)B][+X(3)B]A\nB --> F(1)B\n\
        X(d) : d > 0 --> X(d-1)\nX(d) : d == 0 --> U%\nU --> F(0.3)";
    for step in 6..12 {
        let string = derive(text, step);
        assert_eq!(string.matches("F(1)").count() as u64, step + 20);
        assert_eq!(string.matches("F(0.300000012)").count() as u64, 2 * (step - 5));
    }
}

#[test]
fn assignments_stand_before_and_after_the_condition() {
    let text = "axiom: A(3)\nA(x) : {y = x*2; z = y+1;} y > 5 {w = z*10;} --> B(w,y)";
    assert_eq!(derive(text, 1), "B(70,6)");
}

#[test]
fn decomposition_is_repeated_and_homomorphism_only_shown() {
    let text = "axiom: A(0)\nA(n) --> A(n+1)B(3)\ndecomposition\nmaximum depth: 9\n\
        B(n) : n > 0 --> CB(n-1)\nB(n) --> *\nhomomorphism\nC --> +F\nendlsystem";
    let system = parse(text);
    let string = system.derive(2, 0).unwrap();
    assert_eq!(string.to_string(), "A(2)CCCCCC");
    assert_eq!(system.appearance(&string, 0).unwrap().to_string(), "A(2)+F+F+F+F+F+F");
}

#[test]
fn macros_reach_into_productions() {
    let text = "#define LIMIT 2\n#define grow(x,y) x*(y)\naxiom: A(1)\nA(s) : s < LIMIT --> A(grow(s,1+LIMIT))";
    assert_eq!(derive(text, 5), "A(3)");
    let system =
        parse("#define R 0.5 + 0.25\n#define NAME text\n#define S (2*R)\naxiom: A\nA --> A");
    assert_eq!(system.constants(), [("R".to_string(), 0.75), ("S".to_string(), 1.25)]);
}

#[test]
fn what_explodes_is_named() {
    let system = parse("axiom: AB\nA --> A\nB --> BB");
    let limits = Limits { modules: 1000, ..Limits::default() };
    let error = system.derive_within(64, 0, &limits).unwrap_err();
    let DerivationError::Limit { place, what, step, production } = error else { panic!() };
    assert_eq!((place.line, production.as_str(), step), (3, "B --> BB", 10));
    assert_eq!(what, "more than 1000 modules");
}

#[test]
fn endless_work_is_stopped() {
    let limits = Limits { operations: 1_000_000, ..Limits::default() };
    let quiet = parse("axiom: A\nB --> A");
    let error = quiet.derive_within(u64::MAX, 0, &limits).unwrap_err().to_string();
    assert!(error.contains("more than 1000000 operations"), "{error}");
    let searching = format!("ignore: A\naxiom: {}\nB < A --> C", "A".repeat(3000));
    let error = parse(&searching).derive_within(1, 0, &limits).unwrap_err().to_string();
    assert!(error.contains("operations"), "{error}");
    let deep = parse("axiom: A\nB --> A\ndecomposition\nmaximum depth: 1000000000\nA --> A");
    assert!(deep.derive_within(1, 0, &limits).is_err());
}

#[test]
fn what_has_no_value_is_an_error_with_its_place() {
    let system = parse("axiom: A(0)\nA(x) : x < 1 --> A(3 % x)");
    let error = system.derive(1, 0).unwrap_err().to_string();
    assert_eq!(
        error,
        "test.l:2:1: remainder of a division by zero at step 1 in 'A(x) : x < 1 --> A(3 % x)'"
    );
}

#[test]
fn a_derivation_can_be_watched_step_by_step() {
    let system = parse("axiom: A\nA --> AB");
    let mut derivation = Derivation::new(&system, 0, Limits::default()).unwrap();
    derivation.advance().unwrap();
    derivation.advance().unwrap();
    assert_eq!((derivation.step(), derivation.string().to_string()), (2, "ABB".to_string()));
}
