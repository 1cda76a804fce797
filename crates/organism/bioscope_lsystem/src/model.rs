use std::{collections::BTreeMap, sync::Arc};

use crate::{
    Diagnostic, Place,
    machine::{Pool, Program, Rules},
};

/// What a module is: its symbol and how many parameters it has. Modules of the same symbol with
/// different numbers of parameters are different kinds.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ModuleKind {
    /// The symbol, such as `F`, `@Gs` or `~l`.
    pub symbol: Box<str>,
    /// Number of parameters.
    pub arity: u8,
}

/// The kinds of module that occur in one L-system, numbered; a string of modules stores one of
/// these numbers (a byte) per module.
#[derive(Clone, Debug)]
pub struct Alphabet {
    kinds: Vec<ModuleKind>,
    codes: BTreeMap<ModuleKind, u8>,
}

impl Alphabet {
    /// Code of `[`.
    pub const OPEN: u8 = 0;
    /// Code of `]`.
    pub const CLOSE: u8 = 1;
    /// Code of `%` without parameter.
    pub const CUT: u8 = 2;
    /// Code of `%` with a parameter.
    pub const REPORTED_CUT: u8 = 3;
    /// Code of `$`, which ends a sub-L-system.
    pub const END: u8 = 4;
    /// Code of `=` in a right context: whatever follows in this branch.
    pub(crate) const REST: u8 = 5;

    /// The kinds, in the order of their codes.
    pub fn kinds(&self) -> &[ModuleKind] {
        &self.kinds
    }

    /// The code of a kind; none if it does not occur.
    pub fn code(&self, symbol: &str, arity: u8) -> Option<u8> {
        self.codes.get(&ModuleKind { symbol: symbol.into(), arity }).copied()
    }

    /// The code of a kind, which is added if it is new; none if there are 256 others.
    pub(crate) fn intern(&mut self, symbol: &str, arity: u8) -> Option<u8> {
        let kind = ModuleKind { symbol: symbol.into(), arity };
        if let Some(&code) = self.codes.get(&kind) {
            return Some(code);
        }
        let code = u8::try_from(self.kinds.len()).ok()?;
        self.kinds.push(kind.clone());
        self.codes.insert(kind, code);
        Some(code)
    }
}

impl Default for Alphabet {
    fn default() -> Self {
        let mut alphabet = Self { kinds: Vec::new(), codes: BTreeMap::new() };
        for (symbol, arity) in [("[", 0), ("]", 0), ("%", 0), ("%", 1), ("$", 0), ("=", 0)] {
            alphabet.intern(symbol, arity);
        }
        alphabet
    }
}

/// One module of a predecessor or context; its parameters are bound from `slot` on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pattern {
    pub kind: u8,
    pub arity: u8,
    pub slot: u8,
}

impl Pattern {
    pub fn is_bracket(&self) -> bool {
        matches!(self.kind, Alphabet::OPEN | Alphabet::CLOSE)
    }
}

/// The modules that a production (or the axiom) makes; its program emits all their parameters.
#[derive(Clone, Debug, Default)]
pub(crate) struct Successor {
    pub kinds: Vec<u8>,
    pub program: Program,
}

/// `left < strict > right : {before} condition {after} --> successor : probability`
#[derive(Clone, Debug)]
pub(crate) struct Production {
    pub left: Vec<Pattern>,
    pub strict: Vec<Pattern>,
    pub right: Vec<Pattern>,
    /// Computes `before` and the condition; empty if it applies always.
    pub test: Program,
    pub probability: Option<Program>,
    /// Age at which a timed module is replaced.
    pub after: Option<Program>,
    /// Computes `after` and the parameters.
    pub successor: Successor,
    /// How many parameters and local variables it has.
    pub slots: usize,
    /// Whether it replaces one module, whose parameters it leaves where they are bound.
    pub keeps_parameters: bool,
    /// Whether it replaces one module, without context, weight and random numbers.
    pub is_simple: bool,
    /// Whether it draws random numbers, beside those that choose it.
    pub is_random: bool,
    pub place: Place,
    pub text: String,
    /// Instructions that one attempt to apply it runs at most.
    pub cost: u64,
}

impl Production {
    /// Whether it applies to its kind of module always, and makes modules without parameters.
    fn is_plain(&self) -> bool {
        self.left.is_empty()
            && self.strict.len() == 1
            && self.right.is_empty()
            && self.test.is_empty()
            && self.probability.is_none()
            && self.successor.program.is_empty()
    }

    pub fn programs(&self) -> impl Iterator<Item = &Program> {
        [&self.test, &self.successor.program].into_iter().chain(&self.probability)
    }
}

/// What happens to one kind of module in a step.
#[derive(Clone, Debug)]
pub(crate) enum Action {
    /// No production: it stays.
    Keep,
    /// The production of this number applies always and its successor has no parameters.
    Replace(u32),
    /// The productions of these numbers are tried in order.
    Try(Box<[u32]>),
}

/// Productions that are applied together.
#[derive(Clone, Debug)]
pub(crate) struct ProductionSet {
    pub productions: Vec<Production>,
    /// By the kind of module that begins the strict predecessor.
    pub actions: Vec<Action>,
    /// How often it is applied to its own results (decomposition, homomorphism).
    pub maximum_depth: u32,
    /// Whether modules must be treated one after the other.
    pub has_effects: bool,
    /// Whether random numbers are drawn, other than to choose a production.
    pub is_random: bool,
    /// Most modules that a production replaces at once.
    pub longest: usize,
}

impl ProductionSet {
    pub fn new(productions: Vec<Production>, maximum_depth: u32) -> Self {
        let mut tried = vec![Vec::new(); 256];
        for (number, production) in productions.iter().enumerate() {
            if let Some(first) = production.strict.first() {
                tried[first.kind as usize].push(number as u32);
            }
        }
        let action = |numbers: Vec<u32>| match numbers[..] {
            [] => Action::Keep,
            [first, ..] if productions[first as usize].is_plain() => Action::Replace(first),
            _ => Action::Try(numbers.into()),
        };
        let actions = tried.into_iter().map(action).collect();
        let programs = || productions.iter().flat_map(Production::programs);
        let (has_effects, is_random) =
            (programs().any(Program::has_effects), programs().any(Program::is_random));
        Self {
            has_effects,
            is_random,
            longest: productions.iter().map(|one| one.strict.len()).max().unwrap_or(1),
            actions,
            maximum_depth,
            productions,
        }
    }
}

/// How the successors of a module are found in its right context.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum RightContext {
    /// As in the reference program: branches are passed over unless the context names a bracket,
    /// and brackets must match to the letter.
    #[default]
    Reference,
    /// On the same axis; only the beginning of a bracketed group must match.
    Axis,
    /// Also in the branches that are passed over.
    Tree,
}

/// Which modules of a string are rewritten in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Order {
    /// All at once.
    #[default]
    Parallel,
    /// The leftmost to which a production applies.
    Leftmost,
    /// One of those to which a production applies.
    Random,
}

/// Statements that are run before, between and after steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks {
    pub start: Program,
    pub start_each: Program,
    pub end_each: Program,
    pub end: Program,
}

/// One L-system of a file; those after the first serve as sub-L-systems.
#[derive(Clone, Debug)]
pub(crate) struct System {
    /// What `?(label, scale)` calls it.
    pub label: i64,
    /// One set of productions per table, at least one.
    pub tables: Vec<ProductionSet>,
    /// Conditions that select a table for a step.
    pub selections: Vec<(Program, usize)>,
    pub decomposition: Option<ProductionSet>,
    pub homomorphism: Option<ProductionSet>,
    /// Seed of the homomorphism's own random numbers.
    pub homomorphism_seed: Option<i64>,
    /// By kind: whether context matching looks past it.
    pub skipped: Box<[bool; 256]>,
    pub right_context: RightContext,
    /// Whether the string has no ends.
    pub is_ring: bool,
    /// Whether the file says that productions are chosen by chance (`seed:`).
    pub is_stochastic: bool,
    pub order: Order,
    pub blocks: Blocks,
}

/// What a timed model says about its modules.
#[derive(Clone, Debug)]
pub(crate) struct Timing {
    /// Seconds per step.
    pub step: f64,
    /// By kind: whether it has an age, its first parameter.
    pub is_timed: Box<[bool; 256]>,
    /// By kind: what it shows, and the program that computes its parameters.
    pub growth: Vec<Option<(u8, Program)>>,
}

/// A parsed L-system, ready to derive strings.
#[derive(Clone, Debug)]
pub struct LSystem {
    pub(crate) alphabet: Arc<Alphabet>,
    pub(crate) pool: Arc<Pool>,
    pub(crate) axiom: Successor,
    pub(crate) axiom_place: Place,
    /// The main L-system, then the others.
    pub(crate) systems: Vec<System>,
    pub(crate) timing: Option<Timing>,
    pub(crate) derivation_length: u32,
    pub(crate) angle: Option<f32>,
    pub(crate) environment: Option<String>,
    pub(crate) constants: Vec<(String, f64)>,
    pub(crate) warnings: Vec<Diagnostic>,
}

impl LSystem {
    /// The kinds of module that occur.
    pub fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }

    /// Number of steps after which the model is complete, as the file says; 0 if it does not.
    pub fn derivation_length(&self) -> u32 {
        self.derivation_length
    }

    /// Seconds per step of a timed model (`timed:`).
    pub fn seconds_per_step(&self) -> Option<f64> {
        self.timing.as_ref().map(|timing| timing.step)
    }

    /// Degrees of `+`, `&`, `/` … without parameter, if the file says so (`angle:`).
    pub fn angle(&self) -> Option<f32> {
        self.angle
    }

    /// Name and parameters of the environment that the file asks for (`environment:`).
    pub fn environment(&self) -> Option<&str> {
        self.environment.as_deref()
    }

    /// The file's `#define`d numbers, by name in alphabetical order.
    pub fn constants(&self) -> &[(String, f64)] {
        &self.constants
    }

    /// Value of a `#define`d number.
    pub fn constant(&self, name: &str) -> Option<f64> {
        let index = self.constants.binary_search_by(|(known, _)| known.as_str().cmp(name)).ok()?;
        Some(self.constants[index].1)
    }

    /// The texts of the file; where one is a parameter, as in `@L("bud %g", 3)`, the string holds
    /// its number.
    pub fn texts(&self) -> &[String] {
        &self.pool.texts
    }

    /// All productions, those of decomposition and homomorphism too.
    pub(crate) fn productions(&self) -> impl Iterator<Item = &Production> {
        self.systems.iter().flat_map(|system| {
            let sets =
                system.tables.iter().chain(&system.decomposition).chain(&system.homomorphism);
            sets.flat_map(|set| &set.productions)
        })
    }

    /// Whether the file is in the notation of our own rather than in the cpfg dialect.
    pub(crate) fn is_own(&self) -> bool {
        self.pool.rules == Rules::Own
    }

    /// What is doubtful in the file but not wrong, such as names that stand for nothing.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }
}
