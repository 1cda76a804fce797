//! Any bytes as an L-system file: read or refused with reports that can be shown.

#![no_main]

use bioscope_lsystem::LSystem;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    for name in ["fuzz.l", "fuzz.lsys"] {
        match LSystem::parse(&text, name) {
            Ok(system) => assert!(!system.alphabet().kinds().is_empty()),
            Err(reports) => assert!(reports.to_string().starts_with("fuzz.l")),
        }
    }
});
