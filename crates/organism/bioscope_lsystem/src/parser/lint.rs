//! What is doubtful about a model as a whole: productions that can never be applied.

use std::collections::BTreeSet;

use super::Parser;
use crate::{Diagnostic, model::Production};

impl Parser<'_> {
    /// Warns of productions whose modules nothing makes, and of those that an earlier production
    /// always forestalls.
    pub(super) fn lint(&mut self) {
        if !self.errors.is_empty() {
            return;
        }
        let mut found = Vec::new();
        {
            let made = self.made();
            for draft in &self.drafts {
                let rewriting: Vec<&Production> =
                    draft.rewriting.iter().map(|(_, production)| production).collect();
                let sets = [
                    (rewriting, draft.is_stochastic),
                    (draft.decomposition.list.iter().collect(), false),
                    (draft.homomorphism.list.iter().collect(), false),
                ];
                for (set, is_stochastic) in &sets {
                    found.extend(self.never_made(set, &made));
                    if draft.tables.len() == 1 {
                        found.extend(match is_stochastic {
                            true => competing(set),
                            false => forestalled(set),
                        });
                    }
                }
            }
        }
        self.warnings.extend(found);
        self.warnings.truncate(super::REPORT_LIMIT);
    }

    /// Kinds of module that the axiom or a production makes.
    fn made(&self) -> BTreeSet<u8> {
        let mut made = BTreeSet::new();
        if let Some((axiom, _)) = &self.axiom {
            made.extend(&axiom.kinds);
        }
        made.extend(self.growth.iter().map(|&(_, shown, _)| shown));
        for draft in &self.drafts {
            let rewriting = draft.rewriting.iter().map(|(_, production)| production);
            let others = draft.decomposition.list.iter().chain(&draft.homomorphism.list);
            for production in rewriting.chain(others) {
                made.extend(&production.successor.kinds);
            }
        }
        made
    }

    fn never_made(&self, set: &[&Production], made: &BTreeSet<u8>) -> Vec<Diagnostic> {
        let kinds = self.alphabet.kinds();
        let mut found = Vec::new();
        for production in set {
            let missing = production.strict.iter().find(|pattern| !made.contains(&pattern.kind));
            let Some(missing) = missing else { continue };
            let kind = &kinds[missing.kind as usize];
            let others: Vec<u8> = kinds
                .iter()
                .enumerate()
                .filter(|(code, other)| {
                    other.symbol == kind.symbol && made.contains(&(*code as u8))
                })
                .map(|(_, other)| other.arity)
                .collect();
            let message = format!(
                "this production is never applied: nothing makes '{}' with {}",
                kind.symbol,
                counted(kind.arity)
            );
            let help = others
                .first()
                .map(|&arity| format!("'{}' is made with {}", kind.symbol, counted(arity)));
            found.push(report(production, message, help));
        }
        found
    }
}

/// Productions after one that applies always to the same module.
fn forestalled(set: &[&Production]) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (number, production) in set.iter().enumerate() {
        let earlier = set[..number].iter().find(|earlier| {
            earlier.left.is_empty()
                && earlier.right.is_empty()
                && earlier.test.is_empty()
                && earlier.probability.is_none()
                && earlier.strict.len() == 1
                && earlier.strict[0].kind == production.strict[0].kind
        });
        if let Some(earlier) = earlier {
            let message = format!(
                "this production is never applied: the one in line {} always comes first",
                earlier.place.line
            );
            found.push(report(production, message, None));
        }
    }
    found
}

/// Productions that are meant for what others leave, but are drawn by chance like those: with
/// `seed:` the order of productions means nothing.
fn competing(set: &[&Production]) -> Vec<Diagnostic> {
    let is_rest =
        |one: &Production| one.left.is_empty() && one.right.is_empty() && one.test.is_empty();
    let mut found = Vec::new();
    for production in set.iter().filter(|one| is_rest(one)) {
        let rivals = || set.iter().filter(|other| replaces_same(other, production));
        let special = rivals().find(|rival| !is_rest(rival));
        if let Some(special) = special
            && rivals().all(|rival| rival.probability.is_none())
        {
            let message = format!(
                "'seed:' lets chance decide between this production and the one in line {}",
                special.place.line
            );
            let help = "without 'seed:' the first that applies is taken; weights such as ': 0.5' \
                        say that chance is meant";
            found.push(report(production, message, Some(help.into())));
        }
    }
    found
}

fn replaces_same(one: &Production, other: &Production) -> bool {
    one.strict.len() == other.strict.len()
        && one.strict.iter().zip(&other.strict).all(|(own, its)| own.kind == its.kind)
}

fn counted(arity: u8) -> String {
    match arity {
        0 => "no parameters".into(),
        1 => "1 parameter".into(),
        more => format!("{more} parameters"),
    }
}

fn report(production: &Production, message: String, help: Option<String>) -> Diagnostic {
    Diagnostic {
        place: production.place.clone(),
        source_line: " ".repeat(production.place.column as usize - 1) + &production.text,
        width: production.text.chars().count().max(1) as u32,
        message,
        help,
    }
}
