//! Chebyshev smoothing.

use crate::csr::for_each_row;
use crate::difference::DifferenceMatrix;
use crate::vector::{axpy, mixed_bit, norm};

/// Degree of the polynomial.
const DEGREE: usize = 2;

/// Steps of the power method that estimates the largest eigenvalue.
const POWER_STEPS: usize = 12;

/// By how much the estimate, which comes from below, is raised.
const SAFETY: f64 = 1.1;

/// Part of the largest eigenvalue from which on the polynomial damps: what lies below is for the coarse level.
const LOWEST: f64 = 0.25;

/// A Chebyshev polynomial of `D^-1 A`.
#[derive(Debug)]
pub(crate) struct Chebyshev {
    inverse: Vec<f64>,
    largest: f64,
}

impl Chebyshev {
    pub(crate) fn new(a: &DifferenceMatrix, inverse: Vec<f64>) -> Self {
        let n = a.n();
        let mut x: Vec<f64> = (0..n as u64).map(|i| if mixed_bit(i) { 1.0 } else { -1.0 }).collect();
        let mut y = vec![0.0; n];
        let mut largest = 1.0;
        for _step in 0..POWER_STEPS {
            let before = norm(&x);
            a.mul_vec(&x, &mut y);
            y.iter_mut().zip(&inverse).for_each(|(y, d)| *y *= d);
            let after = norm(&y);
            if !(after > 0.0 && after.is_finite()) {
                break;
            }
            largest = after / before;
            x.iter_mut().zip(&y).for_each(|(x, y)| *x = y / after);
        }
        Self { inverse, largest: SAFETY * largest }
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&*self.inverse)
    }

    /// `x += p(D^-1 A) D^-1 (b - A x)` (Saad, "Iterative methods for sparse linear systems", algorithm 12.1). `t` has twice
    /// the length of `x`.
    pub(crate) fn sweep(&self, a: &DifferenceMatrix, b: &[f64], x: &mut [f64], t: &mut [f64]) {
        let (r, d) = t.split_at_mut(x.len());
        let (theta, delta) = (0.5 * (1.0 + LOWEST) * self.largest, 0.5 * (1.0 - LOWEST) * self.largest);
        let sigma = theta / delta;
        let mut rho = 1.0 / sigma;
        a.residual(x, b, r);
        for_each_row(d, |i, d| *d = self.inverse[i] * r[i] / theta);
        axpy(1.0, d, x);
        for _degree in 1..DEGREE {
            let next = 1.0 / (2.0 * sigma - rho);
            a.residual(x, b, r);
            for_each_row(d, |i, d| *d = next * rho * *d + 2.0 * next / delta * self.inverse[i] * r[i]);
            axpy(1.0, d, x);
            rho = next;
        }
    }
}
