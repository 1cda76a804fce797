//! Programs: what their instructions are, and which of them are made one.

use super::{Binary, CONSTANTS, Call, GLOBALS, Register, TEMPORARIES, Unary};

/// One step of a program: eight bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Instruction {
    Move {
        to: Register,
        from: Register,
    },
    /// One of the constants that found no register.
    Constant {
        to: Register,
        index: u16,
    },
    Add {
        to: Register,
        a: Register,
        b: Register,
    },
    Subtract {
        to: Register,
        a: Register,
        b: Register,
    },
    Multiply {
        to: Register,
        a: Register,
        b: Register,
    },
    Less {
        to: Register,
        a: Register,
        b: Register,
    },
    Greater {
        to: Register,
        a: Register,
        b: Register,
    },
    Equal {
        to: Register,
        a: Register,
        b: Register,
    },
    Unary {
        operation: Unary,
        to: Register,
        a: Register,
    },
    Binary {
        operation: Binary,
        to: Register,
        a: Register,
        b: Register,
    },
    /// Jumps so many instructions ahead.
    Jump {
        distance: u16,
    },
    JumpIfFalse {
        test: Register,
        distance: u16,
    },
    JumpIfTrue {
        test: Register,
        distance: u16,
    },
    /// Jumps so many instructions back, if true.
    BackIfTrue {
        test: Register,
        distance: u16,
    },
    /// Appends a parameter to the string.
    Emit {
        from: Register,
    },
    /// Appends a sum.
    EmitSum {
        a: Register,
        b: Register,
    },
    /// Appends a difference.
    EmitDifference {
        a: Register,
        b: Register,
    },
    /// Appends a product.
    EmitProduct {
        a: Register,
        b: Register,
    },
    /// Appends a × b + c, both operations rounded.
    EmitProductSum {
        a: Register,
        b: Register,
        c: Register,
    },
    /// Multiplies a place in an array by the length of the next dimension and adds an index.
    Index {
        to: Register,
        from: Register,
        dimension: u16,
    },
    Load {
        to: Register,
        array: u16,
        at: Register,
    },
    Store {
        array: u16,
        at: Register,
        from: Register,
    },
    /// The arguments stand from `first` on.
    Call {
        call: Call,
        to: Register,
        first: Register,
    },
    /// Writes text; the numbers stand from `first` on, before them the file if `to_file`.
    Print {
        text: u16,
        first: Register,
        count: u8,
        to_file: bool,
    },
    /// Reads so many numbers from the file in `first` into the registers after it; their count to `first`.
    Scan {
        text: u16,
        first: Register,
        count: u8,
    },
    /// Opens the file of a name, in a mode; its number.
    Open {
        to: Register,
        name: u16,
        mode: u16,
    },
    /// Ends the program with this value.
    Return {
        from: Register,
    },
    /// Ends the program with 0, unless the comparison holds.
    Require {
        comparison: Comparison,
        a: Register,
        b: Register,
    },
}

/// A comparison of two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Comparison {
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    Unequal,
}

impl Comparison {
    #[inline]
    pub(super) fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::Less => a < b,
            Self::LessEqual => a <= b,
            Self::Greater => a > b,
            Self::GreaterEqual => a >= b,
            Self::Equal => a == b,
            Self::Unequal => a != b,
        }
    }
}

impl Instruction {
    /// The register that it writes; scanning writes temporary ones only.
    fn target(&self) -> Option<Register> {
        match *self {
            Self::Move { to, .. }
            | Self::Constant { to, .. }
            | Self::Add { to, .. }
            | Self::Subtract { to, .. }
            | Self::Multiply { to, .. }
            | Self::Less { to, .. }
            | Self::Greater { to, .. }
            | Self::Equal { to, .. }
            | Self::Unary { to, .. }
            | Self::Binary { to, .. }
            | Self::Index { to, .. }
            | Self::Load { to, .. }
            | Self::Call { to, .. }
            | Self::Open { to, .. } => Some(to),
            _ => None,
        }
    }

    /// The comparison that it makes, with its operands and target.
    fn comparison(&self) -> Option<(Comparison, Register, Register, Register)> {
        let (comparison, to, a, b) = match *self {
            Self::Less { to, a, b } => (Comparison::Less, to, a, b),
            Self::Greater { to, a, b } => (Comparison::Greater, to, a, b),
            Self::Equal { to, a, b } => (Comparison::Equal, to, a, b),
            Self::Binary { operation, to, a, b } => {
                let comparison = match operation {
                    Binary::LessEqual => Comparison::LessEqual,
                    Binary::GreaterEqual => Comparison::GreaterEqual,
                    Binary::Unequal => Comparison::Unequal,
                    _ => return None,
                };
                (comparison, to, a, b)
            }
            _ => return None,
        };
        Some((comparison, to, a, b))
    }

    fn jumps(&self) -> bool {
        matches!(
            self,
            Self::Jump { .. }
                | Self::JumpIfFalse { .. }
                | Self::JumpIfTrue { .. }
                | Self::BackIfTrue { .. }
        )
    }

    /// Whether it leaves 0 or 1 in this register.
    pub fn is_truth_in(&self, register: Register) -> bool {
        let truth = matches!(*self, Self::Unary { operation: Unary::Truth | Unary::Not, to, .. } if to == register);
        truth || self.comparison().is_some_and(|(_, to, ..)| to == register)
    }

    /// Whether it changes more than the module that it is run for, or depends on what does.
    fn has_effects(&self) -> bool {
        match *self {
            Self::Move { to, .. } | Self::Constant { to, .. } => is_global(to),
            Self::Store { .. } | Self::Print { .. } | Self::Scan { .. } | Self::Open { .. } => true,
            Self::Call { call, .. } => call.has_effects(),
            _ => false,
        }
    }
}

fn is_global(register: Register) -> bool {
    (GLOBALS..CONSTANTS).contains(&(register as usize))
}

/// A compiled piece of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Program(pub Box<[Instruction]>);

impl Program {
    /// Whether it changes one of the first so many registers.
    pub fn writes_below(&self, count: usize) -> bool {
        self.0.iter().any(|step| step.target().is_some_and(|to| (to as usize) < count))
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// How many instructions it runs at most, its loops counted once.
    pub fn cost(&self) -> u64 {
        self.0.len() as u64
    }

    /// Whether modules must be treated one after the other because of it.
    pub fn has_effects(&self) -> bool {
        self.0.iter().any(Instruction::has_effects)
    }

    /// Whether it draws random numbers.
    pub fn is_random(&self) -> bool {
        self.0.iter().any(|step| matches!(step, Instruction::Call { call, .. } if call.is_random()))
    }
}

/// Ends the computation of a parameter, which begins at `first`, by appending what is in `from`;
/// the operations that lead there and nowhere else are made one with that.
pub(crate) fn end_with_emission(code: &mut Vec<Instruction>, first: usize, from: Register) {
    let own = &code[first..];
    let is_temporary = |register: Register| (TEMPORARIES..GLOBALS).contains(&(register as usize));
    // A jump might lead between them.
    let may_fuse = is_temporary(from) && !own.iter().any(Instruction::jumps);
    let (count, emission) = match (may_fuse, own) {
        (
            true,
            [.., Instruction::Multiply { to: product, a, b }, Instruction::Add { to, a: x, b: y }],
        ) if *to == from && is_temporary(*product) && (x == product) != (y == product) => {
            let c = if x == product { *y } else { *x };
            (2, Instruction::EmitProductSum { a: *a, b: *b, c })
        }
        (true, [.., Instruction::Add { to, a, b }]) if *to == from => {
            (1, Instruction::EmitSum { a: *a, b: *b })
        }
        (true, [.., Instruction::Subtract { to, a, b }]) if *to == from => {
            (1, Instruction::EmitDifference { a: *a, b: *b })
        }
        (true, [.., Instruction::Multiply { to, a, b }]) if *to == from => {
            (1, Instruction::EmitProduct { a: *a, b: *b })
        }
        _ => (0, Instruction::Emit { from }),
    };
    code.truncate(code.len() - count);
    code.push(emission);
}

/// A condition whose comparisons end it as soon as one fails. `one` is a register that holds 1.
pub(crate) fn with_early_ends(code: Vec<Instruction>, one: Register) -> Vec<Instruction> {
    let Some(&Instruction::Return { from }) = code.last() else { return code };
    let last = code.len() - 1;
    let mut fused = Vec::with_capacity(code.len());
    let mut next = 0;
    while next < last {
        let compared = code[next].comparison();
        match (compared, code[next + 1], code.get(next + 2)) {
            // A failed comparison jumps to the end, which returns it.
            (Some((comparison, to, a, b)), Instruction::JumpIfFalse { test, distance }, _)
                if to == test && to == from && next + 2 + distance as usize == last =>
            {
                fused.push(Instruction::Require { comparison, a, b });
                next += 2;
            }
            (
                Some((comparison, to, a, b)),
                Instruction::Unary { operation: Unary::Truth, to: result, a: same },
                Some(Instruction::Return { .. }),
            ) if to == same && result == from && next + 2 == last => {
                fused.push(Instruction::Require { comparison, a, b });
                fused.push(Instruction::Return { from: one });
                return fused;
            }
            (Some((comparison, to, a, b)), Instruction::Return { .. }, _)
                if to == from && next + 1 == last =>
            {
                fused.push(Instruction::Require { comparison, a, b });
                fused.push(Instruction::Return { from: one });
                return fused;
            }
            // Other jumps would lead to the wrong place.
            (_, _, _) if code[next].jumps() => return code,
            _ => {
                fused.push(code[next]);
                next += 1;
            }
        }
    }
    // The last value is none of a comparison.
    code
}
