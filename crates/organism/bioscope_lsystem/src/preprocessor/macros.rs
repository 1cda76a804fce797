//! Macros: their definitions and what they expand to.

use std::sync::Arc;

use super::{
    Preprocessor,
    conditions::Conditions,
    emit,
    token::{Fragment, Kind, Token, after, arguments, call_length, joined},
};
use crate::source::Origin;

/// How deeply macros may be nested in one another.
const DEPTH_LIMIT: usize = 64;
/// How many tokens all expansions together may produce.
const TOKEN_LIMIT: usize = 2_000_000;

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) struct Macro {
    /// None for a constant: no parentheses follow its name.
    formals: Option<Vec<String>>,
    body: Arc<[Token]>,
}

impl Preprocessor<'_> {
    /// A definition: the whole line for reports, and its part after `define`.
    pub(super) fn define(&mut self, line: &[Token], rest: &[Token]) {
        let name = rest.iter().find(|token| !token.is_blank());
        let Some(name) = name.filter(|token| token.kind == Kind::Name) else {
            let end = line[line.len() - 1].origin();
            return self.error(end, "expected a name after #define");
        };
        let mut rest = after(rest, name);
        let mut formals = None;
        if let Some(open) = rest.first().filter(|token| token.kind == Kind::Open) {
            let Some(close) = rest.iter().position(|token| token.kind == Kind::Close) else {
                return self.error(open.origin(), "expected ')' after the macro's parameters");
            };
            let names = rest[1..close].iter().filter(|token| token.kind == Kind::Name);
            formals = Some(names.map(|token| token.text.to_string()).collect());
            rest = &rest[close + 1..];
        }
        let body = rest.iter().map(|token| {
            let mut token = token.clone();
            if token.is_blank() {
                token.kind = Kind::Blank;
                token.text = Fragment { file: " ".into(), span: 0..1 };
            }
            token
        });
        let body = body.skip_while(|token| token.kind == Kind::Blank).collect();
        self.macros.insert(name.text.to_string(), Macro { formals, body });
    }

    /// Copies a name or expands the macro of this name; how many tokens it took from the file.
    pub(super) fn name(&mut self, tokens: &[Token]) -> usize {
        let name = &tokens[0];
        let used = match self.macros.get(&*name.text) {
            None => None,
            Some(Macro { formals: None, .. }) => Some(1),
            Some(_) => call_length(&tokens[1..]).map(|length| length + 1),
        };
        let Some(used) = used else {
            self.copy(name, &Conditions::default());
            return 1;
        };
        let mut expanded = Vec::new();
        match self.expand(&tokens[..used], &mut Vec::new(), &mut expanded) {
            Ok(()) => {
                let span = name.start..tokens[used - 1].end();
                let origin = Origin { file: name.file, span };
                emit(&mut self.source, &joined(&expanded), origin, Some((&*name.text).into()));
            }
            Err(message) => self.error(name.origin(), message),
        }
        used
    }

    /// Appends `tokens` with all macros expanded, except those `active` already.
    pub(super) fn expand(
        &mut self,
        tokens: &[Token],
        active: &mut Vec<String>,
        out: &mut Vec<Token>,
    ) -> Result<(), String> {
        if active.len() >= DEPTH_LIMIT {
            return Err(format!("macros nested more than {DEPTH_LIMIT} deep"));
        }
        let mut next = 0;
        while next < tokens.len() {
            let token = &tokens[next];
            self.produced += 1;
            if self.produced > TOKEN_LIMIT {
                return Err(format!("macros expand to more than {TOKEN_LIMIT} tokens"));
            }
            next += 1;
            let known =
                token.kind == Kind::Name && !active.iter().any(|name| **name == *token.text);
            let Some(definition) = self.macros.get(&*token.text).filter(|_| known) else {
                out.push(token.clone());
                continue;
            };
            let Macro { formals, body } = definition.clone();
            active.push(token.text.to_string());
            match formals {
                None => self.expand(&body, active, out)?,
                Some(formals) => {
                    let Some(length) = call_length(&tokens[next..]) else {
                        active.pop();
                        out.push(token.clone());
                        continue;
                    };
                    let actuals = arguments(&tokens[next..next + length]);
                    next += length;
                    if actuals.len() != formals.len() {
                        return Err(format!(
                            "macro '{}' has {} parameters, found {}",
                            &*token.text,
                            formals.len(),
                            actuals.len()
                        ));
                    }
                    active.pop();
                    let body = self.substitute(&body, &formals, &actuals, active)?;
                    active.push(token.text.to_string());
                    self.expand(&body, active, out)?;
                }
            }
            active.pop();
        }
        Ok(())
    }

    /// The macro's body with its parameters replaced by the expanded arguments.
    fn substitute(
        &mut self,
        body: &[Token],
        formals: &[String],
        actuals: &[&[Token]],
        active: &mut Vec<String>,
    ) -> Result<Vec<Token>, String> {
        let mut expanded = Vec::new();
        for actual in actuals {
            let mut tokens = Vec::new();
            // One more than the macros that are active, so that nested calls count as depth.
            active.push(String::new());
            self.expand(actual, active, &mut tokens)?;
            active.pop();
            expanded.push(tokens);
        }
        let mut out = Vec::new();
        for token in body {
            match formals.iter().position(|formal| **formal == *token.text) {
                Some(index) => out.extend_from_slice(&expanded[index]),
                None => out.push(token.clone()),
            }
            if self.produced + out.len() > TOKEN_LIMIT {
                return Err(format!("macros expand to more than {TOKEN_LIMIT} tokens"));
            }
        }
        self.produced += out.len();
        Ok(out)
    }

    pub(super) fn constants(&mut self) -> Vec<(String, String)> {
        let constants = self.macros.iter().filter(|(_, definition)| definition.formals.is_none());
        let bodies: Vec<(String, Arc<[Token]>)> =
            constants.map(|(name, definition)| (name.clone(), definition.body.clone())).collect();
        let mut texts = Vec::new();
        for (name, body) in bodies {
            let mut out = Vec::new();
            if self.expand(&body, &mut vec![name.clone()], &mut out).is_ok() {
                texts.push((name, joined(&out)));
            }
        }
        texts
    }
}
