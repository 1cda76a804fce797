//! Measures how a fish design swims and turns, and writes its tables.
//!
//! `cargo run --release -p bioscope_motion --example calibrate_fish -- FILE.toml [--search ROUNDS]`
//!
//! Reads a design, takes the stroke of its table that is nearest to its cruise as that of easy swimming, and writes the
//! design back with new swim and turn tables. With `--search` it first improves shape, stiffness and stroke by a random
//! search for swimming that keeps the measures of fishes.

use std::fmt::Write as _;
use std::process::ExitCode;

use bioscope_core::{Error, Purpose, Random, Result};
use bioscope_motion::fish::calibration::{Swimming, calibrate, harder, measure_strokes};
use bioscope_motion::fish::{FishDesign, Stroke};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let rounds = match arguments.as_slice() {
        [_] => 0,
        [_, option, rounds] if option == "--search" => rounds.parse().unwrap_or(0),
        _ => {
            eprintln!("usage: calibrate_fish FILE.toml [--search ROUNDS]");
            return ExitCode::from(2);
        }
    };
    match run(&arguments[0], rounds) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(file: &str, rounds: u64) -> Result<()> {
    let trouble = |error: std::io::Error| Error::format(file, error.to_string());
    let text = std::fs::read_to_string(file).map_err(trouble)?;
    let mut design = FishDesign::parse(&text, file)?;
    let mut easy = design.swim.stroke(design.swim.cruise);
    for round in 0..rounds {
        (design, easy) = improved(design, easy, round)?;
    }
    let design = calibrate(design, easy)?;
    for stroke in &design.swim.strokes[1..] {
        let found = measure_strokes(&design, std::slice::from_ref(stroke))?[0];
        eprintln!("{}", told(&found));
    }
    std::fs::write(file, written(&design)).map_err(trouble)
}

/// Efforts at which a design is judged: slow, easy, fast, fastest.
const EFFORTS: [f64; 4] = [0.4, 1.0, 2.0, 3.5];

/// How much like a fish's its swimming is: easily with long strides, Strouhal number about 0.33, little recoil and an
/// S-shaped body; at any effort straight and whole; and with speed in reserve.
fn merit(swimming: &[Swimming]) -> f64 {
    if swimming.iter().any(|one| !one.whole || one.speed <= 0.0) {
        return -10.0;
    }
    let Swimming { stride, strouhal, bends, speed, .. } = swimming[1];
    let easy = stride.min(0.65)
        - 3.0 * ((strouhal - 0.38).max(0.0) + (0.26 - strouhal).max(0.0))
        - 0.3 * (bends + 0.7).max(0.0);
    let faults = |one: &Swimming| one.drift.abs() + 5.0 * (one.recoil - 0.07).max(0.0);
    let hard = |one: &Swimming| {
        0.5 * one.drift.abs() + 2.0 * (one.recoil - 0.1).max(0.0) + (one.strouhal - 0.6).max(0.0)
    };
    let reserve = swimming[3].speed.max(swimming[2].speed) / speed;
    easy + 0.1 * reserve.min(4.0) + 0.5 * (swimming[0].stride / stride).min(0.8)
        - faults(&swimming[0])
        - faults(&swimming[1])
        - hard(&swimming[2])
        - hard(&swimming[3])
}

/// How a design swims at all [`EFFORTS`] with each of these strokes as that of easy swimming.
fn swimmings(design: &FishDesign, easy: &[Stroke]) -> Result<Vec<Vec<Swimming>>> {
    let strokes = easy.iter().flat_map(|easy| EFFORTS.map(|effort| harder(easy, effort)));
    let found = measure_strokes(design, &strokes.collect::<Vec<_>>())?;
    Ok(found.chunks(EFFORTS.len()).map(<[Swimming]>::to_vec).collect())
}

/// The better of a design and a neighbor of it, tried with two strokes.
fn improved(design: FishDesign, easy: Stroke, round: u64) -> Result<(FishDesign, Stroke)> {
    let mut random = Random::new(1, 1, round, Purpose::new("calibrate"));
    let mut neighbor = design.clone();
    let mut change = |value: &mut f64, by: f32, least: f64, most: f64| {
        *value = (*value * (1.0 + f64::from(random.normal() * by))).clamp(least, most);
    };
    let shape = &mut neighbor.shape;
    shape.half_heights.iter_mut().for_each(|value| change(value, 0.05, 0.03, 0.14));
    shape.half_widths.iter_mut().for_each(|value| change(value, 0.05, 0.012, 0.08));
    change(&mut shape.tail_half_height, 0.05, 0.06, 0.18);
    neighbor.tissue.stiffness.iter_mut().for_each(|value| change(value, 0.1, 0.1, 500.0));
    let mut strokes = [easy; 2];
    strokes[1].amplitudes.iter_mut().for_each(|value| change(value, 0.1, 0.0, 1.0));
    let present = merit(&swimmings(&design, &[easy])?[0]);
    let Ok(found) = swimmings(&neighbor, &strokes) else { return Ok((design, easy)) };
    let merits = [merit(&found[0]), merit(&found[1])];
    let best = usize::from(merits[1] > merits[0]);
    if merits[best] > present {
        eprintln!("round {round}: merit {:.3}", merits[best]);
        found[best].iter().for_each(|one| eprintln!("  {}", told(one)));
        return Ok((neighbor, strokes[best]));
    }
    Ok((design, easy))
}

fn told(swimming: &Swimming) -> String {
    let Swimming { speed, stride, strouhal, tail, recoil, drift, bends, cost, .. } = swimming;
    format!(
        "speed {speed:.4}, stride {stride:.3}, Strouhal {strouhal:.3}, tail {tail:.3}, recoil {recoil:.3}, \
         drift {drift:.4}, bends {bends:.2}, cost {cost:.4}"
    )
}

fn written(design: &FishDesign) -> String {
    let name = |value: &dyn std::fmt::Debug| snake(&format!("{value:?}"));
    let FishDesign { about, step, integrator, shape, tissue, medium, swim, turn, fins } = design;
    let mut text = format!(
        "about = {about:?}\nstep = {step:?}\nintegrator = \"{}\"\n\n[shape]\nstations = {:?}\nhalf_heights = {:?}\n\
         half_widths = {:?}\ntail_half_height = {:?}\n\n[tissue]\nmasses = {:?}\nstiffness = {:?}\ndamping = {:?}\n\
         shortening = {:?}\nguard = {:?}\n\n[medium]\nfriction = {:?}\nthickness = {:?}\n",
        name(integrator),
        rounded(&shape.stations),
        rounded(&shape.half_heights),
        rounded(&shape.half_widths),
        round(shape.tail_half_height),
        tissue.masses,
        rounded(&tissue.stiffness),
        tissue.damping,
        tissue.shortening,
        tissue.guard,
        medium.friction,
        medium.thickness,
    );
    for (part, surface) in [("trunk", medium.trunk), ("fin", medium.fin)] {
        let law = name(&surface.law);
        let _ = writeln!(text, "{part} = {{ law = \"{law}\", push = {:?} }}", surface.push);
    }
    let (lag, cruise) = (round(swim.lag), round(swim.cruise));
    let _ = writeln!(text, "\n[swim]\nlag = {lag:?}\ncruise = {cruise:?}\nstrokes = [");
    for Stroke { speed, frequency, amplitudes } in &swim.strokes {
        let (speed, frequency, amplitudes) =
            (round(*speed), round(*frequency), rounded(amplitudes));
        let _ = writeln!(
            text,
            "  {{ speed = {speed:?}, frequency = {frequency:?}, amplitudes = {amplitudes:?} }},"
        );
    }
    let _ = writeln!(
        text,
        "]\n\n[turn]\nrate = {:?}\nrecovery = {:?}\ntail = {:?}\nbends = [",
        turn.rate, turn.recovery, turn.tail
    );
    for bend in &turn.bends {
        let (angle, hold) = (round(bend.angle), round(bend.hold));
        let _ =
            writeln!(text, "  {{ angle = {angle:?}, depth = {:?}, hold = {hold:?} }},", bend.depth);
    }
    let _ = writeln!(
        text,
        "]\n\n[fins]\narea = {:?}\nweights = {:?}\npitch = {:?}\nroll = {:?}\narm = {:?}\nyaw = {:?}\nrighting = {:?}\noar = {:?}",
        fins.area, fins.weights, fins.pitch, fins.roll, fins.arm, fins.yaw, fins.righting, fins.oar
    );
    text
}

/// `CrossFlow` as `cross_flow`.
fn snake(name: &str) -> String {
    let mut text = String::new();
    for (index, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && index > 0 {
            text.push('_');
        }
        text.extend(letter.to_lowercase());
    }
    text
}

/// Four digits behind the leading one: more were not measured.
fn round(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

fn rounded(values: &[f64]) -> Vec<f64> {
    values.iter().map(|&value| round(value)).collect()
}
