use bioscope_core::{Error, Result, SoundEvent};

/// Loudest amplitude at one metre that is taken seriously.
const LOUDEST: f32 = 100.0;
/// Farthest coordinate in metres.
const FARTHEST: f32 = 1e9;

/// Refuses an event that cannot sound: numbers that are not finite, a negative duration or pitch,
/// an amplitude outside 0 to 100. Sources faster than sound are not refused but heard as if just
/// below it.
pub fn check(event: &SoundEvent) -> Result<()> {
    let name = |field: &str| format!("{} of sound '{}'", field, event.kind);
    if !event.time.is_finite() {
        return Err(Error::value(name("time"), event.time, "a finite number of seconds"));
    }
    for (field, vector) in [("position", event.position), ("velocity", event.velocity)] {
        if !(vector.abs().max_element() <= FARTHEST && vector.is_finite()) {
            return Err(Error::value(name(field), vector, "finite coordinates up to 1e9"));
        }
    }
    let bounded = [
        ("duration", event.duration, 1e6),
        ("amplitude", event.amplitude, LOUDEST),
        ("pitch", event.pitch, 1e6),
    ];
    for (field, value, high) in bounded {
        if !(0.0..=high).contains(&value) {
            return Err(Error::value(name(field), value, format!("0 to {high}")));
        }
    }
    Ok(())
}
