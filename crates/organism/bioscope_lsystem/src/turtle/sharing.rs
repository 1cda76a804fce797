//! Sub-structures that occur more than once: drawn once, placed many times.

use std::collections::BTreeMap;

use bioscope_core::{Mat3, Quat, Result};
use bioscope_geometry::Transform;
use glam::DVec3;

use super::{Axes, Command, Disc, Frame, Spelling, Turtle, TurtleOptions};
use crate::{Alphabet, ModuleString, interpretation::Interpretation};

/// Branches of fewer modules are not worth sharing.
const SMALLEST: usize = 6;
/// A prime below 2⁶¹ and a base for hashes of stretches of the string.
const PRIME: u64 = (1 << 61) - 1;
const BASE: u64 = 0x1_2345_6789_abcd;

/// A plant whose equal branches are drawn once.
#[derive(Clone, Debug)]
pub struct SharedPlant {
    /// What occurs once.
    pub rest: Interpretation,
    /// Branches that occur more often, each in its own space: its base at the origin, heading +Y.
    pub parts: Vec<SharedPart>,
}

/// A branch and all its places.
#[derive(Clone, Debug)]
pub struct SharedPart {
    /// What it looks like.
    pub drawn: Interpretation,
    /// Where it stands, from its own space to the plant's.
    pub places: Vec<Transform>,
}

/// What makes two branches the same: their modules, and the turtle's state but for its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    hash: u64,
    modules: usize,
    width: u32,
    scale: u32,
    color: i32,
    contour: i32,
    texture: u16,
    sides: u16,
}

/// A string with its brackets matched.
struct Branches<'a> {
    string: &'a ModuleString,
    arities: Vec<usize>,
    /// Number of the first parameter of each module; one more at the end.
    parameters: Vec<usize>,
    /// By opening bracket the module after the closing one; 0 for everything else.
    ends: Vec<usize>,
    hashes: Vec<u64>,
    powers: Vec<u64>,
    /// How many modules before each one depend on more than the branch they are in.
    bound: Vec<u32>,
}

impl Turtle<'_> {
    /// What the string looks like, equal branches drawn once.
    pub fn share(string: &ModuleString, options: &TurtleOptions) -> Result<SharedPlant> {
        if Spelling::of(string.alphabet()).is_some() {
            // Which letters belong together is known only along the string.
            return Ok(SharedPlant {
                rest: Turtle::interpret(string, options)?,
                parts: Vec::new(),
            });
        }
        let branches = Branches::new(string, options);
        let mut counts: BTreeMap<Key, u32> = BTreeMap::new();
        let mut walk = Turtle::walking(string.alphabet(), options);
        for module in 0..string.len() {
            if let Some(key) = branches.key(module, &walk) {
                *counts.entry(key).or_insert(0) += 1;
            }
            walk.read(string.kinds()[module], branches.own(module))?;
        }
        let mut turtle = Turtle::new(string.alphabet(), options);
        let mut numbers: BTreeMap<Key, usize> = BTreeMap::new();
        let mut parts: Vec<SharedPart> = Vec::new();
        let mut module = 0;
        while module < string.len() {
            let key = branches.key(module, &turtle).filter(|key| counts[key] > 1);
            if let Some(key) = key {
                let number = match numbers.get(&key) {
                    Some(&number) => number,
                    None => {
                        let drawn = branches.draw(module, &turtle)?;
                        parts.push(SharedPart { drawn, places: Vec::new() });
                        numbers.insert(key, parts.len() - 1);
                        parts.len() - 1
                    }
                };
                turtle.end_stroke();
                parts[number].places.push(turtle.place());
                module = branches.ends[module];
                continue;
            }
            turtle.read(string.kinds()[module], branches.own(module))?;
            module += 1;
        }
        Ok(SharedPlant { rest: turtle.finish(), parts })
    }

    /// What takes the turtle's start to where it is.
    fn place(&self) -> Transform {
        let Frame { heading, left, up } = self.state.axes.rounded();
        let rotation = Quat::from_mat3(&Mat3::from_cols(-left, heading, up)).normalize();
        Transform::new(self.state.position.as_vec3(), rotation, 1.0)
    }

    /// Whether what is drawn next depends on nothing but the branch and the state in its key.
    fn is_free(&self) -> bool {
        self.polygons.is_empty()
            && self.spline.is_none()
            && self.state.susceptibility == 0.0
            && self.options.movements.is_empty()
            && self.skipped.is_none()
    }
}

impl<'a> Branches<'a> {
    fn new(string: &'a ModuleString, options: &TurtleOptions) -> Self {
        let kinds = string.alphabet().kinds();
        let commands: Vec<Command> =
            kinds.iter().map(|kind| super::command(&kind.symbol, kind.arity, options)).collect();
        let arities: Vec<usize> = kinds.iter().map(|kind| kind.arity as usize).collect();
        let count = string.len();
        let mut branches = Self {
            string,
            arities,
            parameters: Vec::with_capacity(count + 1),
            ends: vec![0; count],
            hashes: Vec::with_capacity(count + 1),
            powers: Vec::with_capacity(count + 1),
            bound: Vec::with_capacity(count + 1),
        };
        let (mut parameter, mut hash, mut power, mut bound) = (0, 1, 1, 0);
        let mut open = Vec::new();
        for (module, &code) in string.kinds().iter().enumerate() {
            branches.parameters.push(parameter);
            branches.hashes.push(hash);
            branches.powers.push(power);
            branches.bound.push(bound);
            let arity = branches.arities[code as usize];
            let mut word = u64::from(code) + 1;
            for value in &string.parameters()[parameter..parameter + arity] {
                word = (times(word, BASE) + u64::from(value.to_bits()) + 1) % PRIME;
            }
            hash = (times(hash, BASE) + word) % PRIME;
            power = times(power, BASE);
            parameter += arity;
            bound += u32::from(depends_on_more(commands[code as usize]));
            match code {
                Alphabet::OPEN => open.push(module),
                Alphabet::CLOSE => {
                    if let Some(start) = open.pop() {
                        branches.ends[start] = module + 1;
                    }
                }
                _ => {}
            }
        }
        branches.parameters.push(parameter);
        branches.hashes.push(hash);
        branches.powers.push(power);
        branches.bound.push(bound);
        branches
    }

    /// The parameters of a module.
    fn own(&self, module: usize) -> &'a [f32] {
        &self.string.parameters()[self.parameters[module]..self.parameters[module + 1]]
    }

    /// The key of the branch that a module begins, if it is one that may be shared.
    fn key(&self, module: usize, turtle: &Turtle) -> Option<Key> {
        let end = self.ends[module];
        let modules = end.saturating_sub(module);
        let free = modules >= SMALLEST && self.bound[end] == self.bound[module];
        if !free || !turtle.is_free() {
            return None;
        }
        let before = times(self.hashes[module], self.powers[modules]);
        let state = &turtle.state;
        Some(Key {
            hash: (self.hashes[end] + PRIME - before) % PRIME,
            modules,
            width: state.width.to_bits(),
            scale: state.scale.to_bits(),
            color: state.color,
            contour: state.contour.number(),
            texture: state.texture,
            sides: state.sides,
        })
    }

    /// Draws the branch that a module begins, in its own space.
    fn draw(&self, module: usize, turtle: &Turtle) -> Result<Interpretation> {
        let mut own = Turtle::new(self.string.alphabet(), turtle.options);
        let start = own.state;
        own.state = turtle.state;
        (own.state.position, own.state.axes) = (DVec3::ZERO, Axes::START);
        (own.state.axis, own.state.anchor, own.state.before) = (None, None, start.before);
        for inner in module + 1..self.ends[module] - 1 {
            own.read(self.string.kinds()[inner], self.own(inner))?;
        }
        Ok(own.finish())
    }
}

/// Whether a command looks at more than the way since the branch began.
fn depends_on_more(command: Command) -> bool {
    matches!(
        command,
        Command::Level
            | Command::Look
            | Command::Go
            | Command::Disc(Disc::Flat { .. })
            | Command::BeginPatch
            | Command::PatchPoint
            | Command::DrawPatch
            | Command::Label
            | Command::TropismDirection
            | Command::Susceptibility
            | Command::SusceptibilityStep
            | Command::Untwist
            | Command::Cut
            | Command::CutIf
            | Command::BeginSubsystem
            | Command::EndSubsystem
    )
}

/// The product of two numbers modulo [`PRIME`].
fn times(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    let sum = (product as u64 & PRIME) + (product >> 61) as u64;
    if sum >= PRIME { sum - PRIME } else { sum }
}

#[cfg(test)]
mod tests {
    use bioscope_core::Vec3;

    use super::*;
    use crate::LSystem;

    fn ends(drawn: &Interpretation) -> impl Iterator<Item = Vec3> {
        drawn.segments.iter().map(|segment| segment.end)
    }

    #[test]
    fn shared_parts_stand_where_they_would_be_drawn() {
        let leaf = "angle: 45\naxiom: F(1,1)\n\
            F(s,t) : t == 1 --> F(s,2)[-F(s,1)][+F(s,1)]F(s,2)F(s,1)\nF(s,t) : t == 2 --> F(2*s,2)";
        let string = LSystem::parse(leaf, "leaf.l").unwrap().derive(7, 0).unwrap();
        let options = TurtleOptions { angle: 45.0, ..TurtleOptions::default() };
        let whole = Turtle::interpret(&string, &options).unwrap();
        let plant = Turtle::share(&string, &options).unwrap();
        let mut placed: Vec<Vec3> = ends(&plant.rest).collect();
        for part in &plant.parts {
            for place in &part.places {
                placed.extend(ends(&part.drawn).map(|end| place.point(end)));
            }
        }
        let mut expected: Vec<Vec3> = ends(&whole).collect();
        assert_eq!(placed.len(), expected.len());
        let order = |a: &Vec3, b: &Vec3| {
            let key = |v: &Vec3| [v.y, v.x, v.z].map(|part| (part * 8.0).round());
            key(a).partial_cmp(&key(b)).unwrap()
        };
        placed.sort_by(order);
        expected.sort_by(order);
        let far = placed.iter().zip(&expected).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        assert!(far < 1e-2, "{far}");
        let drawn: usize = plant.parts.iter().map(|part| part.drawn.segments.len()).sum();
        let stored = drawn + plant.rest.segments.len();
        assert!(whole.segments.len() > 2 * stored, "{stored} of {}", whole.segments.len());
    }

    #[test]
    fn branches_of_other_states_are_not_the_same() {
        let branch = "[F(1)+F(1)-F(1)+F(1)]";
        let word = format!("axiom: {branch}!(3){branch}{branch}[@v F(1)F(1)F(1)F(1)F(1)]\nZ --> Z");
        let string = LSystem::parse(&word, "word.l").unwrap().derive(0, 0).unwrap();
        let plant = Turtle::share(&string, &TurtleOptions::default()).unwrap();
        let places: Vec<usize> = plant.parts.iter().map(|part| part.places.len()).collect();
        assert_eq!(places, [2]);
        assert_eq!(plant.rest.segments.len(), 4 + 5);
    }
}
