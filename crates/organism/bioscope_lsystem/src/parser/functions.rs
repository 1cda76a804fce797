//! The functions that expressions may call.

use crate::machine::{Binary, Call, Unary};

#[derive(Clone, Copy)]
pub(super) enum Function {
    Unary(Unary),
    Binary(Binary),
    /// With so many arguments.
    Call(Call, u8),
    Print,
    FilePrint,
    FileOpen,
    FileScan,
    /// Takes a text and does nothing.
    Play,
}

pub(super) const FUNCTIONS: [(&str, Function); 49] = [
    ("tan", Function::Unary(Unary::Tangent)),
    ("sin", Function::Unary(Unary::Sine)),
    ("cos", Function::Unary(Unary::Cosine)),
    ("atan", Function::Unary(Unary::ArcTangent)),
    ("asin", Function::Unary(Unary::ArcSine)),
    ("acos", Function::Unary(Unary::ArcCosine)),
    ("tanh", Function::Unary(Unary::HyperbolicTangent)),
    ("exp", Function::Unary(Unary::Exponential)),
    ("log", Function::Unary(Unary::Logarithm)),
    ("sqrt", Function::Unary(Unary::SquareRoot)),
    ("floor", Function::Unary(Unary::Floor)),
    ("ceil", Function::Unary(Unary::Ceiling)),
    ("trunc", Function::Unary(Unary::Truncate)),
    ("fabs", Function::Unary(Unary::Absolute)),
    ("abs", Function::Unary(Unary::Absolute)),
    ("sign", Function::Unary(Unary::Sign)),
    ("min", Function::Binary(Binary::Minimum)),
    ("max", Function::Binary(Binary::Maximum)),
    ("pow", Function::Binary(Binary::Power)),
    ("atan2", Function::Binary(Binary::Angle)),
    ("ran", Function::Call(Call::Uniform, 1)),
    ("nran", Function::Call(Call::Normal, 2)),
    ("bran", Function::Call(Call::Beta, 2)),
    ("biran", Function::Call(Call::Binomial, 2)),
    ("srand", Function::Call(Call::Seed, 1)),
    ("func", Function::Call(Call::Function, 2)),
    ("curveX", Function::Call(Call::CurveX, 2)),
    ("curveY", Function::Call(Call::CurveY, 2)),
    ("curveZ", Function::Call(Call::CurveZ, 2)),
    ("curveGAL", Function::Call(Call::CurveLength, 1)),
    ("SetDerivationLength", Function::Call(Call::SetLength, 1)),
    ("GetDerivationLength", Function::Call(Call::GetLength, 1)),
    ("vvXmin", Function::Call(Call::View(0), 1)),
    ("vvYmin", Function::Call(Call::View(1), 1)),
    ("vvZmin", Function::Call(Call::View(2), 1)),
    ("vvXmax", Function::Call(Call::View(3), 1)),
    ("vvYmax", Function::Call(Call::View(4), 1)),
    ("vvZmax", Function::Call(Call::View(5), 1)),
    ("vvScale", Function::Call(Call::View(6), 1)),
    ("Display", Function::Call(Call::Nothing, 1)),
    ("stop", Function::Call(Call::Nothing, 1)),
    ("inblob", Function::Call(Call::Nothing, 4)),
    ("fclose", Function::Call(Call::CloseFile, 1)),
    ("fflush", Function::Call(Call::FlushFile, 1)),
    ("printf", Function::Print),
    ("fprintf", Function::FilePrint),
    ("fopen", Function::FileOpen),
    ("fscanf", Function::FileScan),
    ("play", Function::Play),
];

pub(super) fn function(name: &str) -> Option<Function> {
    FUNCTIONS.iter().find(|(known, _)| *known == name).map(|&(_, function)| function)
}
