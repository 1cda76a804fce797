use super::{Conventions, TurtleOptions};

/// What a symbol tells the turtle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Command {
    Nothing,
    Draw { corner: bool },
    Move { corner: bool },
    Turn(f32),
    Pitch(f32),
    Roll(f32),
    Back,
    Level,
    Look,
    Go,
    Push,
    Pop,
    Width(f32),
    Color(i32),
    Scale,
    ScaleStep(f32),
    BeginSubsystem,
    EndSubsystem,
    BeginPolygon,
    Corner,
    EndPolygon,
    Surface(char),
    Ball,
    Disc(Disc),
    Contour,
    Sides,
    Texture,
    BeginAxis,
    ContinueAxis,
    EndAxis,
    AxisTangents,
    RadiusTangents,
    BeginPatch,
    PatchPoint,
    DrawPatch,
    TropismDirection,
    Susceptibility,
    SusceptibilityStep,
    Elasticity(Change),
    Untwist,
    KeepTwist,
    Label,
    Cut,
    CutIf,
}

/// Which way a disc lies and whether it has a rim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Disc {
    /// In the plane of the picture, x and y.
    Flat { rim: bool },
    /// In the plane of the turtle's heading and left.
    Turned { rim: bool },
}

/// What `@Ti @Td @Ts` do to an elasticity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    More,
    Less,
    Set,
}

pub(super) fn command(symbol: &str, arity: u8, options: &TurtleOptions) -> Command {
    let slash = if options.slash_rolls_right { -1.0 } else { 1.0 };
    match symbol {
        "F" => Command::Draw { corner: true },
        "G" => Command::Draw { corner: false },
        "f" => Command::Move { corner: true },
        "g" => Command::Move { corner: false },
        "+" => Command::Turn(1.0),
        "-" => Command::Turn(-1.0),
        "&" => Command::Pitch(1.0),
        "^" => Command::Pitch(-1.0),
        "/" => Command::Roll(slash),
        "\\" => Command::Roll(-slash),
        "|" => Command::Back,
        "[" => Command::Push,
        "]" => Command::Pop,
        "#" => Command::Width(1.0),
        "!" => Command::Width(-1.0),
        ";" | "'" => Command::Color(1),
        "," => Command::Color(-1),
        "_" => Command::SusceptibilityStep,
        "{" => Command::BeginPolygon,
        "." => Command::Corner,
        "}" => Command::EndPolygon,
        "%" => Command::Cut,
        "?" if arity > 0 => Command::BeginSubsystem,
        "$" => Command::EndSubsystem,
        _ => match symbol.strip_prefix('@') {
            Some(name) => special(name, arity, options.conventions),
            None => match symbol.strip_prefix('~').and_then(|name| name.chars().next()) {
                Some(name) => Command::Surface(name),
                None => Command::Nothing,
            },
        },
    }
}

/// The commands that begin with `@`.
fn special(name: &str, arity: u8, conventions: Conventions) -> Command {
    let notes = conventions == Conventions::Notes;
    match name {
        "v" => Command::Level,
        "R" => Command::Look,
        "M" => Command::Go,
        "D" => Command::Scale,
        "Di" => Command::ScaleStep(1.0),
        "Dd" => Command::ScaleStep(-1.0),
        "O" => Command::Ball,
        "o" => Command::Disc(Disc::Flat { rim: false }),
        "c" => Command::Disc(Disc::Turned { rim: false }),
        "bo" => Command::Disc(Disc::Flat { rim: true }),
        "bc" => Command::Disc(Disc::Turned { rim: true }),
        "#" => Command::Contour,
        "!" => Command::Sides,
        "Tx" => Command::Texture,
        "Gs" => Command::BeginAxis,
        "Gc" => Command::ContinueAxis,
        "Ge" => Command::EndAxis,
        "Gt" => Command::AxisTangents,
        "Gr" => Command::RadiusTangents,
        "PS" => Command::BeginPatch,
        "PC" => Command::PatchPoint,
        "PD" => Command::DrawPatch,
        "Td" if notes && arity == 3 => Command::TropismDirection,
        "Ts" if notes && arity <= 1 => Command::Susceptibility,
        "T" | "Ti" => Command::Elasticity(Change::More),
        "Td" => Command::Elasticity(Change::Less),
        "Ts" => Command::Elasticity(Change::Set),
        "Tp" => Command::Untwist,
        "Tf" => Command::KeepTwist,
        "L" => Command::Label,
        "mc" => Command::CutIf,
        _ => Command::Nothing,
    }
}
