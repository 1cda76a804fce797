//! Every construct of the cpfg dialect and of the notation of our own, by what it makes.

use bioscope_lsystem::{
    Derivation, DerivationOptions, Environment, EnvironmentError, Functions, LSystem, Limits,
    Reply, Request,
};

fn parse(text: &str) -> LSystem {
    LSystem::parse(text, "test.l").unwrap_or_else(|reports| panic!("{reports}"))
}

fn own(text: &str) -> LSystem {
    LSystem::parse(text, "test.lsys").unwrap_or_else(|reports| panic!("{reports}"))
}

/// Derived as the reference program does.
fn derive(text: &str, steps: u64) -> String {
    parse(text).derive(steps, None).unwrap().to_string()
}

fn derive_own(text: &str, steps: u64) -> String {
    own(text).derive(steps, 1).unwrap().to_string()
}

#[test]
fn control_blocks_run_around_the_steps() {
    let text = "lsystem: 1\nderivation length: 3\n\
        start: { a = 1; b = 10; }\nstartEach: { a = a*2; }\nendEach: { b = b+Q; }\n\
        end: { printf(\"%g %g\\n\", a, b); }\naxiom: A(a,b)\nA(x,y) --> A(a,b)\nendlsystem";
    let system = parse(text);
    let mut derivation = Derivation::with_options(&system, DerivationOptions::default()).unwrap();
    let mut strings = vec![derivation.string().to_string()];
    for _ in 0..3 {
        derivation.advance().unwrap();
        strings.push(derivation.string().to_string());
    }
    assert_eq!(strings, ["A(1,10)", "A(2,10)", "A(4,11)", "A(8,13)"]);
}

#[test]
fn statements_branch_and_loop() {
    let text = "start: {\n n = 0; i = 5;\n while (i > 0) { n = n + i; i = i - 1; }\n\
        do { n = n + 100; } while (n < 300);\n if (n == 315) { m = 1; } else { m = 2; }\n\
        if (n < 0) { m = 9; } else if (n > 0) { m = m + 0.5; }\n}\naxiom: A\nA --> A(n,m)";
    assert_eq!(derive(text, 1), "A(315,1.5)");
}

#[test]
fn arrays_are_read_and_written() {
    let text = "define: { array a[3] = {1, 2, 3}, b[2][3] = {1, 2, 3, 4, 5, 6}; array c[2]; }\n\
        start: { c[1] = a[2]*b[1][0]; a[0] = 7; }\naxiom: A\n\
        A --> A(a[0],a[1.7],b[1][2],c[0],c[1],a[9],a[-1])";
    // What is out of range is the first or the last element, as in the reference program.
    assert_eq!(derive(text, 1), "A(7,2,6,0,12,3,7)");
}

#[test]
fn productions_may_change_the_variables_of_the_model() {
    let text = "start: { n = 0; }\naxiom: AAA\nA : {n = n + 1;} * --> B(n)\nB(x) --> B(x)C(n)";
    assert_eq!(derive(text, 2), "B(1)C(3)B(2)C(3)B(3)C(3)");
}

#[test]
fn what_follows_the_condition_is_done_only_if_the_production_is_applied() {
    let text = "start: { n = 0; }\naxiom: A(1)A(5)A(7)\nA(x) : x > 3 {n = n + x;} --> B(n)";
    assert_eq!(derive(text, 1), "A(1)B(5)B(12)");
}

#[test]
fn random_numbers_are_those_of_the_reference_program() {
    // drand48 begins with 4e-14, 0.000985, 0.0416, 0.177, 0.365, 0.0913 …, one per module.
    let text = "seed: 77\naxiom: AAAAAA\nA --> x : 0.04\nA --> y : 0.26\nA --> z : 0.7";
    assert_eq!(derive(text, 1), "xxyyzy");
    // Modules without productions take a number too, and `@o` takes two.
    assert_eq!(derive(&text.replace("AAAAAA", "AFAFAF"), 1), "xFyFzF");
    assert_eq!(derive(&text.replace("AAAAAA", "A@oAAA"), 1), "x@oyzy");
    // Without `seed:` the first production is taken.
    assert_eq!(derive(&text.replace("seed: 77\n", ""), 1), "xxxxxx");
    // erand48 from {0x330E, 0, 0} begins as drand48 after srand48(0).
    assert_eq!(derive("axiom: A\nA --> A(ran(1),nran(5,2))", 1), "A(0.17082803,5)");
    // srand48(1) is followed by 0.0416303447718782 in every C library.
    assert_eq!(derive("start: { srand(1); }\naxiom: A\nA --> A(ran(1))", 1), "A(0.0416303463)");
}

#[test]
fn strings_do_not_depend_on_the_seed_of_the_file() {
    let text = |seed| format!("seed: {seed}\naxiom: AAAA\nA --> AB : 1\nA --> C : 1");
    assert_eq!(derive(&text(1), 5), derive(&text(2), 5));
    let system = parse(&text(1));
    let string = |seed: u64| system.derive(5, seed).unwrap().to_string();
    assert!((1..20).any(|seed| string(seed) != string(0)));
}

#[test]
fn rings_have_no_ends() {
    let text = "ring lsystem\naxiom: ABC\nA < B --> X\nC < A --> Y\nC > A --> Z";
    assert_eq!(derive(text, 1), "YXZ");
    assert_eq!(derive(&text.replace("ring lsystem\n", ""), 1), "AXC");
}

#[test]
fn several_modules_may_be_replaced_at_once() {
    assert_eq!(
        derive("axiom: A(1)B(2)A(3)C\nA(x)B(y) > A(z) --> D(x+y+z)\nA(x) --> E(x)", 1),
        "D(6)E(3)C"
    );
}

#[test]
fn decomposition_goes_depth_first_with_the_context_of_the_old_string() {
    let text = "axiom: LAR\nA --> BB\ndecomposition\nmaximum depth: 3\n\
        L < B > R --> C(1)D\nD --> E\nC(x) : x < 9 --> C(x+1)";
    // Both B stand between L and R, since A does; C grows until the depth is reached.
    assert_eq!(derive(text, 1), "LC(3)EC(3)ER");
    // It is applied also to what is left alone, and never with depth 0.
    assert_eq!(derive("axiom: AB\nA --> A\ndecomposition\nB --> CB", 1), "ACB");
    let none = "axiom: AB\nA --> A\ndecomposition\nmaximum depth: 0\nB --> CB";
    assert_eq!(derive(none, 1), "AB");
}

#[test]
fn homomorphism_sees_the_context_and_the_variables_of_the_string() {
    let text = "start: { w = 3; }\nendEach: { w = w + 1; }\naxiom: AAB\nB --> B\nhomomorphism\n\
        maximum depth: 2\nA > A --> +F(w)\nA > B --> -X\nX --> G";
    let system = parse(text);
    let string = system.derive(2, None).unwrap();
    assert_eq!(system.appearance(&string, None).unwrap().to_string(), "+F(5)-GB");
}

#[test]
fn homomorphism_with_a_seed_has_numbers_of_its_own() {
    let text = "axiom: A(0)A(0)\nA(x) --> A(ran(1))\nhomomorphism\nseed: 1\nA(x) --> F(ran(1))";
    let system = parse(text);
    let string = system.derive(1, None).unwrap();
    let shown = system.appearance(&string, None).unwrap().to_string();
    assert!(shown.starts_with("F(0.0416303463)F(0.454492"), "{shown}");
}

#[test]
fn sub_l_systems_have_productions_of_their_own() {
    let text = "lsystem: 1\naxiom: A?(2,0.5)A$A\nA --> AB\nendlsystem\n\
        lsystem: 2\naxiom: A\nA --> C?(3,1)A$\nendlsystem\n\
        lsystem: 3\naxiom: A\nA --> D\nendlsystem";
    assert_eq!(derive(text, 1), "AB?(2,0.5)C?(3,1)A$$AB");
    assert_eq!(derive(text, 2), "ABB?(2,0.5)C?(3,1)D$$ABB");
}

#[test]
fn a_cut_ends_with_its_sub_l_system() {
    let text = "lsystem: 1\naxiom: ?(2,1)A%B[C]$D\nA --> A\nendlsystem\nlsystem: 2\naxiom: A\nA --> E\nendlsystem";
    assert_eq!(derive(text, 1), "?(2,1)E$D");
}

#[test]
fn printing_is_captured() {
    let text = "start: { printf(\"begin %d of %5.2f%%\\n\", 3.9, 2.5); }\naxiom: A\nA : {printf(\"A\");} * --> AA";
    let system = parse(text);
    let mut derivation = Derivation::new(&system, None, Limits::default()).unwrap();
    derivation.advance().unwrap();
    derivation.advance().unwrap();
    assert_eq!(derivation.output(), "begin 3 of  2.50%\nAAA");
}

#[test]
fn files_are_read_and_written_in_the_given_folder_only() {
    let folder = std::env::temp_dir().join("bioscope_lsystem_files");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("in.txt"), "3 4.5\nend").unwrap();
    let text = "define: { array a[2]; }\nstart: { f = fopen(\"in.txt\",\"r\"); n = fscanf(f, \"%f %f\", &x, &a[1]);\n\
        fclose(f); g = fopen(\"out.txt\",\"w\"); fprintf(g, \"sum %g\", x+a[1]); fclose(g); }\naxiom: A\nA --> A(n,x,a[1])";
    let system = parse(text);
    let options = DerivationOptions { folder: Some(folder.clone()), ..Default::default() };
    let mut derivation = Derivation::with_options(&system, options).unwrap();
    derivation.advance().unwrap();
    assert_eq!(derivation.finish().unwrap().to_string(), "A(2,3,4.5)");
    assert_eq!(std::fs::read_to_string(folder.join("out.txt")).unwrap(), "sum 7.5");
    let error = system.derive(1, None).unwrap_err().to_string();
    assert!(error.contains("given no folder"), "{error}");
}

struct Line;

impl Functions for Line {
    fn value(&self, id: usize, x: f64) -> Option<f64> {
        (id == 1).then_some(2.0 * x)
    }

    fn curve(&self, id: usize, t: f64) -> Option<[f64; 3]> {
        (id == 2).then_some([t, 3.0 * t, 4.0 * t])
    }
}

#[test]
fn functions_and_curves_are_looked_up() {
    let text = "axiom: A\nA --> A(func(1,3),func(7,3),curveX(2,1),curveY(2,0.5),curveZ(2,1))B(curveGAL(2)^2)";
    let system = parse(text);
    let functions = Some(std::sync::Arc::new(Line) as std::sync::Arc<dyn Functions>);
    let options = DerivationOptions { functions, ..Default::default() };
    let mut derivation = Derivation::with_options(&system, options).unwrap();
    derivation.advance().unwrap();
    assert_eq!(derivation.string().to_string(), "A(6,0,1,1.5,4)B(26)");
}

#[test]
fn a_model_can_set_its_own_length() {
    let text = "derivation length: 5\nstart: { SetDerivationLength(2); }\naxiom: A\nA --> A(Z,GetDerivationLength(0))";
    let system = parse(text);
    let derivation = Derivation::new(&system, None, Limits::default()).unwrap();
    assert_eq!((system.derivation_length(), derivation.length()), (5, 2));
    assert_eq!(derive(text, 1), "A(5,2)");
}

#[test]
fn conditions_of_the_preprocessor_choose_the_text() {
    let text = "#define WIDE 3\n#if WIDE > 2\n#define W 10\n#else\n#define W 1\n#endif\naxiom: A\nA --> A(W)";
    assert_eq!(derive(text, 1), "A(10)");
}

#[test]
fn included_files_are_part_of_the_model() {
    let folder = std::env::temp_dir().join("bioscope_lsystem_include");
    std::fs::create_dir_all(folder.join("parts")).unwrap();
    std::fs::write(folder.join("parts/leaf.h"), "#define L 4\nB --> ~l(L)\n").unwrap();
    std::fs::write(folder.join("plant.l"), "axiom: A\nA --> B\n#include \"parts/leaf.h\"\n")
        .unwrap();
    let system = LSystem::read(folder.join("plant.l")).unwrap();
    assert_eq!(system.derive(2, None).unwrap().to_string(), "~l(4)");
    std::fs::write(folder.join("bad.l"), "#include \"../plant.l\"\naxiom: A\nA --> B\n").unwrap();
    let error = LSystem::read(folder.join("bad.l")).unwrap_err().to_string();
    assert!(error.contains("outside the folder"), "{error}");
}

#[test]
fn letters_of_ignored_symbols_are_those_of_the_reference_program() {
    assert_eq!(derive("ignore: @o+\naxiom: A@o(1)+B\nA < B --> X", 1), "A@o(1)+X");
    assert_eq!(derive("ignore: @+\naxiom: A@o(1)+B\nA < B --> X", 1), "A@o(1)+B");
}

#[test]
fn the_own_notation_has_its_own_arithmetic() {
    for (expression, value) in [
        ("2^3^2", "512"),
        ("-2^2", "-4"),
        ("1/0", "inf"),
        ("trunc(-1.5)", "-1"),
        ("5 || 0", "1"),
        ("min(2,3)*10+max(2,3)", "23"),
        ("tanh(0)", "0"),
    ] {
        let text = format!("axiom: A(0)\np1: A(o) --> A(o+({expression}))");
        assert_eq!(derive_own(&text, 1), format!("A({value})"), "{expression}");
    }
    assert_eq!(derive_own("axiom: A(-1)\nA(x) : sqrt(x) --> B", 1), "A(-1)");
    let text = "array a[2] = {1, 2}\naxiom: A(5)\np1: A(n) : n > 1 || a[n] > 0 --> B(a[1])";
    assert_eq!(derive_own(text, 1), "B(2)");
    let error = own("array a[2] = {1, 2}\naxiom: A\nA --> B(a[2])").derive(1, 0).unwrap_err();
    assert!(error.to_string().contains("index 2 of array 'a' is outside 0 to 1"), "{error}");
}

#[test]
fn contexts_reach_into_branches_in_tree_mode() {
    let tree = "axiom: F[S]A\nF > S --> X";
    assert_eq!(derive_own(tree, 1), "X[S]A");
    assert_eq!(derive_own(&format!("context: axis\n{tree}"), 1), "F[S]A");
    assert_eq!(derive_own("axiom: F[A[S]]B\nignore: A\nF > S --> X", 1), "X[A[S]]B");
    assert_eq!(derive_own("axiom: A[BE]D\nA > [B]D --> X", 1), "X[BE]D");
    assert_eq!(derive_own("axiom: A[C][B]D\nA > [B]D --> X", 1), "X[C][B]D");
    assert_eq!(derive_own("axiom: A[B]%C\nA > [B]C --> X\nC --> D", 1), "A[B]");
}

#[test]
fn modules_may_have_names_and_named_parameters() {
    let text = "modules: Apex(age, vigor), Leaf(size), Internode\n\
        axiom: Apex(0, 1)\n\
        p1: Apex : age < 2 --> Internode [Leaf(vigor/2)] Apex(age+1, vigor*0.5)\n\
        p2: Leaf --> Leaf(size*3)\n\
        p3: Internode < Apex(a, v) : a == 2 --> Apex(a, v) Leaf";
    assert_eq!(derive_own(text, 1), "Internode[Leaf(0.5)]Apex(1,0.5)");
    assert_eq!(derive_own(text, 3), "Internode[Leaf(4.5)]Internode[Leaf(0.75)]Apex(2,0.25)Leaf(0)");
}

#[test]
fn tables_are_selected_for_each_step() {
    let text = "select: Q >= 3 -> flowering\naxiom: A\ntable: leafy\np1: A --> LA\n\
        table: flowering\np2: A --> K\ntable: *\np3: L --> l";
    let text = format!("select: Q < 3 -> leafy\n{text}");
    let strings: Vec<String> = (0..4).map(|steps| derive_own(&text, steps)).collect();
    assert_eq!(strings, ["A", "LA", "lLA", "llK"]);
}

#[test]
fn one_module_at_a_time_in_sequential_order() {
    let text = "order: leftmost\naxiom: B\np1: A --> AB\np2: B --> A";
    let strings: Vec<String> = (0..5).map(|steps| derive_own(text, steps)).collect();
    assert_eq!(strings, ["B", "A", "AB", "ABB", "ABBB"]);
    let text = "order: random\naxiom: AAAAAAAA\np1: A --> B";
    for steps in 0..9 {
        assert_eq!(derive_own(text, steps).matches('B').count() as u64, steps);
    }
    assert_ne!(derive_own(text, 1), own(text).derive(1, 5).unwrap().to_string());
}

/// The example of the course notes "The artificial life of plants".
#[test]
fn queries_are_told_where_the_turtle_is() {
    let text = "angle: 90\naxiom: A\np1: A --> F(1)?P(0,0)-A\np2: F(k) --> F(k+1)";
    let system = own(text);
    let mut options = DerivationOptions::default();
    options.turtle.angle = 90.0;
    let mut derivation = Derivation::with_options(&system, options).unwrap();
    let expected =
        ["F(1)?P(0,1)-A", "F(2)?P(0,2)-F(1)?P(1,2)-A", "F(3)?P(0,3)-F(2)?P(2,3)-F(1)?P(2,2)-A"];
    for text in expected {
        derivation.advance().unwrap();
        let mut rounded = derivation.string().clone();
        round(&mut rounded);
        assert_eq!(rounded.to_string(), text);
    }
    let text = "axiom: +(90)?H(0,0,0)?L(0,0,0)?U(0,0,0)X\nX --> X";
    let mut string = own(text).derive(0, 0).unwrap();
    round(&mut string);
    assert_eq!(string.to_string(), "+(90)?H(-1,0,0)?L(0,-1,0)?U(0,0,1)X");
}

/// Rounds all parameters; sines of right angles are not exact.
fn round(string: &mut bioscope_lsystem::ModuleString) {
    string.map_parameters(|value| (value * 1e4).round() / 1e4 + 0.0);
}

#[test]
fn queries_see_the_homomorphism() {
    let text =
        "axiom: A?P(0,0,0)B?P(0,0,0)\nX --> X\nhomomorphism\nA --> F(2)?P(9,9,9)F(1)\nB --> f(4)";
    let mut string = parse(text).derive(0, None).unwrap();
    round(&mut string);
    assert_eq!(string.to_string(), "A?P(0,3,0)B?P(0,7,0)");
}

#[derive(Default)]
struct Echo {
    seen: std::sync::Arc<std::sync::Mutex<Vec<String>>>,
}

impl Environment for Echo {
    fn exchange(
        &mut self,
        step: u64,
        requests: &[Request],
        replies: &mut [Reply],
    ) -> Result<(), EnvironmentError> {
        for (request, reply) in requests.iter().zip(replies) {
            let next =
                request.following.map(|next| format!("{}{:?}", next.symbol, next.parameters));
            let height = request.position.y.round();
            self.seen.lock().unwrap().push(format!(
                "{step} {} {:?} {height} {next:?}",
                request.module, request.parameters
            ));
            if request.parameters[0] == 1.0 {
                reply.parameters[0] = height * 10.0;
            }
        }
        if step == 9 {
            let (name, reason) = ("echo".to_string(), "it is tired".to_string());
            return Err(EnvironmentError::Gone { name, reason });
        }
        Ok(())
    }
}

#[test]
fn communication_modules_talk_with_the_environment() {
    let system = own("axiom: ?E(1)F(2)[?E(0)A(7)]?E(1)\np1: ?E(x) --> ?E(x)");
    let echo = Echo::default();
    let seen = echo.seen.clone();
    let options = DerivationOptions { environment: Some(Box::new(echo)), ..Default::default() };
    let mut derivation = Derivation::with_options(&system, options).unwrap();
    assert_eq!(derivation.string().to_string(), "?E(0)F(2)[?E(0)A(7)]?E(20)");
    assert_eq!(
        *seen.lock().unwrap(),
        ["0 0 [1.0] 0 Some(\"F[2.0]\")", "0 3 [0.0] 2 Some(\"A[7.0]\")", "0 6 [1.0] 2 None"]
    );
    for _ in 0..8 {
        derivation.advance().unwrap();
    }
    let error = derivation.advance().unwrap_err().to_string();
    assert_eq!(error, "the environment echo is gone: it is tired (after step 9)");
}

#[test]
fn threads_do_not_change_the_string() {
    let text = "axiom: X(15)\nignore: +-\nX(n) : n > 0 --> X(n-1)X(n-1)\nX(n) --> J(0)+I(0)[-I(0)]I(0) : 2\n\
        X(n) --> I(1)[+I(0)]J(3) : 1\nJ(t) : t > 0 --> J(t-1)\nJ(t) --> J(floor(ran(9)))\n\
        J(t) < I(y) : t == 0 --> I(1)\nI(x) < I(y) : x == 1 && y == 0 --> I(nran(1,0.1))\nI(y) > I(x) --> I(y/2+x/3)";
    let system = parse(text);
    let derive = |threads| {
        let options = DerivationOptions { seed: Some(5), threads, ..Default::default() };
        let mut derivation = Derivation::with_options(&system, options).unwrap();
        for _ in 0..22 {
            derivation.advance().unwrap();
        }
        derivation.finish().unwrap()
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
    let (one, four) = (derive(false), pool.install(|| derive(true)));
    assert!(one.len() > 150_000, "{}", one.len());
    assert!(one.kinds() == four.kinds() && one.parameters() == four.parameters());
}

#[test]
fn far_brackets_are_found() {
    let branch = "F".repeat(300);
    let text =
        format!("axiom: A[{branch}[{branch}]{branch}]B[{branch}]C\nA < B > C --> X\nA > B --> Y");
    let expected = format!("Y[{branch}[{branch}]{branch}]X[{branch}]C");
    assert_eq!(derive(&text, 1), expected);
}

#[test]
fn bombs_do_not_go_off() {
    let limits = Limits { modules: 100_000, bytes: 1 << 20, operations: 3_000_000 };
    for text in [
        "start: { while (1) { x = x + 1; } }\naxiom: A\nA --> A",
        "axiom: A\nA : {do { x = 1; } while (x);} * --> A",
        "axiom: A\nA --> A\ndecomposition\nmaximum depth: 1000000000\nA --> AA",
        "axiom: A\nA --> A\ndecomposition\nmaximum depth: 1000000000\nA --> A",
        "axiom: A\nA --> AA[A]",
        "axiom: A(1)\nA(x) --> A(x)A(x)A(biran(1e9,0.5))",
        "axiom: A\nA : {printf(\"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\");} * --> AA",
    ] {
        let error = parse(text).derive_within(2000, None, &limits).unwrap_err().to_string();
        assert!(error.starts_with("test.l:"), "{error}");
    }
    let deep = "axiom: A\nA --> A\nhomomorphism\nmaximum depth: 1000000000\nA --> A";
    let system = parse(deep);
    let string = system.derive(1, None).unwrap();
    let error = system.appearance(&string, None).unwrap_err().to_string();
    assert!(error.contains("nested more than") || error.contains("operations"), "{error}");
}

#[test]
fn time_is_bounded() {
    let system = parse("axiom: A\nA --> AA");
    let options = DerivationOptions { seconds: Some(0.0), ..Default::default() };
    let mut derivation = Derivation::with_options(&system, options).unwrap();
    let error = derivation.advance().unwrap_err().to_string();
    assert!(error.contains("more time than it was given"), "{error}");
}

#[test]
fn divisions_by_zero_are_remarked() {
    let system = parse("axiom: A(0)\nA(x) --> A(1/x)");
    let mut derivation = Derivation::new(&system, None, Limits::default()).unwrap();
    derivation.advance().unwrap();
    assert_eq!(derivation.string().to_string(), "A(1)");
    let [remark] = &derivation.remarks()[..] else { panic!("one remark") };
    assert!(remark.contains(":2:1: division by zero in 'A(x) --> A(1/x)' (1 times)"), "{remark}");
}

#[test]
fn useless_productions_are_doubtful() {
    let warnings = |text: &str| -> Vec<String> {
        parse(text).warnings().iter().map(|warning| warning.message.clone()).collect()
    };
    assert_eq!(
        warnings("axiom: A(1)\nA(x) --> B\nA --> C\nC --> C"),
        ["this production is never applied: nothing makes 'A' with no parameters"]
    );
    assert_eq!(
        warnings("axiom: A\nA --> B\nA > B --> C\nB --> A"),
        ["this production is never applied: the one in line 2 always comes first"]
    );
    assert_eq!(warnings("seed: 1\naxiom: A\nA --> A\nA --> AA"), [""; 0]);
}
