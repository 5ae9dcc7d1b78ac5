//! Scaling of rows by powers of two, which rounds nothing.

use super::SolveError;
use crate::csr::Csr;
use std::sync::Arc;

/// A matrix scaled so that the sizes of coefficients do not decide about pivots and norms.
#[derive(Debug)]
pub(crate) struct Scaled {
    pub(crate) matrix: Arc<Csr>,
    /// Factors of the rows.
    rows: Vec<f64>,
    /// Factors of the columns; none if only rows are scaled.
    columns: Option<Vec<f64>>,
}

/// The power of two next below the reciprocal of `x > 0`, kept within the normal numbers.
fn reciprocal_power(x: f64) -> f64 {
    (-x.log2().floor()).clamp(-1000.0, 1000.0).exp2()
}

impl Scaled {
    /// Rows with a largest entry between 1 and 2.
    pub(crate) fn rows(matrix: &Csr) -> Result<Self, SolveError> {
        matrix.require_square()?;
        let mut rows = Vec::with_capacity(matrix.nrows());
        for row in 0..matrix.nrows() {
            let largest = matrix.row(row).1.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            if largest == 0.0 {
                return Err(SolveError::EmptyRow { row });
            }
            rows.push(reciprocal_power(largest));
        }
        Ok(Self { matrix: Arc::new(matrix.row_scaled(&rows)?), rows, columns: None })
    }

    /// Another matrix with its rows scaled by the same factors, so that sums over rows keep their meaning.
    pub(crate) fn renewed(&self, matrix: &Csr) -> Result<Self, SolveError> {
        let scaled = matrix.row_scaled(&self.rows)?;
        for row in 0..scaled.nrows() {
            let largest = scaled.row(row).1.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            if largest == 0.0 {
                return Err(SolveError::EmptyRow { row });
            }
        }
        Ok(Self { matrix: Arc::new(scaled), rows: self.rows.clone(), columns: None })
    }

    /// Rows and columns with the same factors and a diagonal between 1 and 4, which keeps a symmetric matrix so.
    /// None unless all of the diagonal is positive.
    pub(crate) fn symmetric(matrix: &Csr) -> Result<Option<Self>, SolveError> {
        matrix.require_square()?;
        let diagonal = matrix.diagonal();
        if diagonal.iter().any(|&d| d <= 0.0) {
            return Ok(None);
        }
        let factors: Vec<f64> = diagonal.iter().map(|d| reciprocal_power(d.sqrt())).collect();
        let scaled = Csr::from_rows(matrix.nrows(), matrix.ncols(), |i, row| {
            let (columns, values) = matrix.row(i);
            for (&j, a) in columns.iter().zip(values) {
                row.push(j as usize, a * factors[i] * factors[j as usize]);
            }
        })?;
        Ok(Some(Self { matrix: Arc::new(scaled), rows: factors.clone(), columns: Some(factors) }))
    }

    /// What every row counts for: by what it was multiplied, taken back. None where columns are scaled as well, which
    /// keeps a symmetric matrix symmetric.
    pub(crate) fn weights(&self) -> Option<Vec<f64>> {
        match self.columns {
            None => Some(self.rows.iter().map(|f| 1.0 / f).collect()),
            Some(_) => None,
        }
    }

    pub(crate) fn rhs(&self, rhs: &[f64]) -> Vec<f64> {
        rhs.iter().zip(&self.rows).map(|(b, f)| b * f).collect()
    }

    pub(crate) fn unscale(&self, mut x: Vec<f64>) -> Vec<f64> {
        if let Some(columns) = &self.columns {
            x.iter_mut().zip(columns).for_each(|(x, f)| *x *= f);
        }
        x
    }
}
