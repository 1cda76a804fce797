//! Times a derivation: `derive FILE [THREADS [FIRST]]`; steps up to FIRST are not timed.
//!
//! Prints modules of the last string, modules of all timed strings, seconds and peak memory in MB.

use std::time::Instant;

use bioscope_lsystem::{Derivation, DerivationOptions, LSystem};

fn main() -> bioscope_core::Result<()> {
    let mut words = std::env::args().skip(1);
    let file = words.next().unwrap_or_default();
    let threads: usize = words.next().and_then(|word| word.parse().ok()).unwrap_or(1);
    let first: u64 = words.next().and_then(|word| word.parse().ok()).unwrap_or(0);
    let system = LSystem::read(file)?;
    let options = DerivationOptions { threads: threads > 1, ..Default::default() };
    let mut derivation = Derivation::with_options(&system, options)?;
    while derivation.step() < first {
        derivation.advance()?;
    }
    let begin = Instant::now();
    let mut modules = 0;
    while derivation.step() < derivation.length() {
        derivation.advance()?;
        modules += derivation.string().len();
    }
    let seconds = begin.elapsed().as_secs_f64();
    println!("{} {modules} {seconds:.4} {:.1}", derivation.string().len(), peak_memory());
    Ok(())
}

/// Most memory that this process had, MB; 0 where the system does not tell.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok());
    kilobytes.unwrap_or(0.0) / 1e3
}
