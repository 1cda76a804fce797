use bioscope_core::math::{self, PI, TAU};

/// Share of the way that a one-pole low-pass of this corner frequency goes in one sample.
pub fn openness(cutoff: f32, rate: f32) -> f32 {
    1.0 - math::exp(-TAU * cutoff / rate)
}

/// A one-pole low-pass: 6 dB per octave above its corner frequency.
#[derive(Clone, Debug)]
pub struct LowPass {
    openness: f32,
    state: f32,
}

impl LowPass {
    pub fn new(cutoff: f32, rate: f32) -> Self {
        Self { openness: openness(cutoff, rate), state: 0.0 }
    }

    pub fn next(&mut self, input: f32) -> f32 {
        self.state += self.openness * (input - self.state);
        self.state
    }
}

/// A two-pole band-pass whose middle may move while it runs; its gain in the middle is 1.
///
/// The trapezoidal state-variable form (A. Simper, "Linear trapezoidal integrated state variable
/// filter", 2013), which stays stable when its coefficients change.
#[derive(Clone, Debug)]
pub struct BandPass {
    rate: f32,
    damping: f32,
    coefficients: [f32; 3],
    states: [f32; 2],
}

impl BandPass {
    /// Around `center` hertz, `quality` times narrower than its middle.
    pub fn new(center: f32, quality: f32, rate: f32) -> Self {
        let mut filter =
            Self { rate, damping: 1.0 / quality, coefficients: [0.0; 3], states: [0.0; 2] };
        filter.move_to(center);
        filter
    }

    /// Moves the middle of the band.
    pub fn move_to(&mut self, center: f32) {
        let warped = math::tan(PI * (center / self.rate).clamp(1e-4, 0.45));
        let first = 1.0 / (1.0 + warped * (warped + self.damping));
        self.coefficients = [first, warped * first, warped * warped * first];
    }

    pub fn next(&mut self, input: f32) -> f32 {
        let [a1, a2, a3] = self.coefficients;
        let [band, low] = self.states;
        let high = input - low;
        let new_band = a1 * band + a2 * high;
        let new_low = low + a2 * band + a3 * high;
        self.states = [2.0 * new_band - band, 2.0 * new_low - low];
        new_band * self.damping
    }
}
