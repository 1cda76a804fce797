//! The peer of the L-system benchmarks: the models of `bench/lsystem/` derived by the crate
//! symbios. `bioscope_symbios a|b|c` prints module-steps per second.
//!
//! The models are written in the notation of symbios; the geometry of the strings is the same.

use std::{error::Error, time::Instant};

use symbios::System;

type Outcome = Result<(), Box<dyn Error>>;

/// Rules, axiom, steps that are not timed, and all steps.
struct Model {
    directives: &'static [&'static str],
    rules: &'static [&'static str],
    axiom: &'static str,
    first: usize,
    steps: usize,
    /// Whether only the last string counts, as in the figure of cpfg.
    last_counts: bool,
}

const BUSH: Model = Model {
    directives: &[],
    rules: &["F -> F F - [ - F + F + F ] + [ + F - F - F ]"],
    axiom: "F",
    first: 0,
    steps: 8,
    last_counts: true,
};

const TREE: Model = Model {
    directives: &[],
    rules: &[
        "A(s,w,t,v) : s >= 0.02 -> !(w) I(s,w,t,v) [ &(45) B(s*0.7,w*0.707,t+1,v*0.5) ] /(137.5) A(s*0.9,w*0.707,t+1,v*0.5+0.1)",
        "B(s,w,t,v) : s >= 0.02 & t < 40 -> !(w) I(s,w,t,v) [ -(45) C(s*0.7,w*0.707,t+1,v*0.5) ] C(s*0.9,w*0.707,t+1,v+0.1)",
        "C(s,w,t,v) : s >= 0.02 -> !(w) I(s,w,t,v) [ +(45) B(s*0.7,w*0.707,t+1,v*0.5) ] B(s*0.9,w*0.707,t+1,v+0.1)",
        "I(s,w,t,v) : t < 1000 -> I(s*1.01+0.001,w+0.01*s,t+1,v*0.99)",
    ],
    axiom: "A(1,0.1,0,1)",
    first: 0,
    steps: 26,
    last_counts: false,
};

const SIGNALS: Model = Model {
    directives: &["#ignore : + -"],
    rules: &[
        "X(n) : n == 6 -> J(0) X(n-1) X(n-1)",
        "X(n) : n > 0 & n != 6 -> X(n-1) X(n-1)",
        "X(n) : n <= 0 -> I(0) + I(0) [ - I(0) ] I(0)",
        "J(t) : t > 0 -> J(t-1)",
        "J(t) : t <= 0 -> J(9)",
        "J(t) < I(y) : t == 0 & y == 0 -> I(1)",
        "I(x) < I(y) : x == 1 & y == 0 -> I(1)",
        "I(y) : y >= 5 -> I(0)",
        "I(y) : y > 0 & y < 5 -> I(y+1)",
    ],
    axiom: "X(15)",
    first: 16,
    steps: 36,
    last_counts: false,
};

fn main() -> Outcome {
    let model = match std::env::args().nth(1).as_deref() {
        Some("a") => BUSH,
        Some("b") => TREE,
        Some("c") => SIGNALS,
        _ => return Err("usage: bioscope_symbios a|b|c".into()),
    };
    let mut system = System::new();
    system.max_capacity = 1 << 28;
    system.state.max_capacity = 1 << 28;
    for directive in model.directives {
        system.add_directive(directive)?;
    }
    for rule in model.rules {
        system.add_rule(rule)?;
    }
    system.set_axiom(model.axiom)?;
    system.derive(model.first)?;
    let (mut modules, mut seconds) = (0, 0.0);
    for _ in model.first..model.steps {
        let start = Instant::now();
        system.derive(1)?;
        seconds += start.elapsed().as_secs_f64();
        modules += system.state.len();
    }
    eprintln!("{} modules at the end", system.state.len());
    let counted = if model.last_counts { system.state.len() } else { modules };
    println!("{}", counted as f64 / seconds);
    Ok(())
}
