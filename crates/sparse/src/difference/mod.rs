//! Matrices in difference form.

mod eliminate;
mod report;
mod scaled;

pub use eliminate::Reduced;
pub use report::{MatrixReport, WrongSign};
pub(crate) use scaled::ScaledRows;

use crate::csr::{Csr, RowBuilder, build_rows, for_each_row, joined};
use crate::error::MatrixError;
use crate::parallel;
use crate::solver::reciprocal_power;

/// Rows that one task takes apart or puts together.
const ROWS_PER_BLOCK: usize = 4096;

/// A sum of entries below this many units in the last place of their sizes is zero, but for rounding.
pub(crate) const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Independent partial sums of a row: one sum would wait for each addition before the next.
const LANES: usize = 4;

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
    pub fn try_from_rows<S: Send, E: From<MatrixError> + Send>(
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

    /// Off-diagonal entries and sums that are known to be in order.
    pub(crate) fn from_trusted(off: Csr, row_sums: Vec<f64>) -> Self {
        debug_assert!(off.nrows() == row_sums.len() && off.ncols() == row_sums.len());
        Self { off, row_sums }
    }

    /// A matrix that comes with its diagonal: the sums of its rows, zero where only rounding is left of them.
    ///
    /// # Errors
    /// [`MatrixError::NotSquare`].
    pub(crate) fn from_csr(matrix: &Csr) -> Result<Self, MatrixError> {
        matrix.require_square()?;
        let n = matrix.nrows();
        let parts = parallel::map(n.div_ceil(ROWS_PER_BLOCK), |block| {
            let (mut lengths, mut indices, mut values) = (Vec::new(), Vec::new(), Vec::new());
            for i in block * ROWS_PER_BLOCK..n.min((block + 1) * ROWS_PER_BLOCK) {
                let (columns, row) = matrix.row(i);
                let before = indices.len();
                for (&j, &a) in columns.iter().zip(row).filter(|(j, _)| **j as usize != i) {
                    indices.push(j);
                    values.push(a);
                }
                lengths.push(indices.len() - before);
            }
            (lengths, indices, values)
        });
        let off = joined(n, n, parts.iter().map(|p| (&p.0[..], &p.1[..], &p.2[..])).collect());
        let mut row_sums = vec![0.0; n];
        for_each_row(&mut row_sums, |i, sum| {
            let (total, size) = matrix.row(i).1.iter().fold((0.0, 0.0), |(t, s), v| (t + v, s + v.abs()));
            *sum = if f64::abs(total) <= ROUNDING * size { 0.0 } else { total };
        });
        Ok(Self { off, row_sums })
    }

    /// Bytes of entries and sums.
    pub(crate) fn bytes(&self) -> usize {
        self.off.bytes() + size_of_val(&*self.row_sums)
    }

    /// Whether all entries and sums are numbers.
    pub(crate) fn require_finite(&self) -> Result<(), MatrixError> {
        self.off.require_finite()?;
        match self.row_sums.iter().position(|s| !s.is_finite()) {
            None => Ok(()),
            Some(row) => Err(MatrixError::NotFinite { row, column: row, value: self.row_sums[row] }),
        }
    }

    /// Powers of two by which rows are multiplied for their largest entries to lie between 1 and 2.
    pub(crate) fn balancing_factors(&self) -> Vec<f64> {
        let mut factors = vec![0.0; self.n()];
        for_each_row(&mut factors, |i, factor| {
            let entries = self.row(i).1.iter();
            let largest = entries.fold(self.diagonal(i).abs(), |m: f64, v| m.max(v.abs()));
            *factor = if largest > 0.0 { reciprocal_power(largest) } else { 1.0 };
        });
        factors
    }

    /// The matrix in a new numbering, see [`Csr::permuted`].
    ///
    /// # Errors
    /// [`MatrixError::NotAPermutation`].
    pub(crate) fn permuted(&self, order: &[u32]) -> Result<Self, MatrixError> {
        let off = self.off.permuted(order)?;
        Ok(Self { off, row_sums: order.iter().map(|&i| self.row_sums[i as usize]).collect() })
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

    pub(crate) fn row_sums(&self) -> &[f64] {
        &self.row_sums
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
        self.scaled_csr(|_| 1.0, |_| 1.0)
    }

    /// [`DifferenceMatrix::to_csr`] with row `i` multiplied by `row(i)` and column `j` by `column(j)`.
    pub(crate) fn scaled_csr(
        &self,
        row: impl Fn(usize) -> f64 + Sync,
        column: impl Fn(usize) -> f64 + Sync,
    ) -> Csr {
        let n = self.n();
        let parts = parallel::map(n.div_ceil(ROWS_PER_BLOCK), |block| {
            let (mut lengths, mut indices, mut values) = (Vec::new(), Vec::new(), Vec::new());
            for i in block * ROWS_PER_BLOCK..n.min((block + 1) * ROWS_PER_BLOCK) {
                let (columns, entries) = self.row(i);
                let factor = row(i);
                let below = columns.partition_point(|&j| (j as usize) < i);
                let mut push = |j: u32, a: f64| {
                    indices.push(j);
                    values.push(factor * a * column(j as usize));
                };
                columns[..below].iter().zip(entries).for_each(|(&j, &a)| push(j, a));
                push(i as u32, self.diagonal(i));
                columns[below..].iter().zip(&entries[below..]).for_each(|(&j, &a)| push(j, a));
                lengths.push(columns.len() + 1);
            }
            (lengths, indices, values)
        });
        joined(n, n, parts.iter().map(|p| (&p.0[..], &p.1[..], &p.2[..])).collect())
    }

    /// Row `i` of `A u`, by differences.
    #[inline]
    pub(crate) fn row_product(&self, i: usize, u: &[f64]) -> f64 {
        let (columns, values) = self.row(i);
        let own = u[i];
        let (column_lanes, column_rest) = columns.as_chunks::<LANES>();
        let (value_lanes, value_rest) = values.as_chunks::<LANES>();
        let mut lanes = [0.0; LANES];
        for (columns, values) in column_lanes.iter().zip(value_lanes) {
            for k in 0..LANES {
                lanes[k] += values[k] * (u[columns[k] as usize] - own);
            }
        }
        let rest = column_rest.iter().zip(value_rest);
        let rest = rest.fold(0.0, |sum, (&j, a)| sum + a * (u[j as usize] - own));
        lanes.iter().sum::<f64>() + rest + self.row_sums[i] * own
    }

    /// `y = A u` by differences: where `u` is nearly constant, nothing large cancels.
    ///
    /// # Panics
    /// If `u` or `y` has not [`DifferenceMatrix::n`] elements.
    pub fn mul_vec(&self, u: &[f64], y: &mut [f64]) {
        assert!(u.len() == self.n() && y.len() == self.n(), "A u: lengths do not match the matrix");
        for_each_row(y, |i, y| *y = self.row_product(i, u));
    }

    /// `r = b - A u` by differences.
    ///
    /// # Panics
    /// If `u`, `b` or `r` has not [`DifferenceMatrix::n`] elements.
    pub fn residual(&self, u: &[f64], b: &[f64], r: &mut [f64]) {
        let fits = u.len() == self.n() && b.len() == self.n() && r.len() == self.n();
        assert!(fits, "b - A u: lengths do not match the matrix");
        for_each_row(r, |i, r| *r = b[i] - self.row_product(i, u));
    }
}
