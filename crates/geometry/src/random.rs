use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

use crate::vector::{dot, scale};

/// Random numbers that are the same on every machine: integers, exact conversions and square roots only.
pub(crate) struct Random(Xoshiro256PlusPlus);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Uniform in `[-1, 1)`: 53 random bits.
    pub(crate) fn symmetric(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 52) as f64) - 1.0
    }

    /// Uniform on the unit sphere, by rejection from the cube.
    pub(crate) fn direction<const D: usize>(&mut self) -> [f64; D] {
        loop {
            let v: [f64; D] = std::array::from_fn(|_| self.symmetric());
            let square = dot(&v, &v);
            if square <= 1.0 && square > 1e-4 {
                return scale(1.0 / square.sqrt(), &v);
            }
        }
    }
}
