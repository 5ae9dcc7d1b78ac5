//! A difference matrix with its rows multiplied by factors, as the iterative solvers see it.

use super::DifferenceMatrix;
use crate::csr::{Csr, for_each_row};
use crate::solver::{LinearOperator, Residuals};

/// `F A` with a diagonal matrix F; nothing is copied.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScaledRows<'a> {
    pub(crate) matrix: &'a DifferenceMatrix,
    /// F
    pub(crate) factors: &'a [f64],
}

impl ScaledRows<'_> {
    /// The same with its diagonal, rounded.
    pub(crate) fn to_csr(self) -> Csr {
        self.matrix.scaled_csr(|i| self.factors[i], |_| 1.0)
    }
}

impl LinearOperator for ScaledRows<'_> {
    fn dim(&self) -> usize {
        self.matrix.n()
    }

    fn apply(&self, x: &[f64], y: &mut [f64]) {
        for_each_row(y, |i, y| *y = self.factors[i] * self.matrix.row_product(i, x));
    }
}

impl Residuals for ScaledRows<'_> {
    fn residual(&self, x: &[f64], b: &[f64], r: &mut [f64]) {
        for_each_row(r, |i, r| *r = b[i] - self.factors[i] * self.matrix.row_product(i, x));
    }

    fn backward_error(&self, x: &[f64], b: &[f64]) -> f64 {
        let mut ratio = vec![0.0; b.len()];
        for_each_row(&mut ratio, |i, ratio| {
            let (columns, values) = self.matrix.row(i);
            let terms = columns.iter().zip(values).map(|(&j, a)| (a * x[j as usize]).abs());
            let terms = terms.sum::<f64>() + (self.matrix.diagonal(i) * x[i]).abs();
            let size = self.factors[i] * terms + b[i].abs();
            let r = b[i] - self.factors[i] * self.matrix.row_product(i, x);
            *ratio = if size == 0.0 { 0.0 } else { r.abs() / size };
        });
        // NaN must come through: f64::max would swallow it.
        ratio.iter().fold(0.0, |worst: f64, &r| if r > worst || r.is_nan() { r } else { worst })
    }
}
