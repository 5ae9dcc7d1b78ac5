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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_unit_vectors_without_a_preference() {
        let mut random = Random::new(1);
        let n = 20_000;
        let mut sum = [0.0; 3];
        let mut squares = [0.0; 3];
        for _ in 0..n {
            let d: [f64; 3] = random.direction();
            assert!((dot(&d, &d) - 1.0).abs() < 1e-14);
            for i in 0..3 {
                sum[i] += d[i] / f64::from(n);
                squares[i] += d[i] * d[i] / f64::from(n);
            }
        }
        // Five standard deviations of the means: 1/sqrt(3n) and sqrt(4/45n).
        assert!(sum.iter().all(|s| s.abs() < 0.021), "{sum:?}");
        assert!(squares.iter().all(|s| (s - 1.0 / 3.0).abs() < 0.011), "{squares:?}");
    }

    #[test]
    fn numbers_stay_in_range() {
        let mut random = Random::new(2);
        assert!((0..10_000).all(|_| (-1.0..1.0).contains(&random.symmetric())));
    }
}
