//! Points that fill a box evenly and always the same.

use crate::aabb::Aabb;

/// The Kronecker sequence of the generalised golden ratio (Roberts 2018, "The unreasonable effectiveness of
/// quasirandom sequences"): `x_n = frac(1/2 + n alpha)` with `alpha_i = phi^-(i+1)`, `phi^(D+1) = phi + 1`.
pub(crate) struct Kronecker<const D: usize> {
    bounds: Aabb<D>,
    alpha: [f64; D],
    state: [f64; D],
}

impl<const D: usize> Kronecker<D> {
    pub(crate) fn new(bounds: &Aabb<D>) -> Self {
        let phi = match D {
            1 => 1.618_033_988_749_895,
            2 => 1.324_717_957_244_746,
            _ => 1.220_744_084_605_76,
        };
        let mut power = 1.0;
        let alpha = std::array::from_fn(|_| {
            power /= phi;
            power
        });
        Self { bounds: *bounds, alpha, state: [0.5; D] }
    }

    /// The sequence from its `n`-th point on.
    pub(crate) fn starting_at(mut self, n: usize) -> Self {
        self.state = self.alpha.map(|a| (0.5 + n as f64 * a).fract());
        self
    }
}

impl<const D: usize> Iterator for Kronecker<D> {
    type Item = [f64; D];

    fn next(&mut self) -> Option<[f64; D]> {
        let lengths = self.bounds.lengths();
        let x = std::array::from_fn(|i| self.bounds.min[i] + self.state[i] * lengths[i]);
        for i in 0..D {
            self.state[i] += self.alpha[i];
            self.state[i] -= self.state[i].floor();
        }
        Some(x)
    }
}
