//! Organisms that break up: the words that a string falls into where a module has died.
//!
//! Source: P. Prusinkiewicz, M. Hammel, R. Měch and J. Hanan, "The artificial life of plants",
//! Problems 7.3 and 7.4: L-systems that operate on sets of words.

use bioscope_core::Vec3;

use super::{Derivation, DerivationError, DerivationOptions, Derived, Noted};
use crate::{Alphabet, EnvironmentError, Frame, LSystem, ModuleString, Turtle, TurtleOptions};

/// One of the words that a string falls into, and where it grows on.
#[derive(Clone, Debug)]
pub struct Fragment {
    /// Its modules; [`DerivationOptions::start`] lets it grow on alone.
    pub word: ModuleString,
    /// Where the turtle was at the break, metres.
    pub position: Vec3,
    /// How it looked there.
    pub frame: Frame,
    /// Width of what it drew there, metres.
    pub width: f32,
    /// Index of its color.
    pub color: i32,
}

impl LSystem {
    /// The words that a string falls into at the modules `dead`, which are left out: what stands
    /// above one in its branch becomes a word of its own. Empty words are left out too.
    ///
    /// The turtle obeys a dead module before the word above it begins, so one that is drawn like
    /// `f` leaves a gap. A module that the homomorphism replaces breaks nothing.
    pub fn fragments(
        &self,
        string: &ModuleString,
        dead: &str,
        seed: Option<u64>,
        turtle: &TurtleOptions,
    ) -> Derived<Vec<Fragment>> {
        let is_dead: Vec<bool> = (0..256)
            .map(|code| {
                let kind = self.alphabet.kinds().get(code);
                kind.is_some_and(|kind| &*kind.symbol == dead)
            })
            .collect();
        let options = DerivationOptions { seed, ..Default::default() };
        let mut derivation = Derivation::begin(self, options);
        if let Some(memory) = &string.memory {
            derivation.machine.recall(memory);
            derivation.step = memory.step;
        }
        let (shown, notes) = derivation.shown(string, Noted::Kinds(&is_dead))?;
        let breaks = breaks(&shown, &notes, turtle).map_err(|error| {
            let reason = error.to_string();
            let error = EnvironmentError::Refused { name: "turtle".into(), reason };
            DerivationError::Environment { error, step: derivation.step }
        })?;
        Ok(words(string, &breaks, turtle))
    }
}

/// By number of a dead module: a word without modules that begins where the turtle is after it.
fn breaks(
    shown: &ModuleString,
    notes: &[(usize, usize)],
    options: &TurtleOptions,
) -> bioscope_core::Result<Vec<(usize, Fragment)>> {
    let mut turtle = Turtle::walking(shown.alphabet(), options);
    let mut notes = notes.iter().peekable();
    let mut breaks = Vec::new();
    let mut rest = shown.parameters();
    for (module, &code) in shown.kinds().iter().enumerate() {
        let arity = shown.alphabet().kinds()[code as usize].arity as usize;
        let (parameters, after) = rest.split_at(arity);
        rest = after;
        turtle.read(code, parameters)?;
        if let Some(&(_, old)) = notes.next_if(|(new, _)| *new == module) {
            breaks.push((old, beginning(&turtle, shown)));
        }
    }
    Ok(breaks)
}

/// A word without modules that begins where the turtle is.
fn beginning(turtle: &Turtle, string: &ModuleString) -> Fragment {
    let (position, frame) = turtle.standing();
    let pose = turtle.pose();
    let word = ModuleString::new(string.alphabet.clone());
    Fragment { word, position, frame, width: pose.width, color: pose.color }
}

fn words(
    string: &ModuleString,
    breaks: &[(usize, Fragment)],
    turtle: &TurtleOptions,
) -> Vec<Fragment> {
    let first = beginning(&Turtle::walking(string.alphabet(), turtle), string);
    let mut words = vec![first];
    let mut breaks = breaks.iter().peekable();
    let (mut present, mut outside) = (0, Vec::new());
    let mut parameter = 0;
    for (module, &code) in string.kinds.iter().enumerate() {
        let arity = string.alphabet.kinds()[code as usize].arity as usize;
        let own = &string.parameters[parameter..parameter + arity];
        parameter += arity;
        if let Some((_, above)) = breaks.next_if(|(dead, _)| *dead == module) {
            words.push(above.clone());
            present = words.len() - 1;
            continue;
        }
        if code == Alphabet::OPEN {
            outside.push(present);
        } else if code == Alphabet::CLOSE {
            // What follows the branch belongs to the word that the branch began in.
            present = outside.pop().unwrap_or(present);
        }
        let word = &mut words[present].word;
        word.kinds.push(code);
        word.parameters.extend_from_slice(own);
    }
    words.retain(|fragment| !fragment.word.is_empty());
    words
}
