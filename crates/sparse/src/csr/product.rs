//! Products with vectors, in parallel over blocks of rows.

use super::Csr;
use crate::parallel;

/// Rows that one task works through. A row's result does not depend on it.
const ROWS_PER_TASK: usize = 2048;

/// `y[i] = f(i)` for every row, in parallel where there is enough to do.
#[inline]
pub(crate) fn for_each_row(y: &mut [f64], f: impl Fn(usize, &mut f64) + Sync) {
    if y.len() <= ROWS_PER_TASK {
        for (i, y) in y.iter_mut().enumerate() {
            f(i, y);
        }
        return;
    }
    parallel::for_each_part(y, ROWS_PER_TASK, &|task, y| {
        for (k, y) in y.iter_mut().enumerate() {
            f(task * ROWS_PER_TASK + k, y);
        }
    });
}

/// Calls `f(i, entries of row i)` for every row, in parallel over blocks of rows; `offsets` says where rows start.
pub(crate) fn for_each_row_of(offsets: &[usize], entries: &mut [f64], f: impl Fn(usize, &mut [f64]) + Sync) {
    let n = offsets.len() - 1;
    let mut parts = Vec::with_capacity(n.div_ceil(ROWS_PER_TASK));
    let mut rest = entries;
    for first in (0..n).step_by(ROWS_PER_TASK) {
        let last = n.min(first + ROWS_PER_TASK);
        let (own, others) = rest.split_at_mut(offsets[last] - offsets[first]);
        rest = others;
        parts.push((first..last, own));
    }
    parallel::for_each_task(parts, |(rows, own)| {
        let start = offsets[rows.start];
        for i in rows {
            f(i, &mut own[offsets[i] - start..offsets[i + 1] - start]);
        }
    });
}

/// Independent partial sums of a row: one sum would wait for each addition before the next.
const LANES: usize = 4;

impl Csr {
    /// `sum_j a_ij x_j`, in an order that depends on the number of entries only.
    #[inline]
    fn row_dot(&self, i: usize, x: &[f64]) -> f64 {
        let (columns, values) = self.row(i);
        let (column_lanes, column_rest) = columns.as_chunks::<LANES>();
        let (value_lanes, value_rest) = values.as_chunks::<LANES>();
        let mut lanes = [0.0; LANES];
        for (columns, values) in column_lanes.iter().zip(value_lanes) {
            for k in 0..LANES {
                lanes[k] += values[k] * x[columns[k] as usize];
            }
        }
        let rest = column_rest.iter().zip(value_rest).fold(0.0, |sum, (&j, a)| sum + a * x[j as usize]);
        lanes.iter().sum::<f64>() + rest
    }

    /// `y = A x`.
    ///
    /// # Panics
    /// If `x` has not `ncols` or `y` not `nrows` elements.
    pub fn mul_vec(&self, x: &[f64], y: &mut [f64]) {
        assert!(x.len() == self.ncols() && y.len() == self.nrows(), "A x: lengths do not match the matrix");
        for_each_row(y, |i, y| *y = self.row_dot(i, x));
    }

    /// `y += alpha A x`.
    ///
    /// # Panics
    /// If `x` has not `ncols` or `y` not `nrows` elements.
    pub fn mul_vec_add(&self, alpha: f64, x: &[f64], y: &mut [f64]) {
        assert!(x.len() == self.ncols() && y.len() == self.nrows(), "A x: lengths do not match the matrix");
        for_each_row(y, |i, y| *y += alpha * self.row_dot(i, x));
    }

    /// `r = b - A x`, subtracted entry by entry so that what cancels does so before the sum grows.
    ///
    /// # Panics
    /// If the lengths of `x`, `b` and `r` do not match the matrix.
    pub fn residual(&self, x: &[f64], b: &[f64], r: &mut [f64]) {
        let fits = x.len() == self.ncols() && b.len() == self.nrows() && r.len() == self.nrows();
        assert!(fits, "b - A x: lengths do not match the matrix");
        for_each_row(r, |i, r| {
            let (columns, values) = self.row(i);
            *r = columns.iter().zip(values).fold(b[i], |sum, (&j, a)| sum - a * x[j as usize]);
        });
    }

    /// Componentwise backward error `max_i |b - A x|_i / (|A| |x| + |b|)_i` (Oettli and Prager 1964): the largest
    /// relative change of single entries for which `x` is exact. Rows whose denominator is 0 do not count.
    ///
    /// # Panics
    /// If the lengths of `x` and `b` do not match the matrix.
    #[must_use]
    pub fn backward_error(&self, x: &[f64], b: &[f64]) -> f64 {
        assert!(x.len() == self.ncols() && b.len() == self.nrows(), "lengths do not match the matrix");
        let mut ratio = vec![0.0; b.len()];
        for_each_row(&mut ratio, |i, ratio| {
            let (columns, values) = self.row(i);
            let (mut r, mut size) = (b[i], b[i].abs());
            for (&j, a) in columns.iter().zip(values) {
                let term = a * x[j as usize];
                r -= term;
                size += term.abs();
            }
            *ratio = if size == 0.0 { 0.0 } else { r.abs() / size };
        });
        // NaN must come through: f64::max would swallow it.
        ratio.iter().fold(0.0, |worst: f64, &r| if r > worst || r.is_nan() { r } else { worst })
    }
}
