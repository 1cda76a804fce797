//! Queries and communication: the turtle walks along the string, and the environment answers.

use super::{Derivation, DerivationError, Derived, Noted};
use crate::{EnvironmentError, Following, ModuleString, Reply, Request, Turtle, turtle::Stance};

/// What a query asks for.
#[derive(Clone, Copy, PartialEq)]
enum Query {
    Position,
    Heading,
    Left,
    Up,
    Environment,
}

fn query(symbol: &str) -> Option<Query> {
    Some(match symbol {
        "?P" => Query::Position,
        "?H" => Query::Heading,
        "?L" => Query::Left,
        "?U" => Query::Up,
        "?E" => Query::Environment,
        _ => return None,
    })
}

/// A communication module.
struct Message {
    stance: Stance,
    /// Number of its first parameter.
    first: usize,
    arity: usize,
}

impl Derivation<'_> {
    /// Tells the queries of the string what they ask for.
    pub(super) fn exchange(&mut self) -> Derived<()> {
        let kinds = self.system.alphabet.kinds();
        let queries: Vec<Option<Query>> = kinds.iter().map(|kind| query(&kind.symbol)).collect();
        let is_query = |&kind: &u8| queries[kind as usize].is_some();
        let has_queries =
            queries.iter().any(Option::is_some) && self.string.kinds.iter().any(is_query);
        if !has_queries && self.options.environment.is_none() {
            return Ok(());
        }
        let stances = if has_queries { self.stances(&queries)? } else { Vec::new() };
        let messages = self.fill(&queries, stances);
        let Some(mut environment) = self.options.environment.take() else { return Ok(()) };
        let sent = if messages.is_empty() { Vec::new() } else { self.string.parameters.clone() };
        let (requests, mut replies) = addressed(&self.string, &self.ids, &messages, &sent);
        let mut replies =
            replies.iter_mut().map(|reply| Reply { parameters: reply }).collect::<Vec<_>>();
        let exchanged = environment.exchange(self.step, &requests, &mut replies);
        let answers: Vec<Vec<f32>> =
            replies.into_iter().map(|reply| reply.parameters.to_vec()).collect();
        self.options.environment = Some(environment);
        exchanged.map_err(|error| self.failed(error))?;
        for (message, answer) in messages.iter().zip(&answers) {
            self.string.parameters[message.first..message.first + message.arity]
                .copy_from_slice(answer);
        }
        Ok(())
    }

    fn failed(&self, error: EnvironmentError) -> DerivationError {
        DerivationError::Environment { error, step: self.step }
    }

    /// Where the turtle stands at each query of the string, through its homomorphism.
    fn stances(&mut self, queries: &[Option<Query>]) -> Derived<Vec<Stance>> {
        let mut wanted: Vec<bool> = queries.iter().map(Option::is_some).collect();
        wanted.resize(256, false);
        let has_homomorphism = self.system.timing.is_some()
            || self.system.systems.iter().any(|one| one.homomorphism.is_some());
        let refused = |step, error: bioscope_core::Error| DerivationError::Environment {
            error: EnvironmentError::Refused { name: "turtle".into(), reason: error.to_string() },
            step,
        };
        let step = self.step;
        if !has_homomorphism {
            let stances = Turtle::stances(&self.string, &self.options.turtle, &wanted);
            return stances.map_err(|error| refused(step, error));
        }
        let string =
            std::mem::replace(&mut self.string, ModuleString::new(self.system.alphabet.clone()));
        let shown = self.shown(&string, Noted::Kinds(&wanted));
        self.string = string;
        let (shown, notes) = shown?;
        let stances = Turtle::stances(&shown, &self.options.turtle, &wanted);
        let stances = stances.map_err(|error| refused(step, error))?;
        // Queries that the homomorphism made are not in the string.
        let mut notes = notes.into_iter().peekable();
        let mut found = Vec::new();
        for stance in stances {
            if let Some((_, module)) = notes.next_if(|(shown, _)| *shown == stance.module) {
                found.push(Stance { module, ..stance });
            }
        }
        Ok(found)
    }

    /// Answers what the turtle knows; the rest are messages to the environment.
    fn fill(&mut self, queries: &[Option<Query>], stances: Vec<Stance>) -> Vec<Message> {
        let mut messages = Vec::new();
        let (mut module, mut parameter) = (0, 0);
        for stance in stances {
            while module < stance.module {
                parameter += self.arities[self.string.kinds[module] as usize] as usize;
                module += 1;
            }
            let kind = self.string.kinds[module] as usize;
            let arity = self.arities[kind] as usize;
            let vector = match queries[kind] {
                Some(Query::Position) => stance.position,
                Some(Query::Heading) => stance.frame.heading,
                Some(Query::Left) => stance.frame.left,
                Some(Query::Up) => stance.frame.up,
                Some(Query::Environment) => {
                    messages.push(Message { stance, first: parameter, arity });
                    continue;
                }
                None => continue,
            };
            let values = &mut self.string.parameters[parameter..parameter + arity];
            for (value, coordinate) in values.iter_mut().zip(vector.to_array()) {
                *value = coordinate;
            }
        }
        messages
    }
}

/// The requests of these messages, and room for their replies.
fn addressed<'s>(
    string: &'s ModuleString,
    ids: &[u64],
    messages: &[Message],
    parameters: &'s [f32],
) -> (Vec<Request<'s>>, Vec<Vec<f32>>) {
    let mut requests = Vec::with_capacity(messages.len());
    let mut replies = Vec::with_capacity(messages.len());
    for Message { stance, first, arity } in messages {
        let own = &parameters[*first..first + arity];
        let next = string
            .kinds
            .get(stance.module + 1)
            .map(|&code| &string.alphabet.kinds()[code as usize]);
        let following = next.filter(|kind| &*kind.symbol != "]").map(|kind| {
            let start = first + arity;
            let parameters = &parameters[start..start + kind.arity as usize];
            Following { symbol: &kind.symbol, parameters }
        });
        requests.push(Request {
            module: stance.module,
            id: ids.get(stance.module).copied().unwrap_or(stance.module as u64),
            parameters: own,
            position: stance.position,
            heading: stance.frame.heading,
            left: stance.frame.left,
            up: stance.frame.up,
            width: stance.width,
            color: stance.color,
            following,
        });
        replies.push(own.to_vec());
    }
    (requests, replies)
}
