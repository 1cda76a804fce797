//! Random numbers: the streams of the reference program, or counters of our own.

use bioscope_core::{Purpose, Random};

const CHOICE: Purpose = Purpose::new("lsystem production");
const DRAW: Purpose = Purpose::new("lsystem expression");

/// The 48-bit congruential generator of `drand48` and `erand48` (POSIX).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Congruential(u64);

impl Congruential {
    const MASK: u64 = (1 << 48) - 1;

    /// The state that `srand48` leaves behind, and `srand` of the reference program.
    fn seeded(seed: i64) -> Self {
        Self(((seed as u64 & 0xffff_ffff) << 16) | 0x330e)
    }

    /// Uniform in [0, 1).
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(0x5_deec_e66d).wrapping_add(0xb) & Self::MASK;
        self.0 as f64 / (1_u64 << 48) as f64
    }
}

/// The three generators of the reference program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Streams {
    /// Chooses productions: `drand48`, which the reference program never seeds.
    choice: Congruential,
    /// `ran`, `nran`, `bran`, `biran`.
    numbers: Congruential,
    /// The numbers of a homomorphism with a seed of its own.
    homomorphism: Option<Congruential>,
    /// The other number of the last pair of normal numbers, if it was not given out.
    spare: Option<f64>,
}

impl Streams {
    pub fn new(homomorphism: Option<i64>) -> Self {
        Self {
            choice: Congruential(0),
            numbers: Congruential(0x330e),
            homomorphism: homomorphism.map(Congruential::seeded),
            // The very first normal number of the reference program is the mean.
            spare: Some(0.0),
        }
    }

    /// Lets the numbers come from the stream of the homomorphism, or no longer.
    pub fn swap_homomorphism(&mut self) {
        if let Some(stream) = &mut self.homomorphism {
            std::mem::swap(stream, &mut self.numbers);
        }
    }
}

/// Where random numbers come from.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// The streams of the reference program, drawn from module after module.
    Reference(Streams),
    /// Counters: a pure function of seed, step, module and production.
    Counter {
        seed: u64,
        module: u32,
        tick: u64,
        production: u32,
        stream: Option<Random>,
        /// `srand` of the model.
        offset: u64,
    },
}

/// Random numbers for one machine.
#[derive(Clone, Debug)]
pub(crate) struct Randomness(pub Source);

impl Randomness {
    pub fn counter(seed: u64) -> Self {
        Self(Source::Counter { seed, module: 0, tick: 0, production: 0, stream: None, offset: 0 })
    }

    pub fn reference(homomorphism: Option<i64>) -> Self {
        Self(Source::Reference(Streams::new(homomorphism)))
    }

    pub fn is_reference(&self) -> bool {
        matches!(self.0, Source::Reference(_))
    }

    /// Begins with another module and production; counters then have a stream for it.
    #[inline]
    pub fn begin(&mut self, at_module: usize, at_tick: u64, number: u32) {
        if let Source::Counter { module, tick, production, stream, .. } = &mut self.0 {
            *module = at_module as u32;
            *tick = at_tick;
            *production = number;
            *stream = None;
        }
    }

    /// Uniform in [0, 1), to choose a production for a module.
    pub fn choice(&mut self, module: usize, tick: u64) -> f64 {
        match &mut self.0 {
            Source::Reference(streams) => streams.choice.uniform(),
            Source::Counter { seed, .. } => {
                f64::from(Random::new(*seed, module as u32, tick, CHOICE).uniform())
            }
        }
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        match &mut self.0 {
            Source::Reference(streams) => streams.numbers.uniform(),
            Source::Counter { .. } => f64::from(self.stream().uniform()),
        }
    }

    /// Uniform in [0, 1) if one is needed.
    pub fn uniform_or_zero(&mut self, is_needed: bool) -> f64 {
        if is_needed { self.uniform() } else { 0.0 }
    }

    /// Lets the numbers come from the stream of the homomorphism, or no longer.
    pub fn swap_homomorphism(&mut self) {
        if let Source::Reference(streams) = &mut self.0 {
            streams.swap_homomorphism();
        }
    }

    /// Normal with mean 0 and deviation 1. The reference program uses the polar method.
    pub fn normal(&mut self) -> f64 {
        match &mut self.0 {
            Source::Reference(streams) => polar(streams),
            Source::Counter { .. } => f64::from(self.stream().normal()),
        }
    }

    /// How far `srand` of the model has moved counters of our own.
    pub fn offset(&self) -> u64 {
        match &self.0 {
            Source::Reference(_) => 0,
            Source::Counter { offset, .. } => *offset,
        }
    }

    /// Moves counters of our own so far.
    pub fn set_offset(&mut self, moved: u64) {
        if let Source::Counter { offset, .. } = &mut self.0 {
            *offset = moved;
        }
    }

    /// Begins the numbers anew.
    pub fn seed(&mut self, value: f64) {
        match &mut self.0 {
            Source::Reference(streams) => {
                streams.numbers = Congruential::seeded(value as i64);
                streams.spare = None;
            }
            Source::Counter { offset, stream, .. } => {
                *offset = (value as i64 as u64).wrapping_mul(0xD1B5_4A32_D192_ED03);
                *stream = None;
            }
        }
    }

    fn stream(&mut self) -> &mut Random {
        let Source::Counter { seed, module, tick, production, stream, offset } = &mut self.0 else {
            unreachable!("only counters have a stream per module");
        };
        let own = u64::from(*production).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let key = seed.wrapping_add(own).wrapping_add(*offset);
        stream.get_or_insert_with(|| Random::new(key, *module, *tick, DRAW))
    }

    /// Beta distributed with parameters a and b. R. C. H. Cheng, "Generating beta variates with
    /// nonintegral shape parameters", Communications of the ACM 21 (1978), algorithm BA.
    pub fn beta(&mut self, a: f64, b: f64) -> f64 {
        const ATTEMPTS: usize = 10_000;
        let sum = a + b;
        let least = a.min(b);
        let rate = if least <= 1.0 { least } else { ((2.0 * a * b - sum) / (sum - 2.0)).sqrt() };
        let shift = a + rate;
        for _ in 0..ATTEMPTS {
            let (first, second) = (self.positive(), self.positive());
            let logit = libm::log(first / (1.0 - first)) / rate;
            let odds = a * libm::exp(logit);
            let accepted = sum * libm::log(sum / (b + odds)) + shift * logit - libm::log(4.0);
            // What is no number is accepted, as in the reference program.
            if accepted.is_nan() || accepted >= libm::log(first * first * second) {
                return odds / (b + odds);
            }
        }
        f64::NAN
    }

    fn positive(&mut self) -> f64 {
        for _ in 0..100 {
            let value = self.uniform();
            if value != 0.0 {
                return value;
            }
        }
        0.5
    }

    /// How many of n coins of this probability show heads.
    pub fn binomial(&mut self, count: f64, probability: f64) -> f64 {
        let count = count.max(0.0) as u64;
        (0..count).filter(|_| self.uniform() <= probability).count() as f64
    }
}

/// G. E. P. Box and M. E. Muller 1958, in the polar form of G. Marsaglia.
fn polar(streams: &mut Streams) -> f64 {
    if let Some(spare) = streams.spare.take() {
        return spare;
    }
    loop {
        let first = 2.0 * streams.numbers.uniform() - 1.0;
        let second = 2.0 * streams.numbers.uniform() - 1.0;
        let square = first * first + second * second;
        if square < 1.0 && square != 0.0 {
            let factor = (-2.0 * libm::log(square) / square).sqrt();
            streams.spare = Some(first * factor);
            return second * factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_begin_as_drand48_does() {
        let mut random = Randomness::reference(None);
        let draws: Vec<f64> = (0..6).map(|_| random.choice(0, 0)).collect();
        let expected = [0.0, 0.000_985, 0.041_631, 0.176_643, 0.364_602, 0.091_330_6];
        for (draw, expected) in draws.iter().zip(expected) {
            assert!((draw - expected).abs() < 1e-6, "{draws:?}");
        }
    }

    /// `srand48(1); drand48()` gives 0.0416303447718782 in every C library.
    #[test]
    fn seeds_are_those_of_srand48() {
        let mut random = Randomness::reference(None);
        random.seed(1.0);
        assert!((random.uniform() - 0.041_630_344_771_878_2).abs() < 1e-15);
        assert!((random.uniform() - 0.454_492_444_728_629_2).abs() < 1e-15);
    }

    #[test]
    fn the_first_normal_number_is_the_mean() {
        let mut random = Randomness::reference(None);
        assert_eq!(random.normal(), 0.0);
        assert_ne!(random.normal(), 0.0);
        random.seed(3.0);
        assert_ne!(random.normal(), 0.0);
    }

    #[test]
    fn beta_and_binomial_have_their_means() {
        let mut random = Randomness::reference(None);
        let mean = |draw: &mut dyn FnMut() -> f64| (0..20_000).map(|_| draw()).sum::<f64>() / 2e4;
        // Beta(2, 3): mean 0.4, deviation 0.2; binomial(10, 0.3): mean 3, deviation 1.45.
        assert!((mean(&mut || random.beta(2.0, 3.0)) - 0.4).abs() < 0.006);
        assert!((mean(&mut || random.binomial(10.0, 0.3)) - 3.0).abs() < 0.045);
    }
}
