//! One L-system of a file, while it is being read.

use super::{Listed, Part};
use crate::{
    Alphabet,
    machine::{Program, Rules},
    model::{Blocks, Order, Production, ProductionSet, RightContext, System},
};

/// Name of the table that is always active.
const ALWAYS: &str = "*";

/// Productions of a decomposition or homomorphism.
#[derive(Default)]
pub(super) struct Productions {
    pub list: Vec<Production>,
    pub depth: Option<u32>,
}

pub(super) struct Draft {
    pub label: String,
    /// Productions with the number of their table.
    pub rewriting: Vec<(usize, Production)>,
    /// Names of the tables; the first is always active.
    pub tables: Vec<String>,
    /// Table to which productions are being added.
    pub table: usize,
    pub selections: Vec<(Program, String)>,
    pub decomposition: Productions,
    pub homomorphism: Productions,
    pub homomorphism_seed: Option<i64>,
    pub ignored: Option<Listed>,
    pub considered: Option<Listed>,
    pub right_context: RightContext,
    pub is_ring: bool,
    pub is_stochastic: bool,
    pub order: Order,
    pub blocks: Blocks,
}

impl Draft {
    pub fn new(rules: Rules) -> Self {
        let right_context = match rules {
            Rules::Reference => RightContext::Reference,
            Rules::Own => RightContext::Tree,
        };
        Self {
            label: String::new(),
            rewriting: Vec::new(),
            tables: vec![ALWAYS.into()],
            table: 0,
            selections: Vec::new(),
            decomposition: Productions::default(),
            homomorphism: Productions::default(),
            homomorphism_seed: None,
            ignored: None,
            considered: None,
            right_context,
            is_ring: false,
            is_stochastic: false,
            order: Order::Parallel,
            blocks: Blocks::default(),
        }
    }

    pub fn has_no_productions(&self) -> bool {
        self.rewriting.is_empty()
    }

    pub fn add(&mut self, part: Part, production: Production) {
        match part {
            Part::Decomposition => self.decomposition.list.push(production),
            Part::Homomorphism => self.homomorphism.list.push(production),
            Part::Rewriting | Part::Over => self.rewriting.push((self.table, production)),
        }
    }

    /// The table of this name, which is new if it is unknown.
    pub fn begin_table(&mut self, name: &str) {
        let known = self.tables.iter().position(|known| known == name);
        self.table = known.unwrap_or_else(|| {
            self.tables.push(name.to_string());
            self.tables.len() - 1
        });
    }

    pub fn finish(self, alphabet: &Alphabet) -> System {
        let mut skipped = Box::new([false; 256]);
        for (code, kind) in alphabet.kinds().iter().enumerate() {
            skipped[code] = self.is_skipped(&kind.symbol);
        }
        let set = |table: usize| {
            let belongs = |&&(of, _): &&(usize, Production)| of == 0 || of == table;
            let chosen = self.rewriting.iter().filter(belongs);
            ProductionSet::new(chosen.map(|(_, production)| production.clone()).collect(), 1)
        };
        let tables = (0..self.tables.len()).map(set).collect();
        let number = |name: &String| self.tables.iter().position(|known| known == name);
        let selections = self.selections.iter();
        let selections = selections
            .filter_map(|(program, name)| Some((program.clone(), number(name)?)))
            .collect();
        let optional = |set: Productions| {
            let depth = set.depth.unwrap_or(1);
            (!set.list.is_empty()).then(|| ProductionSet::new(set.list, depth))
        };
        System {
            label: self.label.trim().parse::<f64>().unwrap_or(0.0) as i64,
            tables,
            selections,
            skipped,
            decomposition: optional(self.decomposition),
            homomorphism: optional(self.homomorphism),
            homomorphism_seed: self.homomorphism_seed,
            right_context: self.right_context,
            is_ring: self.is_ring,
            is_stochastic: self.is_stochastic,
            order: self.order,
            blocks: self.blocks,
        }
    }

    fn is_skipped(&self, symbol: &str) -> bool {
        let bracket = symbol == "[" || symbol == "]";
        let outside = self.considered.as_ref().is_some_and(|list| !list.contains_part_of(symbol));
        let ignored = self.ignored.as_ref().is_some_and(|list| list.contains(symbol));
        !bracket && (outside || ignored)
    }
}
