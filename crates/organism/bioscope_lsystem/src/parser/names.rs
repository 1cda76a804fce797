//! What names stand for: variables of a production or of a model, arrays, constants.

use crate::machine::{
    Array, CONSTANT_LIMIT, CONSTANTS, GLOBAL_LIMIT, GLOBALS, Instruction, LENGTH, PREDEFINED, Pool,
    Register, STEP, TIME,
};

/// Names of parameters and local variables, in the order of their slots.
pub(super) type Scope = Vec<String>;

/// Names of a model, with what its programs share.
#[derive(Default)]
pub(super) struct Names {
    pub pool: Pool,
    /// Variables of the control blocks of all L-systems of the file, with the number of theirs.
    globals: Vec<(usize, String)>,
    /// Number of the L-system whose text is being read.
    pub system: usize,
    /// Whether `T` is the time.
    pub is_timed: bool,
}

impl Names {
    /// Register of a variable of the model.
    pub fn global(&self, name: &str) -> Option<Register> {
        match name {
            "Q" => return Some(STEP),
            "Z" => return Some(LENGTH),
            "T" if self.is_timed => return Some(TIME),
            _ => {}
        }
        let is_it = |(system, known): &(usize, String)| *system == self.system && known == name;
        self.globals.iter().position(is_it).map(|index| (GLOBALS + PREDEFINED + index) as Register)
    }

    /// Register of a new variable of the model; none if there are too many.
    pub fn declare_global(&mut self, name: &str) -> Option<Register> {
        if self.globals.len() + PREDEFINED >= GLOBAL_LIMIT {
            return None;
        }
        self.globals.push((self.system, name.to_string()));
        self.global(name)
    }

    /// Names of the variables and arrays that can be used now.
    pub fn known(&self) -> impl Iterator<Item = &str> {
        let own = self.globals.iter().filter(|(system, _)| *system == self.system);
        own.map(|(_, name)| name.as_str()).chain(self.pool.arrays.iter().map(|array| &*array.name))
    }

    /// Number of the array of this name; the latest of several.
    pub fn array(&self, name: &str) -> Option<u16> {
        self.pool.arrays.iter().rposition(|array| array.name == name).map(|index| index as u16)
    }

    pub fn add_array(&mut self, array: Array) {
        self.pool.arrays.push(array);
    }

    /// The number of one dimension of an array, for an instruction.
    pub fn dimension(&mut self, array: u16, number: u16) -> u16 {
        let dimensions = &mut self.pool.dimensions;
        let known = dimensions.iter().position(|&known| known == (array, number));
        known.unwrap_or_else(|| {
            dimensions.push((array, number));
            dimensions.len() - 1
        }) as u16
    }

    /// The number of a text, for an instruction.
    pub fn text(&mut self, text: String) -> u16 {
        let texts = &mut self.pool.texts;
        let known = texts.iter().position(|known| *known == text);
        known.unwrap_or_else(|| {
            texts.push(text);
            texts.len() - 1
        }) as u16
    }

    /// Where a constant stands: in a register, or it must be fetched by the instruction.
    pub fn constant(&mut self, value: f64, to: Register) -> Result<Register, Instruction> {
        let same = |known: &f64| known.to_bits() == value.to_bits();
        let constants = &mut self.pool.constants;
        if let Some(index) = constants.iter().position(same) {
            return Ok((CONSTANTS + index) as Register);
        }
        if constants.len() < CONSTANT_LIMIT {
            constants.push(value);
            return Ok((CONSTANTS + constants.len() - 1) as Register);
        }
        let more = &mut self.pool.more_constants;
        let index = more.iter().position(same).unwrap_or_else(|| {
            more.push(value);
            more.len() - 1
        });
        Err(Instruction::Constant { to, index: index.min(u16::MAX as usize) as u16 })
    }
}
