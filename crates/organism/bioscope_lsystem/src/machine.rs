//! Arithmetic: a register machine that runs the conditions, statements and parameters of a model.
//!
//! Numbers are f64 while they are computed and f32 when they are stored as parameters. Angles are
//! degrees. Expressions are compiled once to [`Instruction`]s whose operands are registers:
//!
//! | registers | hold |
//! |---|---|
//! | from 0 | parameters and local variables of a production |
//! | from [`TEMPORARIES`] | intermediate results |
//! | from [`GLOBALS`] | `Q` and `Z`, then the variables of the control blocks |
//! | from [`CONSTANTS`] | constants of the whole model |

mod calls;
mod operations;
mod output;
mod powers;
mod program;
mod random;

use std::sync::Arc;

pub(crate) use calls::Call;
pub(crate) use operations::{Binary, Rules, Unary, binary, unary};
pub(crate) use output::Output;
pub(crate) use program::{Instruction, Program, end_with_emission, with_early_ends};
pub(crate) use random::Randomness;

use powers::Powers;

use crate::Functions;

/// Number of a register.
pub(crate) type Register = u16;

/// How many parameters and local variables one production may bind.
pub(crate) const SLOT_LIMIT: usize = 128;
pub(crate) const TEMPORARIES: usize = SLOT_LIMIT;
pub(crate) const TEMPORARY_LIMIT: usize = 128;
pub(crate) const GLOBALS: usize = TEMPORARIES + TEMPORARY_LIMIT;
pub(crate) const GLOBAL_LIMIT: usize = 256;
/// Register of `Q`, the number of the present step.
pub(crate) const STEP: Register = GLOBALS as Register;
/// Register of `Z`, the derivation length that the file gives.
pub(crate) const LENGTH: Register = STEP + 1;
/// Register of `T`, the seconds of a timed model.
pub(crate) const TIME: Register = LENGTH + 1;
/// How many variables are predefined.
pub(crate) const PREDEFINED: usize = 3;
pub(crate) const CONSTANTS: usize = GLOBALS + GLOBAL_LIMIT;
pub(crate) const CONSTANT_LIMIT: usize = REGISTERS - CONSTANTS;
/// A power of two, so that a register number can be bounded by a mask.
const REGISTERS: usize = 1024;

/// An array of numbers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array {
    pub name: String,
    pub sizes: Vec<usize>,
    pub values: Vec<f64>,
}

/// What the programs of one model share.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pool {
    pub rules: Rules,
    /// Values of the constant registers.
    pub constants: Vec<f64>,
    /// Constants beyond those.
    pub more_constants: Vec<f64>,
    pub arrays: Vec<Array>,
    /// Array and dimension of each [`Instruction::Index`].
    pub dimensions: Vec<(u16, u16)>,
    pub texts: Vec<String>,
}

/// Why a program has no value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Fault {
    #[error("remainder of a division by zero")]
    RemainderByZero,
    #[error("index {index} of array '{array}' is outside 0 to {last}")]
    Index { array: String, index: i64, last: usize },
    #[error("a loop that does not end, or more work than a model may do")]
    Endless,
    #[error("{0}")]
    File(String),
}

/// What programs see and change while they run.
pub(crate) struct Machine {
    registers: Box<[f64; REGISTERS]>,
    pub pool: Arc<Pool>,
    arrays: Vec<Vec<f64>>,
    powers: Powers,
    pub random: Randomness,
    pub output: Output,
    pub functions: Option<Arc<dyn Functions>>,
    /// Derivation length, as `SetDerivationLength` may change it.
    pub length: f64,
    /// The first thing that went wrong since it was last cleared.
    pub fault: Option<Fault>,
    /// How often a number was divided by zero, or an index was out of range.
    pub oddities: Oddities,
    /// Instructions of loops that may still be run.
    pub fuel: u64,
}

/// The variables of a model after a step.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    pub step: u64,
    globals: Vec<f64>,
    arrays: Vec<Vec<f64>>,
    random: Randomness,
}

/// What is tolerated, as in the reference program, but worth a remark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Oddities {
    pub divisions_by_zero: u64,
    pub indices_out_of_range: u64,
    /// Address of the program that divided by zero first.
    divided: Option<usize>,
}

impl Oddities {
    /// Adds what happened afterwards.
    pub fn add(&mut self, later: Self) {
        self.divisions_by_zero += later.divisions_by_zero;
        self.indices_out_of_range += later.indices_out_of_range;
        self.divided = self.divided.or(later.divided);
    }

    /// Whether this is the program that divided by zero first.
    pub fn divided_first(&self, program: &Program) -> bool {
        self.divided == Some(program.0.as_ptr() as usize)
    }
}

impl Machine {
    pub fn new(pool: Arc<Pool>, length: f64, random: Randomness, fuel: u64) -> Self {
        let mut registers = Box::new([0.0; REGISTERS]);
        registers[CONSTANTS..CONSTANTS + pool.constants.len()].copy_from_slice(&pool.constants);
        registers[LENGTH as usize] = length;
        Self {
            registers,
            arrays: pool.arrays.iter().map(|array| array.values.clone()).collect(),
            pool,
            powers: Powers::default(),
            random,
            output: Output::default(),
            functions: None,
            length,
            fault: None,
            oddities: Oddities::default(),
            fuel,
        }
    }

    /// One that works on other modules at the same time; no program must have effects.
    pub fn worker(&self) -> Self {
        Self {
            registers: self.registers.clone(),
            pool: self.pool.clone(),
            arrays: self.arrays.clone(),
            powers: Powers::default(),
            random: self.random.clone(),
            output: Output::default(),
            functions: self.functions.clone(),
            length: self.length,
            fault: None,
            oddities: Oddities::default(),
            fuel: self.fuel,
        }
    }

    /// The variables of the model after a step.
    pub fn memory(&self, step: u64) -> Memory {
        Memory {
            step,
            globals: self.registers[GLOBALS..CONSTANTS].to_vec(),
            arrays: self.arrays.clone(),
            random: self.random.clone(),
        }
    }

    /// Gives the variables of the model the values that they had.
    pub fn recall(&mut self, memory: &Memory) {
        self.registers[GLOBALS..CONSTANTS].copy_from_slice(&memory.globals);
        self.arrays.clone_from(&memory.arrays);
        self.random = memory.random.clone();
    }

    /// The variables of the model, without the zeros at their end.
    pub fn variables(&self) -> Vec<f64> {
        let all = &self.registers[GLOBALS..CONSTANTS];
        let used = all.iter().rposition(|value| value.to_bits() != 0).map_or(0, |last| last + 1);
        all[..used].to_vec()
    }

    /// Sets the variables to what [`Self::variables`] gave; false if these cannot be they.
    pub fn set_variables(&mut self, variables: &[f64], arrays: &[Vec<f64>]) -> bool {
        let own = self.arrays.iter().map(Vec::len);
        let fits = variables.len() <= GLOBAL_LIMIT && arrays.iter().map(Vec::len).eq(own);
        if fits {
            self.registers[GLOBALS..GLOBALS + variables.len()].copy_from_slice(variables);
            self.registers[GLOBALS + variables.len()..CONSTANTS].fill(0.0);
            self.arrays.clone_from_slice(arrays);
        }
        fits
    }

    /// The values of the model's arrays.
    pub fn arrays(&self) -> &[Vec<f64>] {
        &self.arrays
    }

    /// Begins a step.
    pub fn begin_step(&mut self, step: u64) {
        self.registers[STEP as usize] = step as f64;
    }

    /// Sets the seconds of a timed model.
    pub fn set_time(&mut self, seconds: f64) {
        self.registers[TIME as usize] = seconds;
    }

    /// Parameters and local variables.
    #[inline]
    pub fn slots(&mut self) -> &mut [f64] {
        &mut self.registers[..SLOT_LIMIT]
    }

    #[inline]
    fn get(&self, register: Register) -> f64 {
        self.registers[register as usize % REGISTERS]
    }

    #[inline]
    fn set(&mut self, register: Register, value: f64) {
        self.registers[register as usize % REGISTERS] = value;
    }

    /// Runs a program; what it emits is appended to `out`, what it returns is returned, else 0.
    pub fn run(&mut self, program: &Program, out: &mut Vec<f32>) -> f64 {
        let code = &program.0[..];
        let mut next = 0;
        while let Some(&instruction) = code.get(next) {
            next += 1;
            match instruction {
                Instruction::Move { to, from } => self.set(to, self.get(from)),
                Instruction::Add { to, a, b } => self.set(to, self.get(a) + self.get(b)),
                Instruction::Subtract { to, a, b } => self.set(to, self.get(a) - self.get(b)),
                Instruction::Multiply { to, a, b } => self.set(to, self.get(a) * self.get(b)),
                Instruction::Less { to, a, b } => self.set(to, truth(self.get(a) < self.get(b))),
                Instruction::Greater { to, a, b } => self.set(to, truth(self.get(a) > self.get(b))),
                Instruction::Equal { to, a, b } => self.set(to, truth(self.get(a) == self.get(b))),
                Instruction::Emit { from } => out.push(self.get(from) as f32),
                Instruction::EmitSum { a, b } => out.push((self.get(a) + self.get(b)) as f32),
                Instruction::EmitDifference { a, b } => {
                    out.push((self.get(a) - self.get(b)) as f32);
                }
                Instruction::EmitProduct { a, b } => out.push((self.get(a) * self.get(b)) as f32),
                Instruction::EmitProductSum { a, b, c } => {
                    out.push((self.get(a) * self.get(b) + self.get(c)) as f32);
                }
                Instruction::Require { comparison, a, b } => {
                    if !comparison.holds(self.get(a), self.get(b)) {
                        return 0.0;
                    }
                }
                Instruction::Return { from } => return self.get(from),
                Instruction::Jump { distance } => next += distance as usize,
                Instruction::JumpIfFalse { test, distance } => {
                    next += if self.is_true(test) { 0 } else { distance as usize };
                }
                Instruction::JumpIfTrue { test, distance } => {
                    next += if self.is_true(test) { distance as usize } else { 0 };
                }
                Instruction::BackIfTrue { test, distance } => {
                    if self.is_true(test) {
                        self.burn(u64::from(distance));
                        if self.fuel == 0 {
                            return 0.0;
                        }
                        next -= distance as usize;
                    }
                }
                other => self.rare(other, code.as_ptr() as usize),
            }
        }
        0.0
    }

    /// Accounts for work that is not seen from outside; fails if there was too much of it.
    fn burn(&mut self, work: u64) {
        self.fuel = self.fuel.saturating_sub(work);
        if self.fuel == 0 {
            self.fail(Fault::Endless);
        }
    }

    /// What is computed seldom; `program` is the address of the program that is run.
    fn rare(&mut self, instruction: Instruction, program: usize) {
        match instruction {
            Instruction::Constant { to, index } => {
                let value = self.pool.more_constants[index as usize];
                self.set(to, value);
            }
            Instruction::Unary { operation, to, a } => {
                let value = unary(operation, self.get(a), self.pool.rules);
                self.set(to, value);
            }
            Instruction::Binary { operation, to, a, b } => {
                if operation == Binary::Divide && self.get(b) == 0.0 {
                    self.oddities.divisions_by_zero += 1;
                    self.oddities.divided.get_or_insert(program);
                }
                self.binary(operation, to, a, b);
            }
            Instruction::Index { to, from, dimension } => self.index(to, from, dimension),
            Instruction::Load { to, array, at } => {
                let value = self.arrays[array as usize].get(self.get(at) as usize).copied();
                self.set(to, value.unwrap_or(0.0));
            }
            Instruction::Store { array, at, from } => {
                let (place, value) = (self.get(at) as usize, self.get(from));
                if let Some(element) = self.arrays[array as usize].get_mut(place) {
                    *element = value;
                }
            }
            Instruction::Call { call, to, first } => {
                let value = self.call(call, first);
                self.set(to, value);
            }
            Instruction::Print { text, first, count, to_file } => {
                self.print(text, first, count, to_file);
            }
            Instruction::Scan { text, first, count } => self.scan(text, first, count),
            Instruction::Open { to, name, mode } => {
                let texts = &self.pool.texts;
                let opened = self.output.open(&texts[name as usize], &texts[mode as usize]);
                let number = self.or_fail(opened, -1.0);
                self.set(to, number);
            }
            other => unreachable!("{other:?} is run elsewhere"),
        }
    }

    fn binary(&mut self, operation: Binary, to: Register, a: Register, b: Register) {
        let (a, b) = (self.get(a), self.get(b));
        if operation == Binary::Power {
            let power = self.powers.power(a, b);
            return self.set(to, power);
        }
        let value = match binary(operation, a, b, self.pool.rules) {
            Ok(value) => value,
            Err(fault) => {
                self.fail(fault);
                f64::NAN
            }
        };
        self.set(to, value);
    }

    fn index(&mut self, to: Register, from: Register, dimension: u16) {
        let (array, number) = self.pool.dimensions[dimension as usize];
        let size = self.pool.arrays[array as usize].sizes[number as usize];
        // A conversion from float saturates, and takes what is no number for 0.
        let mut index = self.get(from) as i64;
        let last = size as i64 - 1;
        if !(0..=last).contains(&index) {
            self.oddities.indices_out_of_range += 1;
            if self.pool.rules == Rules::Own {
                let array = self.pool.arrays[array as usize].name.clone();
                self.fail(Fault::Index { array, index, last: size - 1 });
            }
            index = index.clamp(0, last);
        }
        let place = self.get(to) * size as f64 + index as f64;
        self.set(to, place);
    }

    /// Whether a register counts as true: not zero; what is no number counts as the rules say.
    #[inline]
    fn is_true(&self, register: Register) -> bool {
        is_true(self.get(register), self.pool.rules)
    }

    #[cold]
    fn fail(&mut self, fault: Fault) {
        self.fault.get_or_insert(fault);
    }

    fn or_fail(&mut self, result: Result<f64, String>, otherwise: f64) -> f64 {
        result.unwrap_or_else(|message| {
            self.fail(Fault::File(message));
            otherwise
        })
    }
}

/// Whether a number counts as true.
#[inline]
pub(crate) fn is_true(value: f64, rules: Rules) -> bool {
    value != 0.0 && (rules == Rules::Reference || !value.is_nan())
}

#[inline]
fn truth(condition: bool) -> f64 {
    f64::from(u8::from(condition))
}
