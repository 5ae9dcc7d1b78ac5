//! Scaling of rows by powers of two, which rounds nothing.

use super::SolveError;
use crate::csr::{Csr, for_each_row};
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
pub(crate) fn reciprocal_power(x: f64) -> f64 {
    (-x.log2().floor()).clamp(-1000.0, 1000.0).exp2()
}

/// The largest absolute value of every row; none may be zero.
fn largest_entries(matrix: &Csr) -> Result<Vec<f64>, SolveError> {
    let mut largest = vec![0.0; matrix.nrows()];
    for_each_row(&mut largest, |i, largest| {
        *largest = matrix.row(i).1.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    });
    match largest.iter().position(|&l| l == 0.0) {
        Some(row) => Err(SolveError::EmptyRow { row }),
        None => Ok(largest),
    }
}

impl Scaled {
    /// Rows with a largest entry between 1 and 2.
    pub(crate) fn rows(matrix: &Csr) -> Result<Self, SolveError> {
        matrix.require_square()?;
        let mut rows = largest_entries(matrix)?;
        for_each_row(&mut rows, |_, largest| *largest = reciprocal_power(*largest));
        Ok(Self { matrix: Arc::new(matrix.row_scaled(&rows)?), rows, columns: None })
    }

    /// Rows multiplied by factors that are given.
    fn by_factors(matrix: &Csr, rows: Vec<f64>) -> Result<Self, SolveError> {
        matrix.require_square()?;
        let matrix = Arc::new(matrix.row_scaled(&rows)?);
        largest_entries(&matrix)?;
        Ok(Self { matrix, rows, columns: None })
    }

    /// Another matrix with its rows scaled by the same factors, so that sums over rows keep their meaning.
    pub(crate) fn renewed(&self, matrix: &Csr) -> Result<Self, SolveError> {
        Self::by_factors(matrix, self.rows.clone())
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

    /// What the rows were multiplied by.
    pub(crate) fn factors(&self) -> &[f64] {
        &self.rows
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
