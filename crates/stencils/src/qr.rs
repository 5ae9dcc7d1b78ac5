//! Householder QR of a tall matrix in place, with column pivoting where it is asked for.
//!
//! Golub and Van Loan, *Matrix Computations*, 4th ed., algorithms 5.2.1 and 5.4.1. No memory is allocated once the
//! buffers have their size.

/// What an updated square of a norm may have lost before it is formed anew: the rest has half of the digits.
const CANCELLED: f64 = 1e-8;

/// A factorisation `A P = Q R` of an n x m matrix, n >= 1.
///
/// ```
/// use meshless_stencils::Qr;
///
/// // The line through (0, 1), (1, 2) and (2, 3), at 3: which combination of the three values is it?
/// let mut qr = Qr::default();
/// qr.resize(3, 2);
/// qr.column_mut(0).fill(1.0);
/// qr.column_mut(1).copy_from_slice(&[0.0, 1.0, 2.0]);
/// assert!(qr.factor(1e-12));
/// let (mut z, mut y) = ([0.0; 2], [0.0; 3]);
/// qr.least_norm(&[1.0, 3.0], &mut z, &mut y);
/// let value: f64 = y.iter().zip([1.0, 2.0, 3.0]).map(|(y, f)| y * f).sum();
/// assert!((value - 4.0).abs() < 1e-14);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Qr {
    rows: usize,
    columns: usize,
    /// Column-major; Householder vectors below the diagonal (their first entry is 1), R above it.
    a: Vec<f64>,
    diagonal: Vec<f64>,
    tau: Vec<f64>,
    pivots: Vec<usize>,
    /// Squared norms of what is left of the columns, and what they were when last formed from the columns.
    norms: Vec<f64>,
    fresh: Vec<f64>,
    rank: usize,
}

impl Qr {
    /// Room for a matrix; the caller fills [`Qr::column_mut`] and factors.
    pub fn resize(&mut self, rows: usize, columns: usize) {
        self.rows = rows;
        self.columns = columns;
        self.a.resize(rows * columns, 0.0);
        self.diagonal.resize(columns, 0.0);
        self.tau.resize(columns, 0.0);
        self.norms.resize(columns, 0.0);
        self.pivots.clear();
        self.pivots.extend(0..columns);
    }

    /// A column of the matrix; after factoring, of what is stored in its place.
    pub fn column_mut(&mut self, column: usize) -> &mut [f64] {
        &mut self.a[column * self.rows..(column + 1) * self.rows]
    }

    /// Column `column` becomes column `parent`, which comes before it, times a coordinate of the points in units.
    pub fn multiply_column<const D: usize>(
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

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Columns that were found to be independent.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Largest over smallest diagonal entry of R within the rank.
    pub fn condition(&self) -> f64 {
        let within = self.diagonal[..self.rank].iter().map(|d| d.abs());
        let (low, high) = within.fold((f64::INFINITY, 0.0_f64), |(l, h), d| (l.min(d), h.max(d)));
        if high > 0.0 { high / low } else { f64::INFINITY }
    }

    /// Factors without pivoting; false where a diagonal entry of R falls below `tolerance` times the largest.
    pub fn factor(&mut self, tolerance: f64) -> bool {
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
    ///
    /// The norms of what is left of the columns are updated from step to step, and formed anew where cancellation has
    /// eaten too much of them (Golub and Van Loan, section 5.4.2).
    pub fn factor_pivoted(&mut self, tolerance: f64) {
        self.rank = 0;
        let mut largest = 0.0_f64;
        for j in 0..self.columns {
            let column = &self.a[j * self.rows..(j + 1) * self.rows];
            self.norms[j] = dot(column, column);
        }
        self.fresh.clear();
        self.fresh.extend(&self.norms);
        for k in 0..self.columns.min(self.rows) {
            let pivot =
                (k..self.columns).fold(k, |best, j| if self.norms[j] > self.norms[best] { j } else { best });
            let column = &self.a[pivot * self.rows + k..(pivot + 1) * self.rows];
            let norm = dot(column, column).sqrt();
            largest = largest.max(norm);
            if norm <= tolerance * largest || norm == 0.0 {
                return;
            }
            if pivot != k {
                let (head, tail) = self.a.split_at_mut(pivot * self.rows);
                head[k * self.rows..(k + 1) * self.rows].swap_with_slice(&mut tail[..self.rows]);
                self.pivots.swap(k, pivot);
                self.norms.swap(k, pivot);
                self.fresh.swap(k, pivot);
            }
            self.reflect(k);
            self.rank = k + 1;
            for j in k + 1..self.columns {
                let column = &self.a[j * self.rows + k..(j + 1) * self.rows];
                self.norms[j] -= column[0] * column[0];
                if self.norms[j] <= CANCELLED * self.fresh[j] {
                    self.norms[j] = dot(&column[1..], &column[1..]);
                    self.fresh[j] = self.norms[j];
                }
            }
        }
    }

    /// Makes the Householder vector of column k and applies it to the columns after it.
    fn reflect(&mut self, k: usize) {
        let rows = self.rows;
        let (head, tail) = self.a.split_at_mut((k + 1) * rows);
        let v = &mut head[k * rows + k..];
        let below = dot(&v[1..], &v[1..]);
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
    pub fn least_norm(&self, b: &[f64], z: &mut [f64], y: &mut [f64]) -> f64 {
        let rows = self.rows;
        let mut remainder = 0.0_f64;
        for j in 0..self.columns {
            let known = j.min(self.rank);
            let column = &self.a[j * rows..j * rows + known];
            let sum = b[self.pivots[j]] - dot(column, &z[..known]);
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

    /// `x <- Q^T x`; the entries from the rank on are the part that the columns do not reach.
    pub fn apply_transpose(&self, x: &mut [f64]) {
        let rows = self.rows;
        for k in 0..self.rank {
            apply(&self.a[k * rows + k..(k + 1) * rows], self.tau[k], &mut x[k..rows]);
        }
    }

    /// Solves `R (P^T x) = y` with the rows within the rank; the entries beyond the rank are zero.
    pub fn back_substitute(&self, y: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        if self.pivots.iter().enumerate().all(|(k, &pivot)| k == pivot) {
            // By columns, which lie in a row in memory.
            x[..self.rank].copy_from_slice(&y[..self.rank]);
            for k in (0..self.rank).rev() {
                x[k] /= self.diagonal[k];
                let (before, own) = x.split_at_mut(k);
                let column = &self.a[k * self.rows..k * self.rows + k];
                before.iter_mut().zip(column).for_each(|(x, r)| *x -= r * own[0]);
            }
            return;
        }
        for k in (0..self.rank).rev() {
            let later = (k + 1..self.rank).map(|j| self.a[j * self.rows + k] * x[self.pivots[j]]);
            x[self.pivots[k]] = (y[k] - later.sum::<f64>()) / self.diagonal[k];
        }
    }

    /// Writes the projection of the unit vector `entry` onto the complement of the columns to `y`.
    ///
    /// It is made of what `Q^T e` has beyond the rank, not as a difference that could cancel.
    pub fn complement(&self, entry: usize, y: &mut [f64]) {
        let rows = self.rows;
        y.fill(0.0);
        y[entry] = 1.0;
        for k in 0..self.rank {
            apply(&self.a[k * rows + k..(k + 1) * rows], self.tau[k], &mut y[k..]);
        }
        y[..self.rank].fill(0.0);
        for k in (0..self.rank).rev() {
            apply(&self.a[k * rows + k..(k + 1) * rows], self.tau[k], &mut y[k..]);
        }
    }
}

/// `x -= tau v (v . x)`.
fn apply(v: &[f64], tau: f64, x: &mut [f64]) {
    let factor = tau * dot(v, x);
    x.iter_mut().zip(v).for_each(|(x, v)| *x -= factor * v);
}

/// A scalar product in four partial sums, which the processor can form side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a4, a_rest) = a.as_chunks::<4>();
    let (b4, b_rest) = b.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in a4.iter().zip(b4) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns of a Vandermonde matrix.
    fn vandermonde(rows: usize, columns: usize) -> Qr {
        let mut qr = Qr::default();
        qr.resize(rows, columns);
        for column in 0..columns {
            let power = |row: usize| (row as f64 / rows as f64 - 0.4).powi(column as i32);
            qr.column_mut(column).iter_mut().enumerate().for_each(|(row, x)| *x = power(row));
        }
        qr
    }

    #[test]
    fn both_factorisations_solve_the_same_problem() {
        let b = [1.0, -2.0, 0.5, 3.0, 1.0];
        let solve = |qr: &Qr| {
            let (mut z, mut y) = ([0.0; 5], [0.0; 11]);
            assert!(qr.least_norm(&b, &mut z, &mut y) == 0.0);
            y
        };
        let (mut plain, mut pivoted) = (vandermonde(11, 5), vandermonde(11, 5));
        assert!(plain.factor(1e-11));
        pivoted.factor_pivoted(1e-11);
        assert_eq!((plain.rank(), pivoted.rank()), (5, 5));
        let (y, w) = (solve(&plain), solve(&pivoted));
        let mut a = vandermonde(11, 5);
        for (column, b) in b.iter().enumerate() {
            let product: f64 = a.column_mut(column).iter().zip(&y).map(|(a, y)| a * y).sum();
            assert!((product - b).abs() < 1e-12, "{product} {b}");
        }
        assert!(y.iter().zip(&w).all(|(y, w)| (y - w).abs() < 1e-10 * (1.0 + y.abs())));
    }

    #[test]
    fn dependent_columns_are_left_out() {
        let mut qr = vandermonde(8, 3);
        let copy = qr.column_mut(1).to_vec();
        qr.column_mut(2).copy_from_slice(&copy);
        let mut plain = qr.clone();
        assert!(!plain.factor(1e-11));
        qr.factor_pivoted(1e-11);
        assert_eq!(qr.rank(), 2);
        let (mut z, mut y) = ([0.0; 3], [0.0; 8]);
        assert!(qr.least_norm(&[1.0, 2.0, 2.0], &mut z, &mut y) < 1e-13);
        assert!(qr.least_norm(&[1.0, 2.0, 3.0], &mut z, &mut y) > 0.4);
    }
}
