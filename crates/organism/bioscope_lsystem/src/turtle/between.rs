//! Growth between two steps: what the turtle draws while one string turns into the next.
//!
//! Every module of the new string is compared with the one that it stems from. What is still there
//! goes from its old numbers to its new ones; a stretch that has become another one is drawn out of
//! the old length; what is new grows from nothing. So at a share of 0 the new string looks like the
//! old one, and at 1 like itself.

use std::ops::Range;

use bioscope_core::Result;
use serde::{Deserialize, Serialize};

use super::{Command, Turtle, TurtleOptions, command};
use crate::{
    Interpretation, ModuleString,
    derivation::{Lineage, Shown},
};

/// How deeply nested branches that one module has become are compared.
const DEEPEST: usize = 64;

/// How a string begins to turn into itself: its numbers at the start.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Between {
    /// Parameters of all modules.
    parameters: Vec<f32>,
    /// Of every module, what lengths, angles, widths and sizes are multiplied with.
    factors: Vec<f32>,
}

impl Between {
    /// From what a plant looked like to what it looks like one step later; `lineage` is that step's. Empty if
    /// nothing is known of the step.
    pub fn new(before: &Shown, after: &Shown, lineage: &Lineage, options: &TurtleOptions) -> Self {
        let mut between = Self {
            parameters: after.string.parameters().to_vec(),
            factors: vec![1.0; after.string.len()],
        };
        let (old, new) = (Sheet::new(&before.string, options), Sheet::new(&after.string, options));
        let mut known = false;
        for (from, to) in lineage.groups(before.modules(), after.modules()) {
            if from.end > before.modules() || to.end > after.modules() {
                return Self::default();
            }
            known = true;
            let (from, to) = (before.of(from), after.of(to));
            let moves = old.moves_more(from.end);
            Pair { old: &old, new: &new, moves, depth: 0, between: &mut between }.stretch(from, to);
        }
        if known { between } else { Self::default() }
    }

    /// Whether nothing is known of the step.
    pub fn is_empty(&self) -> bool {
        self.factors.is_empty()
    }
}

impl Turtle<'_> {
    /// What the string looks like when it is only just becoming what it is: `share` 0 to 1 of a step.
    pub fn interpret_between(
        string: &ModuleString,
        options: &TurtleOptions,
        between: &Between,
        share: f32,
    ) -> Result<Interpretation> {
        if between.factors.len() != string.len()
            || between.parameters.len() != string.parameters().len()
        {
            return Turtle::interpret(string, options);
        }
        let sheet = Sheet::new(string, options);
        let mut turtle = Turtle::new(string.alphabet(), options);
        let mut mixed = Vec::new();
        for (module, &code) in string.kinds().iter().enumerate() {
            let range = sheet.firsts[module]..sheet.firsts[module + 1];
            mixed.clear();
            mixed.extend_from_slice(&string.parameters()[range.clone()]);
            if is_measured(sheet.commands[code as usize]) {
                for (own, start) in mixed.iter_mut().zip(&between.parameters[range]) {
                    *own = start + (*own - start) * share;
                }
            }
            turtle.growing = between.factors[module] + (1.0 - between.factors[module]) * share;
            turtle.read(code, &mixed)?;
        }
        Ok(turtle.finish())
    }
}

/// Whether the numbers of a command are measures that may have any value between two.
fn is_measured(command: Command) -> bool {
    matches!(
        command,
        Command::Draw { .. }
            | Command::Move { .. }
            | Command::Turn(_)
            | Command::Pitch(_)
            | Command::Roll(_)
            | Command::Width(_)
            | Command::Surface(_)
            | Command::Ball
            | Command::Disc(_)
    )
}

/// A string as its turtle reads it.
struct Sheet<'a> {
    string: &'a ModuleString,
    options: &'a TurtleOptions,
    commands: Vec<Command>,
    /// Number of the first parameter of each module; one more at the end.
    firsts: Vec<usize>,
}

impl<'a> Sheet<'a> {
    fn new(string: &'a ModuleString, options: &'a TurtleOptions) -> Self {
        let kinds = string.alphabet().kinds();
        let commands =
            kinds.iter().map(|kind| command(&kind.symbol, kind.arity, options)).collect();
        let mut firsts = Vec::with_capacity(string.len() + 1);
        let mut first = 0;
        for &code in string.kinds() {
            firsts.push(first);
            first += kinds[code as usize].arity as usize;
        }
        firsts.push(first);
        Self { string, options, commands, firsts }
    }

    fn command(&self, module: usize) -> Command {
        self.commands[self.string.kinds()[module] as usize]
    }

    /// Length of a stroke or step.
    fn length(&self, module: usize) -> f32 {
        let own = self.string.parameters()[self.firsts[module]..self.firsts[module + 1]].first();
        own.copied().unwrap_or(self.options.step).max(0.0)
    }

    /// Whether the branch goes on from this module with anything that a turn would move.
    fn moves_more(&self, module: usize) -> bool {
        let rest = module..self.string.len();
        let next = rest.map(|one| self.command(one)).find(|&one| {
            matches!(one, Command::Pop | Command::Push | Command::EndPolygon) || is_drawn(one)
        });
        !matches!(next, None | Some(Command::Pop))
    }

    /// The parts of a stretch: modules, and branches with their brackets.
    fn parts(&self, stretch: Range<usize>) -> Vec<Range<usize>> {
        let mut parts = Vec::new();
        let mut module = stretch.start;
        while module < stretch.end {
            let end = match self.command(module) {
                Command::Push => self.end_of_branch(module, stretch.end),
                _ => module + 1,
            };
            parts.push(module..end);
            module = end;
        }
        parts
    }

    /// The module after the bracket that closes the one at `open`; the one after `open` if none does before `end`.
    fn end_of_branch(&self, open: usize, end: usize) -> usize {
        let mut depth = 0;
        for module in open..end {
            match self.command(module) {
                Command::Push => depth += 1,
                Command::Pop => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                return module + 1;
            }
        }
        open + 1
    }
}

/// Whether a command leads along the branch or leaves something there.
fn is_drawn(command: Command) -> bool {
    is_path(command) || matches!(command, Command::Surface(_) | Command::Ball | Command::Disc(_))
}

fn is_path(command: Command) -> bool {
    matches!(command, Command::Draw { .. } | Command::Move { .. })
}

/// An old and a new string that are compared.
struct Pair<'a, 'b> {
    old: &'a Sheet<'a>,
    new: &'a Sheet<'a>,
    /// Whether turns at the end of what is compared would move something old.
    moves: bool,
    /// How many brackets are open in what is compared.
    depth: usize,
    between: &'b mut Between,
}

impl Pair<'_, '_> {
    /// Compares what has become of a stretch with what that was.
    fn stretch(&mut self, from: Range<usize>, to: Range<usize>) {
        let (old, new) = (self.old.string.kinds(), self.new.string.kinds());
        if old[from.clone()] == new[to.clone()] {
            for (old, new) in from.zip(to) {
                self.same(old, new);
            }
            return;
        }
        let (old, new) = (self.old.parts(from), self.new.parts(to));
        let path = |sheet: &Sheet, parts: &[Range<usize>]| -> Vec<usize> {
            let single = parts.iter().filter(|part| part.len() == 1).map(|part| part.start);
            single.filter(|&module| is_path(sheet.command(module))).collect()
        };
        let (strokes, steps) = (path(self.old, &old), path(self.new, &new));
        let length: f32 = strokes.iter().map(|&one| self.old.length(one)).sum();
        let whole: f32 = steps.iter().map(|&one| self.new.length(one)).sum();
        let is_one_to_one = strokes.len() == steps.len();
        if is_one_to_one {
            strokes.iter().zip(&steps).for_each(|(&old, &new)| self.same(old, new));
        }
        let drawn_out = if whole > 0.0 { length / whole } else { 0.0 };
        let mut rest = &old[..];
        for part in new {
            let module = part.start;
            let command = self.new.command(module);
            if part.len() == 1 && is_path(command) {
                if !is_one_to_one {
                    self.between.factors[module] = drawn_out;
                }
            } else if let Some(number) = rest.iter().position(|one| self.is_alike(one, &part)) {
                let alike = rest[number].clone();
                rest = &rest[number + 1..];
                self.part(alike, part);
            } else {
                let turns = if self.moves || length > 0.0 { 0.0 } else { 1.0 };
                let widths = if length > 0.0 { 1.0 } else { 0.0 };
                self.fresh(part, turns, widths);
            }
        }
    }

    /// Whether a new part may be what an old one has become.
    fn is_alike(&self, old: &Range<usize>, new: &Range<usize>) -> bool {
        let (a, b) = (self.old.string.kinds(), self.new.string.kinds());
        match (old.len() > 1, new.len() > 1) {
            (true, true) => true,
            (false, false) => a[old.start] == b[new.start],
            _ => false,
        }
    }

    fn part(&mut self, old: Range<usize>, new: Range<usize>) {
        if new.len() == 1 {
            self.same(old.start, new.start);
        } else if self.depth == DEEPEST {
            self.fresh(new, 1.0, 0.0);
        } else {
            // Nothing follows in a branch.
            let moves = std::mem::replace(&mut self.moves, false);
            self.depth += 1;
            self.stretch(old.start + 1..old.end - 1, new.start + 1..new.end - 1);
            self.depth -= 1;
            self.moves = moves;
        }
    }

    /// A module that is still there: it begins with its old numbers.
    fn same(&mut self, old: usize, new: usize) {
        let numbers = &self.old.string.parameters()[self.old.firsts[old]..];
        let own = self.new.firsts[new]..self.new.firsts[new + 1];
        let count = own.len().min(self.old.firsts[old + 1] - self.old.firsts[old]);
        self.between.parameters[own.start..own.start + count].copy_from_slice(&numbers[..count]);
    }

    /// A part that was not there: turns, and widths, begin with these factors, everything else from nothing.
    fn fresh(&mut self, part: Range<usize>, turns: f32, widths: f32) {
        let is_branch = part.len() > 1;
        for module in part {
            self.between.factors[module] = match self.new.command(module) {
                Command::Turn(_) | Command::Pitch(_) | Command::Roll(_) if is_branch => 1.0,
                Command::Turn(_) | Command::Pitch(_) | Command::Roll(_) => turns,
                Command::Width(_) if !is_branch => widths,
                _ => 0.0,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use bioscope_core::Vec3;

    use super::*;
    use crate::{Derivation, LSystem, Limits};

    /// Strings that show all that may become of a module.
    const MODELS: [(&str, &str); 6] = [
        ("an apex that forks", "angle: 30\naxiom: F(1)A\nA --> [+F(1)~l(0.5)A]/(137)F(1)A\n"),
        (
            "an edge that breaks",
            "axiom: F(1)+(120)F(1)+(120)F(1)\nF(s) --> F(s/3)-(60)F(s/3)+(120)F(s/3)-(60)F(s/3)\n",
        ),
        ("internodes that stretch", "angle: 40\naxiom: FA\nF --> FF\nA --> F[+A][-A]A\n"),
        (
            "shoots that age",
            "axiom: A\nA --> I(0)[&(40)A]A\nI(a) --> I(a+1)\nhomomorphism\nI(a) : a < 1 --> !(0.1)F(0.3)[+(50)~l(0.2)]F(0.7)\nI(a) --> !(0.1*a+0.1)F(0.6)[+(70)~l(0.3)]F(0.6)\n",
        ),
        (
            "a bud that opens",
            "axiom: F(1)K(0)\nK(a) --> K(a+1)\nhomomorphism\nK(a) --> [&(10+a*20){.+(30)f(0.5).-(60)f(0.5).}]@O(0.1+a*0.1)\n",
        ),
        (
            "a branch that is cut",
            "axiom: F(1)[+(60)B(0)F(1)F(1)]F(1)A\nA --> F(1)A\nB(n) : n > 2 --> %\nB(n) --> B(n+1)\n",
        ),
    ];

    /// The string after `step` steps, what it becomes, and how.
    fn step(text: &str, step: usize) -> (Shown, Shown, Between) {
        let system = LSystem::parse(&format!("lsystem: m\n{text}endlsystem\n"), "m.lsys").unwrap();
        let mut derivation = Derivation::new(&system, 7, Limits::default()).unwrap();
        for _ in 0..step {
            derivation.advance().unwrap();
        }
        let before = derivation.shown_by_module().unwrap();
        let lineage = derivation.advance_traced().unwrap();
        let after = derivation.shown_by_module().unwrap();
        let between = Between::new(&before, &after, &lineage, &TurtleOptions::default());
        (before, after, between)
    }

    /// Everything that is seen: middles of strokes and of organs that are not points.
    fn seen(drawn: &Interpretation) -> Vec<Vec3> {
        let strokes = drawn.segments.iter().filter(|one| one.start.distance(one.end) > 1e-4);
        let leaves = drawn.surfaces.iter().filter(|one| one.scale.length() > 1e-4);
        strokes.map(|one| one.end).chain(leaves.map(|one| one.position)).collect()
    }

    /// How far the farthest of these is from the nearest of those.
    fn gap(these: &[Vec3], those: &[Vec3]) -> f32 {
        let nearest =
            |one: &Vec3| those.iter().map(|other| one.distance(*other)).fold(f32::MAX, f32::min);
        these.iter().map(nearest).fold(0.0, f32::max)
    }

    #[test]
    fn a_step_begins_as_the_old_string_and_ends_as_the_new_one() {
        let options = TurtleOptions::default();
        for (name, text) in MODELS {
            // The last loses its branch in the fourth step, which it may do at once.
            for number in 0..3 {
                let (before, after, between) = step(text, number);
                assert!(!between.is_empty(), "{name}");
                let at = |share| {
                    Turtle::interpret_between(&after.string, &options, &between, share).unwrap()
                };
                let old = Turtle::interpret(&before.string, &options).unwrap();
                let new = Turtle::interpret(&after.string, &options).unwrap();
                assert!(gap(&seen(&at(1.0)), &seen(&new)) < 1e-6, "{name}, {number}");
                assert_eq!(at(1.0).segments, new.segments, "{name}, {number}");
                // Nodes that are new may lie on an old stroke, so only the old ones are looked for.
                assert!(gap(&seen(&old), &seen(&at(0.0))) < 1e-4, "{name}, {number}");
                let length = |drawn: &Interpretation| -> f32 {
                    drawn.segments.iter().map(|one| one.start.distance(one.end)).sum()
                };
                let (first, start) = (length(&old), length(&at(0.0)));
                assert!((first - start).abs() < 1e-3, "{name}, {number}: {first} m, {start} m");
                let (parts, size) = (20, 3.0 * length(&new) / 20.0);
                // At 0 nothing is drawn of what has no length yet.
                for part in 1..parts {
                    let (now, then) = (at(part as f32 / 20.0), at((part + 1) as f32 / 20.0));
                    let ends = now.segments.iter().zip(&then.segments);
                    let step = ends.map(|(a, b)| a.end.distance(b.end)).fold(0.0, f32::max);
                    assert!(step < size, "{name}, {number}: {step} m at {part}");
                }
            }
        }
    }

    #[test]
    fn what_has_gone_takes_its_numbers_with_it() {
        let (before, after, _) = step(MODELS[5].1, 0);
        let mut lineage = Lineage::default();
        let options = TurtleOptions::default();
        assert!(Between::new(&before, &after, &lineage, &options).is_empty());
        lineage.retain(|_| false);
        assert!(Between::new(&before, &after, &lineage, &options).is_empty());
    }
}
