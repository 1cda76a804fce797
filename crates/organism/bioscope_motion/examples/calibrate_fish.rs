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
use bioscope_motion::fish::calibration::{Swimming, calibrate, measure_strokes};
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

/// How much like a fish's its swimming is: long strides, Strouhal number about 0.33, little recoil, an S-shaped body.
fn merit(swimming: &Swimming) -> f64 {
    if !swimming.whole || swimming.speed <= 0.0 {
        return -10.0;
    }
    let Swimming { stride, strouhal, recoil, bends, drift, .. } = *swimming;
    stride.min(0.65)
        - 3.0 * ((strouhal - 0.38).max(0.0) + (0.26 - strouhal).max(0.0))
        - 5.0 * (recoil - 0.07).max(0.0)
        - 0.3 * (bends + 0.7).max(0.0)
        - drift.abs()
}

/// The better of a design and a neighbor of it, tried with eight strokes.
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
    change(&mut neighbor.swim.lag, 0.05, 0.2, 0.6);
    let mut strokes = vec![easy; 8];
    for stroke in &mut strokes[1..] {
        stroke.amplitudes.iter_mut().for_each(|value| change(value, 0.1, 0.0, 1.0));
    }
    let present = merit(&measure_strokes(&design, &[easy])?[0]);
    let Ok(found) = measure_strokes(&neighbor, &strokes) else { return Ok((design, easy)) };
    let best = (0..8).max_by(|&a, &b| merit(&found[a]).total_cmp(&merit(&found[b]))).unwrap_or(0);
    if merit(&found[best]) > present {
        eprintln!("round {round}: {}", told(&found[best]));
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
        "]\n\n[fins]\narea = {:?}\nweights = {:?}\npitch = {:?}\nroll = {:?}\narm = {:?}\nyaw = {:?}\noar = {:?}",
        fins.area, fins.weights, fins.pitch, fins.roll, fins.arm, fins.yaw, fins.oar
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
