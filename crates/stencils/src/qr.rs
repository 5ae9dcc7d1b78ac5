//! Householder QR of a tall matrix in place, with column pivoting where it is asked for.
//!
//! Golub and Van Loan, *Matrix Computations*, 4th ed., algorithms 5.2.1 and 5.4.1. No memory is allocated once the
//! buffers have their size.

/// A factorisation `A P = Q R` of an n x m matrix, n >= 1.
#[derive(Debug, Clone, Default)]
pub(crate) struct Qr {
    rows: usize,
    columns: usize,
    /// Column-major; Householder vectors below the diagonal (their first entry is 1), R above it.
    a: Vec<f64>,
    diagonal: Vec<f64>,
    tau: Vec<f64>,
    pivots: Vec<usize>,
    norms: Vec<f64>,
    rank: usize,
}

impl Qr {
    /// Room for a matrix; the caller fills [`Qr::column_mut`] and factors.
    pub(crate) fn resize(&mut self, rows: usize, columns: usize) {
        self.rows = rows;
        self.columns = columns;
        self.a.resize(rows * columns, 0.0);
        self.diagonal.resize(columns, 0.0);
        self.tau.resize(columns, 0.0);
        self.norms.resize(columns, 0.0);
        self.pivots.clear();
        self.pivots.extend(0..columns);
    }

    pub(crate) fn column_mut(&mut self, column: usize) -> &mut [f64] {
        &mut self.a[column * self.rows..(column + 1) * self.rows]
    }

    /// Column `column` becomes column `parent`, which comes before it, times a coordinate of the points in units.
    pub(crate) fn multiply_column<const D: usize>(
        &mut self,
        parent: usize,
        column: usize,
        points: &[[f64; D]],
        axis: usize,
        inverse_unit: f64,
    ) {
        let (head, tail) = self.a.split_at_mut(column * self.rows);
        let source = &head[parent * self.rows..(parent + 1) * self.rows];
        for ((value, parent), point) in tail[..self.rows].iter_mut().zip(source).zip(points) {
            *value = parent * point[axis] * inverse_unit;
        }
    }

    pub(crate) fn rank(&self) -> usize {
        self.rank
    }

    /// Largest over smallest diagonal entry of R within the rank.
    pub(crate) fn condition(&self) -> f64 {
        let within = self.diagonal[..self.rank].iter().map(|d| d.abs());
        let (low, high) = within.fold((f64::INFINITY, 0.0_f64), |(l, h), d| (l.min(d), h.max(d)));
        if high > 0.0 { high / low } else { f64::INFINITY }
    }

    /// Factors without pivoting; false where a diagonal entry of R falls below `tolerance` times the largest.
    pub(crate) fn factor(&mut self, tolerance: f64) -> bool {
        if self.rows < self.columns {
            return false;
        }
        let mut largest = 0.0_f64;
        for k in 0..self.columns {
            self.reflect(k);
            largest = largest.max(self.diagonal[k].abs());
        }
        self.rank = self.columns;
        let safe = |d: &f64| d.abs() > tolerance * largest;
        largest > 0.0 && self.diagonal[..self.columns].iter().all(safe)
    }

    /// Factors with column pivoting, and stops at the first column below `tolerance` times the largest.
    pub(crate) fn factor_pivoted(&mut self, tolerance: f64) {
        self.rank = 0;
        let mut largest = 0.0_f64;
        for k in 0..self.columns.min(self.rows) {
            for j in k..self.columns {
                let column = &self.a[j * self.rows + k..(j + 1) * self.rows];
                self.norms[j] = column.iter().map(|x| x * x).sum::<f64>();
            }
            let pivot =
                (k..self.columns).fold(k, |best, j| if self.norms[j] > self.norms[best] { j } else { best });
            let norm = self.norms[pivot].sqrt();
            largest = largest.max(norm);
            if norm <= tolerance * largest || norm == 0.0 {
                return;
            }
            if pivot != k {
                for row in 0..self.rows {
                    self.a.swap(k * self.rows + row, pivot * self.rows + row);
                }
                self.pivots.swap(k, pivot);
            }
            self.reflect(k);
            self.rank = k + 1;
        }
    }

    /// Makes the Householder vector of column k and applies it to the columns after it.
    fn reflect(&mut self, k: usize) {
        let rows = self.rows;
        let (head, tail) = self.a.split_at_mut((k + 1) * rows);
        let v = &mut head[k * rows + k..];
        let below: f64 = v[1..].iter().map(|x| x * x).sum();
        let alpha = v[0];
        let norm = (alpha * alpha + below).sqrt();
        if below == 0.0 {
            self.diagonal[k] = alpha;
            self.tau[k] = 0.0;
            v[0] = 1.0;
            return;
        }
        let beta = if alpha > 0.0 { -norm } else { norm };
        let scale = 1.0 / (alpha - beta);
        v[1..].iter_mut().for_each(|x| *x *= scale);
        v[0] = 1.0;
        let tau = (beta - alpha) / beta;
        self.diagonal[k] = beta;
        self.tau[k] = tau;
        for column in tail.chunks_exact_mut(rows).take(self.columns - k - 1) {
            apply(v, tau, &mut column[k..]);
        }
    }

    /// Solves `R^T z = P^T b` with the first rows of R, writes `Q z` to `y`, and returns the largest remainder of the
    /// equations beyond the rank: how far the right-hand side is from what the columns can represent.
    pub(crate) fn least_norm(&self, b: &[f64], z: &mut [f64], y: &mut [f64]) -> f64 {
        let rows = self.rows;
        let mut remainder = 0.0_f64;
        for j in 0..self.columns {
            let known = j.min(self.rank);
            let column = &self.a[j * rows..j * rows + known];
            let sum = b[self.pivots[j]] - column.iter().zip(&z[..known]).map(|(r, z)| r * z).sum::<f64>();
            if j < self.rank {
                z[j] = sum / self.diagonal[j];
            } else {
                remainder = remainder.max(sum.abs());
            }
        }
        y[..self.rank].copy_from_slice(&z[..self.rank]);
        y[self.rank..rows].fill(0.0);
        for k in (0..self.rank).rev() {
            apply(&self.a[k * rows + k..(k + 1) * rows], self.tau[k], &mut y[k..rows]);
        }
        remainder
    }
}

/// `x -= tau v (v . x)`, with v[0] read as 1.
fn apply(v: &[f64], tau: f64, x: &mut [f64]) {
    let (first, rest) = x.split_at_mut(1);
    let dot = tau * (first[0] + v[1..].iter().zip(rest.iter()).map(|(v, x)| v * x).sum::<f64>());
    first[0] -= dot;
    rest.iter_mut().zip(&v[1..]).for_each(|(x, v)| *x -= dot * v);
}
