use bioscope_core::math;

/// Level above which peaks are bent.
const KNEE: f32 = 0.5;
/// Level that peaks never reach: 1.5 dB below full scale, which leaves half a decibel to what
/// lossy encoding adds.
const CEILING: f32 = 0.84;
/// Seconds in which the gain recovers after a peak.
const RELEASE: f32 = 0.12;
/// Corner frequency in hertz below which the bus carries nothing.
const LOWEST: f32 = 12.0;

/// The last stage of the mix: takes out the constant part and keeps peaks below -1 dBFS.
///
/// The gain follows the envelope of the louder side: it falls at once with a rising peak, so that
/// nothing passes, and recovers slowly, so that waveforms keep their shape.
#[derive(Clone, Debug)]
pub struct Limiter {
    envelope: f32,
    input: [f32; 2],
    output: [f32; 2],
    retention: f32,
    release: f32,
}

impl Limiter {
    pub fn new(sample_rate: f32) -> Self {
        Self {
            envelope: 0.0,
            input: [0.0; 2],
            output: [0.0; 2],
            retention: math::exp(-math::TAU * LOWEST / sample_rate),
            release: math::exp(-1.0 / (RELEASE * sample_rate)),
        }
    }

    pub fn process(&mut self, frames: &mut [[f32; 2]]) {
        for frame in frames {
            for (side, sample) in frame.iter_mut().enumerate() {
                let output = *sample - self.input[side] + self.retention * self.output[side];
                self.input[side] = *sample;
                self.output[side] = without_denormals(output);
                *sample = self.output[side];
            }
            let peak = frame[0].abs().max(frame[1].abs());
            self.envelope = peak.max(self.envelope * self.release);
            if self.envelope > KNEE {
                let gain = bent(self.envelope) / self.envelope;
                *frame = frame.map(|sample| sample * gain);
            } else {
                self.envelope = without_denormals(self.envelope);
            }
        }
    }
}

/// Output level for an input level above the knee: same slope there, never above the ceiling.
fn bent(level: f32) -> f32 {
    let room = CEILING - KNEE;
    KNEE + room * (1.0 - math::exp(-(level - KNEE) / room))
}

/// Zero for numbers too small to hear but slow to compute with.
pub fn without_denormals(sample: f32) -> f32 {
    if sample.abs() < 1e-15 { 0.0 } else { sample }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quiet_signals_pass_and_loud_ones_stay_below_the_ceiling() {
        let rate = 48_000.0;
        let tone = |level: f32| -> Vec<[f32; 2]> {
            (0..9_600).map(|n| [level * math::sin(0.13 * n as f32), 0.0]).collect()
        };
        let peak = |frames: &[[f32; 2]]| frames.iter().fold(0.0, |top: f32, f| top.max(f[0].abs()));
        let mut quiet = tone(0.4);
        Limiter::new(rate).process(&mut quiet);
        assert!((peak(&quiet) - 0.4).abs() < 0.005, "{}", peak(&quiet));
        for level in [0.6, 1.0, 30.0, 1e6] {
            let mut loud = tone(level);
            Limiter::new(rate).process(&mut loud);
            assert!((KNEE..0.85).contains(&peak(&loud)), "{level}: {}", peak(&loud));
        }
    }

    #[test]
    fn a_constant_input_dies_away() {
        let mut frames = vec![[0.3, -0.3]; 48_000];
        Limiter::new(48_000.0).process(&mut frames);
        assert!(frames[47_999][0].abs() < 1e-6 && frames[0][0] > 0.29);
    }
}
