//! Named random streams: a seed and a stream always give the same numbers, independent of the order in which streams are used.
//!
//! The generator is ChaCha with 8 rounds. Its stream number separates the streams of one seed.

use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};

use super::Real;

/// What the random numbers are for. Each new use adds a variant.
#[derive(Clone, Copy, Debug)]
pub enum Stream {
    /// Radii of the grains.
    Radius = 1,
    /// Initial positions of the grains.
    Position = 2,
}

/// The sequence of random numbers of one stream.
pub struct Random(ChaCha8Rng);

impl Random {
    /// The sequence of `stream` under `seed`.
    pub fn new(seed: u64, stream: Stream) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream as u64);
        Self(generator)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> Real {
        // 53 random bits are exactly what a double in [0, 1) can hold.
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit a double exactly")]
        let mantissa = (self.0.next_u64() >> 11) as Real;
        mantissa / 9_007_199_254_740_992.0
    }

    /// Uniform in [min, max).
    pub fn between(&mut self, min: Real, max: Real) -> Real {
        min + (max - min) * self.unit()
    }
}
