//! Systems with a few extra unknowns, solved by block elimination.

use super::dense::DenseLu;
use crate::csr::Csr;
use crate::difference::DifferenceMatrix;
use crate::error::MatrixError;
use crate::solver::{Prepared, SolveError, SolveInfo, SolverParams};
use crate::vector::{axpy, norm};

/// `A w + B c = b` in `n` equations for `n` values `w` and `m` extra unknowns `c`, where `w = 0` at `m` pinned nodes.
///
/// It is solved as
/// ```text
/// [ A'  B' ] [w]   [b']
/// [ C   D  ] [c] = [g ]
/// ```
/// where `A'` has the equations of the pinned nodes replaced by `w = 0`, and these equations are the rows of `C`, `D`,
/// `g`. `A` is kept in difference form, so that residuals are accurate.
#[derive(Debug, Clone, PartialEq)]
pub struct Bordered {
    matrix: DifferenceMatrix,
    /// Entries of each column of `B`: row, value.
    columns: Vec<Vec<(u32, f64)>>,
    pinned: Vec<u32>,
    rhs: Vec<f64>,
}

/// Solution of a [`Bordered`] system.
#[derive(Debug, Clone, PartialEq)]
pub struct BorderedSolution {
    /// `w`
    pub values: Vec<f64>,
    /// `c`
    pub extra: Vec<f64>,
    /// How the last system with `A'` was solved; products of all of them; residual and backward error of the whole
    /// bordered system.
    pub info: SolveInfo,
}

impl Bordered {
    /// `columns[k]` has the entries (row, value) of extra unknown `k`, `pinned[k]` is the node whose `w` is 0 for it.
    ///
    /// # Errors
    /// Lengths that do not fit, rows out of range, a node pinned twice, numbers that are not finite.
    pub fn new(
        matrix: DifferenceMatrix,
        columns: Vec<Vec<(u32, f64)>>,
        pinned: Vec<u32>,
        rhs: Vec<f64>,
    ) -> Result<Self, MatrixError> {
        MatrixError::check_length("right-hand side", rhs.len(), matrix.n())?;
        MatrixError::check_finite("right-hand side", &rhs)?;
        MatrixError::check_length("pinned nodes", pinned.len(), columns.len())?;
        for (row, value) in columns.iter().flatten().map(|&(row, value)| (row as usize, value)) {
            if row >= matrix.n() {
                return Err(MatrixError::RowOutOfRange { row, nrows: matrix.n() });
            }
            if !value.is_finite() {
                return Err(MatrixError::BadNumber {
                    what: "coefficient of an extra unknown",
                    node: row,
                    value,
                });
            }
        }
        for (cluster, node) in pinned.iter().enumerate() {
            if *node as usize >= matrix.n() {
                return Err(MatrixError::RowOutOfRange { row: *node as usize, nrows: matrix.n() });
            }
            if pinned[..cluster].contains(node) {
                return Err(MatrixError::NoPin {
                    cluster,
                    reason: "its node is pinned for another one already",
                });
            }
        }
        Ok(Self { matrix, columns, pinned, rhs })
    }

    /// Number of values `w`.
    #[must_use]
    pub fn n(&self) -> usize {
        self.rhs.len()
    }

    /// Number of extra unknowns `c`.
    #[must_use]
    pub fn extra(&self) -> usize {
        self.pinned.len()
    }

    /// The matrix `A`, before any equation is replaced.
    #[must_use]
    pub fn matrix(&self) -> &DifferenceMatrix {
        &self.matrix
    }

    /// The columns of `B` as (row, value).
    #[must_use]
    pub fn columns(&self) -> &[Vec<(u32, f64)>] {
        &self.columns
    }

    /// The matrix `A'`: the equations of the pinned nodes replaced by `w = 0`.
    #[must_use]
    pub fn pinned_matrix(&self) -> Csr {
        let a = self.matrix.to_csr();
        let mut is_pinned = vec![false; self.n()];
        self.pinned.iter().for_each(|&p| is_pinned[p as usize] = true);
        let mut offsets = vec![0];
        let (mut indices, mut values) = (Vec::with_capacity(a.nnz()), Vec::with_capacity(a.nnz()));
        for i in 0..self.n() {
            let (columns, row) = a.row(i);
            if is_pinned[i] {
                indices.push(i as u32);
                values.push(1.0);
            } else {
                indices.extend_from_slice(columns);
                values.extend_from_slice(row);
            }
            offsets.push(indices.len());
        }
        Csr::from_trusted(self.n(), offsets, indices, values)
    }

    /// The right-hand side that belongs to [`Bordered::pinned_matrix`].
    #[must_use]
    pub fn pinned_rhs(&self) -> Vec<f64> {
        self.without_pinned(self.rhs.clone())
    }

    /// Solves the system: one factorisation or preconditioner of `A'`, one solution for each extra unknown and one for
    /// the right-hand side, the Schur complement `D - C A'^-1 B'` by Gaussian elimination, and one step of
    /// iterative refinement on the whole.
    ///
    /// # Errors
    /// Those of [`solve`](crate::solve), and [`SolveError::Undetermined`] where the equations leave an extra unknown
    /// open.
    pub fn solve(&self, params: &SolverParams) -> Result<BorderedSolution, SolveError> {
        let prepared = PreparedBordered::new(self.clone(), params)?;
        let mut solution = prepared.solve(&self.rhs)?;
        solution.info.iterations += prepared.products;
        Ok(solution)
    }

    /// `b - A w - B c`, by differences.
    #[must_use]
    pub fn residual(&self, values: &[f64], extra: &[f64]) -> Vec<f64> {
        self.residual_of(&self.rhs, values, extra)
    }

    fn residual_of(&self, rhs: &[f64], values: &[f64], extra: &[f64]) -> Vec<f64> {
        let mut r = vec![0.0; self.n()];
        self.matrix.residual(values, rhs, &mut r);
        for (column, c) in self.columns.iter().zip(extra) {
            for &(row, value) in column {
                r[row as usize] -= value * c;
            }
        }
        r
    }

    /// Largest residual relative to the sum of the sizes of the terms of its equation.
    fn backward_error(&self, rhs: &[f64], values: &[f64], extra: &[f64]) -> f64 {
        let r = self.residual_of(rhs, values, extra);
        let mut size: Vec<f64> = rhs.iter().map(|b| b.abs()).collect();
        for i in 0..self.n() {
            let (columns, row) = self.matrix.row(i);
            let terms = columns.iter().zip(row).map(|(&j, a)| (a * values[j as usize]).abs());
            size[i] += terms.sum::<f64>() + (self.matrix.diagonal(i) * values[i]).abs();
        }
        for (column, c) in self.columns.iter().zip(extra) {
            for &(row, value) in column {
                size[row as usize] += (value * c).abs();
            }
        }
        let ratio = r.iter().zip(&size).map(|(r, s)| if *s == 0.0 { 0.0 } else { r.abs() / s });
        ratio.fold(0.0, |m: f64, v| if v > m || v.is_nan() { v } else { m })
    }

    /// `(A w)_p` for each pinned node.
    fn border_rows(&self, w: &[f64]) -> Vec<f64> {
        let row = |&p: &u32| {
            let p = p as usize;
            let (columns, values) = self.matrix.row(p);
            let sum: f64 = columns.iter().zip(values).map(|(&j, a)| a * (w[j as usize] - w[p])).sum();
            sum + self.matrix.row_sum(p) * w[p]
        };
        self.pinned.iter().map(row).collect()
    }

    fn without_pinned(&self, mut b: Vec<f64>) -> Vec<f64> {
        self.pinned.iter().for_each(|&p| b[p as usize] = 0.0);
        b
    }
}

/// A [`Bordered`] system with what is computed once for all right-hand sides.
#[derive(Debug)]
pub struct PreparedBordered {
    system: Bordered,
    prepared: Prepared,
    /// `A'^-1 B'`, column by column.
    responses: Vec<Vec<f64>>,
    schur: DenseLu,
    products: usize,
}

impl PreparedBordered {
    /// Factors, or sets up the preconditioner, and solves for the response to every extra unknown.
    ///
    /// # Errors
    /// See [`Bordered::solve`].
    pub fn new(system: Bordered, params: &SolverParams) -> Result<Self, SolveError> {
        let prepared = Prepared::new(&system.pinned_matrix(), params)?;
        let m = system.extra();
        let mut schur = vec![vec![0.0; m]; m];
        let mut responses = Vec::with_capacity(m);
        let mut products = 0;
        for (k, column) in system.columns.iter().enumerate() {
            let mut b = vec![0.0; system.n()];
            column.iter().for_each(|&(row, value)| b[row as usize] += value);
            for (l, &p) in system.pinned.iter().enumerate() {
                schur[l][k] = b[p as usize];
            }
            let (x, info) = prepared.solve(&system.without_pinned(b))?;
            products += info.iterations;
            for (l, value) in system.border_rows(&x).into_iter().enumerate() {
                schur[l][k] -= value;
            }
            responses.push(x);
        }
        Ok(Self { system, prepared, responses, schur: DenseLu::new(schur)?, products })
    }

    /// Solves for another right-hand side, with one step of iterative refinement.
    ///
    /// # Errors
    /// See [`Bordered::solve`]; [`MatrixError::Length`] where `rhs` does not have one element for each equation.
    pub fn solve(&self, rhs: &[f64]) -> Result<BorderedSolution, SolveError> {
        let system = &self.system;
        MatrixError::check_length("right-hand side", rhs.len(), system.n())?;
        let (mut values, mut extra, mut info) = self.eliminate(rhs)?;
        let mut products = info.iterations;
        if system.extra() > 0 {
            let residual = system.residual_of(rhs, &values, &extra);
            // What is left may be rounding that an iterative method cannot reduce: then the solution stays as it is.
            if let Ok((d_values, d_extra, d_info)) = self.eliminate(&residual) {
                products += d_info.iterations;
                let better_values: Vec<f64> = values.iter().zip(&d_values).map(|(a, b)| a + b).collect();
                let better_extra: Vec<f64> = extra.iter().zip(&d_extra).map(|(a, b)| a + b).collect();
                let better = system.backward_error(rhs, &better_values, &better_extra);
                if better <= system.backward_error(rhs, &values, &extra) {
                    (values, extra) = (better_values, better_extra);
                }
            }
            let left = norm(&system.residual_of(rhs, &values, &extra));
            info.residual = left / norm(rhs).max(f64::MIN_POSITIVE);
            info.backward_error = system.backward_error(rhs, &values, &extra);
        }
        info.iterations = products;
        Ok(BorderedSolution { values, extra, info })
    }

    fn eliminate(&self, b: &[f64]) -> Result<(Vec<f64>, Vec<f64>, SolveInfo), SolveError> {
        let (mut w, info) = self.prepared.solve(&self.system.without_pinned(b.to_vec()))?;
        let carried = self.system.border_rows(&w);
        let g: Vec<f64> =
            self.system.pinned.iter().zip(&carried).map(|(&p, row)| b[p as usize] - row).collect();
        let extra = self.schur.solve(&g);
        for (x, c) in self.responses.iter().zip(&extra) {
            axpy(-c, x, &mut w);
        }
        Ok((w, extra, info))
    }
}
