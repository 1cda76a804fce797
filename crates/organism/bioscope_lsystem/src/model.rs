use std::{collections::BTreeMap, sync::Arc};

use crate::{
    Diagnostic, Place,
    expression::{Expression, Instruction},
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
    /// Code of `%`.
    pub const CUT: u8 = 2;

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
        for symbol in ["[", "]", "%"] {
            alphabet.intern(symbol, 0);
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

/// The modules that a production (or the axiom) makes, with the expressions of all their
/// parameters in order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Successor {
    pub kinds: Vec<u8>,
    pub arguments: Vec<Expression>,
}

/// `left < strict > right : {before} condition {after} --> successor : probability`
#[derive(Clone, Debug)]
pub(crate) struct Production {
    pub left: Vec<Pattern>,
    pub strict: Vec<Pattern>,
    pub right: Vec<Pattern>,
    pub before: Vec<Instruction>,
    pub condition: Option<Expression>,
    pub after: Vec<Instruction>,
    pub successor: Successor,
    pub probability: Option<Expression>,
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
            && self.before.is_empty()
            && self.condition.is_none()
            && self.probability.is_none()
            && self.successor.arguments.is_empty()
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
        Self { productions, actions, maximum_depth }
    }
}

/// A parsed L-system, ready to derive strings.
#[derive(Clone, Debug)]
pub struct LSystem {
    pub(crate) alphabet: Arc<Alphabet>,
    pub(crate) axiom: Successor,
    pub(crate) axiom_place: Place,
    pub(crate) rewriting: ProductionSet,
    pub(crate) decomposition: Option<ProductionSet>,
    pub(crate) homomorphism: Option<ProductionSet>,
    /// By kind: whether context matching looks past it.
    pub(crate) skipped: Vec<bool>,
    pub(crate) derivation_length: u32,
    pub(crate) angle: Option<f32>,
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

    /// Degrees of `+`, `&`, `/` … without parameter, if the file says so (`angle:`).
    pub fn angle(&self) -> Option<f32> {
        self.angle
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

    /// What is doubtful in the file but not wrong, such as names that stand for nothing.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }
}
