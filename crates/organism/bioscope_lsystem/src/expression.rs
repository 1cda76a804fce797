//! Arithmetic of parameters: compiled to a short program for a stack machine.
//!
//! Numbers are f64 while an expression is evaluated and f32 when they are stored as parameters.
//! Angles are degrees. As in the reference program, `x/0` is x and `%` works on whole numbers.

use bioscope_core::{Purpose, Random};

/// How many numbers the stack of the machine holds.
pub(crate) const STACK_LIMIT: usize = 64;
/// How many parameters and local variables one production may bind.
pub(crate) const SLOT_LIMIT: usize = 128;

const DRAW: Purpose = Purpose::new("lsystem expression");

/// What can be computed from two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    Unequal,
    Minimum,
    Maximum,
    Angle,
}

/// What can be computed from one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unary {
    Negate,
    Not,
    Truth,
    Tangent,
    Sine,
    Cosine,
    ArcTangent,
    ArcSine,
    ArcCosine,
    Exponential,
    Logarithm,
    SquareRoot,
    Floor,
    Ceiling,
    Truncate,
    Absolute,
    Sign,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Instruction {
    Constant(f64),
    /// Pushes a parameter or local variable.
    Load(u8),
    /// Pops into a local variable.
    Store(u8),
    /// Pushes the number of the current derivation step, from 1.
    Step,
    /// Pushes the derivation length of the file.
    Length,
    Unary(Unary),
    Binary(Binary),
    /// Uniform in [0, x).
    Uniform,
    /// Normal with mean and standard deviation.
    Normal,
    /// Jumps by so many instructions.
    Jump(u32),
    /// Pops; jumps if that was false.
    JumpIfFalse(u32),
    /// If the top is false, makes it 0 and jumps; else pops it.
    And(u32),
    /// If the top is true, makes it 1 and jumps; else pops it.
    Or(u32),
}

/// A compiled expression; the frequent trivial ones need no program.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expression {
    Constant(f64),
    Slot(u8),
    Program(Box<[Instruction]>),
}

/// Why an expression has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Fault {
    #[error("remainder of a division by zero")]
    RemainderByZero,
}

/// What an expression sees while it is evaluated.
pub(crate) struct Bindings {
    pub slots: [f64; SLOT_LIMIT],
    /// Kept here so that it need not be cleared for each expression.
    stack: [f64; STACK_LIMIT],
    pub step: f64,
    pub length: f64,
    /// The first thing that went wrong since it was last cleared.
    pub fault: Option<Fault>,
    seed: u64,
    module: u32,
    tick: u64,
    production: u32,
    random: Option<Random>,
}

impl Bindings {
    pub fn new(seed: u64, length: f64) -> Self {
        Self {
            slots: [0.0; SLOT_LIMIT],
            stack: [0.0; STACK_LIMIT],
            step: 0.0,
            length,
            fault: None,
            seed,
            module: 0,
            tick: 0,
            production: 0,
            random: None,
        }
    }

    /// Begins with another module and production: random numbers come from their own stream.
    #[inline]
    pub fn begin(&mut self, module: usize, tick: u64, production: u32) {
        self.module = module as u32;
        self.tick = tick;
        self.production = production;
        self.random = None;
    }

    #[inline]
    fn push(&mut self, top: &mut usize, value: f64) {
        self.stack[*top % STACK_LIMIT] = value;
        *top += 1;
    }

    fn random(&mut self) -> &mut Random {
        let (module, tick) = (self.module, self.tick);
        let seed =
            self.seed.wrapping_add(u64::from(self.production).wrapping_mul(0x9E37_79B9_7F4A_7C15));
        self.random.get_or_insert_with(|| Random::new(seed, module, tick, DRAW))
    }
}

impl Expression {
    /// How many instructions it runs at most.
    pub fn cost(&self) -> u64 {
        match self {
            Self::Constant(_) | Self::Slot(_) => 1,
            Self::Program(program) => program.len() as u64,
        }
    }

    pub fn from_program(program: Vec<Instruction>) -> Self {
        match program[..] {
            [Instruction::Constant(value)] => Self::Constant(value),
            [Instruction::Load(slot)] => Self::Slot(slot),
            _ => Self::Program(program.into()),
        }
    }

    #[inline]
    pub fn evaluate(&self, bindings: &mut Bindings) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Slot(slot) => bindings.slots[*slot as usize],
            Self::Program(program) => run(program, bindings),
        }
    }
}

/// Runs a program; the value on top of the stack at its end, 0 if there is none.
pub(crate) fn run(program: &[Instruction], bindings: &mut Bindings) -> f64 {
    let mut top = 0;
    let mut next = 0;
    while let Some(&instruction) = program.get(next) {
        next += 1;
        match instruction {
            Instruction::Constant(value) => bindings.push(&mut top, value),
            Instruction::Load(slot) => {
                bindings.push(&mut top, bindings.slots[slot as usize % SLOT_LIMIT]);
            }
            Instruction::Store(slot) => {
                top -= 1;
                bindings.slots[slot as usize % SLOT_LIMIT] = bindings.stack[top];
            }
            Instruction::Step => bindings.push(&mut top, bindings.step),
            Instruction::Length => bindings.push(&mut top, bindings.length),
            Instruction::Unary(operation) => {
                bindings.stack[top - 1] = unary(operation, bindings.stack[top - 1]);
            }
            Instruction::Binary(operation) => {
                top -= 1;
                let (a, b) = (bindings.stack[top - 1], bindings.stack[top]);
                bindings.stack[top - 1] = binary(operation, a, b).unwrap_or_else(|fault| {
                    bindings.fault.get_or_insert(fault);
                    f64::NAN
                });
            }
            Instruction::Uniform => {
                bindings.stack[top - 1] *= f64::from(bindings.random().uniform());
            }
            Instruction::Normal => {
                top -= 1;
                let deviation = bindings.stack[top] * f64::from(bindings.random().normal());
                bindings.stack[top - 1] += deviation;
            }
            Instruction::Jump(distance) => next += distance as usize,
            Instruction::JumpIfFalse(distance) => {
                top -= 1;
                next += if is_true(bindings.stack[top]) { 0 } else { distance as usize };
            }
            Instruction::And(distance) | Instruction::Or(distance) => {
                let decided = matches!(instruction, Instruction::Or(_));
                if is_true(bindings.stack[top - 1]) == decided {
                    bindings.stack[top - 1] = truth(decided);
                    next += distance as usize;
                } else {
                    top -= 1;
                }
            }
        }
    }
    if top > 0 { bindings.stack[top - 1] } else { 0.0 }
}

/// Whether a number counts as true: neither zero nor not-a-number.
#[inline]
pub(crate) fn is_true(value: f64) -> bool {
    value != 0.0 && !value.is_nan()
}

pub(crate) fn unary(operation: Unary, x: f64) -> f64 {
    match operation {
        Unary::Negate => -x,
        Unary::Not => truth(!is_true(x)),
        Unary::Truth => truth(is_true(x)),
        Unary::Tangent => libm::tan(x.to_radians()),
        Unary::Sine => libm::sin(x.to_radians()),
        Unary::Cosine => libm::cos(x.to_radians()),
        Unary::ArcTangent => libm::atan(x).to_degrees(),
        Unary::ArcSine => libm::asin(x).to_degrees(),
        Unary::ArcCosine => libm::acos(x).to_degrees(),
        Unary::Exponential => libm::exp(x),
        Unary::Logarithm => libm::log(x),
        Unary::SquareRoot => libm::sqrt(x),
        Unary::Floor => libm::floor(x),
        Unary::Ceiling => libm::ceil(x),
        Unary::Truncate => libm::trunc(x),
        Unary::Absolute => libm::fabs(x),
        Unary::Sign => truth(x > 0.0) - truth(x < 0.0),
    }
}

pub(crate) fn binary(operation: Binary, a: f64, b: f64) -> Result<f64, Fault> {
    Ok(match operation {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide if b == 0.0 => a,
        Binary::Divide => a / b,
        Binary::Remainder => {
            let remainder = (a as i64).checked_rem(b as i64);
            // i64::MIN % -1 is 0 too, so only a zero divisor is a fault.
            remainder.or((b as i64 != 0).then_some(0)).ok_or(Fault::RemainderByZero)? as f64
        }
        Binary::Power => libm::pow(a, b),
        Binary::Less => truth(a < b),
        Binary::LessEqual => truth(a <= b),
        Binary::Greater => truth(a > b),
        Binary::GreaterEqual => truth(a >= b),
        Binary::Equal => truth(a == b),
        Binary::Unequal => truth(a != b),
        Binary::Minimum => a.min(b),
        Binary::Maximum => a.max(b),
        Binary::Angle => libm::atan2(a, b).to_degrees(),
    })
}

fn truth(condition: bool) -> f64 {
    f64::from(u8::from(condition))
}
