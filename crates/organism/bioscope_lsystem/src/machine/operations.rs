//! What is computed from one number and from two.

use super::{Fault, is_true, truth};

/// In what the cpfg dialect and the notation of our own differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Rules {
    /// As in cpfg: `x/0` is x, `trunc` rounds, what is no number is true.
    #[default]
    Reference,
    /// As in IEEE 754: `x/0` is infinite, `trunc` cuts off, what is no number is false.
    Own,
}

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
    HyperbolicTangent,
    Exponential,
    Logarithm,
    SquareRoot,
    Floor,
    Ceiling,
    Truncate,
    Absolute,
    Sign,
}

pub(crate) fn unary(operation: Unary, x: f64, rules: Rules) -> f64 {
    match operation {
        Unary::Negate => -x,
        Unary::Not => truth(!is_true(x, rules)),
        Unary::Truth => truth(is_true(x, rules)),
        Unary::Tangent => libm::tan(x.to_radians()),
        Unary::Sine => libm::sin(x.to_radians()),
        Unary::Cosine => libm::cos(x.to_radians()),
        Unary::ArcTangent => libm::atan(x).to_degrees(),
        Unary::ArcSine => libm::asin(x).to_degrees(),
        Unary::ArcCosine => libm::acos(x).to_degrees(),
        Unary::HyperbolicTangent => libm::tanh(x),
        Unary::Exponential => libm::exp(x),
        Unary::Logarithm => libm::log(x),
        Unary::SquareRoot => libm::sqrt(x),
        Unary::Floor => libm::floor(x),
        Unary::Ceiling => libm::ceil(x),
        Unary::Truncate if rules == Rules::Reference => libm::floor(x + 0.5),
        Unary::Truncate => libm::trunc(x),
        Unary::Absolute => libm::fabs(x),
        Unary::Sign => truth(x > 0.0) - truth(x < 0.0),
    }
}

pub(crate) fn binary(operation: Binary, a: f64, b: f64, rules: Rules) -> Result<f64, Fault> {
    Ok(match operation {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide if b == 0.0 && rules == Rules::Reference => a,
        Binary::Divide => a / b,
        Binary::Remainder => {
            let remainder = (a as i64).checked_rem(b as i64);
            // i64::MIN % -1 is 0 too, so only a zero divisor is a fault.
            remainder.or((b as i64 != 0).then_some(0)).ok_or(Fault::RemainderByZero)? as f64
        }
        Binary::Power if b == 2.0 => a * a,
        Binary::Power if b == 0.5 && a > 0.0 => libm::sqrt(a),
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
