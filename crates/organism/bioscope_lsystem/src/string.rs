use std::{fmt, sync::Arc};

use crate::{Alphabet, ModuleKind, machine::Memory};

/// A string of modules: a byte per module that says its kind, and all parameters in one array.
#[derive(Clone, Debug)]
pub struct ModuleString {
    pub(crate) alphabet: Arc<Alphabet>,
    pub(crate) kinds: Vec<u8>,
    pub(crate) parameters: Vec<f32>,
    /// Variables of the model, if what the string looks like may depend on them.
    pub(crate) memory: Option<Arc<Memory>>,
}

impl ModuleString {
    pub(crate) fn new(alphabet: Arc<Alphabet>) -> Self {
        Self { alphabet, kinds: Vec::new(), parameters: Vec::new(), memory: None }
    }

    /// Number of modules.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there are no modules.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// What the codes in [`Self::kinds`] mean.
    pub fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }

    /// Code of the kind of every module.
    pub fn kinds(&self) -> &[u8] {
        &self.kinds
    }

    /// Parameters of all modules, one after the other.
    pub fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    /// Replaces every parameter by what becomes of it.
    pub fn map_parameters(&mut self, become_of: impl Fn(f32) -> f32) {
        for parameter in &mut self.parameters {
            *parameter = become_of(*parameter);
        }
    }

    /// Every module with its parameters.
    pub fn modules(&self) -> impl Iterator<Item = (&ModuleKind, &[f32])> {
        let mut rest = &self.parameters[..];
        self.kinds.iter().map(move |&code| {
            let kind = &self.alphabet.kinds()[code as usize];
            let (parameters, after) = rest.split_at(kind.arity as usize);
            rest = after;
            (kind, parameters)
        })
    }
}

impl fmt::Display for ModuleString {
    /// The canonical text: each symbol, with its parameters as `%.9g` in parentheses.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (kind, parameters) in self.modules() {
            f.write_str(&kind.symbol)?;
            for (index, &parameter) in parameters.iter().enumerate() {
                f.write_str(if index == 0 { "(" } else { "," })?;
                write_number(f, parameter)?;
            }
            if !parameters.is_empty() {
                f.write_str(")")?;
            }
        }
        Ok(())
    }
}

/// Writes a number as C's `%.9g` does.
fn write_number(f: &mut fmt::Formatter<'_>, number: f32) -> fmt::Result {
    // Most parameters are small whole numbers.
    if number.abs() < 1e6
        && number.trunc() == number
        && (number != 0.0 || number.is_sign_positive())
    {
        return write!(f, "{}", number as i32);
    }
    f.write_str(&general(f64::from(number), 9))
}

/// A number as C's `%.{digits}g` writes it.
pub(crate) fn general(number: f64, digits: usize) -> String {
    if number.is_nan() {
        return if number.is_sign_negative() { "-nan" } else { "nan" }.into();
    }
    if number.is_infinite() {
        return if number > 0.0 { "inf" } else { "-inf" }.into();
    }
    let scientific = format!("{:.*e}", digits - 1, number);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let digits = digits as i32;
    if (-4..digits).contains(&exponent) {
        let fixed = format!("{:.*}", (digits - 1 - exponent) as usize, number);
        return without_trailing_zeros(&fixed).to_string();
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{}e{sign}{:02}", without_trailing_zeros(mantissa), exponent.abs())
}

fn without_trailing_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_look_as_in_c() {
        struct Number(f32);
        impl fmt::Display for Number {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write_number(f, self.0)
            }
        }
        // The expected texts are those of printf("%.9g", (double)x) in C.
        for (number, text) in [
            (0.0, "0"),
            (-0.0, "-0"),
            (1.0, "1"),
            (0.1, "0.100000001"),
            (-2.5, "-2.5"),
            (100.0, "100"),
            (8.0 / 7.0, "1.14285719"),
            (16_777_216.0, "16777216"),
            (1e9, "1e+09"),
            (1.5e20, "1.50000003e+20"),
            (1e-4, "9.99999975e-05"),
            (1.25e-4, "0.000125000006"),
            (f32::INFINITY, "inf"),
        ] {
            assert_eq!(Number(number).to_string(), text);
        }
    }
}
