//! Functions that look at more than their arguments.

use super::{Machine, Register};

/// How many coins are thrown at most for a binomial number.
const MOST_COINS: f64 = 1e7;

/// A function that is called with arguments in consecutive registers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Call {
    Uniform,
    Normal,
    Beta,
    Binomial,
    Seed,
    Function,
    CurveX,
    CurveY,
    CurveZ,
    CurveLength,
    SetLength,
    GetLength,
    /// A face of the view volume: least x, y, z, greatest x, y, z, and its scale.
    View(u8),
    /// Has a meaning only in an interactive program; its value is 0.
    Nothing,
    CloseFile,
    FlushFile,
}

impl Call {
    /// Whether it changes more than the module that it is called for.
    pub fn has_effects(self) -> bool {
        matches!(self, Self::Seed | Self::SetLength | Self::CloseFile | Self::FlushFile)
    }

    /// Whether it draws random numbers.
    pub fn is_random(self) -> bool {
        matches!(self, Self::Uniform | Self::Normal | Self::Beta | Self::Binomial | Self::Seed)
    }
}

impl Machine {
    pub(super) fn call(&mut self, call: Call, first: Register) -> f64 {
        let argument = |number| self.get(first + number);
        let (a, b) = (argument(0), argument(1));
        match call {
            Call::Uniform => self.random.uniform() * a,
            Call::Normal => self.random.normal() * b + a,
            Call::Beta => self.random.beta(a, b),
            Call::Binomial => {
                self.burn(a.clamp(0.0, MOST_COINS) as u64);
                self.random.binomial(a.min(MOST_COINS), b)
            }
            Call::Seed => {
                self.random.seed(a);
                0.0
            }
            Call::Function => {
                self.functions.as_ref().and_then(|found| found.value(a as usize, b)).unwrap_or(0.0)
            }
            Call::CurveX => self.curve(a, b, 0),
            Call::CurveY => self.curve(a, b, 1),
            Call::CurveZ => self.curve(a, b, 2),
            Call::CurveLength => {
                let length = |functions: &std::sync::Arc<dyn crate::Functions>| {
                    functions.curve_length(a as usize)
                };
                self.functions.as_ref().and_then(length).unwrap_or(0.0)
            }
            Call::SetLength => {
                self.length = a.clamp(0.0, 1e9).trunc();
                0.0
            }
            Call::GetLength => self.length,
            Call::View(face) => self.view(face),
            Call::Nothing => 0.0,
            Call::CloseFile => {
                let closed = self.output.close(a);
                self.or_fail(closed, 0.0)
            }
            Call::FlushFile => {
                let flushed = self.output.flush(a);
                self.or_fail(flushed, 0.0)
            }
        }
    }

    fn curve(&self, id: f64, t: f64, axis: usize) -> f64 {
        let point = self.functions.as_ref().and_then(|found| found.curve(id as usize, t));
        point.map_or(0.0, |point| point[axis])
    }

    fn view(&self, face: u8) -> f64 {
        let volume = self.functions.as_ref().and_then(|found| found.view_volume());
        let Some((least, greatest, scale)) = volume else { return 0.0 };
        match face {
            0..=2 => least[face as usize],
            3..=5 => greatest[face as usize - 3],
            _ => scale,
        }
    }

    pub(super) fn print(&mut self, text: u16, first: Register, count: u8, to_file: bool) {
        let numbers: Vec<f64> =
            (0..u16::from(count)).map(|number| self.get(first + number)).collect();
        let pool = self.pool.clone();
        let format = &pool.texts[text as usize];
        let printed = match numbers.split_first() {
            Some((&file, numbers)) if to_file => self.output.print_to(file, format, numbers),
            _ => {
                self.output.print(format, &numbers);
                Ok(0.0)
            }
        };
        self.or_fail(printed, 0.0);
    }

    pub(super) fn scan(&mut self, text: u16, first: Register, count: u8) {
        let pool = self.pool.clone();
        let file = self.get(first);
        let (numbers, ended) = match self.output.scan(file, &pool.texts[text as usize], count) {
            Ok(read) => read,
            Err(message) => {
                self.or_fail(Err(message), 0.0);
                return;
            }
        };
        for (number, value) in numbers.iter().enumerate() {
            self.set(first + 1 + number as u16, *value);
        }
        self.set(first, if ended && numbers.is_empty() { -1.0 } else { numbers.len() as f64 });
    }
}
