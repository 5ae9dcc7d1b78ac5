//! Matrices in difference form.

mod eliminate;
mod report;

pub use eliminate::Reduced;
pub use report::{MatrixReport, WrongSign};

use crate::csr::{Csr, RowBuilder, build_rows, for_each_row};
use crate::error::MatrixError;

/// A square matrix in difference form: row `i` reads `sum_j a_ij (u_j - u_i) + r_i u_i`.
///
/// The off-diagonal entries `a_ij` and the sum `r_i` of the row are stored; the diagonal `r_i - sum_j a_ij` is not,
/// because its rounding would act like an absorption of relative size 1e-16 of the largest coefficient, which at
/// a contrast of 1e10 is no longer small beside the smallest (Alfa, Xue and Ye, Math. Comp. 71, 2002, make the
/// same choice for elimination).
#[derive(Debug, Clone, PartialEq)]
pub struct DifferenceMatrix {
    off: Csr,
    row_sums: Vec<f64>,
}

impl DifferenceMatrix {
    /// Builds `n` rows in parallel. `fill(i, row)` pushes the coefficients `a_ij` of the differences `u_j - u_i`
    /// in any order, repeats add up, and adds to the row sum `r_i` what multiplies `u_i` itself. A push to the
    /// row's own column stands for `u_i - u_i` and is dropped.
    ///
    /// # Errors
    /// A column that is not below `n`, or a value that is not finite, with its row.
    pub fn from_rows(n: usize, fill: impl Fn(usize, &mut RowBuilder) + Sync) -> Result<Self, MatrixError> {
        Self::try_from_rows(
            n,
            || (),
            |(), i, row| {
                fill(i, row);
                Ok(())
            },
        )
    }

    /// Like [`DifferenceMatrix::from_rows`], with a closure that may fail and scratch for each task.
    ///
    /// # Errors
    /// Those of the closure and those of [`DifferenceMatrix::from_rows`]; of several, the one of the lowest row,
    /// whatever the number of threads.
    pub fn try_from_rows<S, E: From<MatrixError> + Send>(
        n: usize,
        scratch: impl Fn() -> S + Sync,
        fill: impl Fn(&mut S, usize, &mut RowBuilder) -> Result<(), E> + Sync,
    ) -> Result<Self, E> {
        let (off, row_sums) = build_rows(n, n, scratch, |scratch, i, row| {
            fill(scratch, i, row)?;
            row.drop_column(i);
            Ok::<(), E>(())
        })?;
        Ok(Self { off, row_sums })
    }

    /// Number of rows and columns.
    #[must_use]
    pub fn n(&self) -> usize {
        self.row_sums.len()
    }

    /// Number of stored off-diagonal entries.
    #[must_use]
    pub fn nnz(&self) -> usize {
        self.off.nnz()
    }

    /// Columns and coefficients of the differences in row `i`.
    #[must_use]
    #[inline]
    pub fn row(&self, i: usize) -> (&[u32], &[f64]) {
        self.off.row(i)
    }

    /// The sum of row `i`.
    #[must_use]
    pub fn row_sum(&self, i: usize) -> f64 {
        self.row_sums[i]
    }

    /// The off-diagonal entries.
    #[must_use]
    pub fn off_diagonal(&self) -> &Csr {
        &self.off
    }

    /// The diagonal entry of row `i`, rounded.
    #[must_use]
    pub fn diagonal(&self, i: usize) -> f64 {
        self.row_sums[i] - self.row(i).1.iter().sum::<f64>()
    }

    /// The matrix with its diagonal, rounded once. Every row has a diagonal entry, be it zero.
    #[must_use]
    pub fn to_csr(&self) -> Csr {
        let n = self.n();
        let mut offsets = Vec::with_capacity(n + 1);
        let mut indices = Vec::with_capacity(self.nnz() + n);
        let mut values = Vec::with_capacity(self.nnz() + n);
        offsets.push(0);
        for i in 0..n {
            let (columns, row) = self.row(i);
            let below = columns.partition_point(|&j| (j as usize) < i);
            indices.extend_from_slice(&columns[..below]);
            values.extend_from_slice(&row[..below]);
            indices.push(i as u32);
            values.push(self.diagonal(i));
            indices.extend_from_slice(&columns[below..]);
            values.extend_from_slice(&row[below..]);
            offsets.push(indices.len());
        }
        Csr::from_trusted(n, offsets, indices, values)
    }

    /// `y = A u` by differences: where `u` is nearly constant, nothing large cancels.
    ///
    /// # Panics
    /// If `u` or `y` has not [`DifferenceMatrix::n`] elements.
    pub fn mul_vec(&self, u: &[f64], y: &mut [f64]) {
        assert!(u.len() == self.n() && y.len() == self.n(), "A u: lengths do not match the matrix");
        for_each_row(y, |i, y| {
            let (columns, row) = self.row(i);
            let differences: f64 = columns.iter().zip(row).map(|(&j, a)| a * (u[j as usize] - u[i])).sum();
            *y = differences + self.row_sums[i] * u[i];
        });
    }

    /// `r = b - A u` by differences.
    ///
    /// # Panics
    /// If `u`, `b` or `r` has not [`DifferenceMatrix::n`] elements.
    pub fn residual(&self, u: &[f64], b: &[f64], r: &mut [f64]) {
        assert_eq!(b.len(), self.n(), "b - A u: lengths do not match the matrix");
        self.mul_vec(u, r);
        for (r, b) in r.iter_mut().zip(b) {
            *r = b - *r;
        }
    }
}
