//! The error of Gaussian kernels from their next order.

use std::f64::consts::TAU;

use super::real::Real;

/// The transform of `G_(m+2) - G_m`, `sigma^2/2 X^(m/2-1) / (m/2)! e^-X` with `X = (k sigma)^2 / 2`, as factors of each
/// direction: it decays in real space like a Gaussian, so that it needs no padding of its own.
#[derive(Debug)]
pub(super) struct Estimate<T> {
    /// `X` of each direction.
    exponents: [Vec<T>; 3],
    /// `e^-X` of each direction.
    factors: [Vec<T>; 3],
    power: i32,
    scale: T,
}

impl<T: Real> Estimate<T> {
    /// For a kernel of an order and smoothing radius, and transforms of these lengths; `all` is their product.
    pub(super) fn new(order: usize, sigma: f64, lengths: [usize; 3], spacing: [f64; 3], all: f64) -> Self {
        let along = |a: usize| {
            let unit = if lengths[a] > 1 { TAU / (lengths[a] as f64 * spacing[a]) } else { 0.0 };
            (0..=lengths[a] / 2).map(move |k| (k as f64 * unit * sigma).powi(2) / 2.0)
        };
        let factorial = (1..=order / 2).map(|j| j as f64).product::<f64>();
        Self {
            exponents: std::array::from_fn(|a| along(a).map(T::rounded).collect()),
            factors: std::array::from_fn(|a| along(a).map(|x| T::rounded((-x).exp())).collect()),
            power: order as i32 / 2 - 1,
            scale: T::rounded(sigma * sigma / 2.0 / factorial / all),
        }
    }

    /// The values for the wave numbers of the third direction, at two wave numbers of the others.
    pub(super) fn line(&self, [i, j]: [usize; 2]) -> impl Iterator<Item = T> {
        let exponent = self.exponents[0][i] + self.exponents[1][j];
        let factor = self.scale * self.factors[0][i] * self.factors[1][j];
        self.exponents[2].iter().zip(&self.factors[2]).map(move |(x, f)| {
            let x = exponent + *x;
            let power = (0..self.power).fold(T::one(), |p, _| p * x);
            factor * *f * power
        })
    }
}
